"""What is a matter of the sensor or of the computation is never taken for physics."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tumblers.dataset import Dataset, Track
from tumblers.diagnosis import diagnose
from tumblers.diagnosis.fitting.hypothesis import Hypothesis
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.floor import SHARED
from tumblers.diagnosis.gap.predictive import is_right, mean_square
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.what.attribute import attribute
from tumblers.diagnosis.what.height_zero import with_height_zero
from tumblers.effects import get
from tumblers.model import Model

from .lab import PLANS, UPWARDS, folded, measure, plan, thinned, without

CONSIDERED = ("camera_calibration", "size_error", "substrate_tilt", "field_rolloff")


@pytest.mark.parametrize(("seed", "sign"), [(0, 1.0), (1, -1.0), (2, 1.0)])
def test_a_sensor_within_its_tolerance_is_no_effect(seed: int, sign: float) -> None:
    off = {"clock_frames": 0.45, "heading_deg": 1.5, "scale": 1.004}
    dataset = measure(
        plan(),
        seed=seed,
        clock_frames=sign * off["clock_frames"],
        origin_m=4e-5,
        heading_deg=sign * off["heading_deg"],
        scale=1.0 + sign * (off["scale"] - 1.0),
    )
    diagnosis = diagnose(dataset, effects=CONSIDERED, jobs=2)
    assert diagnosis.verdict == "no_gap"
    assert not diagnosis.effects
    # There was a gap before the nuisances were fitted, and nothing else closed it.
    assert diagnosis.gap.before > 3.0
    assert diagnosis.gap.after_nuisance_only < 1.1


@pytest.mark.parametrize(("stated_s", "longer_s"), [(None, 1.0 / 60.0), (0.0, 1.0 / 60.0), (0.1, 0.1)])
def test_a_run_is_long_enough_for_a_clock_that_is_off(stated_s: float | None, longer_s: float) -> None:
    # Or the model would stand still in the last frames.
    dataset = measure(plan())
    dataset = replace(dataset, sensor=replace(dataset.sensor, time_offset_s=stated_s))
    run, trial = Simulator(dataset, 1).nominal(0).run, dataset.trials[0]
    assert run.duration_s > trial.duration_s + 0.99 * longer_s
    assert run.duration_s < trial.duration_s + longer_s + 0.01


def test_a_camera_that_is_off_by_more_is_the_camera() -> None:
    dataset = measure(plan(), heading_deg=5.0, scale=1.02, seed=1)
    diagnosis = diagnose(dataset, effects=CONSIDERED, jobs=2)
    assert diagnosis.verdict == "explained"
    assert [effect.name for effect in diagnosis.effects] == ["camera_calibration"]
    for key, value in (("scale", 1.02), ("heading_deg", 5.0)):
        interval = diagnosis.effects[0].parameters[key]
        assert interval.low <= value <= interval.high


@pytest.mark.parametrize(
    ("off", "key", "value"),
    [
        ({"origin_m": (0.0, 3e-4)}, "origin_m[1]", 3e-4),
        # Two and a half frames, where half of one is the tolerance.
        ({"time_offset_s": 2.5 / 60.0}, "time_offset_s", 2.5 / 60.0),
        ({"time_offset_s": -2.5 / 60.0}, "time_offset_s", -2.5 / 60.0),
    ],
)
def test_an_origin_and_a_clock_that_are_off_by_more_are_the_camera(
    off: dict[str, object], key: str, value: float
) -> None:
    dataset = measure(plan(), (get("camera_calibration")(**off),), seed=1)
    diagnosis = diagnose(dataset, effects=CONSIDERED, jobs=2)
    assert diagnosis.verdict == "explained"
    assert [effect.name for effect in diagnosis.effects] == ["camera_calibration"]
    parameters = diagnosis.effects[0].parameters
    assert parameters[key].low <= value <= parameters[key].high
    # What is right is said to be so, no better than the tolerance.
    for other in {"scale", "heading_deg", "origin_m[0]", "time_offset_s", "origin_m[1]"} - {key}:
        neutral = 1.0 if other == "scale" else 0.0
        assert parameters[other].low <= neutral <= parameters[other].high


def test_where_the_tolerance_is_enough_the_camera_has_no_origin_and_no_clock() -> None:
    # A heading that is off by much more moves the way's end along x, which origins take a part of.
    turned = measure(plan(), heading_deg=5.0, seed=1)
    comparison = Comparison(turned, Simulator(turned, 1))
    local = comparison.residual(comparison.nominal_paths).local
    assert comparison.nuisances.enough(local) == {"clock", "origin y"}
    dataset = measure(plan(), heading_deg=3.0, seed=1)
    comparison = Comparison(dataset, Simulator(dataset, 1))
    local = comparison.residual(comparison.nominal_paths).local
    assert comparison.nuisances.enough(local) == {"clock", "origin x", "origin y"}
    # Some trials at an end are no shift of all.
    bound = comparison.nuisances.local_bounds[:, 1]
    local[:, 1] = bound * [1, -1, 0.5, 0.1, 0.1]
    assert "origin x" in comparison.nuisances.enough(local)
    local[:, 1] = bound * [1, 0.0, 0.0, 0.0, 0.0]
    assert "origin x" in comparison.nuisances.enough(local)
    # What all share brings only those to an end whose own share adds to it, but all lie to one side.
    local[:, 1] = bound * [1, 0.6, 0.4, 0.8, 0.5]
    assert comparison.nuisances.enough(local) == {"clock", "origin y"}
    local[:, 1] = bound * [0.98, 0.6, 0.4, 0.8, 0.5]
    assert "origin x" in comparison.nuisances.enough(local)
    local[:, 1] = bound * [1, -0.6, 0.4, 0.8, 0.5]
    assert "origin x" in comparison.nuisances.enough(local)
    # Those that say nothing do not count.
    local[:, 1] = bound * [1, -1, 0.0, 0.0, 0.5]
    assert comparison.nuisances.enough(local) == {"clock", "origin y"}
    local[:, 1] = bound * [1, -1, 1, 0.1, 0.2]
    assert comparison.nuisances.enough(local) == {"clock", "origin y"}
    scenarios = [comparison.simulator.nominal(i) for i in range(len(comparison.readers))]
    hypothesis = Hypothesis.of(get("camera_calibration"), scenarios)
    held = hypothesis.without({"clock", "origin y"})
    assert (hypothesis.free, held.free) == (5, 3)
    assert len(held.starts) == 6
    assert held.effects(np.full(5, 0.5))[0].vector()[3:] == (0.0, 0.0)
    assert hypothesis.without(set()) is hypothesis


@pytest.mark.parametrize("divisor", [1, 4])
def test_another_step_is_no_effect(divisor: int) -> None:
    diagnosis = diagnose(measure(plan(), divisor=divisor, seed=3), effects=CONSIDERED, jobs=2)
    assert diagnosis.verdict == "no_gap"
    assert not diagnosis.effects


def test_numbers_that_were_computed_in_a_coarse_step_by_another_scheme_are_no_effect() -> None:
    planned = replace(plan(), model=Model(), model_given=())
    assert not planned.model_given
    diagnosis = diagnose(measure(planned, coarse=True, seed=5), effects=CONSIDERED, jobs=2)
    assert diagnosis.verdict == "no_gap"
    assert not diagnosis.effects


def test_a_robot_that_left_the_view_is_not_at_rest() -> None:
    dataset = measure(plan(), seed=4)
    for name in ("f05", "f10"):
        dataset = without(dataset, name, slice(14, None))
    diagnosis = diagnose(dataset, effects=CONSIDERED, jobs=2)
    assert diagnosis.verdict == "no_gap"
    floors = {floor.trial: floor for floor in diagnosis.floors}
    assert floors["f05"].lost == floors["f05"].frames - 14
    assert floors["f05"].compared < floors["f02"].compared
    assert any("left the view" in said for said in diagnosis.assumptions)


def test_frames_that_are_lost_throughout_a_trial_leave_the_others() -> None:
    dataset = without(measure(plan(), seed=5), "f05", slice(None))
    diagnosis = diagnose(dataset, effects=CONSIDERED, jobs=2)
    assert diagnosis.verdict == "no_gap"
    (floor,) = (floor for floor in diagnosis.floors if floor.trial == "f05")
    assert (floor.compared, floor.lost) == (0, floor.frames)
    assert diagnosis.to_json()


def test_a_static_field_alone_is_enough_to_see_that_nothing_is_wrong() -> None:
    diagnosis = diagnose(measure(plan([("a", UPWARDS, 0.0), ("b", UPWARDS, 5.0)])), effects=CONSIDERED, jobs=2)
    assert diagnosis.verdict == "no_gap"


def test_nominal_numbers_that_are_held_hide_no_gap() -> None:
    # A moment that is 2 % weak is four tolerances off: fitted, they take half of the gap, held at 0 none of it.
    dataset = measure(plan(), (get("magnetization_strength").from_vector((0.98,)),), seed=4)
    comparison = Comparison(dataset, Simulator(dataset, 1))
    paths = comparison.nominal_paths
    fitted = comparison.residual(paths)
    held = comparison.residual(paths, tolerance=np.zeros(SHARED))
    assert np.all(held.tolerance == 0.0)
    assert mean_square(comparison, held) > mean_square(comparison, fitted) + 0.1
    # Held where they were found, they are what they were, and the sensor's nuisances with them.
    again = comparison.residual(paths, tolerance=fitted.tolerance)
    assert np.all(again.tolerance == fitted.tolerance)
    assert_allclose(again.camera, fitted.camera, atol=1e-3)
    assert mean_square(comparison, again) == pytest.approx(mean_square(comparison, fitted), rel=0.02)
    # All held at once, nothing is fitted.
    same = comparison.held(paths, fitted)
    for before, after in zip(fitted.trials, same.trials, strict=True):
        assert np.array_equal(before, after)


@pytest.mark.parametrize(
    ("stated", "half_a_frame"), [({}, 0.05), ({"frames_per_second": 60.0}, 1 / 120), ({"time_offset_s": 0.003}, 0.003)]
)
def test_a_track_that_leaves_frames_out_has_a_clock_as_good_as_the_camera_s(
    stated: dict[str, float], half_a_frame: float
) -> None:
    # Every sixth frame of 60 in a second.
    data = thinned(measure(plan(PLANS[:1])), 6)
    data = replace(data, sensor=replace(data.sensor, **stated))
    comparison = Comparison(data, Simulator(data, 1))
    assert comparison.nuisances.local_bounds[0, 0] == pytest.approx(half_a_frame, rel=1e-9)


@pytest.mark.parametrize("every", [6, 12])
@pytest.mark.parametrize("clock_frames", [0.4, 1.7, -2.5])
def test_a_clock_is_found_in_a_few_frames_a_cycle(every: int, clock_frames: float) -> None:
    """Where all clocks but near the right one are far off, a right model would look wrong by 30 sigmas."""
    plans = PLANS[1:2] if every == 6 else PLANS[:1]
    whole = measure(plan(plans, duration_s=1.2), clock_frames=clock_frames, origin_m=4e-5, heading_deg=1.5, scale=1.004)
    data = thinned(whole, every)
    comparison = Comparison(data, Simulator(data, 1))
    found = comparison.residual(comparison.nominal_paths)
    # Of 60 in a second. Half a frame of the sparse track is 25 or 50 times as far.
    assert found.local[0, 0] == pytest.approx(clock_frames / 60.0, abs=2e-3)
    # Noise leaves 1, of the few numbers of six frames give or take a tenth.
    assert np.sqrt(np.mean(found.trials[0] ** 2)) < 1.3


def raised(dataset: Dataset) -> Dataset:
    """Return a dataset whose heights are from another zero in each trial."""
    trials = []
    for trial, zero_m in zip(dataset.trials, (-5e-6, 1e-5, -5e-6, 1e-5, -5e-6), strict=True):
        assert trial.track is not None
        channels = {**trial.track.channels, "z_m": trial.track.channels["z_m"] + zero_m}
        trials.append(replace(trial, track=Track(time_s=trial.track.time_s, channels=channels)))
    return replace(dataset, trials=tuple(trials))


def unsure(dataset: Dataset, z_origin_tolerance_m: float) -> Dataset:
    return replace(dataset, sensor=replace(dataset.sensor, z_origin_tolerance_m=z_origin_tolerance_m))


def test_a_height_from_another_zero_in_each_trial_is_no_gap_where_it_may_be_off() -> None:
    dataset = raised(measure(plan(), clock_frames=-0.2, origin_m=2e-5))
    names = ("size_error", "friction_coefficient")
    # To a lab that knows its height it is one: only what passes this test is none.
    known = unsure(dataset, 0.0)
    comparison = Comparison(known, Simulator(known, 1))
    assert not is_right(comparison, comparison.residual(comparison.nominal_paths))
    found = diagnose(unsure(dataset, 3e-5), effects=names, jobs=2)
    assert found.verdict == "no_gap"
    assert found.gap.after_nuisance_only < 1.1 < found.gap.before
    assert any("along z 30 µm" in said for said in found.assumptions)
    # Where nothing is stated, the data say so.
    found = diagnose(dataset, effects=names, jobs=2)
    assert found.verdict == "no_gap"
    assert any("along z 50 µm" in said for said in found.assumptions)
    assert any(said.startswith("Heights are taken to be measured from a zero") for said in found.assumptions)


@pytest.mark.parametrize(
    ("name", "values", "off"),
    [
        ("size_error", (1.03, 1.03), False),
        ("size_error", (1.03, 1.03), True),
        ("stray_field_gradient", (0.0, 0.05, 0.0, 0.0), True),
    ],
)
def test_a_zero_of_the_height_is_fitted_beside_an_effect_where_it_is_off_alone(
    name: str, values: tuple[float, ...], off: bool
) -> None:
    kind = get(name)
    dataset = measure(plan(), (kind.from_vector(values),), origin_m=2e-5)
    # A size takes some of the zero where it is not fitted.
    found = diagnose(raised(dataset) if off else dataset, effects=("size_error", "stray_field_gradient"), jobs=2)
    assert found.verdict == "explained"
    assert [effect.name for effect in found.effects] == [name]
    assert found.z_origin_tolerance_m == (5e-5 if off else 0.0)
    taken = "from a zero of their own" if off else "from the substrate, for the sensor does not say"
    assert any(said.startswith("Heights") and taken in said for said in found.assumptions)


def test_a_cause_that_is_not_considered_is_no_zero_of_the_height() -> None:
    dataset = measure(plan(), (get("size_error").from_vector((1.03, 1.03)),), origin_m=2e-5)
    comparison = Comparison(dataset, Simulator(dataset, 2))
    found = attribute(comparison, [get("friction_coefficient")])
    assert not found.nominal_is_right
    assert with_height_zero(comparison, found) is None


@pytest.mark.parametrize("low_deg", [-90.0, 0.0])
def test_a_camera_that_does_not_know_the_ends_of_an_axis_is_no_gap(low_deg: float) -> None:
    dataset = folded(measure(plan(), clock_frames=-0.2, origin_m=2e-5), low_deg)
    found = diagnose(dataset, effects=("size_error", "viscous_drag"), jobs=2)
    assert found.verdict == "no_gap"
    assert found.gap.after_nuisance_only < 1.1
    assert any("which end is which" in said for said in found.assumptions)
    # What is drawn is within half a turn, in which the model's jumps are none: of a body that lies the noise is 1.2° at
    # most, seven of which no frame of some hundred is off.
    assert any(np.any(np.abs(overlay.nominal["tilt"]) < 30.0) for overlay in found.overlays)
    for overlay in found.overlays:
        apart = overlay.nominal["heading"] - overlay.measured["heading"]
        lying = np.abs(overlay.nominal["tilt"]) < 30.0
        apart = np.abs(apart - 180.0 * np.rint(apart / 180.0))[lying]
        assert np.nanmax(np.abs(overlay.nominal["heading"])) <= 90.0
        assert np.nanmax(apart, initial=0.0) < 8.0
