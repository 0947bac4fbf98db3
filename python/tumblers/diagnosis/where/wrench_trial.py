"""One trial with a wrench added: the wrench's units, and the scenario with it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...field import TableField
from ...scenario import Scenario
from ...surroundings import Surroundings
from ..gap.comparison import Comparison
from ..gap.job import Edit
from .wrench_pieces import Pieces

__all__ = ["added", "derivative_steps", "end_s", "prior_sigma"]

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
