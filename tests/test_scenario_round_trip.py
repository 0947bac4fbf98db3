from __future__ import annotations

import math
import tempfile
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tumblers import (
    Cuboid,
    Curved,
    Ellipsoid,
    Hull,
    Initial,
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
from tumblers.effects.catalogue import CATALOGUE
from tumblers.relief import Relief
from tumblers.surroundings import Surroundings

from .cameras import CAMERAS


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
# Wide enough for a draft of 0.3° over the greatest width, a flat spike too.
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
        draft_deg=draw(st.floats(0, 0.3)) if drafted else 0.0,
        draft_model=draw(st.sampled_from(["geometric", "as_released"])),
        center_of_mass_m=draw(st.tuples(*[st.floats(-1e-6, 1e-6)] * 3)),
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
        quadrature_ratio=draw(st.floats(0, 2)),
        phase_error_deg=draw(st.floats(-90, 90)),
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
AMPLITUDES = st.lists(st.tuples(UNIT, UNIT), max_size=3)
RELIEF = st.builds(
    lambda wavelength, rows: Relief(
        wavelength_m=wavelength, cosine_m=tuple(c for c, _ in rows), sine_m=tuple(s for _, s in rows)
    ),
    st.floats(1e-4, 1.0),
    AMPLITUDES,
)
SURROUNDINGS = st.builds(
    lambda rows, **rest: Surroundings(wrench_time_s=tuple(range(len(rows))), wrench_N_N_m=tuple(rows), **rest),
    st.lists(st.tuples(*[UNIT] * 6), max_size=3),
    force_N=VELOCITY,
    torque_N_m=VELOCITY,
    translational_drag_N_s_per_m=st.floats(0, 1),
    rotational_drag_N_m_s=st.floats(0, 1),
    sheet_conductance_S=st.floats(0, 1e8),
)
NEUTRAL_EFFECTS = st.lists(st.sampled_from(list(CATALOGUE.values())).map(lambda effect: effect()), max_size=3)
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
        compliance_m_per_N=st.floats(0, 30),
        friction_drift_per_s=st.floats(-3, 3),
    ),
    field=FIELD,
    run=st.builds(
        Run,
        duration_s=st.floats(0.01, 1.0),
        step_s=st.floats(1e-5, 1e-3),
        incline_deg=st.floats(-89, 89),
        side_incline_deg=st.floats(-89, 89),
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
    relief=RELIEF,
    surroundings=SURROUNDINGS,
    camera=CAMERAS,
    effects=NEUTRAL_EFFECTS,
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
    # An axis that is a unit vector to rounding is left as it is, so that a saved one loads as itself.
    assert math.hypot(*once) == pytest.approx(1.0, abs=1e-12)
    assert StaticField(strength_T=0.01, direction=once).direction == once
