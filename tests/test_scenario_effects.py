"""Effects in a scenario, and what their parts do to a run."""

from __future__ import annotations

from dataclasses import replace
from math import radians

import numpy as np
import pytest

from tumblers import InputError, Scenario, preset_scenario, simulate
from tumblers.camera import Camera
from tumblers.effects.catalogue import effects_from_tables
from tumblers.relief import Relief
from tumblers.surroundings import Surroundings

SHORT = preset_scenario("cuboid_on_paper", duration_s=0.1)
TWICE = [{"name": "friction_coefficient", "factor": 2.0}]
TWICE_AND_WIDE = [*TWICE, {"name": "line_contact_adhesion", "width_m": 5e-6}]


def test_effects_edit_in_their_order() -> None:
    scenario = replace(SHORT, effects=effects_from_tables(TWICE_AND_WIDE))
    edited = scenario.effective()
    assert edited.effects == ()
    assert edited.substrate.friction_coefficient == 2.0 * SHORT.substrate.friction_coefficient
    assert edited.substrate.line_contact_width_m == 5e-6
    assert scenario.substrate == SHORT.substrate
    assert SHORT.effective() is SHORT


def test_a_run_with_effects_is_that_of_the_effective_scenario() -> None:
    scenario = replace(SHORT, effects=effects_from_tables(TWICE_AND_WIDE))
    run, edited = simulate(scenario), simulate(scenario.effective())
    assert run.position_m.values.tobytes() == edited.position_m.values.tobytes()
    assert Scenario.from_toml(run.attrs["scenario"]) == scenario


def test_only_effects_are_effects() -> None:
    with pytest.raises(InputError, match=r"^effects\[0\]: found 'drag', expected an Effect"):
        replace(SHORT, effects=("drag",))  # type: ignore[arg-type]


def test_an_effect_that_makes_an_impossible_part_is_refused_on_loading() -> None:
    text = SHORT.to_toml() + "\n[[effect]]\nname = 'center_of_mass_offset'\noffset_m = [0.0, 0.0, 1.0]\n"
    with pytest.raises(InputError, match=r"robot\.center_of_mass_m"):
        Scenario.from_toml(text)


def test_parts_that_say_nothing_change_no_bit() -> None:
    flat = Relief(wavelength_m=1e-3, cosine_m=(0.0, 0.0), sine_m=(0.0, 0.0))
    plain, other = simulate(SHORT), simulate(replace(SHORT, relief=flat, camera=Camera(scale=2.0)))
    for name in plain.variables:
        assert plain[name].values.tobytes() == other[name].values.tobytes(), name


def test_a_force_that_holds_the_weight_is_felt_as_less_weight() -> None:
    weight = SHORT.robot.total_mass_kg * SHORT.run.gravity_m_per_s2
    lifted = simulate(replace(SHORT, surroundings=Surroundings(force_N=(0.0, 0.0, 0.5 * weight))))
    lighter = simulate(replace(SHORT, run=replace(SHORT.run, gravity_m_per_s2=0.5 * SHORT.run.gravity_m_per_s2)))
    np.testing.assert_allclose(lifted.position_m, lighter.position_m, rtol=0.0, atol=1e-12)


def test_a_run_on_a_relief_follows_its_heights() -> None:
    relief = Relief(wavelength_m=8e-3, cosine_m=(0.0,), sine_m=(2e-5,))
    run = simulate(replace(preset_scenario("cuboid_on_paper", duration_s=0.6), relief=relief))
    y, z = run.position_m.values[:, 1], run.position_m.values[:, 2]
    height = 2e-5 * np.sin(2.0 * np.pi * y / 8e-3)
    flat = simulate(preset_scenario("cuboid_on_paper", duration_s=0.6)).position_m.values
    assert run.attrs["unconverged_steps"] == 0
    # The cuboid lies flat at the start of each half turn; it is never below where the relief lets it lie.
    assert (z - height).min() == pytest.approx(flat[:, 2].min(), abs=1e-9)
    assert z.min() < flat[:, 2].min() - 1e-6


def test_a_camera_turns_and_scales_what_it_sees() -> None:
    camera = Camera(scale=2.0, heading_deg=90.0)
    np.testing.assert_allclose(camera.seen_position([[0.0, 1.0, 5.0]]), [[-2.0, 0.0, 5.0]], atol=1e-15)
    half = radians(45.0)
    expected = [[np.cos(half), 0.0, 0.0, np.sin(half)]]
    np.testing.assert_allclose(camera.seen_orientation([[1.0, 0.0, 0.0, 0.0]]), expected, atol=1e-15)
    track = np.random.default_rng(1).normal(size=(5, 3))
    assert Camera().seen_position(track).tobytes() == track.tobytes()
    assert Camera().seen_orientation(track[:4, :2].repeat(2, axis=1)).shape == (4, 4)
