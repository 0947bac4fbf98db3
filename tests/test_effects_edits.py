"""What each effect makes of a scenario, beside its equation written out once more."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from tumblers import (
    Cuboid,
    Curved,
    Ellipsoid,
    Hull,
    InputError,
    RotatingField,
    Scenario,
    Spiked,
    SpikedEnds,
    StaticField,
    TableField,
    preset_scenario,
    simulate,
)
from tumblers.camera import Camera
from tumblers.effects import CATALOGUE
from tumblers.presets import ROBOTS
from tumblers.relief import Relief
from tumblers.shape import Shape

NOMINAL = preset_scenario("cuboid_on_paper", robot="cuboid_second_generation", duration_s=0.3)
STATIC = replace(NOMINAL, field=StaticField(strength_T=0.005, direction=(0.0, 0.0, 1.0)))
TABLE = replace(NOMINAL, field=TableField(time_s=(0.0, 1.0), field_T=((0.0, 0.01, 0.0), (0.0, 0.0, 0.01))))
OTHER_FIELDS = pytest.mark.parametrize("scenario", [STATIC, TABLE], ids=["static", "table"])


def edited(name: str, scenario: Scenario = NOMINAL, **keys: object) -> Scenario:
    return CATALOGUE[name].from_table({"name": name, **keys}).edit(scenario)


def paper_axis(theta1_deg: float, theta2_deg: float) -> tuple[float, float, float]:
    one, two = math.radians(theta1_deg), math.radians(theta2_deg)
    return math.sin(two) * math.sin(one), math.cos(one), math.cos(two) * math.sin(one)


@pytest.mark.parametrize("theta2_deg", [-180.0, -90.0, 0.0, 37.0, 90.0])
@pytest.mark.parametrize("theta1_deg", [8.0, 27.0, 90.0])
def test_misalignment_of_the_long_axis_is_the_papers(theta1_deg: float, theta2_deg: float) -> None:
    scenario = edited("magnetization_misalignment", theta1_deg=theta1_deg, theta2_deg=theta2_deg)
    assert_allclose(scenario.robot.magnetic_axis, paper_axis(theta1_deg, theta2_deg), atol=1e-15)


def test_misalignment_turns_a_nominal_axis_by_the_shortest_way() -> None:
    u = np.array([0.36, 0.48, 0.8])
    robot = replace(NOMINAL.robot, magnetization_axis=tuple(u))
    scenario = edited("magnetization_misalignment", replace(NOMINAL, robot=robot), theta1_deg=20.0, theta2_deg=50.0)
    start, end = np.array([0.0, 1.0, 0.0]), np.array(paper_axis(20.0, 50.0))
    cross = np.cross(start, end)
    skew = np.array([[0, -cross[2], cross[1]], [cross[2], 0, -cross[0]], [-cross[1], cross[0], 0]])
    turn = np.eye(3) + skew + skew @ skew / (1.0 + start @ end)
    assert_allclose(turn @ start, end, atol=1e-15)
    assert_allclose(scenario.robot.magnetic_axis, turn @ u, atol=1e-15)


def test_misalignment_replaces_nominal_angles() -> None:
    robot = replace(NOMINAL.robot, theta1_deg=27.0, theta2_deg=0.0)
    scenario = edited("magnetization_misalignment", replace(NOMINAL, robot=robot), theta1_deg=8.0, theta2_deg=180.0)
    assert_allclose(scenario.robot.magnetic_axis, paper_axis(19.0, 0.0), atol=1e-15)


@pytest.mark.parametrize(
    ("name", "keys", "part", "attribute", "expected"),
    [
        ("magnetization_strength", {"factor": 0.5}, "robot", "magnetization_A_per_m", 0.5 * 51835.0),
        ("draft_angle", {"draft_deg": 3.0}, "robot", "draft_deg", 3.0),
        ("center_of_mass_offset", {"offset_m": (1e-5, 2e-5, 3e-6)}, "robot", "center_of_mass_m", (1e-5, 2e-5, 3e-6)),
        ("friction_coefficient", {"factor": 0.5}, "substrate", "friction_coefficient", 0.15),
        ("friction_coefficient", {"drift_per_s": 0.2}, "substrate", "friction_drift_per_s", 0.2),
        ("friction_anisotropy", {"e_t_factor": 2.0}, "substrate", "friction_ellipsoid", (2.0, 1.0, 0.1)),
        ("friction_anisotropy", {"e_o_factor": 2.0}, "substrate", "friction_ellipsoid", (1.0, 2.0, 0.1)),
        ("adhesion_coefficient", {"factor": 2.0}, "substrate", "adhesion_N_per_m2", 2.38),
        ("line_contact_adhesion", {"width_m": 5e-6}, "substrate", "line_contact_width_m", 5e-6),
        ("electrostatic_force", {"added_force_N": -6.54e-7}, "substrate", "electrostatic_force_N", 0.0),
        ("field_ellipticity", {"amplitude_ratio": 0.8}, "field", "quadrature_ratio", 0.8),
        ("field_ellipticity", {"phase_error_deg": 5.0}, "field", "phase_error_deg", 5.0),
        ("field_rolloff", {"time_constant_s": 0.1 / math.pi}, "field", "strength_T", 0.010 / math.sqrt(2.0)),
        ("substrate_tilt", {"slope_x_deg": -2.0}, "run", "side_incline_deg", -2.0),
        ("substrate_tilt", {"slope_y_deg": 3.0}, "run", "incline_deg", 3.0),
        ("eddy_current_drag", {"sheet_conductance_S": 1e6}, "surroundings", "sheet_conductance_S", 1e6),
        ("contact_compliance", {"compliance_m_per_N": 2.0}, "substrate", "compliance_m_per_N", 2.0),
        ("camera_calibration", {"scale": 1.1}, "camera", "scale", 1.1),
        ("camera_calibration", {"heading_deg": 4.0}, "camera", "heading_deg", 4.0),
        ("camera_calibration", {"origin_m": (1e-4, -2e-4)}, "camera", "origin_m", (1e-4, -2e-4)),
        ("camera_calibration", {"time_offset_s": 0.05}, "camera", "time_offset_s", 0.05),
    ],
)
def test_an_effect_edits_its_key_and_nothing_else(
    name: str, keys: dict[str, object], part: str, attribute: str, expected: float | tuple[float, ...]
) -> None:
    scenario = edited(name, **keys)
    assert_allclose(getattr(getattr(scenario, part), attribute), expected, rtol=1e-14)
    nominal = replace(getattr(scenario, part), **{attribute: getattr(getattr(NOMINAL, part), attribute)})
    assert replace(scenario, **{part: nominal}) == NOMINAL


# The equations of these are no products or sums in their parameters.
_OTHERS = ("size_error", "magnetization_misalignment", "field_rolloff", "surface_roughness")


@pytest.mark.parametrize("name", [name for name in CATALOGUE if name not in _OTHERS])
def test_twice_an_effect_is_its_factors_squared_and_its_offsets_doubled(name: str) -> None:
    effect = CATALOGUE[name]
    exponent = (
        [p.key for p in effect.parameters].index("frequency_exponent") if name == "stray_field_gradient" else None
    )
    values = effect.starts(NOMINAL)[-1]
    twice = [
        v if i == exponent else (v * v if p.neutral == 1.0 else 2.0 * v)
        for i, (p, v) in enumerate(zip(effect.parameters, values, strict=True))
    ]
    once = effect.from_vector(values)
    first, second = once.edit(once.edit(NOMINAL)), effect.from_vector(twice).edit(NOMINAL)
    for part in ("robot", "substrate", "field", "run", "surroundings", "camera", "relief"):
        one, other = getattr(first, part), getattr(second, part)
        for key in one.__slots__:
            if isinstance(getattr(one, key), float | tuple):
                assert_allclose(getattr(one, key), getattr(other, key), rtol=1e-14)


def extents(shape: Shape) -> np.ndarray:
    return np.ptp(np.concatenate(shape.body(0.0, False).outline), axis=0)


SHAPES: list[Shape] = [
    *{type(preset.value.shape): preset.value.shape for preset in ROBOTS.values()}.values(),
    Ellipsoid(semi_axes_m=(1e-4, 3e-4, 2e-4)),
    Hull(vertices_m=((1e-4, 0, 0), (-1e-4, 0, 0), (0, 4e-4, 0), (0, -4e-4, 0), (0, 0, 2e-4), (0, 0, -2e-4))),
]


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.kind)
def test_size_error_stretches_length_and_height_alone(shape: Shape) -> None:
    assert {type(s) for s in SHAPES} == {Cuboid, Spiked, SpikedEnds, Curved, Hull, Ellipsoid}
    scenario = replace(NOMINAL, robot=replace(NOMINAL.robot, shape=shape))
    before = extents(shape)
    for y, z in ((1.1, 1.0), (1.0, 0.9), (0.9, 1.15)):
        after = edited("size_error", scenario, length_factor=y, height_factor=z).robot
        # The outline of an arc is a polygon.
        assert_allclose(extents(after.shape), before * (1.0, y, z), rtol=1e-3 if shape.kind == "curved" else 1e-12)
        assert after.total_mass_kg == scenario.robot.total_mass_kg
        assert after.magnetic_moment_A_m2 == scenario.robot.magnetic_moment_A_m2


def test_size_error_of_a_ring_sector_is_what_it_says() -> None:
    nominal = ROBOTS["curved_su8"].value.shape
    assert isinstance(nominal, Curved)
    scenario = edited(
        "size_error", replace(NOMINAL, robot=ROBOTS["curved_su8"].value), length_factor=1.1, height_factor=0.9
    )
    stretched = scenario.robot.shape
    assert isinstance(stretched, Curved)
    (big, small, a), (new_big, new_small, b) = (
        (s.outer_radius_m, s.inner_radius_m, math.radians(s.half_angle_deg)) for s in (nominal, stretched)
    )
    assert_allclose(new_big * math.sin(b), 1.1 * big * math.sin(a), rtol=1e-12)
    assert_allclose(new_big * (1.0 - math.cos(b)), 0.9 * big * (1.0 - math.cos(a)), rtol=1e-12)
    assert_allclose((new_big - new_small) * math.cos(b), 0.9 * (big - small) * math.cos(a), rtol=1e-12)
    assert_allclose(new_big - new_small * math.cos(b), 0.9 * (big - small * math.cos(a)), rtol=1e-12)


def test_size_error_changes_the_mass_only_where_the_density_is_given() -> None:
    robot = replace(NOMINAL.robot, mass_kg=None, density_kg_per_m3=2000.0, magnetic_volume_m3=None)
    scenario = edited("size_error", replace(NOMINAL, robot=robot), length_factor=1.1)
    assert scenario.robot.total_mass_kg == pytest.approx(1.1 * robot.total_mass_kg, rel=1e-12)


def test_a_larger_robot_rolls_faster() -> None:
    # 2 (L + H) f: a tenth more length is 8/9 of a tenth more speed.
    speeds = [simulate(s).attrs["speed_m_per_s"] for s in (NOMINAL, edited("size_error", length_factor=1.1))]
    assert speeds[1] / speeds[0] == pytest.approx(1.0 + 0.1 * 8.0 / 9.0, rel=0.03)


@pytest.mark.parametrize("shape", [SHAPES[-1], SHAPES[-2]], ids=["hull", "ellipsoid"])
def test_a_shape_without_draft_has_no_range_of_it(shape: Shape) -> None:
    scenario = replace(NOMINAL, robot=replace(NOMINAL.robot, shape=shape))
    draft = CATALOGUE["draft_angle"]
    assert draft.ranges(scenario) == ((0.0, 0.0),)
    assert draft.starts(scenario) == ()
    with pytest.raises(InputError, match="draft_deg: found a draft of the shape"):
        draft.from_vector((1.0,)).edit(scenario).trial()


def test_a_draft_is_searched_as_far_as_the_body_bears_it() -> None:
    draft = CATALOGUE["draft_angle"]
    # Two sides, each inset by W tan φ, are as thick as the height at atan(1/8) = 7.1°.
    assert draft.ranges(NOMINAL) == ((0.0, 7.0),)
    assert draft.ranges(edited("draft_angle", draft_deg=6.0)) == ((0.0, 1.0),)
    wide = replace(NOMINAL, robot=ROBOTS["spiked_pdms"].value)
    assert draft.ranges(wide) == ((0.0, 8.0),)
    # A third and two thirds of the way in the logarithm: drafts of a tenth of a degree show.
    way = np.arcsinh(7.0 / 0.1)
    assert_allclose(draft.starts(NOMINAL), [(0.1 * np.sinh(way / 3.0),), (0.1 * np.sinh(way * 2.0 / 3.0),)], rtol=1e-12)


@pytest.mark.parametrize("name", ["adhesion_coefficient", "line_contact_adhesion"])
def test_without_adhesion_there_is_none_to_change(name: str) -> None:
    scenario = replace(NOMINAL, substrate=replace(NOMINAL.substrate, adhesion_N_per_m2=0.0))
    (low, high), *_ = CATALOGUE[name].ranges(scenario)
    assert low == high == CATALOGUE[name].parameters[0].neutral
    assert CATALOGUE[name].starts(scenario) == ()


def test_the_mass_centre_is_searched_within_a_fifth_of_the_half_extents() -> None:
    ranges = CATALOGUE["center_of_mass_offset"].ranges(NOMINAL)
    assert_allclose(ranges, [(-4e-5, 4e-5), (-8e-5, 8e-5), (-1e-5, 1e-5)], rtol=1e-12)


def test_the_attraction_is_searched_from_none_to_twice_the_larger_force() -> None:
    effect = CATALOGUE["electrostatic_force"]
    assert_allclose(effect.ranges(NOMINAL), [(-6.54e-7, 2 * 6.54e-7)])
    without = replace(NOMINAL, substrate=replace(NOMINAL.substrate, electrostatic_force_N=0.0))
    assert_allclose(effect.ranges(without), [(0.0, 2.0 * 4.44e-8 * 9.8)])
    assert effect.from_vector((effect.ranges(NOMINAL)[0][0],)).edit(NOMINAL).substrate.electrostatic_force_N == 0.0
    with pytest.raises(
        InputError, match=r"electrostatic_force\.added_force_N: found -1e-06, expected at least -6.54e-07"
    ):
        edited("electrostatic_force", added_force_N=-1e-6)


def test_a_gradient_pulls_with_the_moment_and_the_frequency() -> None:
    moment = 3.2e-11 * 51835.0
    pulled = edited("stray_field_gradient", gradient_T_per_m=(0.01, 0.05, -0.02), frequency_exponent=2.0)
    assert_allclose(pulled.surroundings.force_N, moment * 0.5**2 * np.array([0.01, 0.05, -0.02]), rtol=1e-12)


@OTHER_FIELDS
def test_a_gradient_that_grows_with_the_frequency_does_not_pull_at_rest(scenario: Scenario) -> None:
    still = edited("stray_field_gradient", scenario, gradient_T_per_m=(0.0, 0.05, 0.0), frequency_exponent=1.0)
    assert still.surroundings.force_N == (0.0, 0.0, 0.0)
    constant = edited("stray_field_gradient", scenario, gradient_T_per_m=(0.0, 0.05, 0.0))
    assert_allclose(constant.surroundings.force_N, (0.0, 3.2e-11 * 51835.0 * 0.05, 0.0), rtol=1e-12)


def test_an_exponent_without_a_gradient_is_neutral() -> None:
    assert edited("stray_field_gradient", frequency_exponent=2.0) is NOMINAL
    assert edited("magnetization_misalignment", theta2_deg=90.0) is NOMINAL
    assert edited("surface_roughness", wavelength_m=1e-3) is NOMINAL


@OTHER_FIELDS
@pytest.mark.parametrize("name", ["field_rolloff", "field_ellipticity"])
def test_effects_of_rotating_fields_leave_others_as_they_are(name: str, scenario: Scenario) -> None:
    effect = CATALOGUE[name]
    for start in effect.starts(scenario):
        assert effect.from_vector(start).edit(scenario) is scenario


def test_rolloff_grows_with_the_frequency() -> None:
    effect = CATALOGUE["field_rolloff"].from_vector((0.02,))
    for frequency in (1.0, 5.0, 15.0):
        scenario = replace(NOMINAL, field=RotatingField(strength_T=0.01, frequency_Hz=frequency))
        field = effect.edit(scenario).field
        assert isinstance(field, RotatingField)
        assert field.strength_T == pytest.approx(0.01 / math.sqrt(1.0 + (0.04 * math.pi * frequency) ** 2), rel=1e-14)


def test_a_fluid_drags_as_on_a_sphere() -> None:
    surroundings = edited("viscous_drag", viscosity_Pa_s=1e-3).surroundings
    radius = 0.5 * (8e-4 * 4e-4 * 1e-4) ** (1.0 / 3.0)
    assert surroundings.translational_drag_N_s_per_m == pytest.approx(6e-3 * math.pi * radius, rel=1e-12)
    assert surroundings.rotational_drag_N_m_s == pytest.approx(8e-3 * math.pi * radius**3, rel=1e-12)


def test_roughness_is_a_relief_and_adds_to_one_of_its_wavelength() -> None:
    keys = {"wavelength_m": 1e-3, "cosine_m": (1e-6, 2e-6, 3e-6), "sine_m": (4e-6, 5e-6, 6e-6)}
    once = edited("surface_roughness", **keys)
    assert once.relief == Relief(wavelength_m=1e-3, cosine_m=(1e-6, 2e-6, 3e-6), sine_m=(4e-6, 5e-6, 6e-6))
    twice = edited("surface_roughness", once, **keys).relief
    assert_allclose(twice.sine_m, (8e-6, 1e-5, 1.2e-5), rtol=1e-14)
    longer = replace(NOMINAL, relief=Relief(wavelength_m=1e-3, cosine_m=(1e-6,) * 4, sine_m=(0.0,) * 4))
    assert_allclose(edited("surface_roughness", longer, **keys).relief.cosine_m, (2e-6, 3e-6, 4e-6, 1e-6), rtol=1e-14)
    with pytest.raises(InputError, match=r"surface_roughness\.wavelength_m: found 0\.002, expected 0\.001, that of"):
        edited("surface_roughness", once, cosine_m=(1e-6, 0.0, 0.0))


def test_a_camera_follows_the_shape_or_the_mass() -> None:
    offset_m = np.array([2e-5, -3e-5, 1e-5])
    moved = edited("center_of_mass_offset", offset_m=tuple(offset_m))
    run = simulate(moved)
    turned = Rotation.from_quat(run["orientation"].values, scalar_first=True)
    shape_m = run["position_m"].values - turned.apply(offset_m)
    assert_allclose(run["seen_position_m"], shape_m, atol=1e-17)
    assert run["seen_position_m"].attrs["long_name"].startswith("centre of the body's shape")
    assert "seen_position_m" not in simulate(replace(moved, camera=Camera(tracked_point="centre_of_mass")))
    larger = simulate(replace(moved, camera=Camera(tracked_point="centre_of_mass", scale=2.0)))
    assert_allclose(larger["seen_position_m"][:, :2], 2.0 * run["position_m"][:, :2], rtol=1e-15)
    assert larger["seen_position_m"].attrs["long_name"].startswith("centre of mass")


def test_the_camera_leaves_the_motion_as_it_is() -> None:
    off = {"scale": 1.1, "heading_deg": 90.0, "origin_m": (1e-4, -2e-4), "time_offset_s": 0.05}
    run, seen = simulate(NOMINAL), simulate(edited("camera_calibration", **off))
    assert run["position_m"].values.tobytes() == seen["position_m"].values.tobytes()
    # What it sees stands beside what happened, and nothing where it is as it should be.
    assert "seen_position_m" not in run
    x, y, z = seen["position_m"].values.T
    assert_allclose(seen["seen_position_m"], np.column_stack([1e-4 - 1.1 * y, 1.1 * x - 2e-4, z]), atol=1e-15)
    assert_allclose(seen["seen_time_s"], run["time"] - 0.05, atol=1e-15)
    assert_allclose(np.abs(seen["seen_orientation"].values[0] @ [0.5**0.5, 0.0, 0.0, 0.5**0.5]), 1.0, rtol=1e-12)
