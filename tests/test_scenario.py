from __future__ import annotations

import math
from dataclasses import replace

import pytest

import tumblers
from tumblers import (
    Cuboid,
    Initial,
    InputError,
    Model,
    Robot,
    RotatingField,
    Scenario,
)


def test_defaults(text: str) -> None:
    scenario = Scenario.from_toml(text)
    assert scenario.model == Model(magnetic_torque="end_of_step", adhesion_acts_at="ecp", adhesion_enters="normal")
    assert scenario.initial == Initial()
    assert scenario.robot.draft_deg == 0.0
    assert scenario.robot.magnetization_A_per_m == 15000.0
    assert isinstance(scenario.robot.magnetization_A_per_m, float)
    assert scenario.substrate.line_contact_width_m == 0.0
    assert scenario.field == RotatingField(strength_T=0.01, frequency_Hz=5.0)
    assert scenario.run.output_every == 1
    assert scenario.run.gravity_m_per_s2 == 9.8


def test_magnetic_axis_follows_the_paper() -> None:
    robot = tumblers.ROBOTS["spiked_pdms"].value
    assert robot.magnetic_axis == (0.0, 1.0, 0.0)
    theta1, theta2 = math.radians(10.0), math.radians(40.0)
    expected = (math.sin(theta2) * math.sin(theta1), math.cos(theta1), math.cos(theta2) * math.sin(theta1))
    assert robot.with_magnetization(10.0, 40.0).magnetic_axis == pytest.approx(expected, rel=1e-15)


@pytest.mark.parametrize("theta2", [10.0 * n for n in range(19)])
def test_magnetic_axes_are_mirror_images_to_the_bit(theta2: float) -> None:
    robot = tumblers.ROBOTS["spiked_pdms"].value
    x, y, z = robot.with_magnetization(10.0, theta2).magnetic_axis
    assert robot.with_magnetization(10.0, 360.0 - theta2).magnetic_axis == (-x, y, z)
    if theta2 % 180.0 == 0.0:
        assert x == 0.0


def test_density_gives_the_mass_and_the_volume_the_moment() -> None:
    shape = Cuboid(length_m=8e-4, width_m=4e-4, height_m=1e-4)
    robot = Robot(shape=shape, density_kg_per_m3=1000.0, magnetization_A_per_m=1000.0)
    assert robot.total_mass_kg == pytest.approx(3.2e-8, rel=1e-12)
    assert robot.magnetic_moment_A_m2 == pytest.approx((0.0, 3.2e-8, 0.0), rel=1e-12)
    assert replace(robot, mass_kg=1e-8).total_mass_kg == 1e-8


def test_errors_form_one_tree() -> None:
    assert issubclass(InputError, tumblers.TumblersError)
    assert issubclass(tumblers.SimulationError, tumblers.TumblersError)
    with pytest.raises(tumblers.TumblersError, match=r"robot: found 1, expected a Robot"):
        Scenario(robot=1, substrate=None, field=None, run=None)  # type: ignore[arg-type]
