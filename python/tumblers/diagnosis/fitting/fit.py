"""`Fit`: a hypothesis at its best."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..gap.comparison import Residual
from .hypothesis import PRIOR_SIGMA, Hypothesis

__all__ = ["Fit"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Fit:
    """A hypothesis at its best.

    Attributes
    ----------
    hypothesis
        What was fitted.
    point
        The parameters as u, shape (p,).
    residual
        How wrong it still is, over all trials.
    cost
        The objective there.
    jacobian
        Derivatives of the fitted differences and the nuisances' terms by u, shape (n, p), Huber's weights in them.
    steps
        Of u, by which these were taken, shape (p,): with the same the same paths serve against another noise.
    """

    hypothesis: Hypothesis
    point: Floats
    residual: Residual
    cost: float
    jacobian: Floats
    steps: Floats

    def information(self, dispersion: float) -> Floats:
        """Return the inverse of `covariance`, shape (p, p)."""
        return self.jacobian.T @ self.jacobian / dispersion + np.eye(len(self.point)) / PRIOR_SIGMA**2

    def covariance(self, dispersion: float) -> Floats:
        """Return the posterior covariance of u by Laplace's Gaussian, shape (p, p).

        Parameters
        ----------
        dispersion
            How many numbers count as one.
        """
        return np.asarray(np.linalg.inv(self.information(dispersion)), dtype=np.float64)
