from __future__ import annotations

import math
import re
import tomllib
from dataclasses import FrozenInstanceError, fields, replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from tumblers import InputError, Scenario, StaticField, preset_scenario, simulate
from tumblers.effects import CATALOGUE, Effect, effects_from_tables, get
from tumblers.effects.description import describe

# The contract's table, in its order.
NAMES = [
    "magnetization_misalignment",
    "magnetization_strength",
    "draft_angle",
    "size_error",
    "center_of_mass_offset",
    "friction_coefficient",
    "friction_anisotropy",
    "adhesion_coefficient",
    "line_contact_adhesion",
    "electrostatic_force",
    "stray_field_gradient",
    "field_rolloff",
    "field_ellipticity",
    "substrate_tilt",
    "eddy_current_drag",
    "viscous_drag",
    "surface_roughness",
    "contact_compliance",
    "camera_calibration",
]

ROLLING = preset_scenario("cuboid_on_paper", duration_s=0.4, incline_deg=5.0)
STATIC = replace(ROLLING, field=StaticField(strength_T=0.005, direction=(0.0, 0.0, 1.0)))
# Flat on its face and held there, on a slope along both axes that is too steep for it.
SLIDING = replace(
    ROLLING,
    field=StaticField(strength_T=0.001, direction=ROLLING.robot.magnetic_axis),
    substrate=replace(ROLLING.substrate, electrostatic_force_N=1e-8),
    run=replace(ROLLING.run, duration_s=0.05, incline_deg=40.0, side_incline_deg=25.0),
)
# Here the robot slides as it turns over its edges.
SLIPPING = preset_scenario("cuboid_up_aluminium", duration_s=0.6, incline_deg=35.0)
# Over its long edges, towards +x.
SIDEWAYS = replace(
    ROLLING,
    robot=ROLLING.robot.with_magnetization(90.0, 90.0),
    field=replace(ROLLING.field, rotation_axis=(0.0, 1.0, 0.0), initial_direction=(1.0, 0.0, 0.0)),
)

# Where an effect is at work; all the others are in ROLLING.
AT_WORK = {
    "friction_coefficient": SLIDING,
    "friction_anisotropy": SLIDING,
    "adhesion_coefficient": SLIDING,
    "electrostatic_force": SLIDING,
    "line_contact_adhesion": SLIPPING,
    "center_of_mass_offset.offset_m[0]": SIDEWAYS,
}

EVERY = pytest.mark.parametrize("effect", list(CATALOGUE.values()), ids=list(CATALOGUE))
PARAMETERS = [(effect, i) for effect in CATALOGUE.values() for i in range(len(effect.parameters))]


def seen(scenario: Scenario) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    run = simulate(scenario)
    if "seen_time_s" not in run:
        return run["position_m"].values, run["orientation"].values
    # The camera looks at other times.
    place, turned = (
        np.column_stack([np.interp(run["time"], run["seen_time_s"], column) for column in run[name].values.T])
        for name in ("seen_position_m", "seen_orientation")
    )
    return place, turned / np.linalg.norm(turned, axis=1)[:, None]


def moved_apart(one: Scenario, other: Scenario) -> bool:
    # A tenth of what a lab's camera sees: 3 µm and 1°.
    positions, orientations = zip(seen(one), seen(other), strict=True)
    angle = 2.0 * np.arccos(np.clip(np.abs(np.sum(orientations[0] * orientations[1], axis=-1)), 0.0, 1.0))
    return bool(np.abs(positions[0] - positions[1]).max() > 3e-7 or angle.max() > math.radians(0.1))


def test_the_catalogue_is_the_contract() -> None:
    assert list(CATALOGUE) == NAMES
    assert all(effect.name == name for name, effect in CATALOGUE.items())


@EVERY
@pytest.mark.parametrize("scenario", [ROLLING, STATIC], ids=["rotating", "static"])
def test_a_neutral_effect_changes_no_bit(effect: type[Effect], scenario: Scenario) -> None:
    neutral = effect()
    assert neutral.is_neutral()
    assert neutral.edit(scenario) is scenario
    short = replace(scenario, run=replace(scenario.run, duration_s=0.1))
    nominal, edited = simulate(short), simulate(replace(short, effects=(neutral,)))
    for name in nominal.variables:
        assert nominal[name].values.tobytes() == edited[name].values.tobytes(), name


