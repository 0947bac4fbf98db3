"""Long sweeps: killed at any moment they go on where they stopped, with nothing lost but the part in flight."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from dataclasses import replace
from importlib import import_module
from pathlib import Path

import pytest
import xarray as xr

from tumblers import InputError, preset_scenario, sweep
from tumblers.effects import CATALOGUE, load_file
from tumblers.parts import Parts

from .kill import files_of, kill_until_done, small_disk

# The package's attribute of this name is the function.
module = import_module("tumblers.sweep")

# The paper's robot for a tenth of a second: 200 steps of 3 cases in a part make one draft a part.
DRAFTS = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]
CASES = [(0.0, 0.0), (10.0, 40.0), (10.0, 90.0)]
ONE_DRAFT = 3 * 200
# Eight drafts of 18 cases, 2000 steps each: a few tenths of a second, with a part after each draft.
ARGUMENTS = ["sweep", "--robot", "spiked", "--drafts", "0:7", "--theta1", "0,10", "--theta2", "10:340:20"]
COMMAND = (
    "import importlib; importlib.import_module('tumblers.sweep')._PART_STEPS = 1; from tumblers.cli import main; main()"
)


@pytest.fixture
def small_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_PART_STEPS", ONE_DRAFT)


def run(folder: Path, **options: object) -> xr.Dataset:
    scenario = preset_scenario("spiked", duration_s=0.1)
    return sweep(scenario, **{"drafts_deg": DRAFTS, "magnetization": CASES, "parts": folder} | options)  # type: ignore[arg-type]


def test_parts_make_the_sweep_that_one_call_makes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = run(tmp_path / "none")
    assert not (tmp_path / "none").exists()
    monkeypatch.setattr(module, "_PART_STEPS", ONE_DRAFT)
    counted: list[int] = []
    parts = run(tmp_path / "parts", progress=counted.append)
    assert len(list((tmp_path / "parts").glob("*.nc"))) == len(DRAFTS)
    xr.testing.assert_identical(parts, whole)
    # From their files they are the same, bit for bit, and so is their order of progress.
    xr.testing.assert_identical(run(tmp_path / "parts"), whole)
    assert counted == sorted(counted)
    assert counted[-1] == len(DRAFTS) * len(CASES)


@pytest.mark.usefixtures("small_parts")
def test_only_the_parts_that_are_missing_are_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "parts"
    whole = run(folder)
    (folder / "drafts-00002.nc").unlink()
    ran: list[float] = []
    rows = module._rows
    monkeypatch.setattr(module, "_rows", lambda *given: ran.extend(given[1]) or rows(*given))
    xr.testing.assert_identical(run(folder), whole)
    assert ran == [2.0]


@pytest.mark.usefixtures("small_parts")
@pytest.mark.parametrize(
    ("options", "word"),
    [({"drafts_deg": [*DRAFTS, 6.0]}, "drafts_deg"), ({"magnetization": CASES[:2]}, "magnetization")],
)
def test_parts_of_another_sweep_are_refused(tmp_path: Path, options: dict[str, object], word: str) -> None:
    run(tmp_path / "parts")
    before = {file: file.read_bytes() for file in (tmp_path / "parts").iterdir()}
    with pytest.raises(InputError, match=f"parts: found another {word}|parts: found {word}"):
        run(tmp_path / "parts", **options)
    assert {file: file.read_bytes() for file in (tmp_path / "parts").iterdir()} == before


@pytest.mark.usefixtures("small_parts")
@pytest.mark.parametrize("spoil", ["text", "another"])
def test_a_part_that_is_none_is_refused_by_its_name(tmp_path: Path, spoil: str) -> None:
    folder = tmp_path / "parts"
    run(folder)
    if spoil == "text":
        (folder / "drafts-00003.nc").write_text("no")
    else:
        shutil.copy(folder / "drafts-00001.nc", folder / "drafts-00003.nc")
    with pytest.raises(InputError, match=r"drafts-00003\.nc"):
        run(folder)


def tumble(*arguments: str, cwd: Path, limit: int | None = None) -> subprocess.CompletedProcess[str]:
    """Run a command whose every draft is a part, with files of at most so many bytes."""
    return subprocess.run(
        [sys.executable, "-c", COMMAND, *arguments],
        capture_output=True,
        text=True,
        cwd=cwd,
        check=False,
        env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"},
        preexec_fn=None if limit is None else small_disk(limit),
    )


@pytest.mark.parametrize("drafts", ["0", "0:7"])
@pytest.mark.parametrize("held", ["someone's", "another sweep's"])
def test_a_sweep_leaves_a_folder_that_is_not_its_own_as_it_is(tmp_path: Path, drafts: str, held: str) -> None:
    """Whether it is so short that it keeps nothing, or long."""
    parts = tmp_path / "out.nc.parts"
    if held == "someone's":
        (parts / "thesis").mkdir(parents=True)
        (parts / "thesis" / "chapter.tex").write_text("three years")
        words = "--out: found no such file at out.nc.parts/settings.json, expected a folder of these results, or none"
    else:
        kept = Parts(parts, module.sweep_settings(preset_scenario("spiked_ends"), DRAFTS, CASES))
        kept.part("drafts-00000", lambda: [1.0], bool)
        words = "--out: found drafts_deg [0.0, 1.0, 2.0, 3.0, 4.0, 5.0] in out.nc.parts, expected drafts_deg [0.0"
    before = files_of(tmp_path)
    done = tumble("sweep", "--robot", "spiked", "--drafts", drafts, "--theta1", "0", "--out", "out.nc", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(f"tumblers: {words}")
    assert done.stderr.count("\n") == 1
    assert files_of(tmp_path) == before


@pytest.mark.skipif(os.name == "nt", reason="limits")
def test_a_full_disk_gets_one_line_and_the_parts_stay(tmp_path: Path) -> None:
    arguments = ("sweep", "--robot", "spiked", "--drafts", "0:3", "--theta1", "0", "--out", "out.nc")
    done = tumble(*arguments, cwd=tmp_path, limit=1024)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.startswith("tumblers: [Errno 27] File too large")
    assert done.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []
    parts = tmp_path / "out.nc.parts"
    whole = tumble(*arguments, cwd=tmp_path)
    assert whole.returncode == 0, whole.stderr
    written = (tmp_path / "out.nc").read_bytes()
    (tmp_path / "out.nc").unlink()
    # The whole is larger than its parts are.
    done = tumble(*arguments, cwd=tmp_path, limit=len(written) - 1)
    assert done.returncode == 1, done.stderr
    assert done.stderr.startswith("tumblers: [Errno 27] File too large")
    assert len(list(parts.glob("*.nc"))) == 4
    assert tumble(*arguments, cwd=tmp_path).returncode == 0
    assert {file.name for file in tmp_path.iterdir()} == {"out.nc"}


@pytest.mark.skipif(os.name == "nt", reason="signals")
def test_a_sweep_that_is_killed_at_random_times_loses_no_part(tmp_path: Path) -> None:
    command = [sys.executable, "-c", COMMAND, *ARGUMENTS, "--jobs", "1", "--out"]
    assert subprocess.run([*command, "whole.nc"], cwd=tmp_path, capture_output=True, check=False).returncode == 0
    parts = tmp_path / "killed.nc.parts"
    assert (
        kill_until_done(
            [*command, "killed.nc"], tmp_path, lambda: files_of(parts, "drafts-*.nc"), tmp_path / "killed.nc", 2026
        )
        > 1
    )
    assert {file.name for file in tmp_path.iterdir()} == {"killed.nc", "whole.nc"}
    with (
        xr.open_dataset(tmp_path / "killed.nc", engine="h5netcdf") as one,
        xr.open_dataset(tmp_path / "whole.nc", engine="h5netcdf") as other,
    ):
        xr.testing.assert_identical(one.load(), other.load())


def test_parts_depend_on_the_files_of_the_effects(tmp_path: Path) -> None:
    file = tmp_path / "weak_supply.py"
    file.write_text(
        "from dataclasses import dataclass\n"
        "from typing import ClassVar\n"
        "from tumblers.effects import Effect, Parameter\n\n\n"
        "@dataclass(frozen=True, kw_only=True, slots=True)\n"
        "class WeakSupply(Effect):\n"
        '    """The coils get less current than they are told."""\n\n'
        '    name: ClassVar[str] = "weak_supply"\n'
        '    source: ClassVar[str] = "Ohm"\n'
        "    parameters: ClassVar[tuple[Parameter, ...]] = (\n"
        '        Parameter(key="factor", neutral=1.0, low=0.3, high=1.5, unit="1", meaning="field over nominal"),\n'
        "    )\n"
        "    factor: float = 1.0\n\n"
        "    def act(self, scenario):\n"
        '        """Return the scenario as it is."""\n'
        "        return scenario\n"
    )
    (kind,) = load_file(file)
    # At once: a monkeypatch would put it back for the tests to come.
    del CATALOGUE[kind.name]
    scenario = replace(preset_scenario("spiked", duration_s=0.1), effects=(kind(),))
    before = module.sweep_settings(scenario, DRAFTS, CASES)
    file.write_text(file.read_text() + "# Another one.\n")
    after = module.sweep_settings(scenario, DRAFTS, CASES)
    assert {key for key in before if before[key] != after[key]} == {"effect_files"}
