from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tumblers import preset_scenario, simulate
from tumblers.blind.cause import CatalogueCause, OutsideCause
from tumblers.blind.forms import FORMS, FrictionDrift, FrictionRunsIn, law_of, scaled
from tumblers.blind.lab import Lab, Plan
from tumblers.blind.law import EffectLaw, Law
from tumblers.blind.outside import OUTSIDE
from tumblers.blind.sensing import Nuisances, measure
from tumblers.blind.view import channels_of, turn_between
from tumblers.blind.world import Scene, watch
from tumblers.dataset import Sensor
from tumblers.effects.base import Effect
from tumblers.effects.camera_calibration import CameraCalibration
from tumblers.effects.catalogue import CATALOGUE
from tumblers.effects.friction_coefficient import FrictionCoefficient
from tumblers.errors import InputError
from tumblers.field import RotatingField, StaticField, TableField
from tumblers.model import Model
from tumblers.scenario import Scenario

TIMES = np.arange(0.0, 0.4, 1.0 / 60.0)
STEP_S = 1.4e-4
MODEL = Model(magnetic_torque="midpoint")


def flat(frequency_Hz: float = 5.0) -> Scenario:
    scenario = preset_scenario("cuboid_on_paper", model=MODEL, step_s=STEP_S)
    return replace(scenario, field=RotatingField(strength_T=0.010, frequency_Hz=frequency_Hz))


def slope() -> Scenario:
    # Steep enough that the robot slips and stands on its faces.
    scenario = flat(1.0)
    return replace(scenario, run=replace(scenario.run, incline_deg=48.0))


def hold() -> Scenario:
    # It lies on its face, where adhesion acts, and slides slowly.
    scenario = flat()
    still = StaticField(strength_T=0.0, direction=(0.0, 1.0, 0.0))
    return replace(scenario, field=still, run=replace(scenario.run, incline_deg=75.0))


def gap_m(first: Scene, second: Scene) -> float:
    return float(np.max(np.abs(first.poses.position_m - second.poses.position_m)))


@pytest.mark.parametrize("robot", ["cuboid", "spiked_pdms"])
@pytest.mark.parametrize("solver", ["reduced", "general"])
def test_a_world_without_causes_is_the_model(robot: str, solver: str) -> None:
    scenario = preset_scenario(robot=robot, substrate="paper", drive="20mT_10Hz", model=MODEL, step_s=STEP_S)
    scene = watch(scenario, (), TIMES, solver=solver)  # type: ignore[arg-type]
    run = simulate(scenario)
    for i in range(3):
        expected = np.interp(TIMES, run["time"].values, run["position_m"].values[:, i])
        # The unreduced problem is solved to 1e-9 of the step's own scale, which thousands of steps add up.
        np.testing.assert_allclose(scene.poses.position_m[:, i], expected, rtol=0.0, atol=1e-8)
    np.testing.assert_allclose(np.linalg.norm(scene.poses.orientation, axis=1), 1.0, atol=1e-12)


def test_exchanging_equal_trials_changes_nothing() -> None:
    class Nothing(Law):
        every = 8

    assert gap_m(watch(flat(), [Nothing()], TIMES, solver="reduced"), watch(flat(), (), TIMES, solver="reduced")) < 1e-9


@pytest.mark.parametrize(("share", "climbs"), [(0.09, False), (0.11, True)])
def test_a_lab_notes_a_climb_by_the_rule_of_the_format(share: float, climbs: bool) -> None:
    plan = Plan(id="up", field=RotatingField(strength_T=0.01, frequency_Hz=3.0), duration_s=1.0, tracked=False)
    plan = replace(plan, outcome="climbs")
    lab = Lab(
        robot=flat().robot,
        substrate=flat().substrate,
        sensor=Sensor(position_noise_m=3e-6, angle_noise_deg=1.0),
        channels=(),
        frames_per_second=60.0,
        view_m=0.02,
        step_s=STEP_S,
        plans=(plan,),
    )
    scene = watch(lab.scenario(plan), (), lab.frames(plan), solver="reduced")
    # Three turns: three perimeters without slip.
    way_m = 3.0 * share * lab.robot.body().hull_perimeter_m
    way_m = np.linspace(0.0, way_m, len(scene.time_s))[:, None] * np.array([0.0, 1.0, 0.0])
    seen = replace(scene, poses=replace(scene.poses, position_m=way_m))
    rng = np.random.default_rng(0)
    trial = measure(lab, 0, seen, replace(Nuisances.draw(rng, lab), scale=1.0, heading_deg=0.0), rng)
    assert trial.outcome is not None
    assert trial.outcome.climbs == climbs


