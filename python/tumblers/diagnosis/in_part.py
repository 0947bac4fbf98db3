"""Effects that act in a part of the data alone: in a place along the robot's way, or in a part of the field's cycle.

What no effect explains that acts all along may be what one does that acts in a part S. With C_t what the model leaves
of trial t (`left_by`), the part is told where

```text
min C(u 1_S)  <  min(C(0), min C(u 1_R)) - 2ac (4.5 + ln N),      C = Σ_t C_t,      min C(u 1_S) < s C(0)
```

R all of the data, a place in which the robot was when its track begins, or the time from a moment on, and S any other;
what was found to act all along is one of them too. a is how many neighbouring numbers count as one, N how many S, each
with how many kinds of effects, are tried first, and c the least C over the numbers of the trials where that is more
than one. That is, what sets in somewhere is three standard deviations clear of what is there all along. A robot that
does not leave a place before its track ends, or that may not, may as well have met something at a moment: there s is
less.

A trial is in a place while the robot was seen there, not while the model is: a model that is right is there then. The
ends are the means over all S that were tried, each with the u that does best for it, of weights e^(-C/2ac): a robot
that jumps over a place does not say whether it belongs to S.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, product
from math import inf, log
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..effects.adhesion_coefficient import AdhesionCoefficient
from ..effects.base import Effect
from ..effects.electrostatic_force import ElectrostaticForce
from ..effects.friction_coefficient import FrictionCoefficient
from ..effects.magnetization_strength import MagnetizationStrength
from ..field import RotatingField
from ..progress import OnPhase
from ..scenario import Scenario
from .comparison import Comparison, Residual
from .job import Interlude, Job
from .onset import CLEAR_LN
from .pose import Path
from .quantity import plain
from .result import Region
from .wrench_trial import left_by

__all__ = ["acts_in_part"]

Floats = NDArray[np.float64]
Ends = tuple[float, float]

# Trials that are looked at, the most of the gap first: with this share of it at least, so many at most.
_LEAST_SHARE, _MOST_TRIALS = 0.03, 4
# Parts of a cycle, of which a region has half at first; of a way so many at most, or this share of the body's length.
_PARTS_OF_CYCLE, _MOST_PARTS, _PART_OF_BODY = 12, 10, 0.25
# How many regions are followed to where less is left, by half of the first steps, a quarter and so on, so many moves
# each: a little more may stop a robot altogether, and what is right by a little is found beside what is wrong.
_FOLLOWED, _MOVES = (36, 24, 12, 8, 4), 2
# s, of what the robot leaves again and of what it may not. A choice, made with the answers of 40 datasets known, in
# which it is 0.55 at most where the region was right.
_THROUGH, _STAYS = 0.6, 0.2
# Of a part of the cycle and one of the way the one that leaves more than so many times what the other leaves is not
# told: slow trials, which come to each once, hardly part them. A choice.
_HARDLY_MORE = 2.0
# Runs of one batch at most, and rows of their paths; and steps of one run of all trials, so that all runs of an axis,
# some two thousand, take some two minutes on a core.
_AT_ONCE, _MOST_ROWS, _MOST_STEPS = 256, 1_000_000, 40_000
# A path has a row at least each so many seconds.
_ROW_S = 2e-3
# Moments from which on the field may drive a robot by less.
_MOMENTS = 10


class _Kind(NamedTuple):
    """Effects in strengths of a scale of its own, so that there are some between others."""

    effects: Callable[[float, Scenario], tuple[Effect, ...]]
    scale: tuple[float, ...]


def _area(strength: float, _: Scenario) -> tuple[Effect, ...]:
    return (AdhesionCoefficient(factor=1.0 + 2.0**strength),)


def _force(strength: float, scenario: Scenario) -> tuple[Effect, ...]:
    weight = scenario.robot.total_mass_kg * scenario.run.gravity_m_per_s2
    return (ElectrostaticForce(added_force_N=2.0**strength * (weight + scenario.substrate.electrostatic_force_N)),)


def _both(strength: float, scenario: Scenario) -> tuple[Effect, ...]:
    return (*_area(strength, scenario), *_force(strength, scenario))


def _friction(strength: float, _: Scenario) -> tuple[Effect, ...]:
    return (FrictionCoefficient(factor=2.0**strength),)


def _drive(strength: float, _: Scenario) -> tuple[Effect, ...]:
    return (MagnetizationStrength(factor=max(1.0 - strength, 0.0)),)


# What a place may do: hold on by the area that touches, by a force, and by both, and be rougher or smoother.
_OF_PLACE = (
    _Kind(_area, (0.0, 1.5, 3.0, 4.5)),
    _Kind(_force, (-2.0, -0.5, 1.0, 2.5, 4.0)),
    _Kind(_both, (-2.0, -0.5, 1.0, 2.5, 4.0)),
    _Kind(_friction, (-1.0, 1.0, 2.0)),
)
_OF_BARE_PLACE = (_OF_PLACE[1], _OF_PLACE[3])
# What a part of the cycle may do: drive the robot by less, or by more.
_OF_CYCLE = _Kind(_drive, (-0.25, 0.25, 0.5, 0.75, 1.0))


# Whether a trial that was not in a region at first leaves it again or stays; what it was in at first is no region.
Passage = Literal["through", "stays", "none"]


class _Tried(NamedTuple):
    """A region, None for all, and a kind of effects in some strength."""

    ends: Ends | None
    kind: int
    strength: float


@dataclass(frozen=True)
class _Axis:
    """What a region is a part of.

    Attributes
    ----------
    name
        Of the contract's axes.
    trials
        That are looked at, the most of the gap first.
    kinds
        What may act; the last in a region that is kept alone, where it stands for what sets in at a moment.
    families
        Regions from low to high that are tried first.
    width
        Of a part.
    turn
        After which it comes again, 0 if never.
    edges
        Between which times, s, a trial is within a region.
    passage
        How the trial that has most of the gap comes through a region.
    """

    name: str
    trials: Sequence[int]
    kinds: Sequence[_Kind]
    families: Sequence[Ends]
    width: float
    turn: float
    edges: Callable[[int, Ends], tuple[float, ...]]
    passage: Callable[[Ends], Passage]


def acts_in_part(
    comparison: Comparison,
    residual: Residual,
    paths: Sequence[Path | None],
    shares: Sequence[float],
    effects: tuple[Effect, ...] = (),
    on_phase: OnPhase | None = None,
) -> tuple[Region, ...]:
    """Return the part of the cycle, or of the way along y, in which an effect acts; none if nobody can say.

    Where either does, the one is told that leaves less, and the other where it does not leave much more. A part of the
    cycle ends beyond 360° where it goes across the cycle's end.

    Parameters
    ----------
    comparison
        The dataset, ready to be compared.
    residual
        How wrong the nominal model is, the sensor's nuisances fitted.
    paths
        The nominal model's.
    shares
        Of the gap, by trial.
    effects
        What was found to act all along.
    on_phase
        Is told the phase, how much of it is done, and of how much.

    Raises
    ------
    SimulationError
        The native module gave up.
    """
    order = sorted(range(len(shares)), key=lambda i: -shares[i])
    tracked = [i for i in order if paths[i] is not None and comparison.floors[i].tracked]
    trials = [i for i in tracked if shares[i] >= _LEAST_SHARE][:_MOST_TRIALS]
    steps = [comparison.simulator.nominal(i).run.steps for i in trials]
    while trials and sum(steps[: len(trials)]) > _MOST_STEPS:
        trials.pop()
    if not trials:
        return ()
    tell = on_phase or (lambda _phase, _done, _total: None)
    nothing, chosen = _left(comparison, residual, trials, paths), inf
    if effects:
        found = comparison.simulator.run([Job(trial, effects) for trial in trials])
        chosen = _left(comparison, residual, trials, dict(zip(trials, found, strict=True)))
    told: list[tuple[float, Region]] = []
    for axis in (_cycle(comparison, trials), _along_y(comparison, residual, paths, trials)):
        if axis is None:
            continue
        most = min([nothing, chosen, *(_HARDLY_MORE * cost for cost, _ in told)])
        runs = _Runs(comparison, residual, axis, most, tell)
        region = _best_region(runs, nothing, min(nothing, chosen), sum(shares[trial] for trial in trials))
        if region is not None:
            told.append((min(runs.known[tried] for tried in runs.whole), region))
    least = min((cost for cost, _ in told), default=inf)
    return tuple(region for cost, region in told if cost <= _HARDLY_MORE * least)


def _left(
    comparison: Comparison,
    residual: Residual,
    trials: Sequence[int],
    paths: Sequence[Path | None] | Mapping[int, Path | None],
) -> float:
    """Return what paths leave of some trials, infinite where one could not be run."""
    cost = 0.0
    for trial in trials:
        path = paths[trial]
        if path is None:
            return inf
        cost += left_by(comparison, residual, trial, path, comparison.differences(trial, path, residual))
    return cost


def _cycle(comparison: Comparison, trials: Sequence[int]) -> _Axis | None:
    fields = {trial: comparison.dataset.trials[trial].field for trial in trials}
    frequency = {trial: field.frequency_Hz for trial, field in fields.items() if isinstance(field, RotatingField)}
    ends_s = {trial: comparison.simulator.nominal(trial).run.duration_s for trial in trials}
    if not frequency:
        return None

    def edges(trial: int, ends: Ends) -> tuple[float, ...]:
        if trial not in frequency:
            return ()
        if ends[1] == inf:
            return (ends[0],)
        cycles = np.arange(-2.0, np.ceil(frequency[trial] * ends_s[trial]) + 1.0)
        times = (cycles[:, None] + np.array(ends) / 360.0) / frequency[trial]
        return tuple(times[(times[:, 1] > 0.0) & (times[:, 0] < ends_s[trial])].ravel().tolist())

    def passage(ends: Ends) -> Passage:
        return "through" if ends[1] - ends[0] < 360.0 else "none"

    width = 360.0 / _PARTS_OF_CYCLE
    starts, parts = range(_PARTS_OF_CYCLE), range(1, _PARTS_OF_CYCLE // 2 + 1)
    families = [(width * first, width * (first + count)) for first, count in product(starts, parts)]
    # From a moment on, s.
    moments = np.linspace(0.0, max(ends_s[trial] for trial in frequency), _MOMENTS + 2)[1:-1]
    families += [(moment, inf) for moment in moments.tolist()]
    return _Axis("cycle_phase_deg", trials, (_OF_CYCLE,), families, width, 360.0, edges, passage)


def _along_y(
    comparison: Comparison, residual: Residual, paths: Sequence[Path | None], trials: Sequence[int]
) -> _Axis | None:
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
        there = inside(first, ends)
        if there[0] or not there.any():
            return "none"
        return "stays" if there[-1] else "through"

    # Of the way of the trial that has most of the gap.
    first = next(iter(seen))
    way = seen[first][1]
    length = float(np.ptp(np.concatenate(comparison.dataset.robot.body().outline)[:, 1]))
    count = int(np.clip(np.ceil(np.ptp(way) / (_PART_OF_BODY * length)), 1, _MOST_PARTS))
    places = np.linspace(np.min(way), np.nextafter(np.max(way), inf), count + 1)
    families = [(low, high) for low, high in combinations(places.tolist(), 2) if inside(first, (low, high)).any()]
    width = float(places[1] - places[0])
    # A multiple of no adhesion is none.
    sticks = comparison.simulator.nominal(first).substrate.adhesion_N_per_m2 > 0.0
    kinds = (*(_OF_PLACE if sticks else _OF_BARE_PLACE), _OF_CYCLE)
    return _Axis("position_y_m", trials, kinds, families, width, 0.0, edges, passage)


def _best_region(runs: _Runs, nothing: float, all_along: float, share: float) -> Region | None:
    """Return the region in which an effect leaves clearly less than elsewhere, and enough less than nothing does.

    Parameters
    ----------
    runs
        Of an axis.
    nothing, all_along
        What the nominal model leaves, and the least that is known of what acts all along.
    share
        Of the gap, that the trials have.
    """
    axis, known = runs.axis, runs.known
    tables = [_table(axis, ends) for ends in (None, *axis.families)]
    runs.cost([tried for table in tables for tried in table])
    for region in (False, True):
        those = [[tried for tried in table if runs.is_region(tried) == region] for table in tables]
        _narrowed(runs, [min(table, key=known.__getitem__) for table in those if table])
    regions = [tried for tried in known if runs.is_region(tried)]
    # What was left before all trials were run is of no use, however little some of them have.
    within = [tried for tried in regions if tried in runs.whole]
    if not within:
        return None
    best = min(within, key=known.__getitem__)
    least = known[best]
    wide = max(1.0, least / runs.numbers)
    stays = min((known[tried] for tried in regions if axis.passage(_ends(tried)) == "stays"), default=inf)
    rest = min([all_along, *(cost for tried, cost in known.items() if not runs.is_region(tried))])
    most = _THROUGH if least < stays - wide * runs.clear else _STAYS
    if least >= rest - wide * runs.clear or least > most * nothing:
        return None
    profile: dict[Ends, float] = {}
    for tried in within:
        profile[_ends(tried)] = min(known[tried], profile.get(_ends(tried), inf))
    ends = np.array(list(profile))
    if axis.turn:
        # Each as near to the best as it is on the circle.
        away = ends.mean(axis=1) - np.mean(_ends(best))
        ends -= axis.turn * np.round(away / axis.turn)[:, None]
    weights = np.exp(-(np.array(list(profile.values())) - least) / (2.0 * runs.comparison.alike * wide))
    low, high = (weights @ ends / weights.sum()).tolist()
    if axis.turn:
        low, high = _canonical((low, high), axis.turn)
    return Region(axis.name, share * (1.0 - least / nothing), low, high, what=_words(runs, best))


def _ends(tried: _Tried) -> Ends:
    assert tried.ends is not None
    return tried.ends


def _canonical(ends: Ends, turn: float) -> Ends:
    """Return a region on a circle with its start within the first turn."""
    back = turn * np.floor(ends[0] / turn)
    return float(ends[0] - back), float(ends[1] - back)


def _words(runs: _Runs, best: _Tried) -> str:
    """Return what acts in the region."""
    scenario = runs.comparison.simulator.nominal(runs.axis.trials[0])
    said = []
    for effect in runs.axis.kinds[best.kind].effects(best.strength, scenario):
        match effect:
            case AdhesionCoefficient():
                said.append(f"{_times(effect.factor)} the adhesion")
            case ElectrostaticForce():
                said.append(f"{plain(effect.added_force_N, 'N')} more attraction")
            case FrictionCoefficient():
                said.append(f"{_times(effect.factor)} the friction")
            case MagnetizationStrength():
                said.append(f"{_times(effect.factor)} the magnetic torque")
    return " and ".join(said)


def _times(factor: float) -> str:
    # Two digits, written out.
    return f"{float(f'{factor:.2g}'):g} times"


def _table(axis: _Axis, ends: Ends | None) -> list[_Tried]:
    """Return what is tried of a region, or of all, first."""
    alone = axis.turn == 0.0 and (ends is None or axis.passage(ends) != "stays")
    kinds = axis.kinds[:-1] if alone else axis.kinds
    return [_Tried(ends, k, strength) for k, kind in enumerate(kinds) for strength in kind.scale]


def _step(axis: _Axis, tried: _Tried) -> float:
    return float(np.median(np.diff(axis.kinds[tried.kind].scale)))


def _narrowed(runs: _Runs, those: Sequence[_Tried]) -> None:
    """Move the ends and the strengths of fewer and fewer of the best, by less and less.

    What is no region has no ends to move.
    """
    for halving, count in enumerate(_FOLLOWED, 1):
        those = sorted(those, key=runs.known.__getitem__)[:count]
        for _ in range(_MOVES):
            tables = [[tried, *_beside(runs, tried, 0.5**halving)] for tried in those]
            runs.cost([tried for table in tables for tried in table])
            those = list(dict.fromkeys(min(table, key=runs.known.__getitem__) for table in tables))


def _beside(runs: _Runs, tried: _Tried, share: float) -> Iterable[_Tried]:
    """Return what is beside a region by a share of the steps between those that are tried first."""
    axis = runs.axis
    more, move = share * _step(axis, tried), share * axis.width
    for strength in (tried.strength - more, tried.strength + more):
        yield tried._replace(strength=strength)
    if tried.ends is None or tried.ends[1] == inf:
        return
    low, high = tried.ends
    moved = [(low - move, high), (low + move, high)]
    if runs.is_region(tried):
        moved += [(low, high - move), (low, high + move)]
    for ends in moved:
        beside = tried._replace(ends=_canonical(ends, axis.turn) if axis.turn else ends)
        if ends[0] < ends[1] and runs.is_region(beside) == runs.is_region(tried):
            yield beside


class _Runs:
    """Runs of an axis's trials with effects in a region, and what the model leaves of all of them.

    Parameters
    ----------
    comparison, residual
        As in `acts_in_part`.
    axis
        What regions are parts of.
    most
        What leaves clearly more than this is of no use.
    tell
        Is told the phase, how much of it is done, and of how much.
    """

    def __init__(self, comparison: Comparison, residual: Residual, axis: _Axis, most: float, tell: OnPhase) -> None:
        self.comparison, self.residual, self.axis, self.tell = comparison, residual, axis, tell
        self.known: dict[_Tried, float] = {}
        # Those of which all trials were run.
        self.whole: set[_Tried] = set()
        self.clear = comparison.objective_of(CLEAR_LN + log(len(axis.families) * len(axis.kinds)))
        self.numbers = sum(comparison.weighed[trial] for trial in axis.trials)
        self._most = most
        rows = max(comparison.simulator.nominal(trial).run.duration_s for trial in axis.trials) / _ROW_S
        self._at_once = int(np.clip(_MOST_ROWS / rows, 1, _AT_ONCE))
        expected = sum(len(_table(axis, ends)) for ends in (None, *axis.families)) + 6 * _MOVES * sum(_FOLLOWED)
        self._told = f"in which part of the {'cycle' if axis.turn else 'way'} something else acts", expected

    def is_region(self, tried: _Tried) -> bool:
        """Return whether something that the axis is asked for acts in a region that a trial came to."""
        if tried.ends is None or self.axis.passage(tried.ends) == "none":
            return False
        return self.axis.turn > 0.0 or tried.kind < len(self.axis.kinds) - 1

    def cost(self, those: Sequence[_Tried]) -> list[float]:
        """Return C with each, or so much of it that it is of no use; infinite if it cannot run."""
        new = [tried for tried in dict.fromkeys(those) if tried not in self.known]
        for first in range(0, len(new), self._at_once):
            phase, expected = self._told
            self.tell(phase, min(len(self.known), expected), expected)
            # What leaves more of some trials than another of all is left there: none leaves less than nothing.
            left = dict.fromkeys(new[first : first + self._at_once], 0.0)
            most = self._most + self.clear * max(1.0, self._most / self.numbers)
            some = list(left)
            for trial in self.axis.trials:
                some = [tried for tried in some if left[tried] <= most]
                for tried, path in zip(some, self._paths(trial, some), strict=True):
                    left[tried] += inf if path is None else self._left_of(trial, path)
            self.known |= left
            self.whole.update(some)
            self._most = min([self._most, *(left[tried] for tried in some)])
        return [self.known[tried] for tried in those]

    def _paths(self, trial: int, those: Sequence[_Tried]) -> list[Path | None]:
        return self.comparison.simulator.run([self._job(trial, tried) for tried in those])

    def _left_of(self, trial: int, path: Path) -> float:
        values = self.comparison.differences(trial, path, self.residual)
        return left_by(self.comparison, self.residual, trial, path, values)

    def _job(self, trial: int, tried: _Tried) -> Job:
        effects = self.axis.kinds[tried.kind].effects(tried.strength, self.comparison.simulator.nominal(trial))
        if tried.ends is None:
            return Job(trial, effects)
        edges = self.axis.edges(trial, tried.ends)
        return Job(trial, interlude=Interlude(effects, edges)) if edges else Job(trial)
