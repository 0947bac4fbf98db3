"""What an interval rests on: derivatives of the parameters by a fit's coordinates, and how far a range goes."""

from __future__ import annotations

from math import atan2, cos, degrees, hypot, inf, sin

import numpy as np
import pytest
from numpy.testing import assert_allclose
from numpy.typing import NDArray

from tumblers.diagnosis.estimate import _gradients, _way_inside
from tumblers.diagnosis.hypothesis import Hypothesis
from tumblers.diagnosis.simulator import Simulator
from tumblers.effects.magnetization_misalignment import MagnetizationMisalignment
from tumblers.effects.size_error import SizeError

from .lab import plan

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
        # The nearer of the two sides ends it, either way.
        ((0.2, 0.1), (0.3, 0.1), 2.0),
        ((0.2, 0.1), (-0.3, -0.1), 4.0),
        ((0.2, 0.1), (0.1, -0.3), 2.0),
        # Along an axis the other coordinate never ends it, not even from its very edge.
        ((0.2, 0.1), (0.0, -0.2), 3.0),
        ((0.8, 0.0), (0.0, 0.5), 2.0),
        ((0.8, 1.0), (-0.9, 0.0), 2.0),
        ((0.8, 0.0), (0.1, 0.1), 0.0),
        # A fit keeps a hair's breadth away from its bounds, on either side of them.
        ((0.8 + 1e-9, 0.0), (0.1, 0.1), 0.0),
        ((0.2, 0.1), (0.0, 0.0), inf),
    ],
)
def test_the_way_inside_a_range_ends_at_its_nearest_side(
    point: tuple[float, float], direction: tuple[float, float], way: float
) -> None:
    assert _way_inside(box(), np.array(point), np.array(direction)) == pytest.approx(way)
