"""Intervals of a hypothesis's parameters.

With q the derivative of a parameter v by the fit's coordinates u and C their posterior covariance, Laplace's standard
deviation is `σ = √(qᵀ C q)`, and the other coordinates follow along the ridge `u ± t C q/σ` of the posterior. How much
the objective really rises there stretches or shrinks each side so that it rises by 1.645², the 90 % interval of a
likelihood ratio; the end is `v ± t σ`. Where the ridge leaves the range, the rise is measured at its edge. Where the
objective rises by a step, at a threshold, the way to the step is halved.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .attribute import Attribution
from .contender import Contender
from .fit import Fitter
from .hypothesis import Hypothesis
from .result import Interval

__all__ = ["intervals"]

Floats = NDArray[np.float64]
# By parameter and direction, how far along its ridge, in standard deviations.
_Ways = dict[tuple[int, float], float]

_SIDE = 1.645
# A profile that is flatter or steeper than this is not trusted further in one round.
_LEAST_RISE, _MOST_RISE = 0.3, 30.0
_ROUNDS = 2
# A side whose end rises by so many times too much is halved so often.
_TOO_FAR, _HALVINGS = 2.0, 6
# So far must the ridge go inside the range, in standard deviations, for a rise that means something.
_LEAST_WAY = 0.2
_IDENTIFIED = 0.5
_HALF_TURN = 180.0


def intervals(fitter: Fitter, attribution: Attribution, contender: Contender) -> dict[tuple[str, str], Interval]:
    """Return the estimate and 90 % interval of every parameter, by effect and key.

    Parameters
    ----------
    fitter
        Of the dataset.
    attribution, contender
        Every hypothesis, and the one whose parameters are wanted.
    """
    fit = contender.fit
    if fit is None:
        return {}
    hypothesis = fit.hypothesis
    gradients = _gradients(hypothesis, fit.point)
    covariance = attribution.covariance(contender)
    deviation = np.sqrt(np.maximum(np.einsum("jp,pq,jq->j", gradients, covariance, gradients), 0.0))
    ridges = gradients @ covariance / np.maximum(deviation, 1e-300)[:, None]
    sides = [(j, sign) for j in range(len(fit.point)) if deviation[j] > 0.0 for sign in (-1.0, 1.0)]
    reach = dict.fromkeys(((j, sign) for j in range(len(fit.point)) for sign in (-1.0, 1.0)), _SIDE)
    inside = {side: _way_inside(hypothesis, fit.point, side[1] * ridges[side[0]]) for side in sides}
    sides = [side for side in sides if inside[side] > _LEAST_WAY]

    def rises(ways: _Ways) -> _Ways:
        """Return how much the objective rises at some ways along the sides' ridges."""
        points = [fit.point + sign * way * ridges[j] for (j, sign), way in ways.items()]
        residuals = fitter.residuals(hypothesis, points)
        return {
            side: (fitter.cost(residual, point) - contender.cost) / attribution.dispersion
            for side, point, residual in zip(ways, points, residuals, strict=True)
        }

    for _ in range(_ROUNDS):
        ways = {side: min(reach[side], inside[side]) for side in sides}
        for side, rise in rises(ways).items():
            # What the rise should be at this way.
            share = (ways[side] / reach[side]) ** 2
            reach[side] *= float(np.sqrt(_SIDE**2 / np.clip(rise / share, _LEAST_RISE, _MOST_RISE)))
    reach |= _before_steps(rises, {side: min(reach[side], inside[side]) for side in sides})
    out = {}
    estimates = hypothesis.values(fit.point)
    parameters = [parameter for kind in hypothesis.kinds for parameter in kind.parameters]
    for j, (key, parameter) in enumerate(zip(hypothesis.keys, parameters, strict=True)):
        # Where a fit moves in other coordinates, it may leave a parameter's range a little.
        low, high = min(hypothesis.ranges[j][0], estimates[j]), max(hypothesis.ranges[j][1], estimates[j])
        if parameter.turns:
            low, high = estimates[j] - _HALF_TURN, estimates[j] + _HALF_TURN
        ends = [float(np.clip(estimates[j] + sign * reach[j, sign] * deviation[j], low, high)) for sign in (-1.0, 1.0)]
        width = (ends[1] - ends[0]) / max(high - low, 1e-300)
        out[key] = Interval(float(estimates[j]), ends[0], ends[1], bool(width < _IDENTIFIED))
    return out


def _before_steps(rises: Callable[[_Ways], _Ways], ends: _Ways) -> _Ways:
    """Return the ways to where the objective rises by a step, for the ends that are beyond one."""
    below = dict.fromkeys(ends, 0.0)
    above = {side: ends[side] for side, rise in rises(ends).items() if rise > _TOO_FAR * _SIDE**2}
    for _ in range(_HALVINGS if above else 0):
        middles = {side: 0.5 * (below[side] + end) for side, end in above.items()}
        for side, rise in rises(middles).items():
            (above if rise > _SIDE**2 else below)[side] = middles[side]
    return above


def _gradients(hypothesis: Hypothesis, point: Floats) -> Floats:
    """Return the derivatives of the parameters by the coordinates, shape (p, p)."""
    step = 1e-6
    turns = [parameter.turns for kind in hypothesis.kinds for parameter in kind.parameters]
    columns = []
    for j in range(len(point)):
        # Towards the inside of the range.
        signed = -step if point[j] + step > hypothesis.high[j] else step
        moved = hypothesis.values(point + signed * np.eye(len(point))[j]) - hypothesis.values(point)
        moved = np.where(turns, (moved + _HALF_TURN) % (2.0 * _HALF_TURN) - _HALF_TURN, moved)
        columns.append(moved / signed)
    return np.column_stack(columns)


def _way_inside(hypothesis: Hypothesis, point: Floats, direction: Floats) -> float:
    """Return how far a point can go in a direction before it leaves the range."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ways = np.where(direction > 0.0, (hypothesis.high - point) / direction, (hypothesis.low - point) / direction)
    ways = np.where(np.abs(direction) > 1e-12, ways, np.inf)
    return float(max(np.min(ways), 0.0))
