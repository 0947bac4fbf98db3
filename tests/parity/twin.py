"""One scenario as the core's trial and as the reference's."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import radians

import numpy as np

from tumblers import (
    Cuboid,
    Curved,
    Ellipsoid,
    Field,
    Robot,
    RotatingField,
    Scenario,
    Spiked,
    SpikedEnds,
    StaticField,
    _core,
    reference,
)


@dataclass(frozen=True, eq=False)
class Twin:
    """The same trial for the core and for the reference."""

    scenario: Scenario
    core: _core.Trial
    reference: reference.Trial

    @classmethod
    def of(cls, scenario: Scenario) -> Twin:
        return cls(scenario, scenario.trial(), reference_trial(scenario))


@lru_cache(maxsize=64)
def reference_body(robot: Robot) -> reference.Body:
    body = _homogeneous(robot)
    return body.with_centre_of_mass(np.array(robot.center_of_mass_m)) if any(robot.center_of_mass_m) else body


def _homogeneous(robot: Robot) -> reference.Body:
    shape, draft, model = robot.shape, radians(robot.draft_deg), robot.draft_model
    match shape:
        case Cuboid():
            return reference.cuboid(shape.length_m, shape.width_m, shape.height_m, draft)
        case Spiked():
            bar = (shape.length_m, shape.width_m, shape.height_m)
            return reference.spiked(*bar, shape.spike_base_m, shape.overall_height_m, draft, model)
        case SpikedEnds():
            bar = (shape.length_m, shape.width_m, shape.height_m)
            return reference.spiked_ends(*bar, shape.spike_base_m, shape.spike_height_m, draft, model)
        case Curved():
            radii = (shape.outer_radius_m, shape.inner_radius_m)
            return reference.curved(*radii, radians(shape.half_angle_deg), shape.width_m, draft)
        case Ellipsoid():
            return reference.ellipsoid(shape.semi_axes_m)
        case _:
            return reference.hull(shape.vertices_m)


def reference_field(field: Field) -> reference.RotatingField | reference.StaticField | reference.TableField:
    match field:
        case RotatingField():
            axes = (np.array(field.rotation_axis), np.array(field.initial_direction))
            second = (field.quadrature_ratio, radians(field.phase_error_deg))
            return reference.RotatingField(field.strength_T, field.frequency_Hz, *axes, *second)
        case StaticField():
            return reference.StaticField(field.strength_T * np.array(field.direction))
        case _:
            return reference.TableField(np.array(field.time_s), np.array(field.field_T))


def reference_trial(scenario: Scenario) -> reference.Trial:
    robot, substrate, model = scenario.robot, scenario.substrate, scenario.model
    relief, around = scenario.relief, scenario.surroundings
    return reference.Trial(
        body=reference_body(robot),
        mass=robot.total_mass_kg,
        moment=np.array(robot.magnetic_moment_A_m2),
        mu=substrate.friction_coefficient,
        friction_drift=substrate.friction_drift_per_s,
        ellipsoid=np.array(substrate.friction_ellipsoid),
        adhesion_coefficient=substrate.adhesion_N_per_m2,
        electrostatic_force=substrate.electrostatic_force_N,
        line_width=substrate.line_contact_width_m,
        field=reference_field(scenario.field),
        incline_rad=radians(scenario.run.incline_deg),
        step=scenario.run.step_s,
        duration=scenario.run.duration_s,
        torque_time=model.magnetic_torque,
        adhesion_acts_at=model.adhesion_acts_at,
        adhesion_enters=model.adhesion_enters,
        gravity=scenario.run.gravity_m_per_s2,
        side_incline_rad=radians(scenario.run.side_incline_deg),
        compliance=substrate.compliance_m_per_N,
        relief=reference.Relief(relief.wavelength_m, np.array(relief.cosine_m), np.array(relief.sine_m)),
        surroundings=reference.Surroundings(
            np.array(around.force_N),
            np.array(around.torque_N_m),
            around.translational_drag_N_s_per_m,
            around.rotational_drag_N_m_s,
            around.sheet_conductance_S,
            np.array(around.wrench_time_s),
            np.array(around.wrench_N_N_m).reshape(-1, 6),
        ),
    )
