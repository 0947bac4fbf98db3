"""The posterior predictive test: whether what a hypothesis leaves is no more than noise.

It holds the mean squared difference, over all trials and in the worst one, against what a right model gives: the floor
is made so that this is about 1 at most.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .comparison import Comparison, Residual
from .loss import robust_cost

__all__ = ["is_right", "mean_square", "mean_squares"]

# A right model's mean square over all numbers, and in its worst trial.
_EXPLAINED, _WORST = 1.25, 2.0


def mean_squares(residual: Residual) -> NDArray[np.float64]:
    """Return Σρ/n of each trial, shape (trials,)."""
    return np.array([robust_cost(values) / max(len(values), 1) for values in residual.trials])


def mean_square(comparison: Comparison, residual: Residual) -> float:
    """Return Σρ/n over all trials."""
    return float(np.average(mean_squares(residual), weights=comparison.sizes))


def is_right(comparison: Comparison, residual: Residual) -> bool:
    """Whether a hypothesis passes the test."""
    # In a trial of few numbers noise alone gives more.
    worst = _WORST * (1.0 + 2.0 * np.sqrt(2.0 / np.maximum(comparison.sizes, 1)))
    return bool(mean_square(comparison, residual) <= _EXPLAINED and np.all(mean_squares(residual) <= worst))
