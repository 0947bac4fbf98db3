"""The part of its way on which a robot lacks a wrench, from one trial alone.

A robot that was held up somewhere stays off its course: where the model is off says less of where the cause is than
where something is missing does. One component w of the wrench is added while the robot was seen in a part S of its way
along y, and none elsewhere; C is what the model leaves then (`left_by`). With a how many neighbouring numbers count as
one and N how many wrenches were tried, a place is told where

```text
min C(w 1_S)  <  min C(w 1_R) - 2 a (4.5 + ln N),      S not from the start of the way, R from the start
```

that is, where what sets in somewhere is three standard deviations clear of what is missing from the start, all along or
up to somewhere, the nominal model included. A robot that jumps over a part does not say whether it belongs to the
place: its ends are the means over all that was tried, of weights e^(-C/2a).
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations, product
from math import log, sqrt

import numpy as np
from numpy.typing import NDArray

from .comparison import Comparison, Residual
from .loss import robust_cost
from .pose import Path
from .result import Region
from .simulator import Job
from .wrench_pieces import Pieces
from .wrench_trial import added, end_s, left_by, prior_sigma

__all__ = ["lacks_at_place"]

Floats = NDArray[np.float64]

# The push along the way, that down or up, and the torque that rolls the robot along y: of the wrench's components.
_COMPONENTS = (1, 2, 3)
# In units of how much may be missing (`prior_sigma`): along the whole way a little does as much. Of the component and
# the direction that leave least, amounts between are tried too.
_IN_PART = (1.0, 2.0, 4.0, 8.0)
_ALL_ALONG = (0.05, 0.1, 0.2, 0.5, *_IN_PART)
_BETWEEN = tuple(sqrt(2.0) * amount for amount in _IN_PART)
# Parts of the way: this share of the body's length each, or so many.
_PART_OF_BODY, _MOST_PARTS = 0.25, 12
# Three standard deviations as a logarithm of likelihoods; and what takes less than this share of what the nominal model
# leaves is not what is missing: of six spots that held a robot the push took 0.51 and more, drag looked like 0.24.
_CLEAR, _LEAST_TAKEN = 4.5, 1.0 / 3.0


def lacks_at_place(
    comparison: Comparison, residual: Residual, paths: Sequence[Path | None], trial: int
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

    Raises
    ------
    SimulationError
        The native module gave up.
    """
    path, observed = paths[trial], comparison.readers[trial].observed
    seen = observed.values.get("y", np.empty(0))
    found = np.isfinite(seen)
    if path is None or np.count_nonzero(found) < 2:
        return None
    time, y = observed.time_s[found], seen[found] - residual.local[trial, 2]
    body = np.concatenate(comparison.dataset.robot.body().outline)
    count = int(np.clip(np.ceil(np.ptp(y) / (_PART_OF_BODY * np.ptp(body[:, 1]))), 1, _MOST_PARTS))
    edges = np.linspace(np.min(y), np.max(y), count + 1)
    part = np.clip(np.searchsorted(edges, y, side="right") - 1, 0, count - 1)
    end = end_s(comparison, trial)
    parts = [
        (ends, pieces)
        for ends in combinations(range(count + 1), 2)
        if ends != (0, count) and (pieces := _while(time, (part >= ends[0]) & (part < ends[1]), end)) is not None
    ]
    if not parts:
        return None
    whole = Pieces(np.array([0.0, end]), np.array([0]))
    along = _left(comparison, residual, trial, [whole], _wrenches(_ALL_ALONG))
    wrenches = _wrenches(_IN_PART)
    inside = _left(comparison, residual, trial, [pieces for _, pieces in parts], wrenches)
    component, most = wrenches[int(np.argmin(inside.min(axis=0)))]
    between = [(component, float(np.copysign(amount, most))) for amount in _BETWEEN]
    inside = np.hstack([inside, _left(comparison, residual, trial, [pieces for _, pieces in parts], between)])
    starts = np.array([first == 0 for (first, _), _ in parts])
    if starts.all():
        return None
    nothing = left_by(comparison, residual, trial, path, residual.trials[trial])
    rest = min(nothing, float(np.min(along)), float(np.min(inside[starts], initial=np.inf)))
    there, edges_there = inside[~starts], edges[[ends for ends, _ in parts]][~starts]
    best = float(np.min(there))
    clear = 2.0 * comparison.alike * (_CLEAR + log(inside.size + along.size))
    if best >= rest - clear or best > (1.0 - _LEAST_TAKEN) * nothing:
        return None
    weights = np.exp(-(there - best) / (2.0 * comparison.alike)).sum(axis=1)
    low, high = weights @ edges_there / weights.sum()
    within = residual.trials[trial][: comparison.floors[trial].tracked]
    return Region(
        "position_y_m",
        1.0 - best / nothing,
        float(low),
        float(high),
        sigmas=float(np.sqrt(robust_cost(within) / len(within))),
    )


def _while(time_s: Floats, inside: NDArray[np.bool_], end_s: float) -> Pieces | None:
    """Return the run in pieces, the second window while the robot was inside; None where it never was, or always."""
    if inside.all() or not inside.any():
        return None
    change = np.flatnonzero(np.diff(inside))
    edges = np.concatenate([[0.0], 0.5 * (time_s[change] + time_s[change + 1]), [end_s]])
    return Pieces(edges, np.concatenate([inside[:1], inside[change + 1]]).astype(np.intp))


def _wrenches(amounts: Sequence[float]) -> list[tuple[int, float]]:
    """Return every component with amounts of either sign."""
    return [(component, sign * amount) for component, sign, amount in product(_COMPONENTS, (-1.0, 1.0), amounts)]


def _left(
    comparison: Comparison,
    residual: Residual,
    trial: int,
    runs: Sequence[Pieces],
    wrenches: Sequence[tuple[int, float]],
) -> Floats:
    """Return what the model leaves with each wrench in the last window of each run, shape (runs, wrenches)."""
    prior = prior_sigma(comparison.simulator.nominal(trial))
    jobs = []
    for pieces, (component, amount) in product(runs, wrenches):
        wrench = np.zeros((pieces.count, 6))
        wrench[-1, component] = amount * prior[component]
        jobs.append(Job(trial, edit=added(pieces, wrench)))
    left = np.full(len(jobs), np.inf)
    for k, path in enumerate(comparison.simulator.run(jobs)):
        if path is not None:
            left[k] = left_by(comparison, residual, trial, path, comparison.differences(trial, path, residual))
    return left.reshape(len(runs), len(wrenches))
