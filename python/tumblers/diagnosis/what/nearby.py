"""Around a fit: where motion hops, the objective is rough, and a better point may be near.

A small change of a parameter changes the differences by steps there, and least squares stop in small local minima.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from ...progress import OnPhase
from ..fitting.fit import Fit
from ..fitting.fitter import Fitter
from ..fitting.hypothesis import Hypothesis
from .contender import Contender, likeliest_first
from .least import least
from .margins import CLEAR, ENOUGH
from .own_noise import settled_at

__all__ = ["all_shaken", "shaken"]

Floats = NDArray[np.float64]

# How many points in all directions, and their spread in standard deviations and in shares of the ranges; the shares by
# which each parameter alone is moved either way. With such moves a pair was found in a dataset with a known truth in
# which the points in all directions had led nowhere.
_POINTS, _SPREADS, _SHARES, _ALONE = 18, (1.0, 2.0, 4.0), (0.02, 0.05, 0.1), (0.05, 0.15)
# Of this many parameters a valley may be met by so many points over the range.
_FEW, _WITHIN = 2, 32
# Fits that are looked around, how many of the points around one are fitted on in so many trial points, beside one with
# a parameter moved alone, and how often.
_SHAKEN, _FITS, _FIT_POINTS, _SHAKES = 3, 2, 3, 2


def all_shaken(
    fitter: Fitter, contenders: Sequence[Contender], seed: int, tell: OnPhase, margin: float = CLEAR
) -> list[Contender]:
    """Look around the best, and around those that are about as good: none is to lead because it alone was.

    Parameters
    ----------
    fitter
        Of the dataset.
    contenders
        The likeliest first; those are looked around that are settled.
    seed
        Of the points.
    tell
        Is told the phase, how much of it is done, and of how much.
    margin
        What is less likely than the best by less than so much, in ln, is about as good.
    """
    near = contenders[0].total + fitter.comparison.objective_of(margin)
    chosen = [k for k, contender in enumerate(contenders) if contender.settled and contender.total < near]
    made = list(contenders)
    for k in chosen[:_SHAKEN]:
        made[k] = shaken(fitter, contenders[k], seed, tell)
    return likeliest_first(made)


def shaken(fitter: Fitter, contender: Contender, seed: int, tell: OnPhase) -> Contender:
    """Look around a fit for a better one, and return it or the fit as it is.

    Parameters
    ----------
    fitter
        Of the dataset.
    contender
        One or two effects.
    seed
        Of the points.
    tell
        Is told the phase, how much of it is done, and of how much.
    """
    rng, best = np.random.default_rng(seed), contender
    clear, enough = (fitter.comparison.objective_of(ln) for ln in (CLEAR, ENOUGH))
    for k in range(_SHAKES):
        tell("around the best", k, _SHAKES)
        assert best.fit is not None
        hypothesis = best.fit.hypothesis
        fitter.take_likeliest_noise(best.effects)
        around = _points_around(best.fit, fitter.comparison.alike, rng)
        if k == 0 and hypothesis.free == _FEW:
            around += _points_within(hypothesis, rng)
        starts = [point for _, point in least(fitter, hypothesis, around, _FITS)]
        if alone := _moved_alone(best.fit):
            starts += [point for _, point in least(fitter, hypothesis, alone, 1)]
        ends = [fitter.descend(hypothesis, start, evaluations=_FIT_POINTS) for start in starts]
        cost, point = min(ends, key=lambda end: end[0])
        # What is clearly worse against this noise is not looked at against its own.
        if cost > fitter.again(best.fit).cost + clear:
            break
        other = settled_at(fitter, hypothesis, point)
        if other.total > best.total - enough:
            break
        best = other
    return best


def _points_around(fit: Fit, alike: float, rng: np.random.Generator) -> list[Floats]:
    """Return points around a fit, within the range, `alike` being how many numbers count as one."""
    count = len(fit.point)
    root = np.linalg.cholesky(fit.covariance(alike))
    spreads = [*(spread * root for spread in _SPREADS), *(share * np.eye(count) for share in _SHARES)]
    low, high = fit.hypothesis.low, fit.hypothesis.high
    moves = [spreads[k % len(spreads)] @ rng.normal(size=count) for k in range(_POINTS)]
    return [np.clip(fit.point + move, low, high) for move in moves]


def _points_within(hypothesis: Hypothesis, rng: np.random.Generator) -> list[Floats]:
    """Return points evenly over the range."""
    sobol = qmc.Sobol(len(hypothesis.neutral), rng=rng)
    return list(hypothesis.low + sobol.random(_WITHIN) * (hypothesis.high - hypothesis.low))


def _moved_alone(fit: Fit) -> list[Floats]:
    """Return points with one parameter moved either way, without those that are the fit itself."""
    hypothesis = fit.hypothesis
    free = np.eye(len(fit.point))[hypothesis.low < hypothesis.high]
    moves = [way * share * unit for unit in free for share in _ALONE for way in (-1.0, 1.0)]
    points = [np.clip(fit.point + move, hypothesis.low, hypothesis.high) for move in moves]
    here = hypothesis.values(fit.point)
    return [point for point in points if np.any(hypothesis.values(point) != here)]
