"""`found_again`: a fit from runs that are drawn to where the robot was seen.

Over a relief a wavelength that is off by one part in a hundred has lost the data's phase some waves on, and there the
objective has a minimum of its own. A run that is drawn to its track,

```text
y ← y + (1 - e^(-γ (t_k - t_(k-1)))) (ŷ_k - y)      at each frame
```

loses none where it is seen (Abarbanel and others 2009, SIAM J. Appl. Dyn. Syst. 8, 1341); as γ falls, the objective
comes back to the one that is asked for. ŷ is what the sensor saw as it was fitted to the run on its own (`Guide`).
What leaves a gap even where its runs are drawn as fast as at first is no relief, and is left, as is what nothing
better is found beside then; and where the best leaves no gap any more, the others start from what it has. Motion that
hops leaves the objective rough, so that least squares stop at every hop: it is searched by clouds of points whose
covariance adapts (CMA-ES; Hansen and Ostermeier 2001, Evol. Comput. 9, 159), in the longer steps as long as runs are
drawn.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import nullcontext

import numpy as np
from cmaes import CMA
from numpy.typing import NDArray

from ...progress import OnPhase
from ..fitting.fitter import Fitter
from ..fitting.hypothesis import Hypothesis
from ..gap.guide import Nudge
from ..gap.predictive import is_wanting, leaves_a_gap
from .contender import Contender, likeliest, of_fit
from .margins import CLEAR
from .own_noise import by_itself, settled

__all__ = ["found_again"]

Floats = NDArray[np.float64]

# The rates γ, 1/s, one after another, with how many clouds each and how wide the first is: of so many points, and in
# shares of the ranges, or of its value for a parameter that has one wherever the effect acts. From where the search of
# a dataset with a known relief had ended, nine of ten searches by runs that were drawn to straight lines between the
# frames came near it, with two companions and several seeds; as many clouds of runs on their own did with none of
# three. In a small lab both lead to it.
_RATES = ((20.0, 30, 1.0), (5.0, 15, 0.6), (0.0, 15, 0.4))
_CLOUD, _SPREAD = 16, 0.05
# A rate whose first so many clouds have found nothing better ends, and all do with the first, whose clouds reach
# farthest. A choice: where a relief was to be found the first that was better was one of nine, and around one that had
# been found already 60 found nothing in the end.
_IDLE = 12
# What such a value counts at least, in its range.
_LEAST_VALUE = 0.02
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
    made, told = list(contenders), 0
    seen = any(guide is not None for guide in fitter.comparison.simulator.guides)
    # A cloud has two dimensions at least; along a line a fit finds its way.
    clouded = [k for k in which if made[k].free >= 2]
    rates = _RATES if seen else _RATES[-1:]
    most = len(clouded) * sum(clouds for _, clouds, _ in rates)

    def on_cloud() -> None:
        nonlocal told
        tell("clouds of points", told, most)
        told += 1

    def keep(k: int, other: Contender) -> float:
        """Keep what is likelier, and return by how much it is."""
        own = made[k] if made[k].settled else by_itself(fitter, made[k], evaluations=1)
        made[k] = likeliest([own, *settled(fitter, [other], tell)])
        return own.total - made[k].total

    def best() -> Contender:
        return likeliest(made[k] for k in which)

    def share(k: int) -> None:
        """Fit a contender from what the best has of the same effects: which one is searched with luck is chance."""
        point = _with_its(made[k], best())
        if not np.array_equal(point, made[k].point):
            keep(k, _fitted(fitter, made[k], point))

    for k in clouded:
        share(k)
        found = _by_clouds(fitter, made[k], rates, seed, on_cloud)
        # From there the others start: what is left to look for is near.
        if found is not None and keep(k, found) > fitter.comparison.objective_of(CLEAR):
            rates = _RATES[-1:]
        if not is_wanting(fitter.comparison, best().residual):
            break
    for k in which:
        share(k)
    return made


def _with_its(contender: Contender, other: Contender) -> Floats:
    """Return a contender's point, where the other has an effect of it too with the other's parameters, shape (p,)."""
    assert contender.fit is not None
    assert other.fit is not None
    theirs = dict(zip(other.fit.hypothesis.keys, other.point.tolist(), strict=True))
    hypothesis = contender.fit.hypothesis
    own = zip(hypothesis.keys, contender.point.tolist(), strict=True)
    point: Floats = np.array([theirs.get(key, value) for key, value in own])
    return np.clip(point, hypothesis.low, hypothesis.high)


def _by_clouds(
    fitter: Fitter,
    contender: Contender,
    rates: Sequence[tuple[float, int, float]],
    seed: int,
    on_cloud: Callable[[], None],
) -> Contender | None:
    """Return a contender where the clouds around it lead; None where the first rate's lead nowhere, or leave a gap.

    It is against the noise around where the last cloud ended.
    """
    assert contender.fit is not None
    hypothesis, point = contender.fit.hypothesis, contender.point
    spread = _spread(hypothesis, point)
    for rate, clouds, width in rates:
        with fitter.comparison.in_longer_steps() if rate > 0.0 else nullcontext():
            fitter.take_likeliest_noise(hypothesis.effects(point))
            cloud = _Cloud(fitter, hypothesis, point, width * spread, rate, seed)
            found = False
            for n in range(clouds):
                on_cloud()
                found |= cloud.move()
                if n + 1 == _IDLE and not found:
                    break
            if rate == rates[0][0] and (not found or cloud.is_wanting()):
                return None
        point = cloud.best
    return _fitted(fitter, contender, point)


def _fitted(fitter: Fitter, contender: Contender, point: Floats) -> Contender:
    """Return a contender fitted from another point, against the noise there."""
    assert contender.fit is not None
    hypothesis = contender.fit.hypothesis
    fitter.take_likeliest_noise(hypothesis.effects(point))
    return of_fit(fitter, fitter.fit(hypothesis, point, evaluations=_LAST_POINTS))


def _spread(hypothesis: Hypothesis, point: Floats) -> Floats:
    """Return how wide a cloud around a point is along each coordinate, shape (p,)."""
    always = np.array([p.always and p.neutral != 0.0 for kind in hypothesis.kinds for p in kind.parameters])
    value = np.maximum(np.abs(hypothesis.neutral / hypothesis.scale + point), _LEAST_VALUE)
    return _SPREAD * np.where(always, value, 1.0)


class _Cloud:
    """Points around the best so far, against the noise of the moment, of runs that are drawn at a rate."""

    def __init__(
        self, fitter: Fitter, hypothesis: Hypothesis, start: Floats, spread: Floats, rate: float, seed: int
    ) -> None:
        self._fitter, self._hypothesis = fitter, hypothesis
        self._free = hypothesis.high > hypothesis.low
        self._spread = spread[self._free]
        self._nudges: list[Nudge] | None = None
        if rate > 0.0:
            (alone,) = fitter.residuals(hypothesis, [start])
            self._nudges = [Nudge.of(rate, local, alone.camera) for local in alone.local]
        self.best, self._least = start, self._costs([start])[0]
        bounds = np.column_stack([hypothesis.low, hypothesis.high])[self._free] / self._spread[:, None]
        self._moving = CMA(
            mean=start[self._free] / self._spread,
            sigma=1.0,
            bounds=bounds,
            # It takes 32 bits.
            seed=int(np.random.SeedSequence(seed).generate_state(1)[0]),
            population_size=_CLOUD,
        )

    def move(self) -> bool:
        """Look at the points of a cloud, let the next one be where they are best, and return whether one is better."""
        asked = [self._moving.ask() for _ in range(_CLOUD)]
        points = [self.best.copy() for _ in asked]
        for point, values in zip(points, asked, strict=True):
            point[self._free] = values * self._spread
            # Divided and multiplied again, an end of a range may be beyond it by rounding.
            np.clip(point, self._hypothesis.low, self._hypothesis.high, out=point)
        costs = self._costs(points)
        self._moving.tell(list(zip(asked, costs, strict=True)))
        k = int(np.argmin(costs))
        better = costs[k] < self._least
        if better:
            self.best, self._least = points[k], costs[k]
        return better

    def is_wanting(self) -> bool:
        """Whether even runs that are drawn to the tracks leave a gap in them at the best point."""
        if self._nudges is None:
            return False
        (best,) = self._fitter.residuals(self._hypothesis, [self.best], nudges=self._nudges)
        comparison = self._fitter.comparison
        drawn = [i for i, guide in enumerate(comparison.simulator.guides) if guide is not None]
        tracks = [best.trials[i][: comparison.floors[i].tracked] for i in drawn]
        return leaves_a_gap(np.concatenate(tracks))

    def _costs(self, points: Sequence[Floats]) -> list[float]:
        found = self._fitter.residuals(self._hypothesis, points, nudges=self._nudges)
        return [self._fitter.cost(residual, point) for residual, point in zip(found, points, strict=True)]
