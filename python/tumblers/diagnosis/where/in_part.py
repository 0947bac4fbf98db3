"""Effects that act in a part of the data alone: in a place along the way, in a part of the cycle, from a moment on.

What no effect explains that acts all along may be what one does that acts in a part S. With C_t what the model leaves
of trial t (`left_by`), the part is told where

```text
min C(u 1_S)  <  min(C(0), min C(u 1_R)) - 2ac (4.5 + ln N),      C = Σ_t C_t,      min C(u 1_S) < s C(0)
```

R all of the data, a place in which the robot was when its track begins, or for a field that is ahead the time from a
moment of the first quarter cycle on, and S any other; what was found to act all along is one of them too. a is how many
neighbouring numbers count as one, N how many S, each with how many kinds of effects, are tried first, and c the least C
over the numbers of the trials where that is more than one. That is, what sets in somewhere is three standard deviations
clear of what is there all along. A robot that does not leave a place before its track ends, or that may not, may as
well have met something at a moment, from which on the field drives it by less: there s is less, unless several trials
come into the place and it is as clear of every moment, the same in all of them. A field that is ahead from a moment on
is like nothing else. Of the cycle, the way and the time each is told that leaves not much more than another.

All that is tried runs in the longest steps, but for what was found to act all along.

A trial is in a place while the robot was seen there, not while the model is: a model that is right is there then. The
ends are the means over all S that were tried, each with the u that does best for it, of weights e^(-C/2ac): a robot
that jumps over a place does not say whether it belongs to S.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import inf

import numpy as np

from ...effects.base import Effect
from ...progress import OnPhase
from ..gap.comparison import Comparison, Residual
from ..gap.job import Job
from ..gap.pose import Path
from ..result import Region
from .acting import DRIVE, TURN, words_of
from .part_axis import Ends, Tried, along_y, cycle, from_a_moment
from .part_runs import Runs
from .remainder import left_of

__all__ = ["acts_in_part"]

# Trials that are looked at, the most of the gap first: with this share of it at least, so many at most, of so many
# steps together, so that all runs of an axis, some two thousand, take some two minutes on a core.
_LEAST_SHARE, _MOST_TRIALS, _MOST_STEPS = 0.03, 4, 40_000
# By how many halvings of the first steps how many regions are followed to where less is left, so many moves
# each: a little more may stop a robot altogether, and what is right by a little is found beside what is wrong.
_FOLLOWED, _MOVES = {1: 36, 2: 24, 3: 12, 4: 8, 5: 4}, 2
# Of the best one either end is tried all along the axis, with so many strengths more and less, by this share of their
# step, and the best of these are followed so, by these halvings. So often, as long as less is left.
_STRENGTHS, _FINE, _FOLLOWED_ON, _ROUNDS = 8, 1.0 / 16.0, {3: 12, 4: 8, 5: 4}, 2
# s, of what the robot leaves again and of what it may not. A choice, made with the answers of 40 datasets known.
_THROUGH, _STAYS = 0.6, 0.2
# Of a part of the cycle, of the way and of the time one that leaves more than so many times what another leaves is not
# told: slow trials, which come to each once, hardly part them. A choice.
_HARDLY_MORE = 2.0


def acts_in_part(
    comparison: Comparison,
    residual: Residual,
    paths: Sequence[Path | None],
    shares: Sequence[float],
    effects: tuple[Effect, ...] = (),
    on_phase: OnPhase | None = None,
) -> tuple[Region, ...]:
    """Return the part of the cycle, of the way along y or of the time in which an effect acts; none if nobody can say.

    A part of the cycle ends beyond 360° where it goes across the cycle's end.

    Parameters
    ----------
    comparison, residual, paths
        As in `begins_at_time`.
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
    # In the steps that they ask for: in longer ones they may do something else, and would not stand in a part's way.
    best = comparison.simulator.run([Job(i, effects) for i in trials])
    with comparison.restored():
        # What is not explained moves the robot by much more than the longest steps get wrong.
        comparison.simulator.take_longest_steps()
        while trials and sum(comparison.simulator.nominal(i).run.steps for i in trials) > _MOST_STEPS:
            trials.pop()
        if not trials:
            return ()
        tell = on_phase or (lambda _phase, _done, _total: None)
        return _parts(comparison, residual, paths, trials, shares, best[: len(trials)], tell)


def _parts(
    comparison: Comparison,
    residual: Residual,
    paths: Sequence[Path | None],
    trials: Sequence[int],
    shares: Sequence[float],
    best: Sequence[Path | None],
    tell: OnPhase,
) -> tuple[Region, ...]:
    """Return what `acts_in_part` does of some trials, in the steps of the moment; `best` is what acts all along."""

    def left(found: Sequence[Path | None]) -> float:
        return sum(left_of(comparison, residual, i, path) for i, path in zip(trials, found, strict=True))

    nothing = left(comparison.simulator.run([Job(i) for i in trials]))
    if nothing == inf:
        return ()
    all_along = min(nothing, left(best))
    axes = [cycle(comparison, trials), along_y(comparison, residual, paths, trials)]
    axes += [from_a_moment(comparison, trials, kind) for kind in (DRIVE, TURN)]
    searched: list[Runs] = []
    least = inf
    for axis in axes:
        if axis is None:
            continue
        followed = sum(_FOLLOWED.values()) + sum(_FOLLOWED_ON.values())
        stretched = 4 * axis.parts * (2 * _STRENGTHS + 1)
        expected = sum(len(table) for table in axis.first) + 6 * _MOVES * followed + stretched
        runs = Runs(comparison, residual, axis, min(all_along, _HARDLY_MORE * least), tell, expected)
        _search(runs)
        searched.append(runs)
        least = min(least, _least_part(runs))
    # Whatever axis it is of.
    rest = min([all_along, *(runs.least_rival() for runs in searched)])
    moment = min((_least_part(runs) for runs in searched if not runs.axis.closes), default=-inf)
    told: dict[str, Region] = {}
    # Of two of one axis the one that leaves less.
    for runs in sorted(searched, key=lambda runs: -_least_part(runs)):
        part = _best_part(runs)
        if (
            part is not None
            and runs.known[part] <= _HARDLY_MORE * least
            and _stands_out(runs, part, nothing, rest, moment)
        ):
            share = sum(shares[i] for i in trials) * (1.0 - runs.known[part] / nothing)
            what = words_of(part.kind.effects(part.strength, comparison.simulator.nominal(trials[0])))
            told[runs.axis.name] = Region(runs.axis.name, share, *_mean_ends(runs, part), what=what)
    return tuple(told.values())


