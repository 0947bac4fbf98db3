from __future__ import annotations

import math
import tempfile
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import tumblers
from tumblers import (
    Cuboid,
    Curved,
    Ellipsoid,
    Hull,
    Initial,
    InputError,
    Model,
    Robot,
    RotatingField,
    Run,
    Scenario,
    Spiked,
    SpikedEnds,
    StaticField,
    Substrate,
    TableField,
)


def lengths(low: float = 1e-5, high: float = 1e-3) -> st.SearchStrategy[float]:
    return st.floats(low, high)


def spiked(length: float, base: float, height: float, over: float, width: float) -> Spiked:
    return Spiked(
        length_m=length, width_m=width, height_m=height, spike_base_m=base * length, overall_height_m=height * over
    )


def spiked_ends(length: float, base: float, height: float, over: float, width: float) -> SpikedEnds:
    return SpikedEnds(
        length_m=length,
        width_m=width,
        height_m=height,
        spike_base_m=0.5 * base * length,
        spike_height_m=0.5 * height * (over - 1.0),
    )


def curved(outer: float, ratio: float, angle: float, width: float) -> Curved:
    return Curved(width_m=width, outer_radius_m=outer, inner_radius_m=ratio * outer, half_angle_deg=angle)


def octahedron(x: float, y: float, z: float) -> Hull:
    return Hull(vertices_m=((x, 0, 0), (-x, 0, 0), (0, y, 0), (0, -y, 0), (0, 0, z), (0, 0, -z)))


BAR = (lengths(4e-4, 1e-3), st.floats(0.1, 0.45), lengths(5e-5, 2e-4), st.floats(1.5, 4.0), lengths(1e-4))
# Wide enough for a draft of 1° over the greatest width.
DRAFTABLE = st.one_of(
    st.builds(Cuboid, length_m=lengths(1e-4), width_m=lengths(), height_m=lengths(1e-4)),
    st.builds(spiked, *BAR),
    st.builds(spiked_ends, *BAR),
    st.builds(curved, lengths(5e-4), st.floats(0.5, 0.8), st.floats(20.0, 60.0), lengths()),
)
UNDRAFTED = st.one_of(
    st.builds(octahedron, lengths(1e-4), lengths(1e-4), lengths(1e-4)),
    st.builds(Ellipsoid, semi_axes_m=st.tuples(lengths(1e-4), lengths(1e-4), lengths(1e-4))),
)
UNIT = st.floats(-1.0, 1.0)
DIRECTION = st.tuples(UNIT, UNIT, UNIT).filter(lambda v: math.hypot(*v) > 1e-3)
MAGNETIZATION = st.one_of(
    st.just({}),
    st.fixed_dictionaries({"magnetization_axis": DIRECTION}),
    st.fixed_dictionaries({"theta1_deg": st.floats(-180, 180)}, optional={"theta2_deg": st.floats(-400, 400)}),
)
MASS = st.fixed_dictionaries({"mass_kg": st.floats(1e-9, 1e-7)}, optional={"density_kg_per_m3": st.floats(500, 9000)})


@st.composite
def robots(draw: st.DrawFn) -> Robot:
    drafted = draw(st.booleans())
    return Robot(
        shape=draw(DRAFTABLE if drafted else UNDRAFTED),
        magnetization_A_per_m=draw(st.floats(0, 1e5)),
        magnetic_volume_m3=draw(st.none() | st.floats(0, 1e-10)),
        draft_deg=draw(st.floats(0, 1.0)) if drafted else 0.0,
        draft_model=draw(st.sampled_from(["geometric", "as_released"])),
        **draw(MASS | st.fixed_dictionaries({"density_kg_per_m3": st.floats(500, 9000)})),
        **draw(MAGNETIZATION),
    )


@st.composite
def rotating(draw: st.DrawFn) -> RotatingField:
    b = draw(DIRECTION)
    other = draw(DIRECTION)
    a = (b[1] * other[2] - b[2] * other[1], b[2] * other[0] - b[0] * other[2], b[0] * other[1] - b[1] * other[0])
    if math.hypot(*a) < 1e-3:
        return RotatingField(strength_T=draw(st.floats(0, 0.1)), frequency_Hz=draw(st.floats(0.1, 50)))
    return RotatingField(
        strength_T=draw(st.floats(0, 0.1)),
        frequency_Hz=draw(st.floats(0.1, 50)),
        rotation_axis=a,
        initial_direction=b,
    )


