"""`found_by_clouds`: a better minimum beside a fit, where there are many.

Over a relief a wavelength that is off by one part in a hundred has lost the data's phase some waves on, and there the
objective has a minimum of its own; and motion that hops makes it rough, so that least squares stop at every hop. What
comes near is searched by clouds of points, whose mean and covariance follow the best of them (CMA-ES; Hansen and
Ostermeier 2001, Evol. Comput. 9, 159): first in the longer steps, then in the right ones, as long as that helps.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from cmaes import CMA
from numpy.typing import NDArray

from ..progress import OnPhase
from .contender import Contender, likeliest
from .fitter import Fitter
from .hypothesis import Hypothesis
from .own_noise import settled, settled_at

__all__ = ["found_by_clouds"]

Floats = NDArray[np.float64]

# Points of a cloud, and how wide the first is: a share of each range, or of its value for a parameter that has one
# wherever the effect acts.
_CLOUD, _SPREAD = 16, 0.05
# Clouds in the longer steps; and in the right ones, once and again from where they ended while that takes off this
# share of the objective; how wide the first ones are then, in shares of the above. In a small lab with a known relief
# wavelengths that were off by 4 to 10 % either way were found with each of three seeds.
_COARSE, _FINE, _WIDTHS, _GAIN = 30, 20, (0.6, 0.4, 0.4), 0.05
# Trial points of the fit from where the last cloud ends.
_LAST_POINTS = 12


def found_by_clouds(
    fitter: Fitter, contenders: Sequence[Contender], which: Sequence[int], seed: int, tell: OnPhase
) -> list[Contender]:
    """Search around some contenders, and keep what is likelier.

    Parameters
    ----------
    fitter
        Of the dataset.
    contenders
        One or two effects each.
    which
        The places of those that are searched around.
    seed
        Of the clouds.
    tell
        Is told the phase, how much of it is done, and of how much.
    """
    made = list(contenders)
    for n, k in enumerate(which):
        tell("clouds around the best", n, len(which))
        made[k] = _found(fitter, contenders[k], seed, tell)
    return made


def _found(fitter: Fitter, contender: Contender, seed: int, tell: OnPhase) -> Contender:
    assert contender.fit is not None
    hypothesis, point = contender.fit.hypothesis, contender.point
    spread = _spread(hypothesis, point)
    with fitter.comparison.in_longer_steps():
        fitter.take_likeliest_noise(contender.effects)
        _, point = _least(fitter, hypothesis, point, spread, _COARSE, seed)
    for width in _WIDTHS:
        fitter.take_likeliest_noise(hypothesis.effects(point))
        gain, point = _least(fitter, hypothesis, point, width * spread, _FINE, seed)
        if gain < _GAIN:
            break
    (other,) = settled(fitter, [settled_at(fitter, hypothesis, point, _LAST_POINTS)], tell)
    return likeliest([contender, other])


def _spread(hypothesis: Hypothesis, point: Floats) -> Floats:
    """Return how wide a cloud around a point is along each coordinate, shape (p,)."""
    always = np.array([p.always for kind in hypothesis.kinds for p in kind.parameters])
    value = np.abs(hypothesis.neutral / hypothesis.scale + point)
    return _SPREAD * np.where(always & (value > 0.0), value, 1.0)


def _least(
    fitter: Fitter, hypothesis: Hypothesis, start: Floats, spread: Floats, clouds: int, seed: int
) -> tuple[float, Floats]:
    """Return what share of the objective the best point of some clouds around a start takes off, and that point."""
    free = hypothesis.high > hypothesis.low
    bounds = np.column_stack([hypothesis.low, hypothesis.high])[free] / spread[free, None]
    cloud = CMA(mean=start[free] / spread[free], sigma=1.0, bounds=bounds, seed=seed, population_size=_CLOUD)
    (before,) = _costs(fitter, hypothesis, [start])
    best, least = start, before
    for _ in range(clouds):
        asked = [cloud.ask() for _ in range(_CLOUD)]
        points = [start.copy() for _ in asked]
        for point, values in zip(points, asked, strict=True):
            point[free] = values * spread[free]
        costs = _costs(fitter, hypothesis, points)
        cloud.tell(list(zip(asked, costs, strict=True)))
        k = int(np.argmin(costs))
        if costs[k] < least:
            best, least = points[k], costs[k]
    return 1.0 - least / max(before, 1e-300), best


def _costs(fitter: Fitter, hypothesis: Hypothesis, points: Sequence[Floats]) -> list[float]:
    found = fitter.residuals(hypothesis, points)
    return [fitter.cost(residual, point) for residual, point in zip(found, points, strict=True)]
