"""``tumblers reproduce``: its files, and what it refuses."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest
import xarray as xr

from tumblers import InputError
from tumblers.reproduction.reproduce import reproduce


def tumble(*arguments: object, cwd: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "tumblers", "reproduce", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, cwd=cwd, timeout=120, check=False)


def test_it_writes_rows_figures_data_and_a_page(tmp_path: Path) -> None:
    done = tumble("--only", "3", "--jobs", 1, "--out", "found", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    # A line of progress every ten seconds, where the machine is busy.
    assert all(line.startswith("tumblers: runs ") for line in done.stderr.splitlines())
    assert "8 rows: " in done.stdout
    found = tmp_path / "found"
    assert {file.name for file in found.iterdir()} == {
        "reproduction.json",
        "index.html",
        "03_adhesion_on_slope.png",
        "03_adhesion_on_slope.nc",
    }
    assert (found / "03_adhesion_on_slope.png").read_bytes().startswith(b"\x89PNG")
    with xr.open_dataset(found / "03_adhesion_on_slope.nc", engine="h5netcdf") as data:
        assert data["set"].values.tolist() == ["text", "released"]
        assert json.loads(data.attrs["choices"])["released"]["parameters"] == "released"
    rows = json.loads((found / "reproduction.json").read_text(encoding="utf-8"))["results"]
    assert len(rows) == 8
    for row in rows:
        assert {"number", "name", "robot", "quantity", "paper", "ours", "verdict", "why"} <= set(row)
        assert row["verdict"] in ("match", "differs")
        assert row["why"] or row["verdict"] == "match"
    page = (found / "index.html").read_text(encoding="utf-8")
    assert page.count('src="data:image/png;base64,') == 1
    assert not re.search(r'(src|href)="(?!data:|#)', page)
    for words in ("adhesion with L × W on the slope, N", "3.808e-07", "half of the last digit given", "differs"):
        assert words in page


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--out", "found", "--only", "11"], "--only: found '11', expected numbers of results from 1 to 10"),
        (["--out", "found", "--only", "2,x"], "--only: found '2,x', expected numbers of results"),
        (["--out", "found", "--only", "1.5"], "--only: found '1.5'"),
        (["--out", "found", "--jobs", "0"], "--jobs: found 0, expected a whole number of at least 1"),
        (["--out", "nowhere/found"], "--out"),
        (["--out", "file"], "--out"),
        (["--out", "found", "--page", "page.txt"], "--page"),
        (["--out", "found", "--only", "3", "--page", "page.md"], "--page: found it beside --only"),
        ([], "--out"),
    ],
)
def test_bad_arguments_get_one_line_and_write_nothing(tmp_path: Path, arguments: list[str], words: str) -> None:
    (tmp_path / "file").write_text("")
    done = tumble(*arguments, cwd=tmp_path)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.startswith("tumblers: ")
    assert done.stderr.count("\n") == 1
    assert words in done.stderr
    assert [file.name for file in tmp_path.iterdir()] == ["file"]


def test_a_folder_in_the_way_of_a_file_is_refused_before_anything_is_written(tmp_path: Path) -> None:
    (tmp_path / "found" / "03_adhesion_on_slope.nc").mkdir(parents=True)
    done = tumble("--only", "3", "--out", "found", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr == (
        "tumblers: --out: found the folder 'found/03_adhesion_on_slope.nc', expected a folder in which "
        "03_adhesion_on_slope.nc can be written\n"
    )
    assert [file.name for file in (tmp_path / "found").iterdir()] == ["03_adhesion_on_slope.nc"]
    # No file of this name is written by another result.
    assert tumble("--only", "2", "--out", "found", "--jobs", 1, cwd=tmp_path).returncode == 0


@pytest.mark.skipif(os.name == "nt", reason="signals")
def test_an_interrupt_leaves_no_file(tmp_path: Path) -> None:
    """In the middle of the runs: the first line of progress comes after ten seconds of them."""
    command = [sys.executable, "-m", "tumblers", "reproduce", "--only", "8,9", "--jobs", "1", "--out", "found"]
    # A shell makes the jobs that it starts in the background ignore SIGINT, the tests among them.
    hear = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, cwd=tmp_path, preexec_fn=hear) as running:
        assert running.stderr is not None
        assert running.stderr.readline().startswith("tumblers: runs ")
        running.send_signal(signal.SIGINT)
        rest = running.stderr.read()
        assert running.wait(60) == 130
    assert rest.endswith("tumblers: interrupted, nothing was written\n")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("arguments", "key"), [({"only": [0]}, "only"), ({"only": []}, "only"), ({"jobs": 0}, "jobs")])
def test_bad_arguments_are_refused_in_python(arguments: dict[str, object], key: str) -> None:
    with pytest.raises(InputError) as refused:
        reproduce(**arguments)  # type: ignore[arg-type]
    assert refused.value.key == key


def test_the_result_does_not_depend_on_the_number_of_threads() -> None:
    assert reproduce([2], jobs=1).table() == reproduce([2], jobs=2).table()