TABLE = st.lists(st.tuples(UNIT, UNIT, UNIT), min_size=2, max_size=6).map(
    lambda rows: TableField(time_s=tuple(range(len(rows))), field_T=rows)
)
FIELD = rotating() | st.builds(StaticField, strength_T=st.floats(0, 0.1), direction=DIRECTION) | TABLE
QUATERNION = (
    st.tuples(UNIT, UNIT, UNIT, UNIT)
    .filter(lambda q: math.hypot(*q) > 1e-3)
    .map(lambda q: tuple(component / math.hypot(*q) for component in q))
)
VELOCITY = st.tuples(UNIT, UNIT, UNIT)
SCENARIO = st.builds(
    Scenario,
    robot=robots(),
    substrate=st.builds(
        Substrate,
        friction_coefficient=st.floats(0, 2),
        friction_ellipsoid=st.tuples(st.floats(0.1, 2), st.floats(0.1, 2), st.floats(1e-5, 0.2)),
        adhesion_N_per_m2=st.floats(0, 400),
        electrostatic_force_N=st.floats(0, 1e-5),
        line_contact_width_m=st.floats(0, 1e-5),
    ),
    field=FIELD,
    run=st.builds(
        Run,
        duration_s=st.floats(0.01, 1.0),
        step_s=st.floats(1e-5, 1e-3),
        incline_deg=st.floats(-89, 89),
        gravity_m_per_s2=st.floats(0, 20),
    ),
    model=st.builds(
        Model,
        magnetic_torque=st.sampled_from(["end_of_step", "midpoint"]),
        adhesion_acts_at=st.sampled_from(["ecp", "patch_centroid"]),
        adhesion_enters=st.sampled_from(["normal", "friction_only"]),
    ),
    initial=st.builds(
        Initial,
        position_m=st.none() | st.tuples(UNIT, UNIT, st.floats(0.1, 1.0)),
        orientation=st.none() | QUATERNION,
        linear_velocity_m_per_s=VELOCITY,
        angular_velocity_rad_per_s=VELOCITY,
    ),
)


@settings(deadline=None)
@given(SCENARIO)
def test_a_saved_scenario_loads_as_itself(scenario: Scenario) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scenario.toml"
        scenario.save(path)
        loaded = Scenario.load(path)
        assert loaded == scenario
        assert loaded.to_toml() == path.read_text(encoding="utf-8")
        assert [file.name for file in Path(folder).iterdir()] == ["scenario.toml"]


@given(DIRECTION)
def test_an_axis_is_normalised_once_and_for_all(axis: tuple[float, float, float]) -> None:
    once = StaticField(strength_T=0.01, direction=axis).direction
    assert math.hypot(*once) == pytest.approx(1.0, abs=1e-15)
    assert StaticField(strength_T=0.01, direction=once).direction == once


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