def _search(runs: Runs) -> None:
    """Run what is tried first, and what is beside the best of it, and at other ends of the best."""
    runs.cost([tried for table in runs.axis.first for tried in table])
    for is_part in (False, True):
        _narrowed(runs, [runs.best(table) for table in runs.axis.first if table[0].is_part == is_part], _FOLLOWED)
    for _ in range(_ROUNDS):
        before = _best_part(runs)
        if before is None:
            return
        _stretched(runs, before)
        if _best_part(runs) == before:
            return


def _stands_out(runs: Runs, best: Tried, nothing: float, rest: float, moment: float) -> bool:
    """Return whether a part leaves clearly less than the rest, and enough less than nothing.

    Parameters
    ----------
    runs
        Of its axis.
    best
        That which leaves least there.
    nothing, rest
        What the nominal model leaves, and the least that is known of what is no part.
    moment
        The least that is known of a field that drives or turns otherwise from a moment on that is the same in all
        trials, infinite where every such leaves far more than a part does; -inf where none was tried.
    """
    clear = runs.clear * _wide(runs, best)
    entering = [trial for trial in runs.axis.trials if runs.axis.edges(trial, _ends(best))]
    of_no_moment = len(entering) > 1 and runs.known[best] < moment - clear
    stays = [cost for tried, cost in runs.known.items() if tried.is_part and _may_be_another(runs, tried)]
    leaves_it = runs.known[best] < min(stays, default=inf) - clear
    enough = _THROUGH if leaves_it or of_no_moment else _STAYS
    return runs.known[best] < min(rest - clear, enough * nothing)


def _may_be_another(runs: Runs, tried: Tried) -> bool:
    """Return whether what sets in for good may be much else too; a field that is ahead does what nothing else does."""
    return runs.axis.passage(_ends(tried)) == "stays" and tried.kind is not TURN


def _best_part(runs: Runs) -> Tried | None:
    # What was left before all trials were run is of no use, however little some of them have.
    whole = [tried for tried in runs.known if tried.is_part and tried in runs.whole]
    return runs.best(whole) if whole else None


def _least_part(runs: Runs) -> float:
    best = _best_part(runs)
    return inf if best is None else runs.known[best]


def _stretched(runs: Runs, best: Tried) -> None:
    """Try either end elsewhere, with a little more or less: a longer region may do as well, but not one in between."""
    more = [_FINE * best.kind.step * k for k in range(-_STRENGTHS, _STRENGTHS + 1)]
    tables = [
        [best._replace(ends=ends, strength=best.strength + change) for change in more]
        for ends in runs.axis.elsewhere(_ends(best))
    ]
    runs.cost([tried for table in tables for tried in table])
    _narrowed(runs, [runs.best(table) for table in tables], _FOLLOWED_ON)


def _narrowed(runs: Runs, those: Sequence[Tried], followed: Mapping[int, int]) -> None:
    """Move the ends and the strengths of fewer and fewer of the best, by less and less."""
    for halving, count in followed.items():
        those = sorted(those, key=runs.known.__getitem__)[:count]
        for _ in range(_MOVES):
            tables = [[tried, *runs.axis.beside(tried, 0.5**halving)] for tried in those]
            runs.cost([tried for table in tables for tried in table])
            those = list(dict.fromkeys(runs.best(table) for table in tables))


def _mean_ends(runs: Runs, best: Tried) -> Ends:
    """Return the means of the ends over all regions that were tried, each with what does best for it."""
    profile: dict[Ends, float] = {}
    for tried in runs.whole:
        if tried.is_part:
            profile[_ends(tried)] = min(runs.known[tried], profile.get(_ends(tried), inf))
    # In an order of their own, so that the sums are always the same.
    ends = np.array(sorted(profile))
    costs = np.array([profile[one] for one in sorted(profile)])
    if runs.axis.turn:
        # Each as near to the best as it is on the circle.
        away = ends.mean(axis=1) - np.mean(_ends(best))
        ends -= runs.axis.turn * np.round(away / runs.axis.turn)[:, None]
    weights = np.exp(-(costs - runs.known[best]) / (2.0 * runs.comparison.alike * _wide(runs, best)))
    low, high = (weights @ ends / weights.sum()).tolist()
    return runs.axis.canonical((low, high))


def _wide(runs: Runs, best: Tried) -> float:
    """Return c."""
    return max(1.0, runs.known[best] / runs.numbers)


def _ends(tried: Tried) -> Ends:
    assert tried.ends is not None
    return tried.ends
