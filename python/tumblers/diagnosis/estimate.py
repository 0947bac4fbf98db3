"""Intervals of a hypothesis's parameters, and samples of its effects.

With q the derivative of a parameter v by the fit's coordinates u and C their posterior covariance, Laplace's standard
deviation is `σ = √(qᵀ C q)`, and the other coordinates follow along the ridge `u ± t C q/σ` of the posterior. How much
the objective really rises there stretches or shrinks each side so that it rises by 1.645², the 90 % interval of a
likelihood ratio; the end is `v ± t σ`. Where the ridge leaves the range, the rise is measured at its edge. Where the
objective rises by a step, at a threshold, the way to the step is halved.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import log

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri
from scipy.stats import qmc

from ..effects.base import Effect
from .attribute import Attribution
from .contender import Contender
from .fit import Fitter
from .hypothesis import PRIOR_SIGMA, Hypothesis
from .loss import robust_cost
from .result import Interval

__all__ = ["intervals", "samples"]

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
# So many points are tried for being within the ranges.
_TRIED = 2048
# How much wider than Laplace's Gaussian, and than what the first points show (in variance), with a share of Laplace's.
_WIDER, _BROADER, _LEAST_SHARE = 3.0, 1.5, 0.05
# So many points must count at least, by Kish's (Σw)²/Σw²: weights are flattened until they do.
_LEAST_POINTS, _LEAST_POWER = 6.0, 1e-3


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


def samples(
    fitter: Fitter, attribution: Attribution, contender: Contender, count: int, seed: int
) -> tuple[tuple[Effect, ...], ...]:
    """Return draws of a hypothesis's effects from its posterior, in the order of a coordinate, some several times.

    Where a threshold decides, such as whether a robot climbs, the posterior is no Gaussian: points are proposed by
    Laplace's Gaussian, by the same three times as wide and by the prior, then by the Gaussian that these show, all
    within the parameters' ranges, and drawn with the weights `posterior/proposed` (sampling-importance resampling;
    Rubin 1988), with c the dispersion and

    ```text
    -2 ln posterior = (cost - outcomes - prior)/c + outcomes + prior
    ```

    Parameters
    ----------
    fitter
        Of the dataset, against whose noise the points are judged.
    attribution, contender
        Every hypothesis, and the one that is drawn from.
    count
        How many.
    seed
        Of the draws.
    """
    fit = contender.fit
    if fit is None:
        return ((),)
    rng = np.random.default_rng(seed)
    hypothesis, free = fit.hypothesis, fit.hypothesis.high > fit.hypothesis.low
    covariance = attribution.covariance(contender)[np.ix_(free, free)]
    middle = np.clip(fit.point, hypothesis.low, hypothesis.high)
    wide = [
        (0.5, middle[free], covariance),
        (0.25, middle[free], _WIDER**2 * covariance),
        (0.25, np.zeros(len(covariance)), PRIOR_SIGMA**2 * np.eye(len(covariance))),
    ]
    parts = [_Part.of(hypothesis, mean, spread, round(share * count), rng) for share, mean, spread in wide]
    found = np.concatenate([part.points for part in parts])
    log_posterior = _log_posterior(fitter, attribution, hypothesis, middle, found)
    weights = _weights(log_posterior - _log_density(parts, found))
    centre = weights @ found
    spread = _BROADER * ((found - centre).T * weights) @ (found - centre) + _LEAST_SHARE * covariance
    parts.append(_Part.of(hypothesis, centre, spread, count, rng))
    more = _log_posterior(fitter, attribution, hypothesis, middle, parts[-1].points)
    found, log_posterior = np.concatenate([found, parts[-1].points]), np.concatenate([log_posterior, more])
    weights = _weights(log_posterior - _log_density(parts, found))
    points = np.tile(middle, (len(found), 1))
    points[:, free] = found
    # Evenly over the cumulated weights, along the points' longest axis: quantiles that depend little on the seed.
    apart = points - weights @ points
    axis = np.linalg.eigh((apart * weights[:, None]).T @ apart)[1][:, -1]
    order = np.argsort((apart @ axis) * np.sign(axis[np.argmax(np.abs(axis))]), kind="stable")
    marks = (np.arange(count) + rng.random()) / count
    drawn = order[np.minimum(np.searchsorted(np.cumsum(weights[order]), marks), len(points) - 1)]
    return tuple(fit.hypothesis.effects(points[k]) for k in drawn)


@dataclass(frozen=True, eq=False)
class _Part:
    """Points from a Gaussian, those outside the ranges thrown away; in the coordinates that have a range.

    Attributes
    ----------
    points
        Shape (n, p).
    mean, root
        Of the Gaussian, shape (p,), and its covariance's Cholesky factor, shape (p, p).
    log_inside
        Logarithm of the share that is within the ranges.
    """

    points: Floats
    mean: Floats
    root: Floats
    log_inside: float

    @classmethod
    def of(
        cls, hypothesis: Hypothesis, mean: Floats, covariance: Floats, count: int, rng: np.random.Generator
    ) -> _Part:
        """Draw so many points at most."""
        free = hypothesis.high > hypothesis.low
        root = np.asarray(np.linalg.cholesky(covariance), dtype=np.float64)
        # Even in the unit cube rather than random: so the shares of what is drawn depend little on the seed.
        cube = qmc.Sobol(len(mean), seed=rng).random(_TRIED)
        tried = mean + ndtri(np.clip(cube, 1e-12, 1.0 - 1e-12)) @ root.T
        inside = np.all((tried >= hypothesis.low[free]) & (tried <= hypothesis.high[free]), axis=1)
        return cls(tried[inside][:count], mean, root, log(max(int(inside.sum()), 1) / _TRIED))


def _log_density(parts: list[_Part], points: Floats) -> Floats:
    """Return the logarithm of the density of a mixture, each part by its number of points, shape (n,)."""
    logs = [
        log(len(part.points))
        - part.log_inside
        - float(np.log(np.diag(part.root)).sum())
        - 0.5 * np.sum(np.linalg.solve(part.root, (points - part.mean).T) ** 2, axis=0)
        for part in parts
        if len(part.points)
    ]
    return np.asarray(np.logaddexp.reduce(logs, axis=0), dtype=np.float64)


def _log_posterior(
    fitter: Fitter, attribution: Attribution, hypothesis: Hypothesis, middle: Floats, found: Floats
) -> Floats:
    """Return the logarithm of the posterior density at points in the coordinates that have a range; see `samples`."""
    points = np.tile(middle, (len(found), 1))
    points[:, hypothesis.high > hypothesis.low] = found
    floors = fitter.comparison.floors
    out = np.empty(len(points))
    for k, residual in enumerate(fitter.residuals(hypothesis, list(points))):
        cost = fitter.cost(residual, points[k])
        prior = float(np.sum((points[k] / PRIOR_SIGMA) ** 2))
        # Outcomes are few and count each for one, neighbouring frames do not (`attribute`).
        outcomes = sum(
            robust_cost(values[len(values) - len(floor.outcome_scale) :])
            for values, floor in zip(residual.trials, floors, strict=True)
        )
        out[k] = -0.5 * ((cost - outcomes - prior) / attribution.dispersion + outcomes + prior)
    return out


def _weights(log_weights: Floats) -> Floats:
    """Return weights that sum to one, flattened by a power below 1 where otherwise next to nothing would count."""
    power = 1.0
    while True:
        weights = np.exp(power * (log_weights - log_weights.max()))
        weights /= weights.sum()
        if 1.0 / float(np.sum(weights**2)) >= min(_LEAST_POINTS, len(weights)) or power < _LEAST_POWER:
            return np.asarray(weights, dtype=np.float64)
        power *= 0.8