def test_a_camera_whose_clock_is_late_films_later_poses_and_leaves_the_field_s_times_as_they_are() -> None:
    late_s = 0.0431
    camera = [EffectLaw(CameraCalibration(time_offset_s=late_s))]
    filmed = watch(flat(), camera, TIMES, solver="reduced")
    np.testing.assert_array_equal(filmed.time_s, TIMES + late_s)
    assert gap_m(filmed, watch(flat(), (), TIMES + late_s, solver="reduced")) == 0.0
    plain = watch(flat(), (), TIMES, solver="reduced")
    assert gap_m(watch(flat(), camera, TIMES, solver="reduced", filmed=False), plain) == 0.0
    assert gap_m(filmed, plain) > 1e-5


def test_a_camera_whose_clock_is_late_sees_the_last_of_a_table_s_field_to_the_end() -> None:
    end_s = float(TIMES[-1])
    field = TableField(time_s=(0.0, end_s), field_T=((0.0, 0.002, 0.0), (0.0, 0.0, 0.01)))
    scenario = flat()
    scenario = replace(scenario, field=field, run=replace(scenario.run, duration_s=end_s))
    seen = watch(scenario, [EffectLaw(CameraCalibration(time_offset_s=0.1))], TIMES, solver="reduced")
    np.testing.assert_array_equal(seen.time_s, np.minimum(TIMES + 0.1, end_s))
    beyond = end_s < (TIMES + 0.1)
    assert 1 < beyond.sum() < len(TIMES)
    assert np.all(seen.poses.position_m[beyond] == seen.poses.position_m[-1])


def test_the_tracked_point_is_the_body_s_centre() -> None:
    scenario = flat()
    offset = (0.0, 3e-5, 2e-5)
    moved = replace(scenario, robot=replace(scenario.robot, center_of_mass_m=offset))
    start = watch(moved, (), TIMES, solver="reduced").poses.position_m[0]
    # A run starts with the mass centre above the origin.
    np.testing.assert_allclose(start, [0.0, -3e-5, 5e-5], atol=1e-9)


def cause(name: str, other_form: bool, seed: int = 3) -> CatalogueCause:
    return CatalogueCause(name, other_form, [flat(), slope()], np.random.default_rng(seed))


@pytest.mark.parametrize("name", FORMS)
def test_each_other_form_changes_the_run_in_its_own_way(name: str) -> None:
    changed = other = 0.0
    for seed in (3, 4, 5):
        drawn = cause(name, True, seed)
        same = EffectLaw(drawn.effect)
        for scenario in (flat(), flat(10.0), slope(), hold()):
            plain = watch(scenario, (), TIMES, solver="reduced")
            seen = watch(scenario, [drawn.law(1.0)], TIMES, solver="reduced")
            changed = max(changed, gap_m(plain, seen))
            other = max(other, gap_m(watch(scenario, [same], TIMES, solver="reduced"), seen))
    assert drawn.form != "catalogue"
    # The answer says what its details were drawn from.
    assert (drawn.form_seed is None, cause(name, False).form_seed) == (False, None)
    assert changed > 1e-6
    assert other > 1e-7


def test_a_form_is_drawn_as_seldom_as_a_diagnosis_expects_it_and_not_beside_another() -> None:
    drawn = [cause("friction_coefficient", False, seed).effect.vector() for seed in range(400)]
    assert all(factor != 1.0 for factor, _ in drawn)
    # A binomial of 400 and 0.2, four of its standard deviations either way.
    assert 48 <= sum(drift != 0.0 for _, drift in drawn) <= 112
    others = [cause("friction_coefficient", True, seed) for seed in range(40)]
    assert {other.form for other in others} == {"runs_in"}
    assert all(other.effect.vector()[1] == 0.0 for other in others)


