"""`native_trial`: a scenario as the native module takes it."""

from __future__ import annotations

from math import radians
from typing import TYPE_CHECKING

from . import _core
from .core_errors import core_error
from .errors import InputError

if TYPE_CHECKING:
    from .scenario import Scenario

__all__ = ["native_trial"]


def native_trial(scenario: Scenario) -> _core.Trial:
    """Return the native trial of a scenario.

    Parameters
    ----------
    scenario
        What is run, its effects at work and none left to apply.

    Raises
    ------
    InputError
        What only the parts together show, or a step that is still to be chosen.
    """
    robot, substrate, run = scenario.robot, scenario.substrate, scenario.run
    model, initial = scenario.model, scenario.initial
    relief, surroundings = scenario.relief, scenario.surroundings
    body = robot.body()
    try:
        return _core.Trial(
            body=body,
            mass_kg=robot.total_mass_kg,
            magnetic_moment_A_m2=robot.magnetic_moment_A_m2,
            friction_coefficient=substrate.friction_coefficient,
            friction_drift_per_s=substrate.friction_drift_per_s,
            friction_ellipsoid=substrate.friction_ellipsoid,
            adhesion_N_per_m2=substrate.adhesion_N_per_m2,
            electrostatic_force_N=substrate.electrostatic_force_N,
            line_contact_width_m=substrate.line_contact_width_m,
            compliance_m_per_N=substrate.compliance_m_per_N,
            field=scenario.field.core(),
            incline_rad=radians(run.incline_deg),
            side_incline_rad=radians(run.side_incline_deg),
            gravity_m_per_s2=run.gravity_m_per_s2,
            duration_s=run.duration_s,
            step_s=run.fixed_step_s,
            magnetic_torque=scenario.magnetic_torque,
            adhesion_acts_at=model.adhesion_acts_at,
            adhesion_enters=model.adhesion_enters,
            position_m=initial.position_m,
            orientation=initial.orientation,
            linear_velocity_m_per_s=initial.linear_velocity_m_per_s,
            angular_velocity_rad_per_s=initial.angular_velocity_rad_per_s,
            relief_wavelength_m=relief.wavelength_m,
            relief_cosine_m=relief.cosine_m,
            relief_sine_m=relief.sine_m,
            force_N=surroundings.force_N,
            torque_N_m=surroundings.torque_N_m,
            translational_drag_N_s_per_m=surroundings.translational_drag_N_s_per_m,
            rotational_drag_N_m_s=surroundings.rotational_drag_N_m_s,
            sheet_conductance_S=surroundings.sheet_conductance_S,
            wrench_time_s=surroundings.wrench_time_s,
            wrench_N_N_m=surroundings.wrench_N_N_m,
        )
    except InputError:
        raise
    except ValueError as error:
        raise core_error(error) from None
