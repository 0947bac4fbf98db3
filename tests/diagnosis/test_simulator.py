from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tumblers import _core
from tumblers.camera import Camera
from tumblers.dataset import Dataset, Sensor, Track
from tumblers.diagnosis.gap import simulator as simulators
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.guide import Nudge
from tumblers.diagnosis.gap.job import Job
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.effects.base import Effect
from tumblers.effects.camera_calibration import CameraCalibration
from tumblers.effects.center_of_mass_offset import CenterOfMassOffset
from tumblers.effects.friction_coefficient import FrictionCoefficient
from tumblers.effects.magnetization_strength import MagnetizationStrength
from tumblers.effects.substrate_tilt import SubstrateTilt
from tumblers.field import TableField
from tumblers.model import Model
from tumblers.presets import drive

from .lab import ANGLE_NOISE_DEG, PLANS, POSITION_NOISE_M, measure, plan, rollouts_made, thinned, without

FAST = Nudge(50.0, Camera())


def jobs(first: int, count: int) -> list[Job]:
    return [Job(0, (FrictionCoefficient(factor=1.0 + 0.01 * k),)) for k in range(first, first + count)]


def test_what_was_run_is_not_run_again_while_it_fits(monkeypatch: pytest.MonkeyPatch) -> None:
    simulator, made = Simulator(plan(), 1), rollouts_made(monkeypatch)
    first = simulator.run(jobs(0, 4))
    again = simulator.run(jobs(2, 4))
    assert made == [4, 2]
    assert [path is not None for path in first] == [True] * 4
    for before, after in zip(first[2:], again[:2], strict=True):
        assert before is not None
        assert after is not None
        np.testing.assert_array_equal(before.position_m, after.position_m)


def test_the_oldest_makes_room_and_comes_back_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    simulator, made = Simulator(plan(), 1), rollouts_made(monkeypatch)
    first = simulator.run(jobs(0, 1))[0]
    room = simulator._kept
    assert room == sum(simulators._size(path) for path in simulator._known.values())
    monkeypatch.setattr(simulators, "_MOST_KEPT", int(3.5 * room))
    simulator.run(jobs(1, 6))
    assert simulator._kept <= 3.5 * room
    assert len(simulator._known) == 3
    back = simulator.run([*jobs(6, 1), *jobs(0, 1)])[1]
    # The latest is still there, the oldest is not.
    assert made == [1, 6, 1]
    assert first is not None
    assert back is not None
    np.testing.assert_array_equal(first.position_m, back.position_m)
    np.testing.assert_array_equal(first.orientation, back.orientation)


def test_what_was_asked_for_again_is_not_the_oldest(monkeypatch: pytest.MonkeyPatch) -> None:
    simulator, made = Simulator(plan(), 1), rollouts_made(monkeypatch)
    simulator.run(jobs(0, 1))
    monkeypatch.setattr(simulators, "_MOST_KEPT", int(3.5 * simulator._kept))
    for asked in ((1, 2), (0, 1), (3, 2), (0, 1), (1, 1)):
        simulator.run(jobs(*asked))
    # The first is there to the end, which a second asked for once is not.
    assert made == [1, 2, 0, 2, 0, 1]


@pytest.mark.parametrize(("factor", "resolved"), [(1.0, True), (100.0, False)])
def test_a_diagnosis_ends_a_rollout_that_spins_and_nothing_else_does(factor: float, resolved: bool) -> None:
    simulator = Simulator(plan(), 1)
    job = Job(0, (MagnetizationStrength(factor=factor),))
    trial = simulator.scenario(job).trial()
    (path,), (whole,) = simulator.run([job]), _core.rollouts([trial], [1], 1)
    (ended,) = _core.rollouts([trial], [1], 1, while_resolved=True)
    rows = len(ended["time_s"])
    assert len(whole["time_s"]) == trial.steps + 1
    assert (rows == trial.steps + 1) == resolved
    assert (path is not None) == resolved
    np.testing.assert_array_equal(ended["orientation"], whole["orientation"][:rows])


def test_a_run_is_longer_by_as_much_as_the_camera_is_late_in_even_pieces() -> None:
    simulator = Simulator(plan(), 1)
    seen, late = simulator.run([Job(0), Job(0, (CameraCalibration(time_offset_s=0.13),))])
    assert seen is not None
    assert late is not None
    assert late.clock_s == 0.13
    rows = len(seen.position_m)
    assert (len(late.position_m) - rows) * late.interval_s == pytest.approx(0.2, abs=1.01 * late.interval_s)
    # The same motion, seen from later on; a camera that is early needs no more of it.
    np.testing.assert_array_equal(late.position_m[:rows], seen.position_m)
    assert simulator.scenario(Job(0, (CameraCalibration(time_offset_s=-0.13),))).run == simulator.nominal(0).run


def test_a_late_camera_sees_a_table_s_field_to_its_end_and_no_longer() -> None:
    table = TableField(time_s=(0.0, 0.3, 0.65), field_T=((0.0, 0.0, 0.01), (0.0, 0.01, 0.0), (0.0, 0.0, 0.01)))
    simulator = Simulator(plan([("table", table, 0.0)]), 1)
    # By the last row's interval, for there is no track whose clock may be late.
    assert simulator.nominal(0).run.duration_s == pytest.approx(0.602)
    late = Job(0, (CameraCalibration(time_offset_s=0.13),))
    assert simulator.scenario(late).run.duration_s == 0.65
    assert simulator.run([late])[0] is not None


