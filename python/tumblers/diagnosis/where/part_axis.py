"""`Axis`: what regions are parts of, the cycle of the field, the way along y or the time, and what is tried first."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations, product
from math import floor, inf
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...field import RotatingField
from ..gap.comparison import Comparison, Residual
from ..gap.pose import Path
from .acting import DRIVE, TURN, Kind, of_place

__all__ = ["Axis", "Ends", "Tried", "along_y", "cycle", "from_a_moment"]

Floats = NDArray[np.float64]
Ends = tuple[float, float]
# Whether a trial that was not in a region at first leaves it again or stays; what it was in at first is no region.
Passage = Literal["through", "stays", "none"]

# Parts of a cycle, of which a region has half at first; of a way so many at most, or this share of the body's length.
_PARTS_OF_CYCLE, _MOST_PARTS, _PART_OF_BODY = 12, 10, 0.25
# Moments from which on something acts, and such that are too early for that.
_ONSETS, _EARLY = 16, 5


class Tried(NamedTuple):
    """Effects in a region.

    Attributes
    ----------
    ends
        From where to where; None for all of the data.
    kind, strength
        What acts, and how much of it.
    is_part
        Whether it is what is looked for; else it is what that has to beat.
    """

    ends: Ends | None
    kind: Kind
    strength: float
    is_part: bool


@dataclass(frozen=True)
class Axis:
    """What regions are parts of.

    Attributes
    ----------
    name
        Of the contract's axes.
    noun
        What it is called.
    trials
        That are looked at, the most of the gap first.
    first
        What is tried first, together what differs by kind and strength alone.
    width, parts
        Of a part, and how many of them a region has at most.
    whole
        From where to where a region may reach at most: no farther than there are data.
    turn
        After which it comes again, 0 if never.
    edges
        Between which times, s, a trial is within a region.
    passage
        How a trial comes through a region, along the way the one that has most of the gap.
    closes
        Whether a region has an end before the data's.
    """

    name: str
    noun: str
    trials: Sequence[int]
    first: Sequence[Sequence[Tried]]
    width: float
    parts: int
    whole: Ends
    turn: float
    edges: Callable[[int, Ends], tuple[float, ...]]
    passage: Callable[[Ends], Passage]
    closes: bool = True

    def beside(self, tried: Tried, share: float) -> list[Tried]:
        """Return what is beside a region by a share of the steps between those that are tried first.

        Parameters
        ----------
        tried
            One of them, or one beside.
        share
            Up to 1.
        """
        more, move = share * tried.kind.step, share * self.width
        made = [tried._replace(strength=tried.strength + way * more) for way in (-1.0, 1.0)]
        if tried.ends is None:
            return made
        passage, (low, high) = self.passage(tried.ends), tried.ends
        moved = [(low - move, high), (low + move, high)] if tried.is_part or passage == "stays" else []
        moved += [(low, high - move), (low, high + move)] if tried.is_part and self.closes else []
        for ends in map(self.canonical, moved):
            then = self.passage(ends)
            if ends[0] < ends[1] and (then != "none" if tried.is_part else then == passage):
                made.append(tried._replace(ends=ends))
        return made

    def elsewhere(self, ends: Ends) -> list[Ends]:
        """Return the regions of which one end is where it is, by halves of a part.

        Parameters
        ----------
        ends
            Of a region.
        """
        low, high = ends
        lengths = [0.5 * self.width * halves for halves in range(1, 2 * self.parts + 1)]
        made = [(high - length, high) for length in lengths]
        made += [(low, low + length) for length in lengths] if self.closes else []
        # Beyond the data all are alike.
        return [ends for ends in dict.fromkeys(map(self.canonical, made)) if self.passage(ends) != "none"]

    def canonical(self, ends: Ends) -> Ends:
        """Return a region within the data, with its start within the first turn."""
        back = self.turn * floor(ends[0] / self.turn) if self.turn else 0.0
        return max(ends[0] - back, self.whole[0]), min(ends[1] - back, self.whole[1])


def _table(ends: Ends | None, kinds: Sequence[Kind], is_part: bool) -> list[Tried]:
    return [Tried(ends, kind, strength, is_part) for kind in kinds for strength in kind.scale]


def _frequencies(comparison: Comparison, trials: Sequence[int]) -> dict[int, float]:
    fields = {trial: comparison.dataset.trials[trial].field for trial in trials}
    return {trial: field.frequency_Hz for trial, field in fields.items() if isinstance(field, RotatingField)}


def cycle(comparison: Comparison, trials: Sequence[int]) -> Axis | None:
    """Return the field's cycle, None where it turns in none of the trials.

    Parameters
    ----------
    comparison
        The dataset.
    trials
        That are looked at, the most of the gap first.
    """
    frequency = _frequencies(comparison, trials)
    ends_s = {trial: comparison.simulator.nominal(trial).run.duration_s for trial in trials}
    if not frequency:
        return None

    def edges(trial: int, ends: Ends) -> tuple[float, ...]:
        if trial not in frequency:
            return ()
        cycles = np.arange(-2.0, np.ceil(frequency[trial] * ends_s[trial]) + 1.0)
        times = (cycles[:, None] + np.array(ends) / 360.0) / frequency[trial]
        return tuple(times[(times[:, 1] > 0.0) & (times[:, 0] < ends_s[trial])].ravel().tolist())

    def passage(ends: Ends) -> Passage:
        return "through" if ends[1] - ends[0] < 360.0 else "none"

    width = 360.0 / _PARTS_OF_CYCLE
    most = _PARTS_OF_CYCLE // 2
    starts, counts = range(_PARTS_OF_CYCLE), range(1, most + 1)
    regions = [(width * first, width * (first + count)) for first, count in product(starts, counts)]
    first = [_table(None, [DRIVE], is_part=False)]
    first += [_table(ends, [DRIVE], is_part=True) for ends in regions]
    return Axis("cycle_phase_deg", "cycle", trials, first, width, most, (-inf, inf), 360.0, edges, passage)


def from_a_moment(comparison: Comparison, trials: Sequence[int], kind: Kind) -> Axis | None:
    """Return the time, of which regions go on to the end, None where the field turns in none of the trials.

    Parameters
    ----------
    comparison, trials
        As in `cycle`.
    kind
        What the field does from a moment on.
    """
    frequency, lab = _frequencies(comparison, trials), comparison.dataset.trials
    if not frequency:
        return None
    # Until a quarter of a cycle of the trial that has most of the gap a robot that lay is not yet over: a field that is
    # ahead from then on may as well be so all along.
    begun = 0.25 / next(iter(frequency.values())) if kind is TURN else 0.0
    longest = max(lab[trial].duration_s for trial in frequency)
    if longest <= begun:
        return None
    # It goes on in those that are not looked at.
    last = max(lab[trial].duration_s for trial in _frequencies(comparison, range(len(lab))))

    def edges(trial: int, ends: Ends) -> tuple[float, ...]:
        return (ends[0],) if trial in frequency else ()

    def passage(ends: Ends) -> Passage:
        return "stays" if begun < ends[0] < longest else "none"

    early, moments = np.linspace(0.0, begun, _EARLY), np.linspace(begun, longest, _ONSETS + 2)[1:-1]
    first = [_table((moment, last), [kind], is_part=False) for moment in dict.fromkeys(early.tolist())]
    first += [_table((moment, last), [kind], is_part=True) for moment in moments.tolist()]
    width, whole = (longest - begun) / (_ONSETS + 1), (0.0, last)
    return Axis("time_s", "run", trials, first, width, _ONSETS, whole, 0.0, edges, passage, closes=False)


def along_y(
    comparison: Comparison, residual: Residual, paths: Sequence[Path | None], trials: Sequence[int]
) -> Axis | None:
    """Return the way along y, None where no trial was seen along it.

    Parameters
    ----------
    comparison, trials
        As in `cycle`.
    residual
        How wrong the nominal model is, the sensor's nuisances fitted.
    paths
        The nominal model's.
    """
    seen: dict[int, tuple[Floats, Floats]] = {}
    for trial in trials:
        path, observed = paths[trial], comparison.readers[trial].observed
        y = observed.values.get("y", np.empty(0))
        if path is None or not y.size:
            continue
        # By the model's clock, while it runs.
        clock = observed.time_s + residual.local[trial, 0] + path.clock_s
        found = np.isfinite(y) & (clock > 0.0) & (clock < comparison.simulator.nominal(trial).run.duration_s)
        if np.count_nonzero(found) >= 2:
            seen[trial] = clock[found], y[found] - residual.local[trial, 2]
    if not seen:
        return None

    def inside(trial: int, ends: Ends) -> NDArray[np.bool_]:
        y = seen[trial][1]
        return (y >= ends[0]) & (y < ends[1])

    def edges(trial: int, ends: Ends) -> tuple[float, ...]:
        if trial not in seen:
            return ()
        time, there = seen[trial][0], inside(trial, ends)
        change = np.flatnonzero(np.diff(there))
        return (*([0.0] if there[0] else []), *(0.5 * (time[change] + time[change + 1])).tolist())

    def passage(ends: Ends) -> Passage:
        there = inside(most, ends)
        if there[0] or not there.any():
            return "none"
        return "stays" if there[-1] else "through"

    # Of the way of the trial that has most of the gap.
    most = next(iter(seen))
    way, kinds = seen[most][1], of_place(comparison.simulator.nominal(most))
    length = float(np.ptp(np.concatenate(comparison.dataset.robot.body().outline)[:, 1]))
    count = int(np.clip(np.ceil(np.ptp(way) / (_PART_OF_BODY * length)), 1, _MOST_PARTS))
    places = np.linspace(np.min(way), np.nextafter(np.max(way), inf), count + 1)
    first = [_table(None, kinds, is_part=False)]
    for ends in combinations(places.tolist(), 2):
        if not inside(most, ends).any():
            continue
        first.append(_table(ends, kinds, is_part=passage(ends) != "none"))
    every = np.concatenate([y for _, y in seen.values()])
    whole = float(np.min(every)), float(np.nextafter(np.max(every), inf))
    return Axis("position_y_m", "way", trials, first, float(places[1] - places[0]), count, whole, 0.0, edges, passage)
