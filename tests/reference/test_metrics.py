"""Speed, drift and twist of made-up runs."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tumblers.reference import Run, State, cycle_twist, drift, flipped, pose_at, speed, tilt, twist
from tumblers.reference.rotation import axis_angle, product


def made_up(angle: float) -> Run:
    """Drift 3 µm, travel 8 µm and a twist of `angle` in one second, in steps of 0.4 s."""
    times = np.array([0.0, 0.4, 0.8, 1.2])
    axis = np.array([0.0, 1.0, 0.0])
    states = [State(np.array([3e-6 * t, 8e-6 * t, 0.0]), axis_angle(axis, angle * t)) for t in times]
    return Run(times, tuple(states), ())


def test_metrics_of_a_steady_run() -> None:
    """The pose after a cycle lies between two steps."""
    result = made_up(math.radians(50.0))
    assert speed(result) == pytest.approx(8e-6)
    assert drift(result, 1.0) == pytest.approx(3e-6)
    assert cycle_twist(result, 1.0) == pytest.approx(math.radians(50.0))
    assert flipped(result, 1.0)
    assert not flipped(made_up(math.radians(44.0)), 1.0)
    np.testing.assert_allclose(pose_at(result, 0.4)[0], result.positions[1])


@pytest.mark.parametrize("degrees", [-179.0, -45.0, 0.0, 90.0, 180.0])
def test_twist_is_about_the_long_axis(degrees: float) -> None:
    """The swing does not count, nor the quaternion's sign; 180° is included, -180° is not."""
    about = axis_angle(np.array([0.0, 1.0, 0.0]), math.radians(degrees))
    swung = product(axis_angle(np.array([1.0, 0.0, 1.0]), 0.4), about)
    for quaternion in (about, -about, swung):
        assert math.degrees(twist(quaternion)) == pytest.approx(degrees)


def test_tilt() -> None:
    """The +y end above the substrate."""
    assert tilt(axis_angle(np.array([1.0, 0.0, 0.0]), 0.3)) == pytest.approx(0.3)
