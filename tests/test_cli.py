from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest
import xarray as xr

import tumblers
from tumblers import Scenario, preset_scenario
from tumblers.effects import CATALOGUE
from tumblers.options import magnetization_cases, numbers

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


@pytest.mark.parametrize("command", [[], ["simulate"], ["sweep"], ["presets"], ["effects"]])
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


@pytest.mark.parametrize("robot", ["spiked", "spiked_ends_pdms", "scenario.toml"])
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
    assert done.stderr.startswith(
        "tumblers: warning: 1 of 2 cases failed, the first: robot.draft_deg: found 80 degrees"
    )
    assert done.stderr.count("\n") == 1


def test_presets_are_listed_and_printed(tmp_path: Path) -> None:
    listed = tumble("presets").stdout
    for name in ("spiked_ends", "cuboid_second_generation", "paper_released", "10mT_15Hz"):
        assert name in listed
    (tmp_path / "printed.toml").write_text(tumble("presets", "spiked_ends").stdout)
    assert Scenario.load(tmp_path / "printed.toml") == preset_scenario("spiked_ends")
    part, section = tumble("presets", "aluminium_pdms").stdout.split("\n")[:2]
    assert part == "# aluminium_pdms: the section [substrate] alone, a part of a scenario and not a whole one"
    assert section == "[substrate]"


def test_effects_are_listed_and_described(tmp_path: Path) -> None:
    listed = tumble("effects").stdout.splitlines()
    assert [line.split()[0] for line in listed] == list(CATALOGUE)
    described = tumble("effects", "stray_field_gradient").stdout
    assert described.startswith("## `stray_field_gradient`\n")
    assert "gradient_T_per_m = [0.0, 0.0, 0.0]" in described
    assert tumble("effects", "--page", tmp_path / "effects.md").stdout == ""
    page = Path(__file__).parents[1] / "docs" / "effects.md"
    # Where this fails, the command writes it again.
    assert (tmp_path / "effects.md").read_text(encoding="utf-8") == page.read_text(encoding="utf-8")


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
        (
            ["simulate", "scenario.toml", "--out", f"{'r' * 240}.nc"],
            "...: file name too long, expected a file that can be",
        ),
        (
            ["simulate", "scenario.toml", "--out", "/proc/run.nc"],
            "--out: found '/proc/run.nc'",
        ),
        (["simulate", "", "--out", "run.nc"], "'SCENARIO.toml': found '', expected a path"),
        (["simulate", "scenario.toml", "--out", "run.nc", "--plot", ""], "'--plot': found '', expected a path"),
        (["simulate", "scenario.toml", "--out", "scenario.toml"], "--out"),
        (["simulate", "scenario.toml", "--out", "run.nc", "--plot", "run.bmp"], ".png"),
        (["simulate", "scenario.toml", "--out", "run.nc", "--plot", "nowhere/run.png"], "nowhere"),
        (["simulate", "scenario.toml", "--out", "run.nc", "--solver", "magic"], "magic"),
        (["simulate", "bad.toml", "--out", "run.nc"], "bad.toml: robot.mass_kg: found -1.0, expected"),
        (
            ["simulate", "long.toml", "--out", "run.nc"],
            "long.toml: run.output_every_s: found 20000001 rows of about 250",
        ),
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
        (
            ["sweep", "--robot", "spiked", "--drafts", "80", "--out", "sweep.nc"],
            "no case could be run, the first: robot.dr",
        ),
        (["presets", "cube"], "'cube'"),
        (["effects", "friction"], "'friction'"),
        (["effects", "size_error", "--page", "effects.md"], "--page"),
        (["simulate", "spiked", "--out", "run.nc"], "`tumblers presets spiked > scenario.toml`"),
    ],
)
def test_bad_input_gets_one_line_and_writes_nothing(
    scenario_file: Path, tmp_path: Path, arguments: list[str], words: str
) -> None:
    (tmp_path / "bad.toml").write_text(scenario_file.read_text().replace("mass_kg = 3.78e-8", "mass_kg = -1.0"))
    long = scenario_file.read_text().replace("duration_s = 0.25", "duration_s = 10000.0")
    (tmp_path / "long.toml").write_text(long)
    (tmp_path / "same.nc").write_text(scenario_file.read_text())
    before = {file.name: file.read_bytes() for file in tmp_path.iterdir()}
    assert words in refused(tumble(*arguments, cwd=tmp_path))
    assert {file.name: file.read_bytes() for file in tmp_path.iterdir()} == before


def test_unconverged_steps_get_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    from tumblers.summary import run_warnings, sweep_warnings

    scenario = preset_scenario("spiked", duration_s=0.01)
    run = tumblers.simulate(scenario)
    assert run_warnings(run) == []
    run.attrs |= {"unconverged_steps": 3, "max_residual": 0.25}
    expected = "3 of 20 steps did not converge (largest residual 2.5e-01): the results there are not solutions"
    assert run_warnings(run) == [expected]
    sweep = tumblers.sweep(scenario, drafts_deg=[0.0, 80.0], magnetization=[(0.0, 0.0)])
    sweep["unconverged_steps"].values[0, 0] = 3
    first, second = sweep_warnings(sweep)
    assert first.startswith("3 of 20 steps did not converge")
    assert second.startswith("1 of 2 cases failed, the first: robot.draft_deg")


