"""What of a trial's track is compared."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tumblers.dataset import Dataset, LabTrial, Track
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.job import Job
from tumblers.diagnosis.gap.observed import observe
from tumblers.diagnosis.gap.reading import reached
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.effects.adhesion_coefficient import AdhesionCoefficient
from tumblers.field import StaticField

from .lab import OFF, PLANS, folded, measure, plan

TIME_S = np.arange(30) / 60.0


def seen(field: StaticField, way_m: float, acceleration_m_per_s2: float = 1.0) -> Dataset:
    """A robot that slides down a slope of 50 degrees until it catches again."""
    empty = plan([("hold", field, 50.0)], duration_s=0.5)
    track = Track(
        time_s=TIME_S,
        channels={"x_m": np.zeros(30), "y_m": -np.minimum(0.5 * acceleration_m_per_s2 * TIME_S**2, way_m)},
    )
    trial = LabTrial(id="hold", field=field, duration_s=0.5, incline_deg=50.0, track=track)
    return replace(empty, trials=(trial,))


def test_of_a_robot_that_slides_without_a_field_half_of_its_way_is_compared_and_that_it_slides() -> None:
    (observed,) = observe(seen(OFF, 6e-4))
    assert observed.slid_m == pytest.approx(6e-4)
    assert_allclose(observed.time_s, TIME_S[0.5 * TIME_S**2 <= 3e-4])
    assert observed.frames == 30
    assert observed.lost == 0


@pytest.mark.parametrize("frame", [0, 12, 29])
def test_a_frame_in_which_something_else_was_taken_for_the_robot_is_no_slide(frame: int) -> None:
    held = seen(OFF, 0.0)
    (trial,) = held.trials
    assert trial.track is not None
    y_m = np.array(trial.track.channels["y_m"])
    y_m[frame] += 3e-4
    track = replace(trial.track, channels={**trial.track.channels, "y_m": y_m})
    (observed,) = observe(replace(held, trials=(replace(trial, track=track),)))
    assert observed.slid_m == 0.0
    assert len(observed.time_s) == 30


@pytest.mark.parametrize(("strength_T", "way_m"), [(0.003, 6e-4), (0.0, 1e-4)])
def test_a_robot_that_holds_or_that_a_field_moves_is_compared_to_the_end(strength_T: float, way_m: float) -> None:
    (observed,) = observe(seen(replace(OFF, strength_T=strength_T), way_m))
    assert observed.slid_m == 0.0
    assert len(observed.time_s) == 30


def test_a_model_that_slides_is_nearer_to_a_robot_that_does_than_one_that_holds() -> None:
    dataset = seen(OFF, 6e-4)
    comparison = Comparison(dataset, Simulator(dataset, 1))
    (reader,) = comparison.readers
    assert reader.outcome_kinds == ("slides",)
    held, slid = comparison.simulator.run([Job(0), Job(0, (AdhesionCoefficient(factor=0.0),))])
    assert held is not None
    assert slid is not None
    still = np.zeros(2)
    # One in a hundred writes down the wrong outcome.
    assert reader.outcome_terms(held, still)["slides"] ** 2 == pytest.approx(-2.0 * np.log(0.01 / 0.99), rel=0.05)
    assert reader.outcome_terms(slid, still)["slides"] == pytest.approx(0.0, abs=1e-6)


def test_of_a_model_that_slides_counts_what_a_late_camera_sees_of_it() -> None:
    dataset = seen(OFF, 6e-4)
    comparison = Comparison(dataset, Simulator(dataset, 1))
    (reader,) = comparison.readers
    (slid,) = comparison.simulator.run([Job(0, (AdhesionCoefficient(factor=0.0),))])
    assert slid is not None
    # A third of the way of the robot: seen whole, by half, and not at all.
    way_m = np.linspace(0.0, 2e-4, 11)
    position_m = np.zeros_like(slid.position_m)
    position_m[:, 1] = -np.interp(slid.interval_s * np.arange(len(position_m)), np.linspace(0.0, 0.2, 11), way_m)
    shares = []
    for late_s in (0.0, 0.1, 0.2):
        path = replace(slid, poses=np.hstack([position_m, slid.orientation]), clock_s=late_s)
        shares.append(reader.outcome_terms(path, np.zeros(2))["slides"])
    fitting = [reached(share, True, border=0.3) for share in (1.0 / 3.0, 1.0 / 6.0, 0.0)]
    assert_allclose(shares, fitting, rtol=1e-6)


def tracked(time_s: np.ndarray, channels: dict[str, np.ndarray]) -> Dataset:
    empty = plan([("still", OFF, 0.0)], duration_s=float(time_s[-1]) + 0.1)
    track = Track(time_s=time_s, channels=channels)
    return replace(empty, trials=(replace(empty.trials[0], track=track, outcome=None),))


def test_angles_count_where_every_quaternion_was_lost() -> None:
    lost, tilt = np.full(30, np.nan), np.linspace(0.0, 5.0, 30)
    quaternions = dict.fromkeys(("qw", "qx", "qy", "qz"), lost)
    (observed,) = observe(tracked(TIME_S, {**quaternions, "tilt_deg": tilt}))
    assert observed.channels == ("tilt",)
    assert_allclose(observed.values["tilt"], np.radians(tilt))
    assert observed.lost == 0


@pytest.mark.parametrize(
    ("headings_deg", "turn"),
    [
        ((-90.0, 3.0, 90.0), np.pi),
        ((0.0, 3.0, 180.0), np.pi),
        ((-1.0, 3.0, np.nan), np.pi),
        ((-173.0, 3.0, -90.0), np.pi),
        ((np.nan, np.nan, np.nan), 2.0 * np.pi),
        # An end that jumps by half a turn as the body tumbles.
        ((3.0, -178.0, 1.0, -176.0), 2.0 * np.pi),
        ((-1.0, 181.0, 3.0, 178.0), 2.0 * np.pi),
    ],
)
def test_headings_within_half_a_turn_are_of_an_axis(headings_deg: tuple[float, ...], turn: float) -> None:
    (observed,) = observe(tracked(TIME_S[: len(headings_deg)], {"heading_deg": np.array(headings_deg)}))
    assert observed.heading_turn == turn


def test_a_sensor_that_says_what_headings_are_of_is_believed() -> None:
    for headings, said, turn in ((-1.0, "end", 2.0 * np.pi), (-177.0, "axis", np.pi)):
        dataset = tracked(TIME_S[:2], {"heading_deg": np.array([3.0, headings])})
        (observed,) = observe(replace(dataset, sensor=replace(dataset.sensor, heading_of=said)))
        assert observed.heading_turn == turn


def test_what_a_quaternion_says_has_its_ends() -> None:
    dataset = measure(plan(PLANS[:1], duration_s=0.3), quaternions=True)
    (observed,) = observe(replace(dataset, sensor=replace(dataset.sensor, heading_of="axis")))
    assert observed.heading_turn == 2.0 * np.pi


def test_an_axis_is_told_by_the_headings_of_all_trials() -> None:
    dataset = folded(measure(plan(PLANS[:2], duration_s=0.3)), 0.0)
    assert [observed.heading_turn for observed in observe(dataset)] == [np.pi] * 2
    directed = measure(plan(PLANS[:2], duration_s=0.3))
    mixed = replace(dataset, trials=(dataset.trials[0], directed.trials[1]))
    assert [observed.heading_turn for observed in observe(mixed)] == [2.0 * np.pi] * 2


def test_quaternions_take_the_place_of_angles() -> None:
    whole = {"qw": np.ones(30), **dict.fromkeys(("qx", "qy", "qz"), np.zeros(30))}
    (observed,) = observe(tracked(TIME_S, {**whole, "tilt_deg": np.full(30, 5.0)}))
    assert observed.channels == ("tilt", "heading", "twist")
    assert observed.values == {}


def test_neighbours_are_as_far_apart_as_what_is_compared() -> None:
    # 20 s at 100 frames a second: 160 of 2001 frames are compared.
    time = np.arange(2001) / 100.0
    dataset = tracked(time, {"x_m": np.zeros(2001)})
    (observed,) = observe(dataset)
    assert len(observed.time_s) == 160
    assert observed.frame_interval_s == pytest.approx(0.01)
    # There is one interval less than there are frames: a part in 160.
    assert observed.compared_interval_s == pytest.approx(float(np.mean(np.diff(observed.time_s))), rel=0.01)
    # What is 0.125 s apart counts as 0.16 s do, not eight for one.
    assert Comparison(dataset, Simulator(dataset, 1)).alike == pytest.approx(0.16 / 0.125, rel=0.02)


def test_neighbours_are_far_apart_where_most_frames_are_lost() -> None:
    time, x = np.arange(200) / 100.0, np.full(200, np.nan)
    x[::10] = 0.0
    (observed,) = observe(tracked(time, {"x_m": x}))
    assert observed.compared_interval_s == pytest.approx(0.1)
    x[:] = 0.0
    x[5] = np.nan
    (observed,) = observe(tracked(time[:150], {"x_m": x[:150]}))
    assert observed.compared_interval_s == observed.frame_interval_s
