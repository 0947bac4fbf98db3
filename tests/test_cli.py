from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import xarray as xr

import tumblers
from tumblers import Scenario, preset_scenario

COMMAND = [sys.executable, "-m", "tumblers"]
SMALL = ["--drafts", "0,2", "--theta1", "0,10", "--theta2", "90:180:90"]


def tumble(*arguments: object, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    command = [*COMMAND, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, cwd=cwd, timeout=120, check=False)


def refused(done: subprocess.CompletedProcess[str]) -> str:
    assert done.returncode == 2, done.stderr
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1
    assert "Traceback" not in done.stderr
    assert done.stderr.startswith("tumblers: ")
    return done.stderr


def test_version() -> None:
    done = tumble("--version")
    assert (done.returncode, done.stdout) == (0, f"tumblers {tumblers.__version__}\n")


@pytest.mark.parametrize("command", [[], ["simulate"], ["sweep"], ["presets"]])
def test_help_has_examples(command: list[str]) -> None:
    done = tumble(*command, "--help")
    assert done.returncode == 0
    assert "Examples:\n" in done.stdout
    assert re.search(r"^ +tumblers ", done.stdout, re.MULTILINE)


def test_simulate_writes_the_run_and_the_figure(scenario_file: Path, tmp_path: Path) -> None:
    done = tumble("simulate", scenario_file, "--out", tmp_path / "run.nc", "--plot", tmp_path / "run.png")
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert "0 unconverged steps" in done.stdout
    with xr.open_dataset(tmp_path / "run.nc", engine="h5netcdf") as run:
        assert Scenario.from_toml(run.attrs["scenario"]) == Scenario.load(scenario_file)
    assert (tmp_path / "run.png").read_bytes().startswith(b"\x89PNG")
    assert {file.name for file in tmp_path.iterdir()} == {"scenario.toml", "run.nc", "run.png"}


@pytest.mark.parametrize("robot", ["spiked", "spiked_ends", "scenario.toml"])
def test_sweep_writes_the_grid_and_the_maps(scenario_file: Path, tmp_path: Path, robot: str) -> None:
    arguments = ("--robot", robot, *SMALL, "--jobs", 2, "--out", "sweep.nc", "--plot", "sweep.svg")
    done = tumble("sweep", *arguments, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert "6 of 6 cases done" in done.stdout
    for words in ("flips: ", "drift within 50 µm", "unconverged steps: 0", "largest residual: ", "time: "):
        assert words in done.stdout
    with xr.open_dataset(tmp_path / "sweep.nc", engine="h5netcdf") as result:
        assert result["draft_deg"].values.tolist() == [0.0, 2.0]
        assert result["theta1_deg"].values.tolist() == [0.0, 10.0, 10.0]
        assert result["theta2_deg"].values.tolist() == [0.0, 90.0, 180.0]
    assert {file.name for file in tmp_path.iterdir()} == {"scenario.toml", "sweep.nc", "sweep.svg"}


def test_a_sweep_with_bad_cases_says_so(tmp_path: Path) -> None:
    done = tumble("sweep", "--robot", "spiked", "--drafts", "0,80", "--theta1", "0", "--out", tmp_path / "sweep.nc")
    assert done.returncode == 0
    assert "1 of 2 cases done" in done.stdout
    assert "failed: 1, the first: robot.draft_deg: " in done.stdout


def test_presets_are_listed_and_printed(tmp_path: Path) -> None:
    listed = tumble("presets").stdout
    for name in ("spiked_ends", "cuboid_second_generation", "paper_released", "10mT_15Hz"):
        assert name in listed
    (tmp_path / "printed.toml").write_text(tumble("presets", "spiked_ends").stdout)
    assert Scenario.load(tmp_path / "printed.toml") == preset_scenario("spiked_ends")
    assert tumble("presets", "aluminium_pdms").stdout.startswith("[substrate]\n")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([], "Missing command"),
        (["fly"], "fly"),
        (["simulate"], "SCENARIO.toml"),
        (["simulate", "scenario.toml"], "--out"),
        (["simulate", "scenario.toml", "--out", "run.nc", "--fast"], "--fast"),
        (["simulate", "nowhere.toml", "--out", "run.nc"], "nowhere.toml: found no such file"),
        (["simulate", "scenario.toml", "--out", "nowhere/run.nc"], "nowhere"),
        (["simulate", "scenario.toml", "--out", "run.txt"], ".nc"),
        (["simulate", "scenario.toml", "--out", "scenario.toml"], "--out"),
        (["simulate", "scenario.toml", "--out", "run.nc", "--plot", "run.bmp"], ".png"),
        (["simulate", "scenario.toml", "--out", "run.nc", "--plot", "nowhere/run.png"], "nowhere"),
        (["simulate", "scenario.toml", "--out", "run.nc", "--solver", "magic"], "magic"),
        (["simulate", "bad.toml", "--out", "run.nc"], "bad.toml: robot.mass_kg: found -1.0, expected"),
        (["simulate", "same.nc", "--out", "./same.nc"], "named twice"),
        (["sweep", "--out", "sweep.nc"], "--robot"),
        (["sweep", "--robot", "cube", "--out", "sweep.nc"], "'cube'"),
        (["sweep", "--robot", "bad.toml", "--out", "sweep.nc"], "bad.toml: robot.mass_kg"),
        (["sweep", "--robot", "spiked", "--drafts", "0:x", "--out", "sweep.nc"], "--drafts"),
        (["sweep", "--robot", "spiked", "--drafts", "5:0", "--out", "sweep.nc"], "--drafts"),
        (["sweep", "--robot", "spiked", "--drafts", "0:1:0", "--out", "sweep.nc"], "--drafts"),
        (["sweep", "--robot", "spiked", "--drafts", "", "--out", "sweep.nc"], "--drafts"),
        (["sweep", "--robot", "spiked", "--theta1", "nan", "--out", "sweep.nc"], "--theta1"),
        (["sweep", "--robot", "spiked", "--theta2", "0:1e9", "--out", "sweep.nc"], "--theta2"),
        (["sweep", "--robot", "spiked", "--jobs", "0", "--out", "sweep.nc"], "--jobs"),
        (["sweep", "--robot", "spiked", "--jobs", "two", "--out", "sweep.nc"], "--jobs"),
        (["sweep", "--robot", "spiked", "--drafts", "80", "--out", "sweep.nc"], "no case"),
        (["presets", "cube"], "'cube'"),
    ],
)
def test_bad_input_gets_one_line_and_writes_nothing(
    scenario_file: Path, tmp_path: Path, arguments: list[str], words: str
) -> None:
    (tmp_path / "bad.toml").write_text(scenario_file.read_text().replace("mass_kg = 3.78e-8", "mass_kg = -1.0"))
    (tmp_path / "same.nc").write_text(scenario_file.read_text())
    before = {file.name: file.read_bytes() for file in tmp_path.iterdir()}
    assert words in refused(tumble(*arguments, cwd=tmp_path))
    assert {file.name: file.read_bytes() for file in tmp_path.iterdir()} == before


@pytest.mark.skipif(os.name == "nt", reason="signals")
@pytest.mark.parametrize("command", ["simulate", "sweep"])
def test_ctrl_c_stops_with_one_line_and_leaves_nothing(scenario_file: Path, tmp_path: Path, command: str) -> None:
    scenario_file.write_text(scenario_file.read_text().replace("duration_s = 0.25", "duration_s = 10000.0"))
    robot = [scenario_file] if command == "simulate" else ["--robot", scenario_file]
    arguments = [*COMMAND, command, *robot, "--out", tmp_path / "out.nc"]
    process = subprocess.Popen(list(map(str, arguments)), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        time.sleep(5.0)
        assert process.poll() is None
        process.send_signal(signal.SIGINT)
        start = time.perf_counter()
        out, err = process.communicate(timeout=30)
        assert time.perf_counter() - start < 10.0
    finally:
        process.kill()
    assert process.returncode == 130
    assert out == ""
    assert err == "tumblers: interrupted, nothing was written\n"
    assert {file.name for file in tmp_path.iterdir()} == {"scenario.toml"}
