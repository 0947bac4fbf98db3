from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest
import xarray as xr

import tumblers
from tumblers import Scenario, drive, preset_scenario
from tumblers.parts import Parts
from tumblers.studies.robust import Errors

COMMAND = [sys.executable, "-m", "tumblers"]
DESIGN = ["design", "--robot", "spiked.toml", "--samples", 8, "--draws", 8, "--generations", 1]


@pytest.fixture(autouse=True)
def _spiked_file(tmp_path: Path) -> None:
    """Write a spiked robot whose cycle is a tenth of the paper's, and so are the runs."""
    preset_scenario("spiked", drive=drive(0.020, 10.0), duration_s=0.1).save(tmp_path / "spiked.toml")


def tumble(*arguments: object, cwd: Path) -> subprocess.CompletedProcess[str]:
    command = [*COMMAND, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, cwd=cwd, timeout=120, check=False)


def said(stderr: str) -> str:
    """Return what is neither progress, of which a log gets a line every ten seconds, nor a word on a small design."""
    left = re.sub(r"^tumblers: (slopes|cases|runs) \d+/\d+\n", "", stderr, flags=re.MULTILINE)
    return re.sub(r"^tumblers: warning: the robust design is no better.*\n", "", left, flags=re.MULTILINE)


@pytest.mark.parametrize("command", ["climb", "tolerance", "design", "convergence"])
def test_help_has_examples(command: str, tmp_path: Path) -> None:
    done = tumble(command, "--help", cwd=tmp_path)
    assert done.returncode == 0
    assert re.search(rf"Examples:\n +tumblers {command} .*--out ", done.stdout)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (
            ["climb", "--robot", "cuboid", "--substrate", "paper", "--field", "20mT_1Hz", "--slopes", "0:80:20"],
            ["greatest slope: 47.", "friction limit, electrostatic force, no adhesion: 47.18°"],
        ),
        (["climb", "--robot", "scenario.toml", "--slopes", "0:80:20"], ["greatest slope: "]),
        (
            [
                "tolerance",
                "--robot",
                "spiked",
                "--draft-model",
                "as_released",
                "--drafts",
                "0:3",
                "--theta1",
                "0,10",
                "--theta2",
                "-20:20:10",
            ],
            ["draft alone: φ ≤ 2.0", "the paper's φ ≤ 2°, |θ2| ≤ 10°: "],
        ),
        (DESIGN, ["designs on the front", "robust over nominal: "]),
        (
            ["convergence", "--only", "spiked_drift", "--steps", "5e-4", "--e-r", "0.1", "--torques", "end_of_step"],
            ["spiked, φ = 2° as drawn: drift", "82.8"],
        ),
    ],
)
def test_a_study_writes_its_result_and_its_figure(
    scenario_file: Path, tmp_path: Path, arguments: list[object], words: list[str]
) -> None:
    before = {file.name for file in tmp_path.iterdir()}
    done = tumble(*arguments, "--jobs", 2, "--out", "out.nc", "--plot", "out.png", cwd=tmp_path)
    assert (done.returncode, said(done.stderr)) == (0, ""), done.stderr
    for found in words:
        assert found in done.stdout
    with xr.open_dataset(tmp_path / "out.nc", engine="h5netcdf") as result:
        assert result.attrs["title"] == f"tumblers {arguments[0]}"
    assert (tmp_path / "out.png").read_bytes().startswith(b"\x89PNG")
    assert {file.name for file in tmp_path.iterdir()} == before | {"out.nc", "out.png"}


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["climb", "--out", "a.nc"], "--robot"),
        (["climb", "--robot", "cube", "--out", "a.nc"], "--robot: found 'cube'"),
        (["climb", "--robot", "", "--out", "a.nc"], "--robot: found '', expected spiked, "),
        (["climb", "--robot", "cuboid", "--substrate", "ice", "--out", "a.nc"], "--substrate: found 'ice'"),
        (["climb", "--robot", "cuboid", "--field", "1T", "--out", "a.nc"], "--field: found '1T'"),
        (["climb", "--robot", "cuboid", "--out", "a.txt"], "--out: found 'a.txt'"),
        (["climb", "--robot", "cuboid", "--out", "a.nc", "--plot", "a.bmp"], "--plot: found 'a.bmp'"),
        (["climb", "--robot", "cuboid", "--out", "a.nc", "--jobs", "0"], "--jobs: found 0"),
        (["climb", "--robot", "cuboid", "--out", "a.nc", "--slopes", "10,5"], "--slopes: found [10.0, 5.0]"),
        (["climb", "--robot", "cuboid", "--out", "a.nc", "--slopes", "0,95"], "--slopes[1]: found 95.0"),
        (["climb", "--robot", "cuboid", "--out", "a.nc", "--resolution", "0"], "--resolution: found 0.0"),
        (["climb", "--robot", "cuboid", "--out", "a.nc", "--cycles", "0"], "--cycles: found 0"),
        (["climb", "--robot", "still.toml", "--out", "a.nc"], "field.kind: found 'static'"),
        (["climb", "--robot", "bad.toml", "--out", "a.nc"], "bad.toml: robot.mass_kg: found -1.0"),
        (["tolerance", "--robot", "spiked", "--out", "a.nc", "--draft-model", "mine"], "--draft-model: found 'mine'"),
        (["tolerance", "--robot", "spiked", "--out", "a.nc", "--drift-limit-um", "0"], "--drift-limit-um: found 0.0"),
        (["tolerance", "--robot", "spiked", "--out", "a.nc", "--drift-limit-um", "-5"], "--drift-limit-um: found -5.0"),
        (["tolerance", "--robot", "spiked", "--out", "a.nc", "--drafts", "1:3"], "--drafts: found [1.0, 2.0, 3.0]"),
        (["design", "--robot", "spiked", "--out", "a.nc", "--samples", "9"], "--samples: found 9"),
        (["design", "--robot", "spiked", "--out", "a.nc", "--draws", "9"], "--draws: found 9"),
        (["design", "--robot", "spiked", "--out", "a.nc", "--draft-most", "-1"], "--draft-most: found -1.0"),
        (["design", "--robot", "spiked", "--out", "old.nc"], "--out: found no settings in old.nc, expected"),
        (["convergence", "--out", "a.nc", "--only", "speed"], "--only[0]: found 'speed'"),
        (["convergence", "--out", "a.nc", "--steps", "0"], "--steps[0]: found 0.0"),
        (["convergence", "--out", "a.nc", "--torques", "later"], "--torques[0]: found 'later'"),
    ],
)
def test_bad_input_gets_one_line_and_writes_nothing(
    scenario_file: Path, tmp_path: Path, arguments: list[str], words: str
) -> None:
    text = scenario_file.read_text()
    (tmp_path / "bad.toml").write_text(text.replace("mass_kg = 3.78e-8", "mass_kg = -1.0"))
    still = text.replace('kind = "rotating"', 'kind = "static"\ndirection = [0.0, 1.0, 0.0]')
    (tmp_path / "still.toml").write_text(still.replace("frequency_Hz = 5\n", ""))
    (tmp_path / "old.nc").write_text("no design")
    before = {file.name: file.read_bytes() for file in tmp_path.iterdir()}
    done = tumble(*arguments, cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, ""), done.stderr
    assert done.stderr.startswith("tumblers: ")
    assert done.stderr.count("\n") == 1
    assert words in done.stderr
    assert {file.name: file.read_bytes() for file in tmp_path.iterdir()} == before


