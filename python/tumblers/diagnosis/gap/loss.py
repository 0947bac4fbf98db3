"""Huber's loss of whitened differences: what the objective, the gap and the maps count in.

ρ(r) = r² up to |r| = `HUBER`, 2 `HUBER` |r| - `HUBER`² beyond (Huber 1964)
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ... import _core

__all__ = ["FAR", "HUBER", "huber", "robust_cost", "weight_of"]

Floats = NDArray[np.float64]

# Where the loss turns from square to linear, in sigmas.
HUBER = _core.HUBER
# A trial's track whose mean square is beyond this counts by its logarithm.
FAR = _core.FAR


def huber(values: Floats) -> Floats:
    """Return ρ of each number.

    Parameters
    ----------
    values
        Whitened differences, of any shape.
    """
    size = np.abs(values)
    return np.asarray(np.where(size <= HUBER, size**2, 2.0 * HUBER * size - HUBER**2), dtype=np.float64)


def robust_cost(values: Floats) -> float:
    """Return Σ ρ.

    Parameters
    ----------
    values
        Whitened differences, of any shape.
    """
    return float(np.sum(huber(values)))


def weight_of(track: Floats, count: int) -> float:
    """Return how much a trial's track counts: less where the model is far from it (`Objective`).

    Parameters
    ----------
    track
        Its whitened differences, so far as they are compared, shape (n,).
    count
        How many the whole track has.
    """
    return 1.0 / (1.0 + robust_cost(track) / (FAR * count)) if count else 1.0
