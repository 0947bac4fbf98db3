"""Points around a fit: where motion hops the objective is rough, and a better point may be near."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .fit import Fit

__all__ = ["points_around"]

Floats = NDArray[np.float64]

# How many, and their spread in standard deviations and in shares of the ranges.
_POINTS, _SPREADS, _SHARES = 18, (1.0, 2.0, 4.0), (0.02, 0.05, 0.1)


def points_around(fit: Fit, dispersion: float, rng: np.random.Generator) -> list[Floats]:
    """Return points around a fit, within the range.

    Parameters
    ----------
    fit
        A hypothesis at its best.
    dispersion
        How many numbers count as one.
    rng
        Where they come from.
    """
    count = len(fit.point)
    root = np.linalg.cholesky(fit.covariance(dispersion))
    spreads = [*(spread * root for spread in _SPREADS), *(share * np.eye(count) for share in _SHARES)]
    low, high = fit.hypothesis.low, fit.hypothesis.high
    return [np.clip(fit.point + spreads[k % len(spreads)] @ rng.normal(size=count), low, high) for k in range(_POINTS)]
