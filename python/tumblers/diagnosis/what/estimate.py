"""Intervals of a hypothesis's parameters.

With q the derivative of a parameter v by the fit's coordinates u and C their posterior covariance, Laplace's standard
deviation is `σ = √(qᵀ C q)`, and the other coordinates follow along the ridge `u ± t C q/σ` of the posterior, as far as
their ranges let them. The objective is measured along it, and an interval ends at the farthest t at which it is no more
than 1.645² above the least that was met on the way: the 90 % interval of a likelihood ratio. Where motion hops the
objective is rough, and what is beyond a small rise may be as good as before it; where it rises by a step, at a
threshold, the way to the step is halved. All of what may move the path counts as noise here, not only what made the
fit likeliest: that was chosen for leaving least, and would say too little of what is not known.

Where the trials pull at a parameter by more than σ says, or the fit is farther than σ from where its slope leads, σ and
what the objective may rise by on the way are of that instead (`sandwich`).

What says the same as a nominal number's being off is known no better than that number (`least_deviation`). A nuisance
has it only where differences are linear in it; where motion is chaotic the fit moves the parameter instead.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..fitting.descent import Descent
from ..fitting.fit import Fit
from ..fitting.fitter import Fitter
from ..fitting.hypothesis import Hypothesis
from ..fitting.sandwich import misfit_factors
from ..result import Interval
from .attribute import Attribution
from .contender import Contender
from .tolerated import least_deviation

__all__ = ["SIDE", "intervals"]

Floats = NDArray[np.float64]
# A parameter and a direction; ways along its ridge are in standard deviations, widened where they are.
_Side = tuple[int, float]

# Standard deviations to either end of a 90 % interval.
SIDE = 1.645
# Where the objective is measured first, in ways to the ends that a Gaussian would have; and how often the way is
# doubled where it has not risen there.
_WAYS, _DOUBLINGS = (0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0), 4
# How often the stretch that holds an end is halved.
_HALVINGS = 5
_IDENTIFIED = 0.5
_HALF_TURN = 180.0
# Nearer to an end than this share of its range, a coordinate counts as at it: least squares stop short of it.
_PRESSED = 1e-3


def intervals(fitter: Fitter, attribution: Attribution, contender: Contender) -> dict[tuple[str, str], Interval]:
    """Return the estimate and 90 % interval of every parameter, by effect and key.

    Parameters
    ----------
    fitter
        Of the dataset.
    attribution, contender
        Every hypothesis, and the one whose parameters are wanted.
    """
    if contender.fit is None:
        return {}
    comparison = fitter.comparison
    before = comparison.floors
    comparison.take_noise_of(contender.effects)
    hypothesis, steps = contender.fit.hypothesis, contender.fit.steps
    descent = Descent(fitter, hypothesis, contender.fit.point, fitter.trials, share=1.0, steps=steps)
    fit = descent.fit(descent.end(evaluations=1))
    gradients, pulls = _gradients(hypothesis, fit.point), descent.pulls(fit, attribution.dispersion)
    factors = misfit_factors(pulls, gradients, _pressing(hypothesis, fit.point, pulls.slope))
    found = _around(fitter, attribution.dispersion, fit, gradients, factors)
    comparison.floors = before
    return found


def _around(
    fitter: Fitter, dispersion: float, fit: Fit, gradients: Floats, factors: Floats
) -> dict[tuple[str, str], Interval]:
    hypothesis = fit.hypothesis
    covariance = fit.covariance(dispersion)
    deviation = np.sqrt(np.maximum(np.einsum("jp,pq,jq->j", gradients, covariance, gradients), 0.0))
    ridges = gradients @ covariance * (factors / np.maximum(deviation, 1e-300))[:, None]
    sides = [(j, sign) for j in range(len(fit.point)) if deviation[j] > 0.0 for sign in (-1.0, 1.0)]

    def at(side: _Side, way: float) -> Floats:
        j, sign = side
        return np.asarray(np.clip(fit.point + sign * way * ridges[j], hypothesis.low, hypothesis.high))

    def rises(ways: list[tuple[_Side, float]]) -> list[float]:
        """Return how much the objective rises at some ways along the sides' ridges, by what it may."""
        points = [at(side, way) for side, way in ways]
        residuals = fitter.residuals(hypothesis, points)
        return [
            (fitter.cost(residual, point) - fit.cost) / (dispersion * factors[side[0]] ** 2)
            for (side, _), point, residual in zip(ways, points, residuals, strict=True)
        ]

    reach = _ends(rises, {side: _whole_way(hypothesis, fit.point, side[1] * ridges[side[0]]) for side in sides})
    out = {}
    estimates = hypothesis.values(fit.point)
    parameters = [parameter for kind in hypothesis.kinds for parameter in kind.parameters]
    for j, (key, parameter) in enumerate(zip(hypothesis.keys, parameters, strict=True)):
        low, high = hypothesis.ranges[j]
        if parameter.turns:
            low, high = estimates[j] - _HALF_TURN, estimates[j] + _HALF_TURN
        moved = [hypothesis.values(at(side, reach[side]))[j] - estimates[j] for side in sides if side[0] == j]
        if parameter.turns:
            moved = [(change + _HALF_TURN) % (2.0 * _HALF_TURN) - _HALF_TURN for change in moved]
        least = SIDE * least_deviation(*key, float(estimates[j]), fitter.comparison.dataset)
        # What the sensor's tolerance takes was not fitted here, and is known no better than that.
        taken = parameter.beyond if hypothesis.high[j] <= hypothesis.low[j] else None
        if taken is not None:
            least = fitter.comparison.nuisances.tolerance(taken)
        ends = [float(np.clip(estimates[j] + end, low, high)) for end in (min([-least, *moved]), max([least, *moved]))]
        width = (ends[1] - ends[0]) / max(high - low, 1e-300)
        out[key] = Interval(float(estimates[j]), ends[0], ends[1], bool(width < _IDENTIFIED) and taken is None)
    return out