# Each: what to replace, by what, the key that the error names, words that it holds.
REFUSED = [
    ("mass_kg = 3.78e-8", "mass_kg = -1.0", "robot.mass_kg", "-1.0"),
    ("mass_kg = 3.78e-8", "mass_kg = 0", "robot.mass_kg", "greater than 0"),
    ("mass_kg = 3.78e-8", "mass_kg = nan", "robot.mass_kg", "nan"),
    ("mass_kg = 3.78e-8", "mass_kg = inf", "robot.mass_kg", "inf"),
    ("mass_kg = 3.78e-8", "mass_kg = true", "robot.mass_kg", "True"),
    ("mass_kg = 3.78e-8", 'mass_kg = "heavy"', "robot.mass_kg", "'heavy'"),
    ("mass_kg = 3.78e-8", "mass_kg = 1979-05-27", "robot.mass_kg", "a finite number"),
    ("mass_kg = 3.78e-8", "mass_kg = 1" + "0" * 400, "robot.mass_kg", "a finite number"),
    ("mass_kg = 3.78e-8\n", "", "robot.mass_kg", "nothing"),
    ("length_m = 8.0e-4", "length_m = 0.0", "robot.length_m", "0.0"),
    ("length_m = 8.0e-4\n", "", "robot.length_m", "nothing"),
    ("[robot]", '[robot]\ncolour = "red"', "robot.colour", "unknown key"),
    ("[robot]", "[robot]\nspike_base_m = 1e-5", "robot.spike_base_m", "unknown key"),
    ("[robot]", "[robot]\n'a\\nb' = 1", "robot.", "unknown key"),
    ('shape = "cuboid"', 'shape = "sphere"', "robot.shape", "'sphere'"),
    ('shape = "cuboid"\n', "", "robot.shape", "nothing"),
    ("magnetization_A_per_m = 15000\n", "", "robot.magnetization_A_per_m", "nothing"),
    ("magnetization_axis = [0.0, 1.0, 0.0]", "magnetization_axis = [0, 0, 0]", "robot.magnetization_axis", "not zero"),
    ("magnetization_axis = [0.0, 1.0, 0.0]", "magnetization_axis = [0, 1]", "robot.magnetization_axis", "[0, 1]"),
    ("magnetization_axis = [0.0, 1.0, 0.0]", "magnetization_axis = 1", "robot.magnetization_axis", "3 numbers"),
    ("magnetization_axis = [0.0,", "theta1_deg = 1\nmagnetization_axis = [0.0,", "robot.theta1_deg", "not both"),
    ("magnetization_axis = [0.0, 1.0, 0.0]", "theta2_deg = 1", "robot.theta1_deg", "theta2_deg"),
    ("[robot]", "[robot]\ndraft_deg = -1", "robot.draft_deg", "at least 0"),
    ("[robot]", "[robot]\ndraft_deg = 80", "robot.draft_deg", "draft"),
    ("[robot]", '[robot]\ndraft_model = "drawn"', "robot.draft_model", "geometric or as_released"),
    ("friction_coefficient = 0.3", "friction_coefficient = -0.3", "substrate.friction_coefficient", "-0.3"),
    ("friction_coefficient = 0.3\n", "", "substrate.friction_coefficient", "nothing"),
    ("[1.0, 1.0, 0.1]", "[1.0, 1.0, 0.0]", "substrate.friction_ellipsoid[2]", "greater than 0"),
    ("[1.0, 1.0, 0.1]", "[1.0, 1.0, false]", "substrate.friction_ellipsoid[2]", "False"),
    ("[substrate]", "[substrate]\nmu = 1", "substrate.mu", "unknown key"),
    ('kind = "rotating"', 'kind = "wobbling"', "field.kind", "rotating or static or table"),
    ('kind = "rotating"\n', "", "field.kind", "nothing"),
    ("frequency_Hz = 5", "frequency_Hz = 0", "field.frequency_Hz", "greater than 0"),
    ("frequency_Hz = 5\n", "", "field.frequency_Hz", "nothing"),
    ("frequency_Hz = 5", "frequency_Hz = 5\nrotation_axis = [0, 1, 0]", "field.initial_direction", "right angles"),
    ("frequency_Hz = 5", "frequency_Hz = 5\nrotation_axis = [0, 0, 0]", "field.rotation_axis", "not zero"),
    ("frequency_Hz = 5", "direction = [0, 0, 1]", "field.direction", "unknown key"),
    ("step_s = 5.0e-4", "step_s = 0", "run.step_s", "greater than 0"),
    ("step_s = 5.0e-4\n", "", "run.step_s", "nothing"),
    ("step_s = 5.0e-4", "step_s = [1]", "run.step_s", "a finite number"),
    ("duration_s = 0.25", "duration_s = -1", "run.duration_s", "-1"),
    ("duration_s = 0.25", "duration_s = 1e9", "run.duration_s", "steps"),
    ("[run]\n", "[[run]]\n", "run", "a table"),
    ("[run]", "effect = [1]\n[run]", "field.effect", "unknown key"),
    ("step_s = 5.0e-4", "step_s = 5.0e-4\noutput_every_s = 7e-4", "run.output_every_s", "multiple"),
    ("step_s = 5.0e-4", "step_s = 5.0e-4\noutput_every_s = 1e-5", "run.output_every_s", "multiple"),
    ("step_s = 5.0e-4", "step_s = 5.0e-4\nincline_deg = 90", "run.incline_deg", "less than 90"),
    ("[run]", "[model]\nmagnetic_torque = 'later'\n[run]", "model.magnetic_torque", "end_of_step or start_of_step"),
    ("[run]", "[model]\nsolver = 'x'\n[run]", "model.solver", "unknown key"),
    ("[run]", "[initial]\norientation = [1, 1, 0, 0]\n[run]", "initial.orientation", "length 1"),
    ("[run]", "[initial]\norientation = [1, 0, 0]\n[run]", "initial.orientation", "4 numbers"),
    ("[run]", "[initial]\nposition_m = [0, 0, -1]\n[run]", "initial.position_m", "substrate"),
    ("[run]", "[[effect]]\nname = 'viscous_drag'\n[run]", "effect[0].name", "not available in this version"),
    ("[run]", "[[effect]]\n[run]", "effect[0].name", "nothing"),
    ("[run]", "[effect]\n[run]", "effect", "array of tables"),
    ("[run]", "[camera]\n[run]", "camera", "unknown key"),
    ("[run]", "[run", None, "malformed TOML"),
    ("tumblers-scenario/1", "tumblers-scenario/2", "format", "tumblers-scenario/1"),
    ('format = "tumblers-scenario/1"\n', "", "format", "nothing"),
    ("[robot]", "robot = 1\n[robots]", "robots", "unknown key"),
]


