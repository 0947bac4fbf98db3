"""The parts that a diagnosis rests on: poses, readings, the loss."""

from __future__ import annotations

from math import cos, pi, radians, sin

import numpy as np
import pytest

from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.loss import HUBER, robust_cost
from tumblers.diagnosis.gap.pose import Path, body_axis, heading_of, relative_turn, tilt_of
from tumblers.diagnosis.gap.reading import reached
from tumblers.diagnosis.gap.simulator import Simulator

from .lab import measure, plan


def turn(axis: tuple[float, float, float], degrees: float) -> np.ndarray:  # type: ignore[type-arg]
    """Return the unit quaternion of a rotation, shape (4,)."""
    way = np.array(axis) / np.linalg.norm(axis)
    return np.array([cos(0.5 * radians(degrees)), *(sin(0.5 * radians(degrees)) * way)])


def after(first: np.ndarray, then: np.ndarray) -> np.ndarray:  # type: ignore[type-arg]
    """Return the quaternion of two turns, `then` in the frame that `first` has turned, shape (4,)."""
    w, v = first[0], first[1:]
    return np.array([w * then[0] - v @ then[1:], *(w * then[1:] + then[0] * v + np.cross(v, then[1:]))])


@pytest.mark.parametrize("degrees", [0.0, 1e-9, 3.0, -40.0, 119.0, 179.0])
@pytest.mark.parametrize("axis", [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.3, -0.5, 0.8)])
def test_the_relative_turn_is_the_rotation_vector_in_the_body_frame(
    axis: tuple[float, float, float], degrees: float
) -> None:
    model = turn((0.2, 0.9, -0.4), 77.0)
    measured = after(model, turn(axis, degrees))
    expected = radians(degrees) * np.array(axis) / np.linalg.norm(axis)
    # A quaternion and its negative are the same orientation.
    for sign in (1.0, -1.0):
        found = relative_turn(model[None], sign * measured[None])
        np.testing.assert_allclose(found, expected[None], rtol=1e-9, atol=1e-15)


def test_a_nose_up_is_a_positive_tilt_and_a_turn_to_the_left_a_positive_heading() -> None:
    axis = body_axis(np.stack([turn((1.0, 0.0, 0.0), 30.0), turn((0.0, 0.0, 1.0), 20.0), turn((0.0, 1.0, 0.0), 50.0)]))
    np.testing.assert_allclose(np.degrees(tilt_of(axis)), [30.0, 0.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(np.degrees(heading_of(axis)), [0.0, 20.0, 0.0], atol=1e-12)


def test_a_path_is_linear_between_its_rows_and_holds_its_ends() -> None:
    orientation = np.stack([turn((1.0, 0.0, 0.0), angle) for angle in (0.0, 10.0, 20.0)])
    path = Path(
        interval_s=0.1,
        poses=np.hstack([[[0.0, 0.0, 1.0], [0.0, 2.0, 1.0], [1.0, 2.0, 1.0]], orientation]),
        contact_mode=np.array([3, 2, 0], dtype=np.int8),
    )
    position, turned = path.at(np.array([-1.0, 0.05, 0.15, 9.0]))
    np.testing.assert_allclose(position[:, :2], [[0.0, 0.0], [0.0, 1.0], [0.5, 2.0], [1.0, 2.0]], atol=2e-6)
    np.testing.assert_allclose(np.degrees(tilt_of(body_axis(turned))), [0.0, 5.0, 15.0, 20.0], atol=1e-4)
    assert path.mode_at(np.array([0.04, 0.06, 5.0])).tolist() == [3, 2, 0]


def test_an_outcome_that_was_foretold_costs_nothing_and_a_wrong_one_no_more_than_a_lapse() -> None:
    assert reached(1.0, True) == pytest.approx(0.0, abs=1e-3)
    assert reached(-1.0, False) == pytest.approx(0.0, abs=1e-3)
    lapse = np.sqrt(-2.0 * np.log(0.01 / 0.99))
    assert abs(reached(-5.0, True)) == pytest.approx(lapse, rel=1e-6)
    assert abs(reached(5.0, False)) == pytest.approx(lapse, rel=1e-6)
    shares = np.linspace(-0.5, 1.0, 200)
    assert np.all(np.diff([abs(reached(s, True)) for s in shares]) <= 0.0)
    assert np.all(np.diff([abs(reached(s, False)) for s in shares]) >= 0.0)
    # What the two borders pull towards.
    assert np.sign(reached(0.0, True)) == -np.sign(reached(0.3, False))


def test_the_loss_is_square_to_its_border_and_smooth_there() -> None:
    assert robust_cost(np.array([1.0, -2.0, HUBER])) == pytest.approx(5.0 + HUBER**2)
    assert robust_cost(np.array([-10.0])) == pytest.approx(2.0 * HUBER * 10.0 - HUBER**2)
    at = [robust_cost(np.array([HUBER + s])) for s in (-2e-3, -1e-3, 1e-3, 2e-3)]
    assert at[1] - at[0] == pytest.approx(at[3] - at[2], rel=1e-3)
    assert robust_cost(np.empty(0)) == 0.0


@pytest.mark.parametrize("quaternions", [False, True])
def test_the_derivatives_by_the_nuisances_are_those_of_the_differences(quaternions: bool) -> None:
    dataset = measure(plan(), quaternions=quaternions)
    comparison = Comparison(dataset, Simulator(dataset, 1))
    # A camera that is off by little counts as one that is not: its products are left out.
    local, camera = np.array([0.0, 2e-5, -1e-5, 3e-5]), np.zeros(2)
    steps = np.array([2e-4, 1e-8, 1e-8, 1e-8, 1e-5, 1e-6])
    for reader, path in zip(comparison.readers, comparison.nominal_paths, strict=True):
        assert path is not None
        columns, here = reader.linearised(path, local, camera), reader.differences(path, local, camera)
        for k, step in enumerate(steps):
            move = step * np.eye(6)[k]
            # A path is linear between its rows: a centred difference would not see its kinks as a forward one does.
            back = -1.0 if k else 0.0
            ahead = reader.differences(path, local + move[:4], camera + move[4:])
            behind = reader.differences(path, local + back * move[:4], camera + back * move[4:])
            for name, by in columns.items():
                wrong = ahead[name] - behind[name]
                # An angle beyond half a turn comes back from the other side.
                wrong = np.where(np.abs(wrong) > pi, 0.0, wrong) if name not in "xyz" else wrong
                found = wrong / ((1.0 - back) * step)
                tolerance = 1e-3 * np.max(np.abs(by[:, k])) + 1e-9
                wrong_by = np.abs(by[:, k] - found)
                if quaternions and name in ("tilt", "twist", "heading"):
                    # Rotation vectors add up to first order in what is left: where the body snaps over, some degrees.
                    wrong_by -= 0.05 + 0.6 * np.abs(here[name])
                assert np.all(wrong_by <= tolerance), f"{name} by {k}"
