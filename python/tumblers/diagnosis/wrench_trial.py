"""One trial with a wrench added: the wrench's units, the scenario with it, and what the model leaves with it.

What is left is that of `missing_wrench`: Huber's loss of the whitened differences with the sensor's nuisances and the
nominal numbers at their best, and what these cost, all of them linearised.
"""

from __future__ import annotations

from dataclasses import replace
from typing import get_args

import numpy as np
from numpy.typing import NDArray

from ..effects.parameter import Nuisance
from ..field import TableField
from ..scenario import Scenario
from ..surroundings import Surroundings
from .comparison import Comparison, Residual
from .job import Edit
from .loss import HUBER, robust_cost
from .pose import Path
from .wrench_pieces import Pieces

__all__ = ["added", "derivative_steps", "end_s", "left_by", "nuisance_columns", "nuisances_present", "prior_sigma"]

Floats = NDArray[np.float64]

_PRIOR_SHARE = 0.3
# The derivatives' steps, as shares of the weight and of the moment that it turns the body over with: smaller ones meet
# the jumps of a body that may or may not leave an edge.
_STEP_FORCE, _STEP_TORQUE = 0.03, 0.02


def end_s(comparison: Comparison, trial: int) -> float:
    """Return until when a trial was observed, s.

    Parameters
    ----------
    comparison
        The dataset.
    trial
        Its place in the dataset.
    """
    # Beyond the last frame nothing says what is missing.
    observed = comparison.readers[trial].observed
    last = float(observed.time_s[-1]) + observed.frame_interval_s
    return min(last, comparison.simulator.nominal(trial).run.duration_s)


def _scales(scenario: Scenario) -> tuple[float, float, float]:
    """Return the weight with F_elect, N, the magnetic moment times the field, N m, and the body's half length, m."""
    robot, field = scenario.robot, scenario.field
    weight = robot.total_mass_kg * scenario.run.gravity_m_per_s2 + scenario.substrate.electrostatic_force_N
    strength = (
        float(np.max(np.linalg.norm(field.field_T, axis=1))) if isinstance(field, TableField) else field.strength_T
    )
    moment = float(np.linalg.norm(robot.magnetic_moment_A_m2)) * strength
    return weight, moment, float(np.max(np.abs(np.concatenate(robot.body().outline))))


def prior_sigma(scenario: Scenario) -> Floats:
    """Return how much may be missing, standard deviations, N and N m, shape (6,).

    Parameters
    ----------
    scenario
        The nominal one of a trial.
    """
    weight, moment, reach = _scales(scenario)
    # Without a field the weight bounds the torque that could be missing, and without a weight the field the force.
    force, torque = max(weight, 1e-3 * moment / reach), max(moment, 1e-3 * weight * reach)
    return _PRIOR_SHARE * np.array([force] * 3 + [torque] * 3)


def derivative_steps(scenario: Scenario) -> Floats:
    """Return the steps of derivatives by a wrench, N and N m, shape (6,).

    Parameters
    ----------
    scenario
        The nominal one of a trial.
    """
    weight, moment, reach = _scales(scenario)
    force, torque = max(weight, 1e-3 * moment / reach), max(weight * reach, 1e-3 * moment)
    return np.array([_STEP_FORCE * force] * 3 + [_STEP_TORQUE * torque] * 3)


def added(pieces: Pieces, wrench: Floats) -> Edit:
    """Return the edit that adds a wrench.

    Parameters
    ----------
    pieces
        Of the run.
    wrench
        By window, N and N m, shape (k, 6).
    """

    def edit(scenario: Scenario) -> Scenario:
        table = Surroundings(wrench_time_s=tuple(pieces.edges.tolist()), wrench_N_N_m=tuple(pieces.rows(wrench)))  # type: ignore[arg-type]
        return replace(scenario, surroundings=table)

    return edit


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
    best = -np.linalg.solve(
        (n * weight).T @ (n * weight) + np.eye(n.shape[1]), (n * weight).T @ (values * weight[:, 0]) + present
    )
    off = best + present
    return robust_cost(values + n @ best) + float(off @ off)
