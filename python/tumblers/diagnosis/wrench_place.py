"""The part of its way on which a robot lacks a wrench, from one trial alone.

A robot that was held up somewhere stays off its course: where the model is off says less of where the cause is than
where something is missing does. One component w of the wrench is added while the robot was seen in a part S of its way
along y, and none elsewhere; C is what the model leaves then (`left_by`). With a how many neighbouring numbers count as
one and N how many wrenches were tried, a place is told where

```text
min C(w 1_S)  <  min C(w 1_R) - 2 a (4.5 + ln N),
```

R a part in which the robot was when its track begins, or when it ends, or all of its way, and S any other: that is,
where what sets in somewhere and ceases somewhere is three standard deviations clear of what is missing from the start,
or from a moment on, the nominal model included. Where a trial is off by a hundred standard deviations, an amount that
is off by a few per cent costs more than a part that is wrong: of the component and the direction that leave least in
some S, and of those that do in some R, each S and R has the amount that does best for it. A robot that jumps over a
part does not say whether it belongs to the place: its ends are the means over all S, of weights e^(-C/2ac), with c the
least C over the numbers of the trial where that is more than one. A constant wrench is not quite what is there: that
blurs the ends. Whether there is a place it does not: S and R are as constant, and a third of C at least must be gone.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations, product
from math import log
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..progress import OnPhase
from .comparison import Comparison, Residual
from .loss import robust_cost
from .onset import CLEAR_LN
from .pose import Path
from .result import Region
from .simulator import Job
from .wrench_pieces import Pieces
from .wrench_trial import added, end_s, left_by, prior_sigma

__all__ = ["lacks_at_place"]

Floats = NDArray[np.float64]

# The push along the way, that down or up, and the torque that rolls the robot along y: of the wrench's components.
_COMPONENTS = (1, 2, 3)
# In units of how much may be missing (`prior_sigma`), in S and in R: along much of the way a little does as much. From
# the best of these, steps by a factor of √2 either way, its logarithm halved so often: to half a per cent.
_IN_PART = (1.0, 2.0, 4.0, 8.0)
_ALONG = (0.05, 0.1, 0.2, 0.5, *_IN_PART)
_HALVINGS = 7
# Runs of one batch.
_AT_ONCE = 256
# Parts of the way: this share of the body's length each, or so many; fewer where all runs would have more steps.
_PART_OF_BODY, _MOST_PARTS, _MOST_STEPS = 0.25, 12, 40_000_000
# What takes less than this share of what the nominal model leaves is not what is missing. A choice, made with six spots
# known that held a robot, of which the best took 0.46 and more.
_LEAST_TAKEN = 1.0 / 3.0


def lacks_at_place(
    comparison: Comparison,
    residual: Residual,
    paths: Sequence[Path | None],
    trial: int,
    on_phase: OnPhase | None = None,
) -> Region | None:
    """Return the place along y in which a wrench is missing, None if there is none or nobody can say.

    Parameters
    ----------
    comparison
        The dataset, ready to be compared.
    residual
        How wrong the nominal model is, the sensor's nuisances fitted.
    paths
        The nominal model's.
    trial
        The trial's place in the dataset.
    on_phase
        Is told the phase, how much of it is done, and of how much.

    Raises
    ------
    SimulationError
        The native module gave up.
    """
    path, observed = paths[trial], comparison.readers[trial].observed
    seen = observed.values.get("y", np.empty(0))
    if path is None or not seen.size:
        return None
    # By the model's clock, while it runs.
    end, clock = end_s(comparison, trial), observed.time_s + residual.local[trial, 0] + path.clock_s
    found = np.isfinite(seen) & (clock > 0.0) & (clock < end)
    if np.count_nonzero(found) < 2:
        return None
    time, y = clock[found], seen[found] - residual.local[trial, 2]
    body = np.concatenate(comparison.dataset.robot.body().outline)
    count = int(np.clip(np.ceil(np.ptp(y) / (_PART_OF_BODY * np.ptp(body[:, 1]))), 1, _MOST_PARTS))
    steps = comparison.simulator.nominal(trial).run.steps
    inner, outer = _parts(y, count)
    while _count(inner, _IN_PART) + _count(outer, _ALONG) > _MOST_STEPS / steps:
        count -= 1
        inner, outer = _parts(y, count)
    if not inner:
        return None
    total = _count(inner, _IN_PART) + _count(outer, _ALONG)
    runs = _Runs(comparison, residual, trial, total, on_phase or (lambda _phase, _done, _total: None))
    there, elsewhere = _left_at_best(
        runs,
        [
            ([_while(time, part.inside, end) for part in parts], amounts)
            for parts, amounts in ((inner, _IN_PART), (outer, _ALONG))
        ],
    )
    nothing = left_by(comparison, residual, trial, path, residual.trials[trial])
    best, rest = float(np.min(there)), min(nothing, float(np.min(elsewhere, initial=np.inf)))
    clear = comparison.objective_of(CLEAR_LN + log(total))
    if best >= rest - clear or best > (1.0 - _LEAST_TAKEN) * nothing:
        return None
    wide = comparison.alike * max(1.0, best / comparison.weighed[trial])
    weights = np.exp(-(there - best) / (2.0 * wide))
    low, high = weights @ np.array([(part.low, part.high) for part in inner]) / weights.sum()
    within = residual.trials[trial][: comparison.floors[trial].tracked]
    return Region(
        "position_y_m",
        1.0 - best / nothing,
        float(low),
        float(high),
        sigmas=float(np.sqrt(robust_cost(within) / len(within))),
    )


class _Part(NamedTuple):
    """A part of the way.

    Attributes
    ----------
    low, high
        From where to where along y, m.
    inside
        In which frames the robot was there, shape (n,).
    """

    low: float
    high: float
    inside: NDArray[np.bool_]


def _parts(y: Floats, count: int) -> tuple[list[_Part], list[_Part]]:
    """Return the parts in which the robot was neither first nor last, and the others, of so many along its way."""
    edges = np.linspace(np.min(y), np.max(y), count + 1)
    place = np.clip(np.searchsorted(edges, y, side="right") - 1, 0, count - 1)
    inner: list[_Part] = []
    outer: list[_Part] = []
    for first, last in combinations(range(count + 1), 2):
        part = _Part(float(edges[first]), float(edges[last]), (place >= first) & (place < last))
        if part.inside.any():
            (outer if part.inside[0] or part.inside[-1] else inner).append(part)
    return inner, outer


def _count(parts: Sequence[_Part], amounts: Sequence[float]) -> int:
    """Return how many runs some parts ask for at most."""
    return len(parts) * (2 * len(_COMPONENTS) * len(amounts) + 4 * _HALVINGS)


def _while(time_s: Floats, inside: NDArray[np.bool_], end_s: float) -> Pieces:
    """Return the run in pieces, the last window while the robot was inside."""
    change = np.flatnonzero(np.diff(inside))
    edges = np.concatenate([[0.0], 0.5 * (time_s[change] + time_s[change + 1]), [end_s]])
    windows = inside[np.concatenate([[0], change + 1])]
    return Pieces(edges, np.where(windows.all(), 0, windows).astype(np.intp))


class _Runs:
    """Runs of one trial with a wrench in the last window of their pieces.

    Parameters
    ----------
    comparison, residual, trial
        As in `lacks_at_place`.
    total
        How many there will be at most.
    tell
        Is told the phase, how much of it is done, and of how much.
    """

    def __init__(self, comparison: Comparison, residual: Residual, trial: int, total: int, tell: OnPhase) -> None:
        self.comparison, self.residual, self.trial, self.total, self.tell = comparison, residual, trial, total, tell
        self.done = 0

    def left(self, those: Sequence[tuple[Pieces, int, float]]) -> Floats:
        """Return what the model leaves with each wrench, a component and how much of it; infinite if it cannot run."""
        prior = prior_sigma(self.comparison.simulator.nominal(self.trial))
        left = np.full(len(those), np.inf)
        for first in range(0, len(those), _AT_ONCE):
            self.tell("in which place something is missing", self.done, self.total)
            jobs = []
            for pieces, component, amount in those[first : first + _AT_ONCE]:
                wrench = np.zeros((pieces.count, 6))
                wrench[-1, component] = amount * prior[component]
                jobs.append(Job(self.trial, edit=added(pieces, wrench)))
            for k, path in enumerate(self.comparison.simulator.run(jobs), first):
                if path is not None:
                    values = self.comparison.differences(self.trial, path, self.residual)
                    left[k] = left_by(self.comparison, self.residual, self.trial, path, values)
            self.done += len(jobs)
        return left


def _left_at_best(runs: _Runs, families: Sequence[tuple[Sequence[Pieces], Sequence[float]]]) -> list[Floats]:
    """Return what the model leaves with the best wrench in each run of each family, shape (runs,).

    Parameters
    ----------
    runs
        Of the trial.
    families
        Pieces, and the amounts that are tried of each component and direction first.
    """
    tables, wanted = [], set[tuple[int, float]]()
    for family, amounts in families:
        wrenches = [(c, sign, amount) for c, sign, amount in product(_COMPONENTS, (-1.0, 1.0), amounts)]
        table = runs.left([(pieces, c, sign * amount) for pieces in family for c, sign, amount in wrenches])
        tables.append(table.reshape(len(family), len(_COMPONENTS), 2, len(amounts)))
        if len(family):
            wanted.add(wrenches[int(tables[-1].reshape(len(family), -1).min(axis=0).argmin())][:2])
    found = []
    for (family, amounts), table in zip(families, tables, strict=True):
        best = table.min(axis=(1, 2, 3))
        for component, sign in sorted(wanted):
            mine = table[:, _COMPONENTS.index(component), int(sign > 0.0)]
            left, at = mine.min(axis=1), np.array(amounts)[mine.argmin(axis=1)]
            for halving in range(1, _HALVINGS + 1):
                beside = at[:, None] * 2.0 ** (np.array([-1.0, 1.0]) * 0.5**halving)
                those = [(p, component, sign * one) for p, row in zip(family, beside, strict=True) for one in row]
                tried = runs.left(those).reshape(-1, 2)
                better = tried.min(axis=1) < left
                at = np.where(better, beside[np.arange(len(family)), tried.argmin(axis=1)], at)
                left = np.minimum(left, tried.min(axis=1))
            best = np.minimum(best, left)
        found.append(np.asarray(best, dtype=np.float64))
    return found
