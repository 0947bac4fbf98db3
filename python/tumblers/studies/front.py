"""The Pareto front of a design space."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["pareto_front"]


def pareto_front(costs: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return which designs no other one beats: no worse in every cost, and better in one.

    Parameters
    ----------
    costs
        What is to be small, shape (designs, costs); a design with a cost that is NaN is not on the front.

    Returns
    -------
    numpy.ndarray
        Truth values, shape (designs,).
    """
    known = np.asarray(np.isfinite(costs).all(axis=1))
    filled = np.where(known[:, None], costs, np.inf)
    # Row i, column j: whether design j beats design i.
    no_worse = np.asarray(np.less_equal(filled[None, :, :], filled[:, None, :]).all(axis=2))
    better = np.asarray(np.less(filled[None, :, :], filled[:, None, :]).any(axis=2))
    return np.asarray(known & ~(no_worse & better).any(axis=1))
