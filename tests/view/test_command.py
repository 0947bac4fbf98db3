from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
import xarray as xr

from tumblers import preset_scenario, save_netcdf, sweep

COMMAND = [sys.executable, "-m", "tumblers"]


def tumble(*arguments: object, cwd: Path) -> subprocess.CompletedProcess[str]:
    # Without a PATH there is no ffmpeg.
    environment = {**os.environ, "PATH": ""}
    command = [*COMMAND, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, cwd=cwd, timeout=120, check=False, env=environment)


def refused(done: subprocess.CompletedProcess[str]) -> str:
    assert done.returncode == 2, done.stderr
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1
    assert done.stderr.startswith("tumblers: ")
    return done.stderr


@pytest.fixture
def saved(run: xr.Dataset, tmp_path: Path) -> Path:
    save_netcdf(run.isel(time=slice(0, None, 50)), tmp_path / "run.nc")
    return tmp_path / "run.nc"


PICTURES = ("--snapshots", "above.png", "--cycle", "cycle.svg", "--view", "run.html")


def test_a_saved_run_is_drawn(saved: Path) -> None:
    done = tumble("view", saved, *PICTURES, "--animate", "run.gif", cwd=saved.parent)
    assert done.returncode == 0, done.stderr
    # On a slow machine the frames take long enough for a line of progress.
    assert all(line.startswith("tumblers: frames ") for line in done.stderr.splitlines())
    assert done.stdout == "snapshots: above.png\ncycle: cycle.svg\nanimate: run.gif\nview: run.html\n"
    starts = {"above.png": b"\x89PNG", "cycle.svg": b"<?xml", "run.html": b"<!doctype html>", "run.gif": b"GIF8"}
    assert {file.name for file in saved.parent.iterdir()} == {"run.nc", *starts}
    for name, start in starts.items():
        assert (saved.parent / name).read_bytes().startswith(start)


def test_simulate_draws_its_run(tmp_path: Path) -> None:
    preset_scenario("cuboid_on_paper", duration_s=0.02).save(tmp_path / "scenario.toml")
    done = tumble("simulate", "scenario.toml", "--out", "run.nc", *PICTURES, cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    made = {"run.nc", "above.png", "cycle.svg", "run.html"}
    assert {file.name for file in tmp_path.iterdir()} == {"scenario.toml", *made}


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ((), "found no picture asked for, expected --snapshots, --cycle, --animate, --view"),
        (("--view", "run.png"), "--view: found 'run.png', expected a file name that ends in .html"),
        (("--animate", "run.mp4"), "--animate: found mp4 but no ffmpeg on this machine, expected gif"),
        (("--animate", "run.avi"), "--animate: found 'run.avi', expected a file name that ends in .gif or .mp4"),
        (("--snapshots", "a.png", "--cycle", "a.png"), "--cycle: found 'a.png', expected a file that is not named"),
        (("--cycle", "none/a.png"), "--cycle: found 'none/a.png', expected a file in a folder that exists"),
    ],
)
def test_bad_options_get_one_line(saved: Path, options: tuple[str, ...], words: str) -> None:
    assert words in refused(tumble("view", saved, *options, cwd=saved.parent))
    assert [file.name for file in saved.parent.iterdir()] == ["run.nc"]


def test_what_is_no_run_gets_one_line(tmp_path: Path) -> None:
    (tmp_path / "text.nc").write_text("no netCDF")
    save_netcdf(
        sweep(preset_scenario("spiked", duration_s=0.005), drafts_deg=[0.0], magnetization=[(0, 0)]),
        tmp_path / "sweep.nc",
    )
    for name, words in {
        "none.nc": "none.nc: found no such file",
        "text.nc": "text.nc: found a file that is no netCDF-4",
        "sweep.nc": "sweep.nc: run: found no variable time(time)",
    }.items():
        assert words in refused(tumble("view", name, "--view", "run.html", cwd=tmp_path))
    assert not (tmp_path / "run.html").exists()
