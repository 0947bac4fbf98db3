"""What a model leaves of one trial.

That is Huber's loss of the whitened differences with the sensor's nuisances and the nominal numbers at their best, and
what these cost, all of them linearised.
"""

from __future__ import annotations

from math import inf
from typing import get_args

import numpy as np
from numpy.typing import NDArray

from ...effects.parameter import Nuisance
from ..gap.comparison import Comparison, Residual
from ..gap.loss import HUBER, robust_cost
from ..gap.pose import Path

__all__ = ["left_by", "left_of", "nuisance_columns", "nuisances_present"]

Floats = NDArray[np.float64]


def nuisance_columns(comparison: Comparison, residual: Residual, trial: int, path: Path) -> Floats:
    """Return the whitened columns of the nuisances in units of their priors, shape (n, m).

    Parameters
    ----------
    comparison, residual
        The dataset, and the nominal model with its nuisances.
    trial
        Its place in the dataset.
    path
        The model's with a wrench or without.
    """
    floor = comparison.floors[trial]
    found = comparison.readers[trial].linearised(path, residual.local[trial], residual.camera)
    # The last column is the difference itself.
    parts = [floor.whiten[name] @ found[name][kept, :-1] for name, kept in floor.valid.items()]
    rows = np.concatenate([*parts, np.zeros((len(floor.outcome_scale), len(get_args(Nuisance)) + 2))])
    sigmas = np.concatenate([comparison.nuisances.local_sigmas[trial], comparison.nuisances.shared_sigmas])
    return np.asarray(np.hstack([rows, -floor.tolerance]) * sigmas, dtype=np.float64)


def nuisances_present(comparison: Comparison, residual: Residual, trial: int) -> Floats:
    """Return how far the nuisances are off already, in units of their priors, shape (m,).

    What they took of the gap under the nominal model costs them, so that a wrench can take it back.

    Parameters
    ----------
    comparison, residual, trial
        As in `nuisance_columns`.
    """
    shared = np.concatenate([residual.camera, residual.tolerance]) / comparison.nuisances.shared_sigmas
    return np.concatenate([residual.local[trial] / comparison.nuisances.local_sigmas[trial], shared])


def left_by(comparison: Comparison, residual: Residual, trial: int, path: Path, values: Floats) -> float:
    """Return what the model leaves of a trial, the nuisances at their best.

    Parameters
    ----------
    comparison, residual, trial, path
        As in `nuisance_columns`.
    values
        The path's whitened differences, shape (n,).
    """
    n, present = nuisance_columns(comparison, residual, trial, path), nuisances_present(comparison, residual, trial)
    weight = np.sqrt(np.minimum(1.0, HUBER / np.maximum(np.abs(values), 1e-12)))[:, None]
    weighed = n * weight
    best = -np.linalg.solve(weighed.T @ weighed + np.eye(n.shape[1]), weighed.T @ (values * weight[:, 0]) + present)
    off = best + present
    return robust_cost(values + n @ best) + float(off @ off)


def left_of(comparison: Comparison, residual: Residual, trial: int, path: Path | None) -> float:
    """Return what a path leaves of a trial by its own differences, infinite without a path.

    Parameters
    ----------
    comparison, residual, trial, path
        As in `nuisance_columns`.
    """
    if path is None:
        return inf
    return left_by(comparison, residual, trial, path, comparison.differences(trial, path, residual))
