"""Fits to the beginnings of trials first: where an effect is strong, paths soon have nothing in common any more."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from ..fitting.fitter import Fitter
from ..fitting.hypothesis import Hypothesis
from .contender import Contender, of_fit
from .least import least

__all__ = ["MANY", "beginning", "from_beginnings", "from_its_own_beginning", "promise"]

Floats = NDArray[np.float64]

# Points that are tried (of one parameter, of more): some evenly over the range, and as many in each decade of their
# distance from neutral, or from where two effects are, over so many decades. Of one parameter a valley that is a
# twentieth of the range wide is to be met. From the best few of them these shares of
# the trials' time are fitted one after another, the best alone after the first, in so many trial points; then all.
_EVEN, _BY_DECADE, _DECADES = 32, (32, 64), 1.7
_BEST, _STAGES, _STAGE_POINTS, _LAST_POINTS = 3, (0.25, 0.5), 4, 6
# Of more parameters than this, points over the range tell nothing: from where it is and from the close starts, these
# shares are fitted one after another, each from the best so many of before, then all from the best of these. Over a
# first beginning many do as well as the right one: how many go on was chosen, of five ways, on four datasets with a
# known truth.
MANY, _FOLLOWED, _ENDS = 4, ((0.1, 32), (0.25, 12), (0.5, 4)), 2


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
    if contender.free > MANY:
        return _fitted(fitter, contender, _followed(fitter, contender, possible, tracked))
    sampled = [point for _, point in _sampled(fitter, contender, seed, tracked, _BEST)]
    return _fitted(fitter, contender, [_staged(fitter, hypothesis, sampled, tracked)])


def from_its_own_beginning(fitter: Fitter, contender: Contender) -> Contender:
    """Fit a contender again from where it is, the beginnings of the trials first, or return it where there are none.

    Where a second effect has changed what the first one asks for, a wavelength is off by more than its valley is wide
    over whole trials, and by less than it is over their beginnings.

    Parameters
    ----------
    fitter
        Of the dataset.
    contender
        One or two effects.
    """
    tracked = _tracked(fitter)
    if not tracked:
        return contender
    assert contender.fit is not None
    fitter.take_likeliest_noise(contender.effects)
    return _fitted(fitter, contender, [_followed_from(fitter, contender, [contender.point], tracked)[0][1]])


def _fitted(fitter: Fitter, contender: Contender, starts: Sequence[Floats]) -> Contender:
    """Fit a contender to all of the trials from some starts, and keep what is best against the noise of the moment."""
    assert contender.fit is not None
    fits = [fitter.fit(contender.fit.hypothesis, start, evaluations=_LAST_POINTS) for start in starts]
    return of_fit(fitter, min([fitter.again(contender.fit), *fits], key=lambda fit: fit.cost))


def promise(fitter: Fitter, contender: Contender, seed: int) -> float:
    """Return how much better than a contender the best point over its range follows the beginnings of the trials.

    By the objective, against the noise of the moment; 0 where there are no tracks.

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
    return beginning(fitter, contender) - _sampled(fitter, contender, seed, tracked, 1)[0][0]


def beginning(fitter: Fitter, contender: Contender) -> float:
    """Return the objective of a contender over the beginnings of the trials, against the noise of the moment.

    0 where there are no tracks.

    Parameters
    ----------
    fitter
        Of the dataset.
    contender
        One or two effects.
    """
    tracked = _tracked(fitter)
    if not tracked:
        return 0.0
    assert contender.fit is not None
    here = fitter.residuals(contender.fit.hypothesis, [contender.point], tracked, _STAGES[0])[0]
    return fitter.cost(here, contender.point, tracked)


def _tracked(fitter: Fitter) -> tuple[int, ...]:
    return tuple(i for i in fitter.trials if len(fitter.comparison.readers[i].observed.time_s))


def _sampled(
    fitter: Fitter, contender: Contender, seed: int, tracked: tuple[int, ...], count: int
) -> list[tuple[float, Floats]]:
    """Return the best of many points with their objective over the beginnings, the best first."""
    assert contender.fit is not None
    hypothesis = contender.fit.hypothesis
    low, high = hypothesis.low, hypothesis.high
    more = int(hypothesis.free > 1)
    sobol = qmc.Sobol(1 + len(low), rng=np.random.default_rng(seed))
    even = low + sobol.random(_EVEN)[:, 1:] * (high - low)
    drawn = sobol.random(_BY_DECADE[more])
    ways = 2.0 * drawn[:, 1:] - 1.0
    ways *= (10.0 ** (-_DECADES * drawn[:, 0]) / np.max(np.abs(ways), axis=1))[:, None]
    # Of two effects one may be right as it is.
    centre = contender.point if len(contender.names) > 1 else np.zeros(len(low))
    tried: list[Floats] = [*even, *np.clip(centre + np.where(ways > 0.0, ways * high, -ways * low), low, high)]
    return least(fitter, hypothesis, tried, count, tracked, _STAGES[0])


def _staged(fitter: Fitter, hypothesis: Hypothesis, points: Sequence[Floats], tracked: tuple[int, ...]) -> Floats:
    """Return where fits to more and more of the trials' time lead from some points."""
    for stage in _STAGES:
        ends = [fitter.descend(hypothesis, point, tracked, _STAGE_POINTS, stage) for point in points]
        points = [min(ends, key=lambda end: end[0])[1]]
    return points[0]


def _followed(
    fitter: Fitter, contender: Contender, possible: Sequence[Hypothesis], tracked: tuple[int, ...]
) -> list[Floats]:
    """Return the best points after fits from where a contender is and from the close starts."""
    assert contender.fit is not None
    share, count = _FOLLOWED[0]
    close = least(fitter, contender.fit.hypothesis, _starts_within(contender, possible), count, tracked, share)
    # Where it is does not have to beat the others over the first beginnings.
    ends = _followed_from(fitter, contender, [contender.point], tracked)
    ends += _followed_from(fitter, contender, [point for _, point in close], tracked)
    return [point for _, point in sorted(ends, key=lambda end: end[0])[:_ENDS]]


def _followed_from(
    fitter: Fitter, contender: Contender, points: Sequence[Floats], tracked: tuple[int, ...]
) -> list[tuple[float, Floats]]:
    """Return the ends of fits from some points, fewer of them over more of the trials, with their objective."""
    assert contender.fit is not None
    ends: list[tuple[float, Floats]] = []
    for stage, count in _FOLLOWED:
        ends = [fitter.descend(contender.fit.hypothesis, p, tracked, _STAGE_POINTS, stage) for p in points[:count]]
        ends.sort(key=lambda end: end[0])
        points = [point for _, point in ends]
    return ends


def _starts_within(contender: Contender, possible: Sequence[Hypothesis]) -> list[Floats]:
    """Return a contender's point with the effect that has most parameters at each of its close starts."""
    kinds = [next(h for h in possible if h.names == (name,)) for name in contender.names]
    most = max(range(len(kinds)), key=lambda n: kinds[n].free)
    first = sum(len(h.neutral) for h in kinds[:most])
    points = []
    for start in kinds[most].close:
        point = contender.point.copy()
        point[first : first + len(start)] = start
        points.append(point)
    return points
