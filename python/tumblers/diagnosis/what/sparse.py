"""`as_far`: a contender fitted as far as it goes, with those of its parameters at neutral that it does not need.

Where motion hops, least squares stop in a small minimum: in one parameter beside a narrow valley, in many with numbers
that need not be there. What is left without these is fitted farther, in fewer derivatives. One parameter is looked for
on a line, at its end each point against the noise around itself: that is a part of the likelihood that least squares
do not see. Of two effects that do the same neither must win by how far its fit went.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..fitting.fitter import Fitter
from ..fitting.hypothesis import Hypothesis
from .contender import Contender, likeliest
from .least import least
from .occam import unneeded
from .own_noise import POLISH_POINTS, against_itself, by_itself, settled_at

__all__ = ["as_far"]

Floats = NDArray[np.float64]

# How often a fit is taken on, each time against the noise around where it is.
_ROUNDS = 2
# Of one parameter, factors of its way from neutral that are tried first, and standard deviations around where it ends.
_FACTORS, _AROUND = (0.8, 0.9, 0.95, 0.98, 1.0, 1.02, 1.05, 1.1, 1.25), (-1.0, -0.5, 0.5, 1.0)


def as_far(fitter: Fitter, contender: Contender, alike: float) -> Contender:
    """Return a contender against its own noise, or what is likelier near it.

    Parameters
    ----------
    fitter
        Of the dataset.
    contender
        One or two effects.
    alike
        How many numbers count as one.
    """
    known = contender if contender.settled else by_itself(fitter, contender, evaluations=1)
    assert known.fit is not None
    hypothesis = known.fit.hypothesis
    those = unneeded(known.fit, alike, fitter.comparison.independent)
    less, start = hypothesis.held(those), np.where(those, 0.0, known.point)
    if less.free == 1:
        end = _on_its_line(fitter, less, start, alike)
    else:
        end = start
        for _ in range(_ROUNDS):
            fitter.take_likeliest_noise(less.effects(end))
            end = fitter.descend(less, end, evaluations=POLISH_POINTS)[1]
    return likeliest([known, settled_at(fitter, hypothesis, end)])


def _on_its_line(fitter: Fitter, hypothesis: Hypothesis, start: Floats, alike: float) -> Floats:
    """Return the likeliest point near a start in one parameter."""

    def within(point: Floats) -> Floats:
        return np.clip(point, hypothesis.low, hypothesis.high)

    fitter.take_likeliest_noise(hypothesis.effects(start))
    best = least(fitter, hypothesis, [within(factor * start) for factor in _FACTORS], 1)[0][1]
    near = settled_at(fitter, hypothesis, best, POLISH_POINTS)
    assert near.fit is not None
    deviation = np.sqrt(np.diag(near.fit.covariance(alike)))
    around = [replace(near.fit, point=within(near.point + way * deviation)) for way in _AROUND]
    return likeliest([near, *(against_itself(fitter, fit) for fit in around)]).point