def test_a_design_that_is_there_is_shown_again_and_another_one_refused(tmp_path: Path) -> None:
    first = tumble(*DESIGN, "--out", "out.nc", cwd=tmp_path)
    assert first.returncode == 0, first.stderr
    written = (tmp_path / "out.nc").stat().st_mtime_ns
    again = tumble(*DESIGN, "--out", "out.nc", "--plot", "out.svg", cwd=tmp_path)
    assert again.returncode == 0, again.stderr
    assert again.stdout.splitlines()[:-1] == first.stdout.splitlines()[:-1]
    assert (tmp_path / "out.svg").exists()
    other = tumble(*DESIGN, "--seed", 1, "--out", "out.nc", cwd=tmp_path)
    assert (other.returncode, other.stdout) == (2, "")
    assert "--out: found errors_seed 0 in out.nc, expected errors_seed 1, or another file" in other.stderr
    assert (tmp_path / "out.nc").stat().st_mtime_ns >= written


@pytest.mark.parametrize("finished", [False, True])
def test_a_design_leaves_a_folder_that_is_not_its_own_as_it_is(tmp_path: Path, finished: bool) -> None:
    """Even where the design is there already, and there is nothing more to keep."""
    if finished:
        assert tumble(*DESIGN, "--out", "out.nc", cwd=tmp_path).returncode == 0
    parts = tmp_path / "out.nc.parts"
    parts.mkdir()
    (parts / "chapter.tex").write_text("three years")
    before = {file: file.read_bytes() for file in tmp_path.rglob("*") if file.is_file()}
    done = tumble(*DESIGN, "--out", "out.nc", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == (
        "tumblers: --out: found no such file at out.nc.parts/settings.json, "
        "expected a folder of these results, or none\n"
    )
    assert {file: file.read_bytes() for file in tmp_path.rglob("*") if file.is_file()} == before


def test_parts_of_a_design_that_is_there_are_cleared_up(tmp_path: Path) -> None:
    """As a kill leaves them between the whole and the parts' end."""
    assert tumble(*DESIGN, "--out", "out.nc", cwd=tmp_path).returncode == 0
    with xr.open_dataset(tmp_path / "out.nc", engine="h5netcdf") as result:
        settings = json.loads(result.attrs["settings"])
    Parts(tmp_path / "out.nc.parts", settings).part("candidates", lambda: 1, bool)
    assert tumble(*DESIGN, "--out", "out.nc", cwd=tmp_path).returncode == 0
    assert {file.name for file in tmp_path.iterdir()} == {"out.nc", "spiked.toml"}


@pytest.mark.skipif(os.name == "nt", reason="signals")
def test_ctrl_c_keeps_the_parts_of_a_design(tmp_path: Path) -> None:
    arguments = ["design", "--robot", "spiked.toml", "--samples", 4096, "--draws", 8, "--jobs", 1, "--out", "out.nc"]
    process = subprocess.Popen(
        [*COMMAND, *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=tmp_path,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    parts = tmp_path / "out.nc.parts"
    try:
        while not (parts / "samples-00008.json").exists():
            assert process.poll() is None
            with suppress(subprocess.TimeoutExpired):
                process.wait(timeout=0.05)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=30)
    finally:
        process.kill()
    assert (process.returncode, out) == (130, "")
    assert re.fullmatch(
        r"tumblers: interrupted, \d+ parts kept in out\.nc\.parts: the same command goes on from there\n", said(err)
    )
    assert {file.name for file in tmp_path.iterdir()} == {"out.nc.parts", "spiked.toml"}
    assert all(file.suffix == ".json" for file in parts.iterdir())


@pytest.mark.parametrize(
    ("content", "words"), [("half of", "text that is no JSON in"), ('{"speed_m_per_s": [1.0]}', "something else in")]
)
def test_a_broken_part_gets_one_line_and_stays(tmp_path: Path, content: str, words: str) -> None:
    scenario = Scenario.load(tmp_path / "spiked.toml")
    parts = tmp_path / "out.nc.parts"
    tumblers.design(scenario, samples=8, generations=1, errors=Errors(draws=8), parts=parts)
    before = {file.name for file in parts.iterdir()}
    for name in ("samples-00000", "nominal-00001", "candidates"):
        part = parts / f"{name}.json"
        whole = part.read_text()
        part.write_text(content)
        done = tumble(*DESIGN, "--out", "out.nc", cwd=tmp_path)
        assert (done.returncode, done.stdout) == (2, "")
        assert done.stderr.startswith(f"tumblers: --out: found {words} out.nc.parts/{name}.json, expected a part")
        assert done.stderr.count("\n") == 1
        assert part.read_text() == content
        part.write_text(whole)
    assert {file.name for file in parts.iterdir()} == before
    assert not (tmp_path / "out.nc").exists()