@pytest.mark.parametrize(("old", "new", "key", "words"), REFUSED)
def test_bad_input_gets_one_line(
    scenario_file: Path, text: str, old: str, new: str, key: str | None, words: str
) -> None:
    assert text.count(old) >= 1
    scenario_file.write_text(text.replace(old, new, 1))
    with pytest.raises(InputError) as caught:
        Scenario.load(scenario_file)
    error = caught.value
    line = str(error)
    assert "\n" not in line
    assert line.startswith(f"{scenario_file}: ")
    assert error.key == key or (error.key or "").startswith(key or "!")
    assert words in line
    assert "found " in line
    assert ", expected " in line
    assert len(line) < 500 + len(str(scenario_file))


HULL = """shape = "hull"
vertices_m = {vertices}
"""
CUBOID = """shape = "cuboid"
length_m = 8.0e-4
width_m = 4.0e-4
height_m = 1.0e-4
"""
CORNERS = [[x, y, z] for x in (-1e-4, 1e-4) for y in (-2e-4, 2e-4) for z in (-1e-4, 1e-4)]


@pytest.mark.parametrize(
    ("vertices", "key", "words"),
    [
        ([], "robot.vertices_m", "no points"),
        ([[0, 0, 0], [1e-4, 0, 0], [0, 1e-4, 0]], "robot.vertices_m", "3 distinct points"),
        ([[0, 0, 0], [1e-4, 0, 0], [0, 1e-4, 0], [0, 0, 0]], "robot.vertices_m", "3 distinct points"),
        ([[0, 0, 0], [1e-4, 0, 0], [0, 1e-4, 0], [1e-4, 1e-4, 0]], "robot.vertices_m", "flat"),
        ([[0, 0], [1e-4, 0], [0, 1e-4], [1e-4, 1e-4]], "robot.vertices_m[0]", "3 numbers"),
        ([*CORNERS, [0, 0, 1e-6]], "robot.vertices_m[8]", "convex"),
        ([[x + 1e-3, y, z] for x, y, z in CORNERS], "robot.vertices_m", "outside the hull"),
    ],
)
def test_bad_hulls_get_one_line(text: str, vertices: list[list[float]], key: str, words: str) -> None:
    assert CUBOID in text
    with pytest.raises(InputError, match="found") as caught:
        Scenario.from_toml(text.replace(CUBOID, HULL.format(vertices=vertices)))
    assert caught.value.key == key
    assert words in str(caught.value)


def test_a_good_hull_is_welcome(text: str) -> None:
    scenario = Scenario.from_toml(text.replace(CUBOID, HULL.format(vertices=CORNERS)))
    assert scenario.robot.body().volume_m3 == pytest.approx(1.6e-11, rel=1e-12)