@pytest.mark.parametrize(
    ("effect", "index"), PARAMETERS, ids=[f"{e.name}-{e.parameters[i].key}" for e, i in PARAMETERS]
)
def test_each_parameter_moves_what_is_observed(effect: type[Effect], index: int) -> None:
    key = effect.parameters[index].key
    scenario = AT_WORK.get(f"{effect.name}.{key}", AT_WORK.get(effect.name, ROLLING))
    start = effect.starts(scenario)[0]
    low, high = effect.ranges(scenario)[index]
    moved = (*start[:index], low + 0.75 * (high - low), *start[index + 1 :])
    assert moved != start
    one, other = (replace(scenario, effects=(effect.from_vector(values),)) for values in (start, moved))
    assert moved_apart(one, other)


@EVERY
def test_a_fit_starts_within_the_range_and_moves_what_is_observed(effect: type[Effect]) -> None:
    scenario = AT_WORK.get(effect.name, ROLLING)
    ranges = effect.ranges(scenario)
    starts = effect.starts(scenario)
    assert 2 <= len(starts) <= 10
    assert len(set(starts)) == len(starts)
    for start in starts:
        assert not effect.from_vector(start).is_neutral()
        assert all(low <= value <= high for (low, high), value in zip(ranges, start, strict=True))
    assert any(moved_apart(scenario, replace(scenario, effects=(effect.from_vector(start),))) for start in starts)


@EVERY
def test_a_search_over_the_beginnings_starts_within_the_range(effect: type[Effect]) -> None:
    scenario = AT_WORK.get(effect.name, ROLLING)
    starts = effect.close_starts(scenario)
    assert len(set(starts)) == len(starts) >= len(effect.starts(scenario))
    for start in starts:
        assert not effect.from_vector(start).is_neutral()
        assert all(low <= value <= high for (low, high), value in zip(effect.ranges(scenario), start, strict=True))


@EVERY
@pytest.mark.parametrize("end", [0, 1], ids=["low", "high"])
def test_the_ends_of_the_ranges_can_be_run(effect: type[Effect], end: int) -> None:
    for scenario in (ROLLING, STATIC):
        values = [ends[end] for ends in effect.ranges(scenario)]
        replace(scenario, effects=(effect.from_vector(values),)).trial()


@EVERY
def test_the_definition_is_complete(effect: type[Effect]) -> None:
    text = " ".join((effect.__doc__ or "").split())
    for f in fields(effect):
        assert re.search(rf"\b{f.name}\b", text), f.name
    for words in ("neutral", "plausible" if effect.name != "eddy_current_drag" else "searched", "Not modelled"):
        assert words in text
    assert effect.source
    assert f"Source: {effect.source}. Attributes" in text
    for p in effect.parameters:
        assert p.unit
        assert p.meaning
        assert p.low <= p.neutral <= p.high


@EVERY
def test_a_vector_is_the_effect(effect: type[Effect]) -> None:
    for start in effect.starts(ROLLING):
        assert effect.from_vector(start).vector() == start
    with pytest.raises(InputError, match=f"{effect.name}: found 0 values"):
        effect.from_vector(())


@EVERY
def test_an_effect_survives_the_scenario_file(effect: type[Effect], tmp_path: Path) -> None:
    one = effect.from_vector(effect.starts(ROLLING)[-1])
    scenario = replace(ROLLING, effects=(one, effect()))
    scenario.save(tmp_path / "scenario.toml")
    loaded = Scenario.load(tmp_path / "scenario.toml")
    assert loaded == scenario
    assert loaded.effects == (one, effect())
    assert effects_from_tables([one.to_table()]) == (one,)


@EVERY
def test_an_effect_cannot_be_changed(effect: type[Effect]) -> None:
    with pytest.raises((FrozenInstanceError, AttributeError)):
        setattr(effect(), effect.parameters[0].field, 1.0)