def test_a_path_under_a_table_ends_where_the_table_does() -> None:
    table = TableField(time_s=(0.0, 0.3, 0.6), field_T=((0.0, 0.0, 0.01), (0.0, 0.01, 0.0), (0.0, 0.0, 0.01)))
    simulator = Simulator(plan([("table", table, 0.0)]), 1)
    (path,) = simulator.run([Job(0)])
    assert path is not None
    assert (len(path.position_m) - 1) * path.interval_s == pytest.approx(0.6)


@pytest.mark.parametrize("strength_T", [0.020, 0.025, 0.4])
def test_a_scheme_that_is_unstable_in_long_steps_is_run_in_shorter_ones(strength_T: float) -> None:
    fields = [("fast", drive(strength_T, 2.0), 0.0)]
    dataset = replace(plan(fields, duration_s=0.05), model=Model(magnetic_torque="start_of_step"))
    simulator = Simulator(dataset, 1)
    stronger = (MagnetizationStrength(factor=2.0),)
    for job in (Job(0), Job(0, edit=simulator.coarse), Job(0, edit=simulator.twice), Job(0, stronger)):
        # What the core refuses as unstable has no path.
        assert simulator.run([job])[0] is not None
    simulator.lengthen_steps()
    assert simulator.run([Job(0)])[0] is not None


def test_a_run_that_is_drawn_to_its_track_stays_near_it_and_is_kept_for_itself() -> None:
    dataset = measure(plan(PLANS[:2], duration_s=1.0), (SubstrateTilt(slope_y_deg=10.0),))
    simulator = Simulator(dataset, 1)
    free, drawn, other = simulator.run([Job(0), Job(0, nudge=FAST), Job(1, nudge=FAST)])
    off = []
    for i, path in ((0, free), (0, drawn), (1, other)):
        track = dataset.trials[i].track
        assert path is not None
        assert track is not None
        off.append(float(np.nanmax(np.abs(path.at(track.time_s)[0][:, 1] - track.channels["y_m"]))))
    # Without the tilt it would be elsewhere in the end.
    assert off[0] > 3e-4
    assert max(off[1:]) < 0.5 * off[0]
    again = simulator.run([Job(0)])[0]
    assert again is not None
    assert free is not None
    np.testing.assert_array_equal(again.position_m, free.position_m)


def test_without_a_track_a_run_is_on_its_own() -> None:
    simulator = Simulator(plan(), 1)
    free, drawn = simulator.run([Job(0), Job(0, nudge=FAST)])
    assert free is not None
    assert drawn is not None
    np.testing.assert_array_equal(free.position_m, drawn.position_m)


def once_wrong(dataset: Dataset, by_m: float) -> Dataset:
    """Return a dataset of one track in which something else was once taken for the robot."""
    (trial,) = dataset.trials
    assert trial.track is not None
    y = trial.track.channels["y_m"].copy()
    y[40] += by_m
    track = Track(time_s=trial.track.time_s, channels=trial.track.channels | {"y_m": y})
    return replace(dataset, trials=(replace(trial, track=track),))


@pytest.mark.parametrize(
    "effects",
    [
        (),
        (CenterOfMassOffset(offset_m=(0.0, 4e-5, 2e-5)),),
        (CameraCalibration(scale=1.05),),
        (CameraCalibration(heading_deg=8.0),),
        (CameraCalibration(origin_m=(3e-4, -4e-4)),),
        (CameraCalibration(time_offset_s=0.08),),
    ],
)
@pytest.mark.parametrize("seen", [1, 6, slice(0, 20), slice(25, 45), slice(50, None), 3e-3])
def test_a_model_that_is_right_is_drawn_nowhere(effects: tuple[Effect, ...], seen: int | slice | float) -> None:
    """But by noise: not by a sensor that is off, by what is tracked, by lost frames or by what is no robot."""
    tolerant = Sensor(
        position_noise_m=POSITION_NOISE_M,
        angle_noise_deg=ANGLE_NOISE_DEG,
        origin_tolerance_m=3e-4,
        heading_tolerance_deg=6.0,
        scale_tolerance=0.04,
    )
    planned = replace(plan(PLANS[1:2], duration_s=1.2), sensor=tolerant)
    dataset = measure(planned, effects, clock_frames=0.4, origin_m=2.5e-4, heading_deg=5.0, scale=1.03)
    match seen:
        case slice():
            dataset = without(dataset, "f05", seen)
        case int():
            dataset = thinned(dataset, seen)
        case float():
            dataset = once_wrong(dataset, seen)
    comparison = Comparison(dataset, Simulator(dataset, 1))
    (alone,) = comparison.simulator.run([Job(0, effects)])
    as_fitted = comparison.residual([alone])
    for rate in (5.0, 50.0):
        nudge = Nudge.of(rate, as_fitted.local[0], as_fitted.camera)
        (drawn,) = comparison.simulator.run([Job(0, effects, nudge=nudge)])
        assert alone is not None
        assert drawn is not None
        shift = np.abs(drawn.position_m - alone.position_m).max()
        # A part of what the sensor is off by: of the way of 7 mm its scale alone takes 0.2 mm.
        assert 0.0 < shift < 6e-5
