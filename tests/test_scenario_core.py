"""Each message of the native module finds its key."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from tumblers import Scenario, _core, preset_scenario
from tumblers.core_errors import core_error

NAN = math.nan
BODY = _core.Body.cuboid(8e-4, 4e-4, 1e-4, 0.0)
FIELD = _core.Field.rotating(0.01, 1.0, (-1, 0, 0), (0, 1, 0))
CUBE = [[x, y, z] for x in (-1e-4, 1e-4) for y in (-1e-4, 1e-4) for z in (-1e-4, 1e-4)]
SOUND: dict[str, Any] = {
    "body": BODY,
    "mass_kg": 1e-8,
    "magnetic_moment_A_m2": (0, 1e-6, 0),
    "friction_coefficient": 0.3,
    "friction_ellipsoid": (1, 1, 0.1),
    "adhesion_N_per_m2": 1.0,
    "electrostatic_force_N": 0.0,
    "line_contact_width_m": 0.0,
    "field": FIELD,
    "incline_rad": 0.0,
    "gravity_m_per_s2": 9.8,
    "duration_s": 1.0,
    "step_s": 1e-3,
    "magnetic_torque": "end_of_step",
    "adhesion_acts_at": "ecp",
    "adhesion_enters": "normal",
}


def trial(**changed: object) -> Callable[[], object]:
    return lambda: _core.Trial(**(SOUND | changed))


BUILT: list[tuple[Callable[[], object], str, str]] = [
    (lambda: _core.Body.cuboid(NAN, 1, 1, 0), "robot.length_m", "found NaN, expected a finite number"),
    (lambda: _core.Body.cuboid(1, -1, 1, 0), "robot.width_m", "expected a positive number"),
    (lambda: _core.Body.cuboid(1, 1, 0, 0), "robot.height_m", "expected a positive number"),
    (lambda: _core.Body.cuboid(1, 1, 1, -0.5), "robot.draft_deg", "found -28.6479, expected at least 0"),
    (lambda: _core.Body.cuboid(1, 1, 1, 2.0), "robot.draft_deg", "found 114.592, expected less than 90"),
    (lambda: _core.Body.cuboid(1, 1, 1, NAN), "robot.draft_deg", "found nan, expected a finite number"),
    (lambda: _core.Body.cuboid(1, 1, 1, 1.0), "robot.draft_deg", "found 57.2958 degrees, at which the "),
    (lambda: _core.Body.spiked(1, 1, 0.1, 2, 1, 0, False), "robot.spike_base_m", "found 2e0, expected less than 1e0"),
    (lambda: _core.Body.spiked(1, 1, 2, 0.1, 1, 0, False), "robot.height_m", "found 2e0, expected less than 1e0"),
    (lambda: _core.Body.spiked_ends(1, 1, 0.1, 0.2, 0, 0, False), "robot.spike_height_m", "positive"),
    (lambda: _core.Body.curved(1, 2, 0.4, 1, 0), "robot.inner_radius_m", "less than 1e0"),
    (lambda: _core.Body.curved(2, 1, 3.0, 1, 0), "robot.half_angle_deg", "found 171.887, expected less than 90"),
    (lambda: _core.Body.hull([[0, 0, 0]] * 4), "robot.vertices_m", "found 1 distinct points, expected at least 4"),
    (lambda: _core.Body.hull([[x, y, 0] for x, y, _ in CUBE]), "robot.vertices_m", "which are flat, expected more"),
    (lambda: _core.Body.hull([[x + 1, y, z] for x, y, z in CUBE]), "robot.vertices_m", "outside the hull"),
    (lambda: _core.Body.hull([[NAN, 0, 0]]), "robot.vertices_m", "finite"),
    (lambda: _core.Body.ellipsoid((1, 0, 1)), "robot.semi_axes_m", "positive"),
    (lambda: _core.Field.rotating(-1, 1, (1, 0, 0), (0, 1, 0)), "field.strength_T", "0 or more"),
    (lambda: _core.Field.rotating(1, NAN, (1, 0, 0), (0, 1, 0)), "field.frequency_Hz", "finite"),
    (lambda: _core.Field.rotating(1, 1, (0, 0, 0), (0, 1, 0)), "field.rotation_axis", "found a length of 0"),
    (lambda: _core.Field.rotating(1, 1, (0, 1, 0), (0, 1, 0)), "field.initial_direction", "at right angles"),
    (lambda: _core.Field.uniform(1, (0, 0, 0)), "field.direction", "not zero"),
    (lambda: _core.Field.table([0], [[0, 0, 0]]), "field.time_s", "found 1 rows, expected at least 2"),
    (lambda: _core.Field.table([0, 0], [[0, 0, 0]] * 2), "field.time_s", "expected a time after 0 s"),
    (lambda: _core.Field.table([0, 1], [[NAN, 0, 0]] * 2), "field.field_T", "finite"),
    (trial(field=_core.Field.table([0, 0.5], [[0, 0, 0]] * 2)), "field.time_s", "expected rows that cover 0 s to 1 s"),
    (lambda: BODY.with_center_of_mass((0, 0, 1)), "robot.center_of_mass_m", "outside the hull or on its boundary"),
    (lambda: BODY.with_center_of_mass((NAN, 0, 0)), "robot.center_of_mass_m", "finite"),
    (lambda: _core.Field.rotating(1, 1, (1, 0, 0), (0, 1, 0), -1), "field.quadrature_ratio", "0 or more"),
    (lambda: _core.Field.rotating(1, 1, (1, 0, 0), (0, 1, 0), 1, NAN), "field.phase_error_deg", "finite"),
    (trial(friction_drift_per_s=NAN), "substrate.friction_drift_per_s", "finite"),
    (trial(compliance_m_per_N=-1.0), "substrate.compliance_m_per_N", "0 or more"),
    (trial(side_incline_rad=NAN), "run.side_incline_deg", "finite"),
    (trial(relief_wavelength_m=0.0), "relief.wavelength_m", "greater than 0"),
    (trial(relief_cosine_m=[NAN], relief_sine_m=[0.0]), "relief.cosine_m", "finite"),
    (trial(relief_cosine_m=[0.0]), "relief.sine_m", "found 0 entries, expected 1"),
    (trial(force_N=(NAN, 0, 0)), "surroundings.force_N", "finite"),
    (trial(torque_N_m=(NAN, 0, 0)), "surroundings.torque_N_m", "finite"),
    (trial(translational_drag_N_s_per_m=-1.0), "surroundings.translational_drag_N_s_per_m", "0 or more"),
    (trial(rotational_drag_N_m_s=-1.0), "surroundings.rotational_drag_N_m_s", "0 or more"),
    (trial(sheet_conductance_S=-1.0), "surroundings.sheet_conductance_S", "0 or more"),
    (trial(wrench_time_s=[0.0]), "surroundings.wrench_N_N_m", "found 0 entries, expected 1"),
    (trial(wrench_time_s=[0, 0], wrench_N_N_m=[[0] * 6] * 2), "surroundings.wrench_time_s", "a time after 0 s"),
    (trial(wrench_time_s=[0], wrench_N_N_m=[[NAN] * 6]), "surroundings.wrench_N_N_m", "finite"),
    (trial(mass_kg=0.0), "robot.mass_kg", "found 0, expected a number greater than 0"),
    (trial(magnetic_moment_A_m2=(NAN, 0, 0)), "robot.magnetization_A_per_m", "finite"),
    (trial(friction_coefficient=-1.0), "substrate.friction_coefficient", "found -1, expected 0 or more"),
    (trial(friction_ellipsoid=(0, 1, 1)), "substrate.friction_ellipsoid", "greater than 0"),
    (trial(adhesion_N_per_m2=-1.0), "substrate.adhesion_N_per_m2", "0 or more"),
    (trial(electrostatic_force_N=-1.0), "substrate.electrostatic_force_N", "0 or more"),
    (trial(line_contact_width_m=-1.0), "substrate.line_contact_width_m", "0 or more"),
    (trial(incline_rad=NAN), "run.incline_deg", "finite"),
    (trial(gravity_m_per_s2=-1.0), "run.gravity_m_per_s2", "0 or more"),
    (trial(duration_s=-1.0), "run.duration_s", "greater than 0"),
    (trial(duration_s=1e9), "run.duration_s", "found 1e9 s in 1e12 steps, expected at most 1e9"),
    (trial(step_s=0.0), "run.step_s", "greater than 0"),
    (trial(step_s=0.5, magnetic_torque="start_of_step"), "run.step_s", "start_of_step is unstable beyond it"),
    (trial(magnetic_torque="late"), "model.magnetic_torque", "found 'late', expected end_of_step or"),
    (trial(adhesion_acts_at="top"), "model.adhesion_acts_at", "found 'top'"),
    (trial(adhesion_enters="never"), "model.adhesion_enters", "found 'never'"),
    (trial(linear_velocity_m_per_s=(NAN, 0, 0)), "initial.linear_velocity_m_per_s", "finite"),
    (trial(orientation=(NAN, 0, 0, 0)), "initial.orientation", "finite"),
    (trial(orientation=(0, 0, 0, 0)), "initial.orientation", "expected"),
    (trial(position_m=(NAN, 0, 0)), "initial.position_m", "finite"),
    (trial(position_m=(0, 0, -1)), "initial.position_m", "into the substrate, expected one on or above"),
]


@pytest.mark.parametrize(("build", "key", "words"), BUILT)
def test_a_message_of_the_native_module_finds_its_key(build: Callable[[], object], key: str, words: str) -> None:
    with pytest.raises(ValueError, match=" ") as caught:
        build()
    error = core_error(caught.value)
    assert error.key == key, caught.value
    assert words in str(error)
    assert " rad" not in str(error)
    assert str(error).count("expected") == 1


def test_what_is_sound_is_built() -> None:
    trial()()


@pytest.mark.parametrize("draft_deg", [80.0, 45.0])
def test_a_draft_that_is_too_large_is_told_in_degrees(draft_deg: float) -> None:
    scenario: Scenario = preset_scenario("spiked")
    with pytest.raises(ValueError, match=rf"^robot.draft_deg: found {draft_deg:g} degrees, at which"):
        scenario.robot.with_draft(draft_deg).body()
