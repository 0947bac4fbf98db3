"""Where the gap lies: the nominal model's differences by trial, condition, place, time, phase, contact and channel.

A number's share of the gap is `ρ(r) - ν` over the sum of the same, ρ Huber's loss of its whitened difference and ν what
noise gives it. A part of the data counts as affected where in one of its channels, of n numbers there,

```text
Σ (ρ(r) - ν) > 3 · 2 √n
```

which is three standard errors of a sum of squares whose numbers are correlated in pairs. No part counts as affected
unless a trial does, and in a trial ν is 1, the floor's variance, which is more than the noise has.

Of time, of place and of the cycle an interval holds most of what is affected. Where the gap sets in at a moment, in a
place along y or in a part of the cycle that trials share (`onset`), the region is that instead. Where nothing explains
the gap, and trials share no moment at which it sets in, it is that of the place, the part of the cycle or the time in
which an effect acts alone (`in_part`), if there is one: what is wrong from somewhere on shows where it began, and less
where it ended.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...effects.base import Effect
from ...progress import OnPhase
from ..gap.comparison import Comparison, Residual
from ..gap.observed import CHANNELS
from ..gap.pose import Path
from ..gap.predictive import contradicted
from ..result import HeatMap, Region
from .cells import MODES, Cells
from .in_part import acts_in_part
from .onset import begins_at_phase, begins_at_place, begins_at_time

__all__ = ["localise"]

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
Mask = NDArray[np.bool_]

_SIGNIFICANT = 6.0
# A trial is off where its track's mean square is greater than noise by this much.
_TRIAL_EXCESS = 0.3
# An interval holds this much of what stands out on its axis; a region with less of the whole gap is not worth telling.
_MOST = 0.8
_LEAST_SHARE = 0.1
# A region holds more of the gap than of the numbers by this factor.
_CONCENTRATED = 1.25
_BINS = 10
_PHASES = 12
_MOST_CELLS = 14
# Conditions that are nearer to each other than this share are one.
_SAME = 0.02


@dataclass(frozen=True, eq=False)
class _Axis:
    """Bins along a number: which bin each cell is in (-1: none), and the ends of each bin."""

    name: str
    place: Ints
    low: Floats
    high: Floats
    turns: bool = False

    @property
    def labels(self) -> tuple[str, ...]:
        return tuple(
            f"{low:.3g}" if high <= low * (1.0 + _SAME) else f"{low:.3g}–{high:.3g}"
            for low, high in zip(self.low, self.high, strict=True)
        )


def localise(
    comparison: Comparison,
    residual: Residual,
    paths: Sequence[Path | None],
    unexplained: bool = False,
    effects: tuple[Effect, ...] = (),
    on_phase: OnPhase | None = None,
) -> tuple[tuple[Region, ...], tuple[HeatMap, ...]]:
    """Return the regions of the gap, the greatest share first, and maps of it.

    Parameters
    ----------
    comparison
        The dataset, ready to be compared.
    residual
        How wrong the nominal model is, the sensor's nuisances fitted.
    paths
        The nominal model's.
    unexplained
        Whether no effect that acts all along explains the gap, so that one is looked for that acts in a part alone.
    effects
        The best that act all along.
    on_phase
        Is told the phase, how much of it is done, and of how much.

    Returns
    -------
    tuple
        Regions, none where noise explains the differences, and heat maps.
    """
    cells = Cells.of(comparison, residual, paths)
    ids = tuple(trial.id for trial in comparison.dataset.trials)
    axes = _axes(cells)
    total = float(np.sum(np.maximum(_sums(cells.trial, cells.excess, len(ids)), 0.0)))
    regions = _trials(cells, ids, total, contradicted(comparison, residual))
    if regions:
        found = [begins(comparison, residual, paths) for begins in (begins_at_time, begins_at_place, begins_at_phase)]
        begun = {region.axis: region for region in found if region is not None}
        if unexplained and "time_s" not in begun:
            shares = [next((r.share_of_gap for r in regions if r.value == name), 0.0) for name in ids]
            parts = acts_in_part(comparison, residual, paths, shares, effects, on_phase)
            # Where it began to show along the other axis is not where it acts.
            begun = {part.axis: _with_sigmas(cells, part) for part in parts} or begun
        for axis in axes.values():
            regions += [begun[axis.name]] if axis.name in begun else _interval(cells, axis, total)
        regions += _values(cells, "contact_mode", cells.mode, MODES, total)
        regions += _values(cells, "channel", cells.channel, CHANNELS, total)
    regions.sort(key=lambda region: -region.share_of_gap)
    return tuple(regions), _maps(cells, ids, axes)


def _with_sigmas(cells: Cells, part: Region) -> Region:
    """Return a part of the cycle, of the way or of the time with how far off the numbers in it are."""
    assert part.low is not None
    assert part.high is not None
    place = {"cycle_phase_deg": cells.phase_deg, "position_y_m": cells.y_m, "time_s": cells.time_s}[part.axis]
    beyond = (place - part.low) % 360.0 if part.axis == "cycle_phase_deg" else place - part.low
    inside = (beyond >= 0.0) & (beyond <= part.high - part.low)
    return replace(part, sigmas=_rms(cells, inside)) if inside.any() else part


def _sums(place: Ints, values: Floats, count: int) -> Floats:
    kept = place >= 0
    return np.asarray(np.bincount(place[kept], values[kept], count), dtype=np.float64)


def _stands_out(cells: Cells, mask: Mask, excess: Floats) -> bool:
    """Whether one of the channels is off there."""
    count = np.bincount(cells.channel[mask], minlength=len(CHANNELS))
    sums = np.bincount(cells.channel[mask], excess[mask], len(CHANNELS))
    return bool(np.any(sums > _SIGNIFICANT * np.sqrt(np.maximum(count, 1))))


def _rms(cells: Cells, mask: Mask) -> float:
    return float(np.sqrt(np.mean(cells.loss[mask])))


def _trials(cells: Cells, ids: tuple[str, ...], total: float, denied: Mask) -> list[Region]:
    regions = []
    for i, name in enumerate(ids):
        mine = cells.trial == i
        track, outcomes = mine & ~cells.outcome, mine & cells.outcome
        # Of yes or no the other is said by less than that.
        off = bool(denied[i]) or any(cells.loss[k] - 1.0 > _SIGNIFICANT for k in np.flatnonzero(outcomes))
        if track.any() and _stands_out(cells, track, cells.loss - 1.0):
            # A channel whose floor is wide does not hide the others.
            excess = [cells.excess[track & (cells.channel == c)].sum() for c in range(len(CHANNELS))]
            off = off or sum(max(float(e), 0.0) for e in excess) > _TRIAL_EXCESS * track.sum()
        if off:
            share = _share(cells, mine, total)
            regions.append(Region("trial", share, value=name, sigmas=_rms(cells, mine)))
    return regions


def _share(cells: Cells, mask: Mask, total: float) -> float:
    return float(np.clip(np.sum(cells.excess[mask]) / max(total, 1e-12), 0.0, 1.0))


def _axes(cells: Cells) -> dict[str, _Axis]:
    conditions = {name: getattr(cells, name) for name in ("frequency_Hz", "strength_T", "incline_deg")}
    axes = [_conditions(name.replace("strength_T", "field_strength_T"), values) for name, values in conditions.items()]
    axes += [
        _even("time_s", cells.time_s),
        _even("position_x_m", cells.x_m),
        _even("position_y_m", cells.y_m),
        _even("cycle_phase_deg", cells.phase_deg, (0.0, 360.0), _PHASES),
    ]
    return {axis.name: axis for axis in axes}


def _conditions(name: str, values: Floats) -> _Axis:
    present = np.unique(values[np.isfinite(values)])
    groups: list[list[float]] = []
    for value in present:
        if groups and abs(value - groups[-1][0]) <= _SAME * abs(groups[-1][0]):
            groups[-1].append(float(value))
        else:
            groups.append([float(value)])
    low, high = np.array([g[0] for g in groups]), np.array([g[-1] for g in groups])
    place = np.searchsorted(low, np.nan_to_num(values, nan=-np.inf), side="right") - 1
    return _Axis(name, place.astype(np.intp), low, high)


def _even(name: str, values: Floats, ends: tuple[float, float] | None = None, count: int = _BINS) -> _Axis:
    finite = np.isfinite(values)
    if not finite.any():
        return _Axis(name, np.full(len(values), -1, dtype=np.intp), np.empty(0), np.empty(0))
    low, high = (float(values[finite].min()), float(values[finite].max())) if ends is None else ends
    edges = np.linspace(low, max(high, low + 1e-12), count + 1)
    place = np.searchsorted(edges[1:-1], np.nan_to_num(values), side="right")
    return _Axis(name, np.where(finite, place, -1).astype(np.intp), edges[:-1], edges[1:], turns=ends is not None)


def _interval(cells: Cells, axis: _Axis, total: float) -> list[Region]:
    """Return the shortest interval that holds most of what stands out, unless it holds little more than any other."""
    count = len(axis.low)
    if count < 2:
        return []
    arises = axis.name in ("position_x_m", "position_y_m", "cycle_phase_deg")
    for loss in (cells.fresh, cells.loss) if arises else (cells.loss,):
        off = np.array([_stands_out(cells, axis.place == b, loss - cells.noise) for b in range(count)])
        if off.any():
            break
    else:
        return []
    held = np.where(off, np.maximum(_sums(axis.place, loss - cells.noise, count), 0.0), 0.0)
    if held.sum() <= 0.0:
        return []
    best: tuple[int, float, int] | None = None
    for first in np.flatnonzero(off):
        for length in range(1, (count if axis.turns else count - int(first)) + 1):
            inside = (first + np.arange(length)) % count
            if held[inside].sum() >= _MOST * held.sum():
                found = length, -float(held[inside].sum()), int(first)
                best = found if best is None else min(best, found)
                break
    assert best is not None
    length, _, start = best
    inside = (start + np.arange(length)) % count
    mask = np.isin(axis.place, inside)
    whole = total if loss is cells.loss else max(float(np.sum(loss - cells.noise)), 1e-12)
    share = float(np.clip(np.sum((loss - cells.noise)[mask]) / whole, 0.0, 1.0))
    if not _telling(share, mask, axis.place >= 0):
        return []
    low, high = float(axis.low[inside[0]]), float(axis.high[inside[-1]])
    # An interval across the end of a cycle ends beyond 360°.
    high += 360.0 if axis.turns and inside[-1] < inside[0] else 0.0
    return [Region(axis.name, share, low, high, sigmas=_rms(cells, mask))]


def _telling(share: float, mask: Mask, present: Mask) -> bool:
    """Whether a region holds some of the gap, and more than its part of the numbers."""
    return share >= max(_LEAST_SHARE, _CONCENTRATED * float(mask.sum() / present.sum()))


def _values(cells: Cells, name: str, place: Ints, labels: Sequence[str], total: float) -> list[Region]:
    regions = []
    for k, label in enumerate(labels):
        mask = place == k
        if mask.any() and _stands_out(cells, mask, cells.excess):
            share = _share(cells, mask, total)
            if _telling(share, mask, place >= 0):
                regions.append(Region(name, share, value=label, sigmas=_rms(cells, mask)))
    return regions


def _maps(cells: Cells, ids: tuple[str, ...], axes: dict[str, _Axis]) -> tuple[HeatMap, ...]:
    worst = np.argsort(-_sums(cells.trial, cells.excess, len(ids)), kind="stable")[:_MOST_CELLS]
    # The trials that are off most, in the dataset's order.
    shown = np.sort(worst)
    trial = np.full(len(ids), -1, dtype=np.intp)
    trial[shown] = np.arange(len(shown))
    trials = "trial", trial[cells.trial], tuple(ids[i] for i in shown)
    channels = "channel", cells.channel, CHANNELS
    modes = "contact mode", cells.mode, MODES

    def along(name: str, title: str, factor: float = 1.0) -> tuple[str, Ints, tuple[str, ...]]:
        axis = replace(axes[name], low=factor * axes[name].low, high=factor * axes[name].high)
        return title, np.where(axis.place < _MOST_CELLS, axis.place, -1), axis.labels[:_MOST_CELLS]

    wanted = [
        (trials, channels),
        (trials, along("time_s", "time, s")),
        (along("frequency_Hz", "frequency, Hz"), along("cycle_phase_deg", "phase of the cycle, °")),
        (modes, channels),
        (along("position_y_m", "place along y, mm", 1e3), channels),
    ]
    maps = []
    for (rows, row, row_labels), (columns, column, column_labels) in wanted:
        shape = len(row_labels), len(column_labels)
        both = (row >= 0) & (column >= 0)
        if not both.any():
            continue
        flat = row[both] * shape[1] + column[both]
        count = np.bincount(flat, minlength=shape[0] * shape[1]).reshape(shape)
        sums = np.bincount(flat, cells.loss[both], shape[0] * shape[1]).reshape(shape)
        values = np.where(count > 0, np.sqrt(sums / np.maximum(count, 1)), np.nan)
        filled = np.flatnonzero((count > 0).any(axis=1)), np.flatnonzero((count > 0).any(axis=0))
        maps.append(
            HeatMap(
                title=f"{rows} × {columns}",
                rows=rows,
                columns=columns,
                row_labels=tuple(row_labels[i] for i in filled[0]),
                column_labels=tuple(column_labels[i] for i in filled[1]),
                values=values[np.ix_(*filled)],
            )
        )
    return tuple(maps)