def test_a_hull_takes_no_draft(text: str) -> None:
    with pytest.raises(InputError, match=r"robot\.draft_deg: found a draft of the shape hull"):
        Scenario.from_toml(text.replace(CUBOID, HULL.format(vertices=CORNERS) + "draft_deg = 1.0\n"))


def test_a_step_beyond_the_stability_bound_is_refused_with_the_numbers(text: str) -> None:
    explicit = text + '\n[model]\nmagnetic_torque = "start_of_step"\n'
    Scenario.from_toml(explicit)
    with pytest.raises(InputError, match=r"run\.step_s: found 0\.01, expected less than 0\.001") as caught:
        Scenario.from_toml(explicit.replace("step_s = 5.0e-4", "step_s = 0.01"))
    assert "start_of_step" in str(caught.value)


def test_missing_files_and_folders_get_one_line(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nowhere\.toml: found no such file, expected a tumblers-scenario/1 file"):
        Scenario.load(tmp_path / "nowhere.toml")
    with pytest.raises(InputError, match="found is a directory"):
        Scenario.load(tmp_path)
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="UTF-8"):
        Scenario.load(tmp_path / "binary.toml")


def with_table(text: str, csv: str = "field.csv") -> str:
    return text.replace('kind = "rotating"\nstrength_T = 0.010\nfrequency_Hz = 5', f'kind = "table"\ncsv = "{csv}"')


ROWS = "time_s,Bx_T,By_T,Bz_T\n0,0,0.01,0\n0.1,0,0,0.01\n0.5,0,-0.01,0\n"


def test_a_table_travels_with_its_scenario(scenario_file: Path, text: str, tmp_path: Path) -> None:
    (tmp_path / "field.csv").write_text(ROWS)
    scenario_file.write_text(with_table(text))
    scenario = Scenario.load(scenario_file)
    assert scenario.field == TableField(
        time_s=(0.0, 0.1, 0.5), field_T=((0.0, 0.01, 0.0), (0.0, 0.0, 0.01), (0.0, -0.01, 0.0))
    )
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    scenario.save(elsewhere / "saved.toml")
    (tmp_path / "field.csv").unlink()
    assert Scenario.load(elsewhere / "saved.toml") == scenario


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        (None, "No such file"),
        ("", "columns"),
        ("time_s,Bx_T,By_T\n0,0,0\n", "columns"),
        (ROWS.replace("Bz_T", "B_T"), "columns"),
        ("time_s,Bx_T,By_T,Bz_T\n0,0,0,0\n", "1 rows"),
        (ROWS.replace("0.1,0,0,0.01", "0.1,0,0"), "line 3 with 3 cells"),
        (ROWS.replace("0.1,0,0,0.01", "0.1,0,x,0.01"), "line 3: By_T 'x'"),
        (ROWS.replace("0.1,0,0,0.01", "0.1,0,nan,0.01"), "finite"),
        (ROWS.replace("0.1,", "0.6,"), "line 4"),
        (ROWS.replace("0.5,", "0.2,"), "cover 0 s to 0.25 s"),
        (ROWS.replace("\n0,", "\n0.01,"), "cover 0 s to 0.25 s"),
    ],
)
def test_bad_tables_get_one_line(scenario_file: Path, text: str, tmp_path: Path, rows: str | None, words: str) -> None:
    if rows is not None:
        (tmp_path / "field.csv").write_text(rows)
    scenario_file.write_text(with_table(text))
    with pytest.raises(InputError) as caught:
        Scenario.load(scenario_file)
    line = str(caught.value)
    assert "\n" not in line
    assert line.startswith(f"{scenario_file}: field.")
    assert words in line


def test_errors_form_one_tree() -> None:
    assert issubclass(InputError, tumblers.TumblersError)
    assert issubclass(tumblers.SimulationError, tumblers.TumblersError)
    with pytest.raises(tumblers.TumblersError, match=r"robot: found 1, expected a Robot"):
        Scenario(robot=1, substrate=None, field=None, run=None)  # type: ignore[arg-type]
