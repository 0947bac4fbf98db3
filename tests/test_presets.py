from __future__ import annotations

import pytest

from tumblers import DRIVES, EXPERIMENTS, ROBOTS, SUBSTRATES, InputError, Model, Scenario, drive, preset_scenario


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_every_experiment_can_be_built_and_survives_toml(name: str) -> None:
    scenario = preset_scenario(name)
    assert Scenario.from_toml(scenario.to_toml()) == scenario


@pytest.mark.parametrize("robot", ROBOTS)
@pytest.mark.parametrize("substrate", SUBSTRATES)
def test_every_robot_goes_on_every_substrate(robot: str, substrate: str) -> None:
    preset_scenario(robot=robot, substrate=substrate, drive="20mT_1Hz").trial()


def test_every_preset_names_its_source() -> None:
    for group in (ROBOTS, SUBSTRATES, DRIVES, EXPERIMENTS):
        for preset in group.values():
            assert preset.source.startswith(("text: ", "released: ", "derived: "))


@pytest.mark.parametrize(("name", "micrometres"), [("spiked_pdms", 1093.4), ("spiked_ends_pdms", 1197.2)])
def test_hull_perimeters_are_those_of_the_text(name: str, micrometres: float) -> None:
    assert ROBOTS[name].value.body().hull_perimeter_m * 1e6 == pytest.approx(micrometres, abs=0.1)


@pytest.mark.parametrize("name", ["spiked", "spiked_ends"])
def test_the_sweeps_constants(name: str) -> None:
    scenario = preset_scenario(name)
    assert scenario.substrate.friction_coefficient == 0.8
    assert scenario.substrate.adhesion_N_per_m2 == 340.115
    assert scenario.substrate.friction_ellipsoid == (1.0, 1.0, 0.1)
    assert (scenario.field.strength_T, scenario.field.frequency_Hz) == (0.02, 1.0)
    assert (scenario.run.duration_s, scenario.run.step_s) == (1.0, 5e-4)
    assert scenario.model.magnetic_torque == "end_of_step"


def test_parts_can_be_replaced() -> None:
    scenario = preset_scenario(
        "cuboid_on_paper", substrate="aluminium", drive=drive(0.02, 3.0), incline_deg=10, model=Model()
    )
    assert scenario.substrate == SUBSTRATES["aluminium"].value
    assert scenario.field.frequency_Hz == 3.0
    assert scenario.run.incline_deg == 10.0


def test_unknown_names_get_one_line() -> None:
    with pytest.raises(InputError, match="experiment: found 'cube', expected one of spiked, "):
        preset_scenario("cube")
    with pytest.raises(InputError, match="substrate: found 'ice', expected one of paper, "):
        preset_scenario("spiked", substrate="ice")
    with pytest.raises(InputError, match="substrate: found nothing"):
        preset_scenario(robot="cuboid")
