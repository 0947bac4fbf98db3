"""`found_again`: a fit from runs that are drawn to where the robot was seen.

Over a relief a wavelength that is off by one part in a hundred has lost the data's phase some waves on, and there the
objective has a minimum of its own. A run that is drawn to its track,

```text
y ← y + (1 - e^(-γh)) (ŷ(t) - y)
```

loses no phase (Abarbanel and others 2009, SIAM J. Appl. Dyn. Syst. 8, 1341); as γ falls, the objective comes back to
the one that is asked for. Motion that hops leaves it rough, so that least squares stop at every hop: it is searched
by clouds of points whose covariance adapts (CMA-ES; Hansen and Ostermeier 2001, Evol. Comput. 9, 159), in the longer
steps as long as runs are drawn.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext

import numpy as np
from cmaes import CMA
from numpy.typing import NDArray

from ..progress import OnPhase
from .contender import Contender, likeliest
from .fitter import Fitter
from .hypothesis import Hypothesis
from .own_noise import settled, settled_at

__all__ = ["found_again"]

Floats = NDArray[np.float64]

# The rates γ, 1/s, one after another, with how many clouds each and how wide the first is: of so many points, and in
# shares of the ranges, or of its value for a parameter that has one wherever the effect acts. From where the search of
# a dataset with a known relief had ended, such clouds led to it, or near it, with two of three companions, and as many
# clouds of runs on their own with none; in a small lab both lead to it.
_RATES = ((20.0, 30, 1.0), (5.0, 15, 0.6), (0.0, 15, 0.4))
_CLOUD, _SPREAD = 16, 0.05
# Trial points of the fit from where the last cloud ends.
_LAST_POINTS = 12


def found_again(
    fitter: Fitter, contenders: Sequence[Contender], which: Sequence[int], seed: int, tell: OnPhase
) -> list[Contender]:
    """Search around some contenders by runs that are drawn to the tracks, and keep what is likelier.

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
        tell("runs drawn to the tracks", n, len(which))
        made[k] = _found_again(fitter, contenders[k], seed, tell)
    return made


def _found_again(fitter: Fitter, contender: Contender, seed: int, tell: OnPhase) -> Contender:
    assert contender.fit is not None
    # A cloud has two dimensions at least; along a line a fit finds its way.
    if contender.free < 2:
        return contender
    hypothesis, point = contender.fit.hypothesis, contender.point
    spread = _spread(hypothesis, point)
    for rate, clouds, width in _RATES:
        with fitter.comparison.in_longer_steps() if rate > 0.0 else nullcontext():
            fitter.take_likeliest_noise(hypothesis.effects(point))
            point = _least_by_clouds(fitter, hypothesis, point, width * spread, rate, clouds, seed)
    (other,) = settled(fitter, [settled_at(fitter, hypothesis, point, _LAST_POINTS)], tell)
    return likeliest([contender, other])


def _spread(hypothesis: Hypothesis, point: Floats) -> Floats:
    """Return how wide a cloud around a point is along each coordinate, shape (p,)."""
    always = np.array([p.always for kind in hypothesis.kinds for p in kind.parameters])
    value = np.abs(hypothesis.neutral / hypothesis.scale + point)
    return _SPREAD * np.where(always & (value > 0.0), value, 1.0)


def _least_by_clouds(
    fitter: Fitter, hypothesis: Hypothesis, start: Floats, spread: Floats, rate: float, clouds: int, seed: int
) -> Floats:
    """Return the best point of some clouds, the first around a start, or the start, against the noise of the moment."""
    free = hypothesis.high > hypothesis.low
    bounds = np.column_stack([hypothesis.low, hypothesis.high])[free] / spread[free, None]
    cloud = CMA(mean=start[free] / spread[free], sigma=1.0, bounds=bounds, seed=seed, population_size=_CLOUD)
    best, least = start, _costs(fitter, hypothesis, [start], rate)[0]
    for _ in range(clouds):
        asked = [cloud.ask() for _ in range(_CLOUD)]
        points = [start.copy() for _ in asked]
        for point, values in zip(points, asked, strict=True):
            point[free] = values * spread[free]
        costs = _costs(fitter, hypothesis, points, rate)
        cloud.tell(list(zip(asked, costs, strict=True)))
        k = int(np.argmin(costs))
        if costs[k] < least:
            best, least = points[k], costs[k]
    return best


def _costs(fitter: Fitter, hypothesis: Hypothesis, points: Sequence[Floats], rate: float) -> list[float]:
    found = fitter.residuals(hypothesis, points, rate_per_s=rate)
    return [fitter.cost(residual, point) for residual, point in zip(found, points, strict=True)]
