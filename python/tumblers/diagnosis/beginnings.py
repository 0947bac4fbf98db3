"""Fits to the beginnings of trials first: where an effect is strong, paths soon have nothing in common any more."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from .contender import Contender, of_fit
from .fit import Fitter
from .hypothesis import Hypothesis

__all__ = ["MANY", "from_beginnings", "promise"]

Floats = NDArray[np.float64]

# Points over the range that are tried (of one parameter, of more), every other one so much nearer to neutral, where
# most causes are; from the best of them are fitted these shares of the trials' time one after another, in so many trial
# points, then all of it.
_ONE_PARAMETER_POINTS, _MORE_POINTS, _NEARER, _STAGES, _STAGE_POINTS, _LAST_POINTS = 8, 16, 0.15, (0.25, 0.5), 4, 6
# Of more parameters than this, points over the range tell nothing: from all close starts, then from the best so
# many, these shares are fitted.
MANY, _FOLLOWED = 4, ((0.1, None), (0.25, 4), (0.5, 2))


def from_beginnings(fitter: Fitter, contender: Contender, possible: Sequence[Hypothesis], seed: int) -> Contender:
    """Fit a contender again, the beginnings of the trials first, or return it as it is where there are none.

    Parameters
    ----------
    fitter
        Of the dataset.
    contender
        One or two effects.
    possible
        Every effect by itself.
    seed
        Of the points over the range.
    """
    tracked = _tracked(fitter)
    if not tracked:
        return contender
    assert contender.fit is not None
    fitter.take_likeliest_noise(contender.effects)
    hypothesis = contender.fit.hypothesis
    point = (
        _followed(fitter, contender, possible, tracked)
        if len(contender.point) > MANY
        else _staged(fitter, hypothesis, _sampled(fitter, hypothesis, seed, tracked)[1], tracked)
    )
    fit = fitter.fit(hypothesis, point, evaluations=_LAST_POINTS)
    return of_fit(fitter, min(fitter.again(contender.fit), fit, key=lambda fit: fit.cost))


def promise(fitter: Fitter, contender: Contender, seed: int) -> float:
    """Return how much better than a contender the best point over its range follows the beginnings of the trials.

    Parameters
    ----------
    fitter
        Of the dataset.
    contender
        One effect of few parameters.
    seed
        Of the points over the range.
    """
    tracked = _tracked(fitter)
    if not tracked:
        return 0.0
    assert contender.fit is not None
    hypothesis = contender.fit.hypothesis
    here = fitter.residuals(hypothesis, [contender.point], tracked, _STAGES[0])[0]
    return fitter.cost(here, contender.point, tracked) - _sampled(fitter, hypothesis, seed, tracked)[0]


def _tracked(fitter: Fitter) -> tuple[int, ...]:
    return tuple(i for i in fitter.trials if len(fitter.comparison.readers[i].observed.time_s))


def _sampled(fitter: Fitter, hypothesis: Hypothesis, seed: int, tracked: tuple[int, ...]) -> tuple[float, Floats]:
    """Return the objective over the beginnings at the best of many points over the range, and that point."""
    free = hypothesis.high > hypothesis.low
    points = _ONE_PARAMETER_POINTS if free.sum() < 2 else _MORE_POINTS
    shares = qmc.Sobol(len(free), rng=np.random.default_rng(seed)).random(points)
    tried: list[Floats] = [hypothesis.low + share * (hypothesis.high - hypothesis.low) for share in shares]
    tried[1::2] = [_NEARER * point for point in tried[1::2]]
    residuals = fitter.residuals(hypothesis, tried, tracked, _STAGES[0])
    costs = [fitter.cost(residual, point, tracked) for residual, point in zip(residuals, tried, strict=True)]
    best = int(np.argmin(costs))
    return costs[best], tried[best]


def _staged(fitter: Fitter, hypothesis: Hypothesis, point: Floats, tracked: tuple[int, ...]) -> Floats:
    """Return where a fit to more and more of the trials' time leads from a point."""
    for stage in _STAGES:
        point = fitter.fit(hypothesis, point, tracked, _STAGE_POINTS, stage).point
    return point


def _followed(fitter: Fitter, contender: Contender, possible: Sequence[Hypothesis], tracked: tuple[int, ...]) -> Floats:
    """Return the point that is best after fits from all close starts, fewer of them over more of the trials."""
    assert contender.fit is not None
    hypothesis = contender.fit.hypothesis
    points = _starts_within(contender, possible)
    for stage, count in _FOLLOWED:
        fits = [fitter.fit(hypothesis, point, tracked, _STAGE_POINTS, stage) for point in points[:count]]
        points = [fit.point for fit in sorted(fits, key=lambda fit: fit.cost)]
    return points[0]


def _starts_within(contender: Contender, possible: Sequence[Hypothesis]) -> list[Floats]:
    """Return a contender's point with the effect that has most parameters at each of its close starts."""
    kinds = [next(h for h in possible if h.names == (name,)) for name in contender.names]
    most = max(range(len(kinds)), key=lambda n: len(kinds[n].neutral))
    first = sum(len(h.neutral) for h in kinds[:most])
    points = []
    for start in kinds[most].close:
        point = contender.point.copy()
        point[first : first + len(start)] = start
        points.append(point)
    return points
