"""`least`: the best of many points, without simulating every trial of every one (branch and bound).

The objective is a sum over trials of terms `c_t` that are not negative, the nuisances n at their best:

```text
min_n Σ_(t in a part) c_t(u, n) <= min_n Σ_t c_t(u, n)
```

A point that costs more over a part of the trials than the best ones do over all is left there (Land and Doig 1960).
The trials come first that part the points most for their time. The nuisances are fitted by least squares, not by the
objective, so that the bound may be off by a little: by less than what is clear, it is not used.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

import numpy as np
from numpy.typing import NDArray

from ...effects.base import Effect
from ..fitting.fitter import Fitter
from ..fitting.hypothesis import Hypothesis
from ..gap.comparison import Residual
from .margins import CLEAR

__all__ = ["least"]

Floats = NDArray[np.float64]

# Points that are simulated in all trials at once, and the shares of the trials' time over which the others are held.
_PILOTS, _PARTS = 4, (0.2, 0.45)


def least(
    fitter: Fitter,
    hypothesis: Hypothesis,
    points: Sequence[Floats],
    count: int,
    train: Sequence[int] | None = None,
    share: float = 1.0,
    limit: float = inf,
    shown: Sequence[Residual] = (),
) -> list[tuple[float, Floats]]:
    """Return the best so many of some points with their objective, the best first; fewer where few are within a limit.

    Parameters
    ----------
    fitter
        Of the dataset.
    hypothesis, points
        What is simulated.
    count
        How many are wanted.
    train
        Trials that count; all if None.
    share
        Of each trial's time that counts.
    limit
        What costs more is of no use, and is left too.
    shown
        How wrong some hypotheses are that the trials have to part, where this is known; else some points are simulated
        for it.
    """
    chosen = fitter.trials if train is None else tuple(train)
    costs: dict[int, float] = {}
    clear = fitter.comparison.objective_of(CLEAR)

    def over(these: Sequence[int], part: Sequence[int]) -> list[Residual]:
        return fitter.residuals(hypothesis, [points[k] for k in these], part, share)

    def measure(these: Sequence[int]) -> list[Residual]:
        residuals = over(these, chosen)
        for k, residual in zip(these, residuals, strict=True):
            costs[k] = fitter.cost(residual, points[k], chosen)
        return residuals

    if not shown:
        pilots = np.linspace(0, len(points) - 1, max(count, _PILOTS)).round().astype(int)
        shown = measure(np.unique(pilots).tolist())
    left = [k for k in range(len(points)) if k not in costs]
    by_trial = np.array([[fitter.trial_cost(residual, i) for i in chosen] for residual in shown])
    for part in _parts(by_trial, _times(fitter, hypothesis.effects(points[0]), chosen)):
        if not left:
            break
        some = tuple(chosen[n] for n in part)
        bounds = {k: fitter.cost(residual, points[k], some) for k, residual in zip(left, over(left, some), strict=True)}
        # What promises most lowers the limit for the rest.
        measure([k for k in sorted(left, key=lambda k: (bounds[k], k))[:count] if bounds[k] <= limit + clear])
        bound = min([limit, *sorted(costs.values())[count - 1 : count]])
        left = [k for k in left if k not in costs and bounds[k] <= bound + clear]
    measure(left)
    best = sorted((k for k in costs if costs[k] <= limit), key=lambda k: (costs[k], k))[:count]
    return [(costs[k], points[k]) for k in best]


def _times(fitter: Fitter, effects: tuple[Effect, ...], chosen: Sequence[int]) -> Floats:
    """Return how long some trials take to simulate, by their number of steps, shape (n,)."""
    comparison = fitter.comparison
    steps = comparison.simulator.steps_of(effects)
    return np.array([comparison.readers[i].duration_s / steps[i] for i in chosen])


def _parts(costs: Floats, times: Floats) -> list[list[int]]:
    """Return parts of the trials, the ones that part points most for their time first.

    Parameters
    ----------
    costs
        Of some points by trial, shape (k, n).
    times
        That the trials take, shape (n,).
    """
    order = np.argsort(-(costs - costs.min(axis=0)).mean(axis=0) / times, kind="stable")
    taken = np.cumsum(times[order]) / times.sum()
    counts = [min(int(np.searchsorted(taken, share)) + 1, len(order) - 1) for share in _PARTS]
    return [order[:count].tolist() for count in dict.fromkeys(counts) if count > 0]