def test_shares_of_contact_leave_out_the_start_and_weigh_by_time() -> None:
    from tumblers.summary import run_summary

    scenario = preset_scenario("spiked", duration_s=0.01)
    run = tumblers.simulate(scenario).isel(time=[0, 5, 20])
    run["contact_mode"].values[:] = [0, 1, 3]
    run.attrs |= {"speed_m_per_s": -1e-12, "drift_m": -0.0, "twist_deg": -0.01}
    summary = run_summary(run, 0.0)
    assert "contact: airborne 0%, point 25%, line 0%, surface 75%" in summary
    assert summary.startswith("speed 0.0 µm/s; drift 0.0 µm, twist 0.0° after one cycle")


def test_a_range_goes_through_the_decimals_that_were_typed() -> None:
    assert numbers("--theta2", "-0.3:0.3:0.1") == [-0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3]
    assert numbers("--theta2", "1:2:0.1")[-1] == 2.0


def test_the_papers_grid_stands_once() -> None:
    from tumblers.commands import _DRAFTS, _THETA1, _THETA2

    assert (_DRAFTS, _THETA1, _THETA2) == ("0:15", "0,10", "10:360:10")
    assert tuple(numbers("--drafts", _DRAFTS)) == tumblers.PAPER_DRAFTS_DEG
    cases = magnetization_cases(numbers("--theta1", _THETA1), numbers("--theta2", _THETA2))
    assert tuple(cases) == tumblers.PAPER_MAGNETIZATION_DEG


@pytest.mark.skipif(os.name == "nt", reason="limits")
@pytest.mark.parametrize("limit_kB", [10, 100])
def test_a_full_disk_gets_one_line(scenario_file: Path, tmp_path: Path, limit_kB: int) -> None:
    import resource

    limit = limit_kB * 1024
    scenario_file.write_text(scenario_file.read_text().replace("duration_s = 0.25", "duration_s = 2"))
    done = subprocess.run(
        [*COMMAND, "simulate", "scenario.toml", "--out", "run.nc"],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        check=False,
        env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"},
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)),
    )
    assert (done.returncode, done.stdout) == (1, ""), done.stderr
    assert done.stderr.startswith("tumblers: ")
    assert done.stderr.count("\n") == 1
    assert {file.name for file in tmp_path.iterdir()} == {"scenario.toml"}


INTERRUPTED = "tumblers: interrupted, nothing was written\n"


def hear_interrupts() -> None:
    """Undo what a shell does to the jobs that it starts in the background, the tests among them: it ignores SIGINT."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@pytest.mark.skipif(os.name == "nt", reason="signals")
@pytest.mark.parametrize("command", ["simulate", "sweep"])
def test_ctrl_c_stops_with_one_line_and_leaves_nothing(scenario_file: Path, tmp_path: Path, command: str) -> None:
    long = "duration_s = 10000.0\noutput_every_s = 1.0"
    scenario_file.write_text(scenario_file.read_text().replace("duration_s = 0.25", long))
    robot = [scenario_file] if command == "simulate" else ["--robot", scenario_file]
    arguments = [*COMMAND, command, *robot, "--out", tmp_path / "out.nc"]
    master, terminal = os.openpty()
    environment = os.environ | {"TERM": "xterm", "COLUMNS": "100"}
    process = subprocess.Popen(
        list(map(str, arguments)),
        stdout=subprocess.PIPE,
        stderr=terminal,
        env=environment,
        preexec_fn=hear_interrupts,
    )
    os.close(terminal)
    try:
        written = b""
        while b"steps" not in written and b"cases" not in written:
            written += os.read(master, 4096)
        process.send_signal(signal.SIGINT)
        start = time.perf_counter()
        with suppress(OSError):  # the end of a terminal
            while part := os.read(master, 4096):
                written += part
        assert process.wait(timeout=30) == 130
        assert time.perf_counter() - start < 10.0
    finally:
        process.kill()
        os.close(master)
    assert process.stdout is not None
    assert process.stdout.read() == b""
    process.stdout.close()
    assert written.decode().replace("\r\n", "\n").endswith(INTERRUPTED)
    assert "Traceback" not in written.decode()
    assert {file.name for file in tmp_path.iterdir()} == {"scenario.toml"}


@pytest.mark.skipif(os.name == "nt", reason="signals")
@pytest.mark.parametrize("module", ["typer", "numpy", "xarray"])
def test_ctrl_c_during_an_import_gets_one_line(scenario_file: Path, tmp_path: Path, module: str) -> None:
    slow = tmp_path / "slow"
    slow.mkdir()
    (slow / f"{module}.py").write_text("import time; print('importing', flush=True); time.sleep(60)")
    process = subprocess.Popen(
        [*COMMAND, "simulate", str(scenario_file), "--out", str(tmp_path / "out.nc")],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONPATH": str(slow)},
        preexec_fn=hear_interrupts,
    )
    try:
        assert process.stdout is not None
        assert process.stdout.readline() == "importing\n"
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=30)
    finally:
        process.kill()
    assert process.returncode == 130
    assert err == INTERRUPTED