def _ends(rises: Callable[[list[tuple[_Side, float]]], list[float]], whole: dict[_Side, float]) -> dict[_Side, float]:
    """Return by side the farthest way, up to a whole one, at which the objective is near the least that is met."""
    known: dict[_Side, dict[float, float]] = {side: {0.0: 0.0} for side in whole}

    def measure(wanted: list[tuple[_Side, float]]) -> None:
        for (side, way), rise in zip(wanted, rises(wanted), strict=True):
            known[side][way] = rise

    def last_near(side: _Side) -> float:
        least = min(known[side].values())
        return max(way for way, rise in known[side].items() if rise <= least + SIDE**2 or way == 0.0)

    measure([(side, way) for side in whole for way in sorted({min(SIDE * k, whole[side]) for k in _WAYS})])
    for _ in range(_DOUBLINGS):
        flat = [side for side in whole if last_near(side) == max(known[side]) < whole[side]]
        measure([(side, min(2.0 * max(known[side]), whole[side])) for side in flat])
    for _ in range(_HALVINGS):
        middles = []
        for side in whole:
            near = last_near(side)
            beyond = [way for way in known[side] if way > near]
            if beyond:
                middles.append((side, 0.5 * (near + min(beyond))))
        measure(middles)
    return {side: last_near(side) for side in whole}


def _gradients(hypothesis: Hypothesis, point: Floats) -> Floats:
    """Return the derivatives of the parameters by the coordinates, shape (p, p).

    A parameter that rests there has the slope to the farther end of its range.
    """
    step = 1e-6
    turns = [parameter.turns for kind in hypothesis.kinds for parameter in kind.parameters]
    columns = []
    for j in range(len(point)):
        # Towards the inside of the range.
        signed = -step if point[j] + step > hypothesis.high[j] else step
        moved = hypothesis.values(point + signed * np.eye(len(point))[j]) - hypothesis.values(point)
        moved = np.where(turns, (moved + _HALF_TURN) % (2.0 * _HALF_TURN) - _HALF_TURN, moved)
        columns.append(moved / signed)
    slopes = np.column_stack(columns)
    for j in np.flatnonzero(hypothesis.rests(point)).tolist():
        below, above = hypothesis.low[j] - point[j], hypothesis.high[j] - point[j]
        way = above if above > -below else below
        slopes[j, j] = (hypothesis.values(point + way * np.eye(len(point))[j]) - hypothesis.values(point))[j] / way
    return slopes


def _pressing(hypothesis: Hypothesis, point: Floats, slope: Floats) -> NDArray[np.bool_]:
    """Return which coordinates are fixed, or at an end of their range beyond which the objective falls, shape (p,)."""
    near = _PRESSED * (hypothesis.high - hypothesis.low)
    fixed = hypothesis.high <= hypothesis.low
    down, up = (point <= hypothesis.low + near) & (slope > 0.0), (point >= hypothesis.high - near) & (slope < 0.0)
    return np.asarray(fixed | down | up)


def _whole_way(hypothesis: Hypothesis, point: Floats, direction: Floats) -> float:
    """Return how far a point can go in a direction before all its coordinates are at an end of their range."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ways = np.where(direction > 0.0, (hypothesis.high - point) / direction, (hypothesis.low - point) / direction)
    return float(max(np.max(np.where(np.abs(direction) > 1e-12, ways, 0.0)), 0.0))
