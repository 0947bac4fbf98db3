"""Intervals of a hypothesis's parameters, and samples of its effects.

Laplace's standard deviations give two points of each parameter's profile, `u ± 1.645 σ`, the other parameters following
along the ridge of the posterior; how much the objective really rises there stretches or shrinks each side so that it
rises by 1.645², the 90 % interval of a likelihood ratio.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..effects.base import Effect
from .attribute import Attribution, Contender
from .fit import Fitter
from .result import Interval

__all__ = ["intervals", "samples"]

Floats = NDArray[np.float64]

_SIDE = 1.645
# A profile that is flatter or steeper than this is not trusted further in one round.
_LEAST_RISE, _MOST_RISE = 0.3, 30.0
_ROUNDS = 2
_IDENTIFIED = 0.5


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
    covariance = attribution.covariance(contender)
    deviation = np.sqrt(np.diag(covariance))
    ridges = covariance / np.diag(covariance)
    sides = [(j, sign) for j in range(len(fit.point)) for sign in (-1.0, 1.0)]
    reach = {(j, sign): _SIDE * deviation[j] for j, sign in sides}
    for _ in range(_ROUNDS):
        points = [
            np.clip(fit.point + sign * reach[j, sign] * ridges[:, j], hypothesis.low, hypothesis.high)
            for j, sign in sides
        ]
        residuals = fitter.residuals(hypothesis, points)
        for (j, sign), point, residual in zip(sides, points, residuals, strict=True):
            rise = (fitter.cost(residual, point) - contender.cost) / attribution.dispersion
            reach[j, sign] *= float(np.sqrt(_SIDE**2 / np.clip(rise, _LEAST_RISE, _MOST_RISE)))
    ends = {
        (j, sign): float(np.clip(fit.point[j] + sign * reach[j, sign], hypothesis.low[j], hypothesis.high[j]))
        for j, sign in sides
    }
    out = {}
    for j, key in enumerate(hypothesis.keys):
        value = [hypothesis.neutral[j] + hypothesis.scale[j] * u for u in (fit.point[j], ends[j, -1.0], ends[j, 1.0])]
        width = (ends[j, 1.0] - ends[j, -1.0]) / max(hypothesis.high[j] - hypothesis.low[j], 1e-300)
        out[key] = Interval(float(value[0]), float(value[1]), float(value[2]), bool(width < _IDENTIFIED))
    return out


def samples(attribution: Attribution, contender: Contender, count: int, seed: int) -> tuple[tuple[Effect, ...], ...]:
    """Return draws of a hypothesis's effects from its posterior, the best fit first.

    Parameters
    ----------
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
    root = np.linalg.cholesky(attribution.covariance(contender))
    draws = [fit.point] + [fit.point + root @ rng.standard_normal(len(fit.point)) for _ in range(count - 1)]
    return tuple(fit.hypothesis.effects(point) for point in draws)
