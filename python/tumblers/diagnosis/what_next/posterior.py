"""Draws of a hypothesis's effects from its posterior.

Where a threshold decides, such as whether a robot climbs, the posterior is no Gaussian: points are proposed by
Laplace's Gaussian, by the same three times as wide and by the prior, then by the Gaussian that these show, all within
the parameters' ranges, and drawn with the weights `posterior/proposed` (sampling-importance resampling; Rubin 1988),
with c the dispersion and

```text
-2 ln posterior = (cost - prior)/c + prior
```

Parameters that are rather neutral than not by Occam's factor (`seldom_needed`) are neutral in all draws: what a trial
tells apart must not rest on numbers that nothing asks for. The others' Gaussian is the one with these held, about
`u_f - I_ff⁻¹ I_fn (0 - u_n)` with the fit u and the information I; the weights make up for what the tempering moves.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri
from scipy.stats import qmc

from ...effects.base import Effect
from ..fitting.fit import Fit
from ..fitting.fitter import Fitter
from ..fitting.hypothesis import PRIOR_SIGMA, Hypothesis
from ..what.attribute import Attribution
from ..what.contender import Contender
from ..what.occam import seldom_needed

__all__ = ["samples"]

Floats = NDArray[np.float64]

# So many points are tried for being within the ranges.
_TRIED = 2048
# How much wider than Laplace's Gaussian, and than what the first points show (in variance), with a share of Laplace's.
_WIDER, _BROADER, _LEAST_SHARE = 3.0, 1.5, 0.05
# So many points must count at least, by Kish's (Σw)²/Σw²: weights are flattened until they do.
_LEAST_POINTS, _LEAST_POWER = 6.0, 1e-3


def samples(
    fitter: Fitter, attribution: Attribution, contender: Contender, count: int, seed: int
) -> tuple[tuple[Effect, ...], ...]:
    """Return draws of a hypothesis's effects from its posterior, in the order of a coordinate, some several times.

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
    hypothesis, middle, covariance = _needed(fit, attribution.dispersion, fitter.comparison.independent)
    free = hypothesis.high > hypothesis.low
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
    return tuple(hypothesis.effects(points[k]) for k in drawn)


def _needed(fit: Fit, dispersion: float, numbers: float) -> tuple[Hypothesis, Floats, Floats]:
    """Return the hypothesis without what is seldom needed, and its Gaussian; the covariance of what has a range."""
    neutral = seldom_needed(fit, dispersion, numbers)
    hypothesis = fit.hypothesis.held(neutral)
    free = hypothesis.high > hypothesis.low
    information = fit.information(dispersion)
    covariance = np.asarray(np.linalg.inv(information[np.ix_(free, free)]), dtype=np.float64)
    middle = np.where(neutral, 0.0, fit.point)
    middle[free] += covariance @ information[np.ix_(free, neutral)] @ fit.point[neutral]
    return hypothesis, np.clip(middle, hypothesis.low, hypothesis.high), covariance


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
        cube = qmc.Sobol(len(mean), rng=rng).random(_TRIED)
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
    """Return the logarithm of the posterior density at points in the coordinates that have a range; see the module."""
    points = np.tile(middle, (len(found), 1))
    points[:, hypothesis.high > hypothesis.low] = found
    out = np.empty(len(points))
    for k, residual in enumerate(fitter.residuals(hypothesis, list(points))):
        cost = fitter.cost(residual, points[k])
        prior = float(np.sum((points[k] / PRIOR_SIGMA) ** 2))
        out[k] = -0.5 * ((cost - prior) / attribution.dispersion + prior)
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