@EVERY
@pytest.mark.parametrize("wrong", [math.nan, math.inf, "1", None, True])
def test_a_wrong_value_is_refused_by_its_key(effect: type[Effect], wrong: object) -> None:
    for f in fields(effect):
        default = f.default
        value = (wrong, *default[1:]) if isinstance(default, tuple) else wrong
        key = f"effect[1].{f.name}" + ("[0]" if isinstance(default, tuple) else "")
        with pytest.raises(InputError) as error:
            effects_from_tables([{"name": "friction_coefficient"}, {"name": effect.name, f.name: value}])
        assert error.value.key == key
        assert "\n" not in str(error.value)


@EVERY
def test_a_list_of_another_length_is_refused(effect: type[Effect]) -> None:
    for f in fields(effect):
        wrong: object = 0.0 if isinstance(f.default, tuple) else (0.0,)
        for value in (wrong, (0.0,) * 5):
            with pytest.raises(InputError) as error:
                effects_from_tables([{"name": effect.name, f.name: value}])
            assert error.value.key == f"effect[0].{f.name}"


@EVERY
def test_a_value_beyond_its_bound_is_refused(effect: type[Effect]) -> None:
    for i, p in enumerate(effect.parameters):
        if p.least is None and p.above is None:
            continue
        values = [parameter.neutral for parameter in effect.parameters]
        values[i] = -1e-9 if p.above is None else p.above
        with pytest.raises(InputError, match=re.escape(f"{effect.name}.{p.key}: found")):
            effect.from_vector(values)


@pytest.mark.parametrize(
    ("tables", "message"),
    [
        ({"name": "draft_angle"}, "effect: found {'name': 'draft_angle'}, expected an array of tables"),
        (["draft_angle"], "effect[0]: found 'draft_angle', expected a table"),
        ([{}], "effect[0].name: found no such key, expected an effect's name"),
        ([{"name": 3}], "effect[0].name: found 3, expected an effect's name"),
        ([{"name": "draft_angel"}], "effect[0].name: found 'draft_angel' (did you mean draft_angle?), expected one of"),
        ([{"name": "draft_angle", "draft": 1}], "effect[0].draft: found an unknown key (did you mean draft_deg?)"),
        ([{"name": "draft_angle", "parameters": 1}], "effect[0].parameters: found an unknown key"),
    ],
)
def test_a_wrong_table_is_refused(tables: object, message: str) -> None:
    with pytest.raises(InputError) as error:
        effects_from_tables(tables)
    assert str(error.value).startswith(message)
    assert "\n" not in str(error.value)


def test_a_name_is_looked_up() -> None:
    assert get("draft_angle") is CATALOGUE["draft_angle"]
    with pytest.raises(InputError, match=r"effect\.name: found 'wind', expected one of magnetization_misalignment"):
        get("wind")


def test_effects_act_in_their_order_and_together() -> None:
    double, add = CATALOGUE["friction_coefficient"](factor=2.0), CATALOGUE["substrate_tilt"](slope_y_deg=2.0)
    effective = replace(ROLLING, effects=(double, add, double)).effective()
    assert effective.substrate.friction_coefficient == 4.0 * ROLLING.substrate.friction_coefficient
    assert effective.run.incline_deg == ROLLING.run.incline_deg + 2.0
    assert effective.effects == ()


@pytest.mark.parametrize("name", NAMES)
def test_a_description_has_what_it_is_its_numbers_and_a_table_that_loads(name: str) -> None:
    effect = CATALOGUE[name]
    text = describe(effect)
    assert effect.source.split()[0] in text
    assert text.count("```text\n") == 1
    assert "Attributes" not in text
    for parameter in effect.parameters:
        assert f"| `{parameter.key}` | {parameter.meaning} |" in text
    table = re.search(r"```toml\n(.*?)```", text, re.DOTALL)
    assert table is not None
    (loaded,) = effects_from_tables(tomllib.loads(table[1])["effect"])
    assert isinstance(loaded, effect)
    assert loaded.is_neutral()
