"""What an interval rests on: derivatives of the parameters by a fit's coordinates, and how far a range goes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from math import atan2, cos, degrees, hypot, sin

import numpy as np
import pytest
from numpy.testing import assert_allclose
from numpy.typing import NDArray

from tumblers.dataset import Tolerance
from tumblers.diagnosis import diagnose
from tumblers.diagnosis.fitting.hypothesis import Hypothesis
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.what.estimate import SIDE, _ends, _gradients, _whole_way
from tumblers.diagnosis.what.tolerated import least_deviation
from tumblers.effects.magnetization_misalignment import MagnetizationMisalignment
from tumblers.effects.magnetization_strength import MagnetizationStrength
from tumblers.effects.size_error import SizeError
from tumblers.effects.stray_field_gradient import StrayFieldGradient

from .lab import measure, plan

# Of a step of 1e-6: half of it times the second derivative, at most 57°/0.25² here.
OF_A_STEP = 1e-3


def hypothesis_of(*kinds: type[SizeError | MagnetizationMisalignment]) -> Hypothesis:
    scenario = Simulator(plan()).nominal(0)
    first, *others = (Hypothesis.of(kind, [scenario]) for kind in kinds)
    return sum(others, start=first)


def by_polar_angles(up: float, side: float, most: float) -> NDArray[np.float64]:
    """Return the derivatives of θ1 and θ2, degrees, by `u = θ1 (cos θ2, sin θ2)/most`, shape (2, 2)."""
    size, angle = hypot(up, side), atan2(side, up)
    turn = degrees(1.0) / size
    return np.array([[most * cos(angle), most * sin(angle)], [-turn * sin(angle), turn * cos(angle)]])


def test_where_the_coordinates_are_the_parameters_the_derivatives_are_the_scales() -> None:
    hypothesis = hypothesis_of(SizeError)
    count = len(hypothesis.scale)
    # At an upper end a step outwards would be clipped to nothing; at a lower one a step inwards is an ordinary one.
    for point in (np.full(count, 0.1), hypothesis.low, hypothesis.high):
        assert_allclose(_gradients(hypothesis, point), np.diag(hypothesis.scale), rtol=1e-8, atol=1e-12)


def test_what_is_flat_beside_a_point_has_the_slope_to_the_end_of_its_range() -> None:
    hypothesis = Hypothesis.of(StrayFieldGradient, [Simulator(plan()).nominal(0)])
    expected = np.diag([*hypothesis.scale[:3], 3.0])
    assert_allclose(_gradients(hypothesis, np.zeros(4)), expected, rtol=1e-8, atol=1e-12)


# Beside the half turn, a step of 1e-6 ends on its other side: there θ2 goes from -180° to 180°.
@pytest.mark.parametrize("side", [0.3, -0.3, 1e-3, 5e-7, 0.0, -5e-7, -1e-3])
@pytest.mark.parametrize("up", [0.25, -0.25])
def test_a_misalignment_has_the_derivatives_of_polar_angles_all_round(up: float, side: float) -> None:
    hypothesis = hypothesis_of(MagnetizationMisalignment)
    found = _gradients(hypothesis, np.array([up, side]))
    assert_allclose(found, by_polar_angles(up, side, hypothesis.scale[0]), atol=OF_A_STEP)


def test_effects_that_are_joined_keep_their_own_derivatives() -> None:
    alone = hypothesis_of(SizeError)
    joined = hypothesis_of(SizeError, MagnetizationMisalignment)
    count = len(alone.scale)
    found = _gradients(joined, np.array([*np.full(count, 0.1), -0.25, -5e-7]))
    # Every parameter by every coordinate: rows are parameters.
    expected = np.zeros((count + 2, count + 2))
    expected[:count, :count] = np.diag(alone.scale)
    expected[count:, count:] = by_polar_angles(-0.25, -5e-7, joined.scale[count])
    assert_allclose(found, expected, atol=OF_A_STEP)


def box() -> Hypothesis:
    """Return a range that is wider to one side than to the other, in both coordinates."""
    low, high = np.array([-1.0, -0.5]), np.array([0.8, 1.0])
    neutral, ranges = np.zeros(2), np.column_stack([low, high])
    none = np.empty((0, 2))
    return Hypothesis((), neutral, np.ones(2), low, high, none, none, ranges)


@pytest.mark.parametrize(
    ("point", "direction", "way"),
    [
        # The farther of the two sides ends it, either way: what is at its end stays there.
        ((0.2, 0.1), (0.3, 0.1), 9.0),
        ((0.2, 0.1), (-0.3, -0.1), 6.0),
        ((0.2, 0.1), (0.1, -0.3), 6.0),
        # What does not move never ends it.
        ((0.2, 0.1), (0.0, -0.2), 3.0),
        ((0.8, 0.0), (0.0, 0.5), 2.0),
        ((0.8, 1.0), (-0.9, 0.0), 2.0),
        ((0.8, 0.0), (0.1, 0.1), 10.0),
        # A fit keeps a hair's breadth away from its bounds, on either side of them.
        ((0.8 + 1e-9, 1.0), (0.1, 0.0), 0.0),
        ((0.2, 0.1), (0.0, 0.0), 0.0),
    ],
)
def test_a_whole_way_ends_at_the_farthest_side_of_a_range(
    point: tuple[float, float], direction: tuple[float, float], way: float
) -> None:
    assert _whole_way(box(), np.array(point), np.array(direction)) == pytest.approx(way, abs=1e-7)


# The stretch that holds an end is 0.25 ways long near the start and 1.0 farther out, and is halved five times.
NEAR, FAR = 0.25 * SIDE / 32.0, 1.0 * SIDE / 32.0


@pytest.mark.parametrize(
    ("rise", "end", "off"),
    [
        # A Gaussian ends where it should, also one that is narrower or wider than Laplace's.
        (lambda way: way**2, SIDE, NEAR),
        (lambda way: (way / 0.1) ** 2, 0.1 * SIDE, NEAR),
        (lambda way: (way / 2.5) ** 2, 2.5 * SIDE, FAR),
        # A threshold ends it there, however high it is.
        (lambda way: 1e6 * (way > 1.0), 1.0, NEAR),
        # A narrow ridge within the well does not.
        (lambda way: way**2 + 100.0 * (0.3 < way < 0.6), SIDE, NEAR),
        # Where nothing rises, the range ends it.
        (lambda way: 0.0 * way, 20.0, 0.0),
        # What is better than the fit counts: from there on it rises.
        (lambda way: (way - 1.5) ** 2 - 1.5**2, 1.5 + SIDE, NEAR * 4.0),
    ],
)
def test_an_interval_ends_where_the_objective_stays_up(rise: Callable[[float], float], end: float, off: float) -> None:
    side = (0, 1.0)
    found = _ends(lambda ways: [rise(way) for _, way in ways], {side: 20.0})
    assert found[side] == pytest.approx(end, abs=off + 1e-12)


def test_a_factor_is_known_no_better_than_the_nominal_number_that_it_multiplies() -> None:
    known_to = Tolerance(friction_coefficient=0.2)
    lab = replace(plan(), tolerance=known_to)
    together = hypot(known_to.magnetization, known_to.field_strength, known_to.mass)
    least = partial(least_deviation, lab=lab)
    assert least("magnetization_strength", "factor", 0.8) == pytest.approx(0.8 * together)
    assert least("friction_coefficient", "factor", 0.5) == pytest.approx(0.5 * 0.2)
    expected = known_to.electrostatic_force * lab.substrate.electrostatic_force_N
    assert least("electrostatic_force", "added_force_N", 1e-7) == pytest.approx(expected)
    assert least("substrate_tilt", "slope_x_deg", 2.0) == 0.0
    # What five trials leave open is less than what the lab does not know of its magnet and its coils.
    found = diagnose(measure(plan(), (MagnetizationStrength(factor=0.8),)), effects=["magnetization_strength"])
    (effect,) = found.effects
    factor = effect.parameters["factor"]
    assert factor.low <= factor.estimate - 1.6 * 0.8 * together
    assert factor.high >= factor.estimate + 1.6 * 0.8 * together
