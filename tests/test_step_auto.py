"""`step_s = "auto"`, or no step at all: in a file, in Python, and in every command that takes a scenario."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

import tumblers
from tumblers import InputError, Model, Run, Scenario, choose_step, preset_scenario
from tumblers.blind.world import watch
from tumblers.commands import app

from .chosen_step import TORQUES, rolling, same_rows

# The file


def test_auto_goes_through_a_file(scenario_file: Path, text: str) -> None:
    scenario = Scenario.from_toml(text.replace("step_s = 5.0e-4", 'step_s = "auto"'))
    assert scenario.run.step_s == "auto"
    assert 'step_s = "auto"' in scenario.to_toml()
    assert Scenario.from_toml(scenario.to_toml()) == scenario
    scenario.save(scenario_file)
    assert Scenario.load(scenario_file) == scenario


@pytest.mark.parametrize(
    ("old", "new", "key", "words"),
    [
        ("5.0e-4", '"sometimes"', "run.step_s", "found 'sometimes', expected 'auto' or a finite number greater than 0"),
        ("5.0e-4", '"AUTO"', "run.step_s", "found 'AUTO', expected 'auto' or a finite number"),
        ("5.0e-4", '""', "run.step_s", "found '', expected 'auto'"),
        ("5.0e-4", '"auto"\noutput_every_s = 0.3', "run.output_every_s", "at most duration_s, which is 0.25"),
        ("5.0e-4", '"auto"\noutput_every_s = -1', "run.output_every_s", "greater than 0"),
        ("5.0e-4", '"auto"\nside_incline_deg = 90', "run.side_incline_deg", "less than 90"),
        # What only the parts together show is still refused before anything runs.
        ("5.0e-4", '"auto"\n[initial]\nposition_m = [0, 0, -1]', "initial.position_m", "substrate"),
    ],
)
def test_another_word_is_refused_in_one_line(
    scenario_file: Path, text: str, old: str, new: str, key: str, words: str
) -> None:
    scenario_file.write_text(text.replace(f"step_s = {old}", f"step_s = {new}"))
    with pytest.raises(InputError) as caught:
        Scenario.load(scenario_file)
    line = str(caught.value)
    assert line.startswith(f"{scenario_file}: {key}: found ")
    assert words in line
    assert "\n" not in line


# What is meant where nothing is stated


def test_a_file_that_leaves_out_the_step_has_one_chosen_at_the_midpoint(text: str) -> None:
    bare = text.replace("step_s = 5.0e-4\n", "")
    scenario = Scenario.from_toml(bare)
    assert scenario.run.step_s == "auto"
    assert scenario.model == Model(magnetic_torque="midpoint")
    assert scenario == Scenario.from_toml(f'{bare}step_s = "auto"\n')
    assert Scenario.from_toml(scenario.to_toml()) == scenario
    assert 'magnetic_torque = "midpoint"' in scenario.to_toml()


def test_a_file_with_a_number_means_what_it_always_meant(text: str) -> None:
    scenario = Scenario.from_toml(text)
    assert scenario.run.step_s == 5e-4
    assert scenario.model == Model(magnetic_torque="end_of_step")
    partly = Scenario.from_toml(f'{text}[model]\nadhesion_enters = "friction_only"\n')
    assert partly.model == Model(magnetic_torque="end_of_step", adhesion_enters="friction_only")


@pytest.mark.parametrize("torque", TORQUES)
@pytest.mark.parametrize("step", ["", 'step_s = "auto"\n', "step_s = 2e-4\n"])
def test_a_torque_that_is_stated_stays(text: str, torque: str, step: str) -> None:
    stated = text.replace("step_s = 5.0e-4\n", step) + f'[model]\nmagnetic_torque = "{torque}"\n'
    assert Scenario.from_toml(stated).model.magnetic_torque == torque


def test_python_means_the_same_as_a_file() -> None:
    parts = rolling(5.0)
    made = Scenario(robot=parts.robot, substrate=parts.substrate, field=parts.field, run=Run(duration_s=0.5))
    assert made == parts
    assert preset_scenario("cuboid_on_paper", step_s="auto").model.magnetic_torque == "midpoint"
    assert preset_scenario("cuboid_on_paper").model.magnetic_torque == "end_of_step"
    # What has been set stays set when the step is replaced.
    assert made.at_step(5e-4).model.magnetic_torque == "midpoint"


# Who works with a number


def test_what_needs_a_number_says_so_in_one_line() -> None:
    scenario = rolling(5.0)
    for needs in (
        lambda: scenario.run.steps,
        lambda: scenario.run.output_every and scenario.run.rows,
        scenario.trial,
        lambda: watch(scenario, [], np.array([0.0, 0.1])),
    ):
        with pytest.raises(InputError, match=r"^run\.step_s: found 'auto', expected a number here: choose_step finds"):
            needs()


def test_a_run_that_is_too_long_for_the_steps_is_refused() -> None:
    with pytest.raises(InputError, match=r"^run\.step_s: found 'auto', .* for 1e\+06 s, expected a step"):
        tumblers.simulate(rolling(5.0, duration_s=1e6))


def test_a_sweep_and_the_studies_choose_once() -> None:
    scenario = rolling(10.0, duration_s=0.2)
    chosen = choose_step(scenario)
    number = chosen.scenario
    cases = {"drafts_deg": [0.0, 2.0], "magnetization": [(0.0, 0.0), (10.0, 90.0)]}
    swept, plain = tumblers.sweep(scenario, **cases), tumblers.sweep(number, **cases)  # type: ignore[arg-type]
    assert same_rows(swept, plain)
    assert swept.attrs == {**plain.attrs, **chosen.attributes()}
    climbed = tumblers.climb(scenario, slopes_deg=(0.0, 60.0), resolution_deg=30.0)
    assert climbed.attrs["step_s"] == chosen.step_s
    assert Scenario.from_toml(climbed.attrs["scenario"]).run.step_s == chosen.step_s
    few = {"drafts_deg": (0.0, 2.0), "theta1_deg": (0.0, 10.0), "theta2_deg": (0.0,)}
    borne = tumblers.tolerance(scenario, **few)
    assert borne.attrs["step_met"] == 1
    designed = tumblers.design(scenario, samples=8, generations=0, errors=None)
    assert Scenario.from_toml(designed.attrs["scenario"]).run.step_s == designed.attrs["step_s"] == chosen.step_s


def test_a_sweep_goes_on_from_its_parts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # The function hides the module of its name.
    monkeypatch.setattr(sys.modules["tumblers.sweep"], "_PART_STEPS", 1)
    scenario = rolling(10.0, duration_s=0.2)
    cases = {"drafts_deg": [0.0, 2.0], "magnetization": [(0.0, 0.0)], "parts": tmp_path / "parts"}
    first = tumblers.sweep(scenario, **cases)  # type: ignore[arg-type]
    assert len(list((tmp_path / "parts").glob("drafts-*.nc"))) == 2
    assert same_rows(tumblers.sweep(scenario, **cases), first)  # type: ignore[arg-type]


def test_a_sweep_of_the_command_line_goes_on_from_its_parts_and_removes_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys.modules["tumblers.sweep"], "_PART_STEPS", 1)
    monkeypatch.chdir(tmp_path)
    scenario = rolling(10.0, duration_s=0.2)
    scenario.save("slope.toml")
    tumblers.sweep(scenario, drafts_deg=[0.0, 2.0], magnetization=[(0.0, 0.0)], parts="x.nc.parts")
    (tmp_path / "x.nc.parts" / "drafts-00001.nc").unlink()
    arguments = ["sweep", "--robot", "slope.toml", "--drafts", "0,2", "--theta1", "0", "--out", "x.nc"]
    found = CliRunner().invoke(app, arguments)
    assert found.exit_code == 0, found.output
    assert sorted(path.name for path in tmp_path.iterdir()) == ["slope.toml", "x.nc"]


@pytest.mark.parametrize(
    "arguments",
    [
        ["simulate", "FILE", "--out", "x.nc"],
        ["sweep", "--robot", "FILE", "--drafts", "0,2", "--theta1", "0", "--out", "x.nc"],
        ["climb", "--robot", "FILE", "--slopes", "0,60", "--resolution", "30", "--out", "x.nc"],
        ["tolerance", "--robot", "FILE", "--drafts", "0,2", "--theta1", "0,10", "--theta2", "0", "--out", "x.nc"],
        ["design", "--robot", "FILE", "--samples", "8", "--draws", "8", "--generations", "0", "--out", "x.nc"],
    ],
)
def test_every_command_that_takes_a_scenario_takes_auto(
    arguments: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    rolling(10.0, duration_s=0.2).save("slope.toml")
    found = CliRunner().invoke(app, [word.replace("FILE", "slope.toml") for word in arguments])
    assert found.exit_code == 0, found.output
    assert "µs, chosen" in found.output
    with xr.open_dataset("x.nc", engine="h5netcdf") as held:
        assert held.attrs["step_met"] == 1
    if arguments[0] == "simulate":
        viewed = CliRunner().invoke(app, ["view", "x.nc", "--view", "x.html", "--snapshots", "x.png"])
        assert viewed.exit_code == 0, viewed.output