def test_friction_runs_in_to_what_the_effect_says() -> None:
    for seed in range(20):
        law = law_of(FrictionCoefficient(factor=0.5), "runs_in", seed)
        assert isinstance(law, FrictionRunsIn)
        scales = [law.scale(time_s, {}) for time_s in (0.0, 0.5, 5.0)]
        assert 0.1 <= scales[0] <= 0.5
        assert scales == sorted(scales)
        assert scales[-1] == pytest.approx(1.0, abs=1e-4)


def test_an_answer_with_a_form_that_is_drawn_no_more_keeps_its_law_and_one_that_never_was_is_refused() -> None:
    friction = FrictionCoefficient(factor=0.5)
    drifts = law_of(friction, "drifts_with_time", 3)
    assert isinstance(drifts, FrictionDrift)
    assert drifts.scale(0.5, {}) == pytest.approx(1.0)
    assert type(law_of(friction, "catalogue", None)) is EffectLaw
    with pytest.raises(InputError, match=r"friction_coefficient\.form: found 'barrel', expected catalogue or runs_in"):
        law_of(friction, "barrel", 3)
    with pytest.raises(InputError, match=r"draft_angle\.form: found 'barrel', expected catalogue"):
        law_of(CATALOGUE["draft_angle"].from_vector([1.0]), "barrel", 3)


@pytest.mark.parametrize("name", OUTSIDE)
def test_each_cause_outside_the_catalogue_changes_the_run(name: str) -> None:
    scenario = flat()
    outside = OutsideCause(name, scenario.robot, np.random.default_rng(7))
    times = np.arange(0.0, 0.6, 1.0 / 60.0)
    plain = watch(scenario, (), times, solver="reduced")
    assert gap_m(plain, watch(scenario, [outside.law(1.0)], times, solver="reduced")) > 3e-6
    assert outside.name not in CATALOGUE


@pytest.mark.parametrize("name", ["broken_spike", "dust_speck"])
@pytest.mark.parametrize("robot", ["cuboid", "spiked_pdms", "spiked_ends_pdms"])
def test_a_hull_with_next_to_nothing_cut_or_added_is_the_body(name: str, robot: str) -> None:
    scenario = preset_scenario(robot=robot, substrate="paper", drive="20mT_1Hz", model=MODEL, step_s=STEP_S)
    law = OutsideCause(name, scenario.robot, np.random.default_rng(1)).law(1e-4)
    settled = law.settle(scenario, 0)
    size = scenario.robot.body().size_m
    assert settled.robot.body().size_m == pytest.approx(size, rel=1e-2)
    assert settled.robot.total_mass_kg == scenario.robot.total_mass_kg
    np.testing.assert_allclose(settled.robot.magnetic_moment_A_m2, scenario.robot.magnetic_moment_A_m2)


@pytest.mark.parametrize("name", CATALOGUE)
def test_no_share_of_an_effect_is_neutral_and_all_of_it_is_the_effect(name: str) -> None:
    effect: Effect = cause(name, False).effect
    assert scaled(effect, 0.0).is_neutral()
    np.testing.assert_allclose(scaled(effect, 1.0).vector(), effect.vector(), rtol=1e-12)
    assert not scaled(effect, 0.5).is_neutral()


def test_tilt_and_heading_follow_the_format() -> None:
    half = np.sqrt(0.5)
    poses = watch(flat(), (), TIMES, solver="reduced").poses
    # Up by 90 degrees about x; towards -x by 90 degrees about z.
    orientation = np.array([[half, half, 0.0, 0.0], [half, 0.0, 0.0, half]])
    channels = channels_of(type(poses)(np.zeros((2, 3)), orientation))
    np.testing.assert_allclose(channels["tilt_deg"], [90.0, 0.0], atol=1e-6)
    assert np.isnan(channels["heading_deg"][0])
    assert channels["heading_deg"][1] == pytest.approx(90.0)
    turn = turn_between(np.array([[1.0, 0.0, 0.0, 0.0]]), orientation[1:])
    np.testing.assert_allclose(turn, [[0.0, 0.0, 90.0]], atol=1e-9)
