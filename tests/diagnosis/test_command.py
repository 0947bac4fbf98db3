"""The command line of a diagnosis."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import tumblers
from tumblers.commands import run
from tumblers.dataset import Dataset, Track
from tumblers.diagnosis.diagnosis import FILES, Diagnosis
from tumblers.diagnosis.wording.words import summary
from tumblers.effects import catalogue
from tumblers.effects.catalogue import CATALOGUE

from .example import lab, small
from .test_edges import WEAK_AMPLIFIER


def unseen() -> Dataset:
    track = Track(time_s=np.array([0.0, 0.1]), channels={"y_m": np.full(2, np.nan)})
    return replace(lab(), trials=(replace(lab().trials[0], track=track),))


def tumble(*arguments: object, cwd: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "tumblers", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, cwd=cwd, timeout=120, check=False)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["data"], "--out"),
        (["nowhere", "--out", "out"], "nowhere"),
        (["data", "--out", "nowhere/out"], "'nowhere' does not"),
        (["data", "--out", "file"], "the file 'file'"),
        (["data", "--out", "taken"], "--out: found the folder 'taken/diagnosis.json'"),
        (["data", "--out", "out", "--jobs", "0"], "--jobs: found 0"),
        (["data", "--out", "out", "--jobs", "100000"], "--jobs: found 100000"),
        (["lost", "--out", "out"], "lost: trial: found no measurement in any trial: every frame is lost"),
        (["data", "--out", "out", "--seed", "-1"], "--seed: found -1"),
        (
            ["data", "--out", "out", "--effects", "friction_coefficient,wind"],
            "--effects: found 'wind', expected one of m",
        ),
        (["data", "--out", "strange"], "--out: found 'strange/scenario.toml', of no diagnosis"),
        (["data", "--out", "foreign"], "--out: found 'foreign/diagnosis.json', of no diagnosis"),
        (["data", "--out", ""], "'--out': found '', expected a path"),
        (["", "--out", "out"], "'DATASET': found '', expected a path"),
        (
            ["data", "--out", "o" * 300],
            f"--out: found '{'o' * 76}...: file name too long, expected a folder that can be",
        ),
        (["data", "--out", "/proc/out"], "--out: found '/proc/out'"),
        (["data", "--out", "deep"], "--out: found 'deep/diagnosis.json', of no diagnosis"),
        (["data", "--out", "pipe"], "--out: found 'pipe/diagnosis.json', of no diagnosis"),
        (["data", "--out", "dangling"], "--out: found the link 'dangling' to nothing"),
        (["data", "--out", "file/out"], "'file' is a file"),
        (["data", "--out", "out", "--effects", ""], "--effects: found ''"),
        (["data", "--out", "out", "--effects", "draft_angle", "--effects", "wind"], "--effects: found 'wind'"),
        (["data", "--out", "out", "--effects", "gone.py"], "gone.py: found no such file"),
        (["data", "--out", "out", "--effects", "bad.py"], "bad.py: found no effect"),
    ],
)
def test_bad_input_gets_one_line_and_writes_nothing(tmp_path: Path, arguments: list[str], words: str) -> None:
    lab(tracks=False).save(tmp_path / "data")
    unseen().save(tmp_path / "lost")
    (tmp_path / "taken" / "diagnosis.json").mkdir(parents=True)
    (tmp_path / "file").write_text("")
    (tmp_path / "strange").mkdir()
    (tmp_path / "strange" / "scenario.toml").write_text("")
    (tmp_path / "foreign").mkdir()
    (tmp_path / "foreign" / "diagnosis.json").write_text('{"patient": "7"}')
    (tmp_path / "deep").mkdir()
    (tmp_path / "deep" / "diagnosis.json").write_text("[" * 100_000)
    (tmp_path / "pipe").mkdir()
    os.mkfifo(tmp_path / "pipe" / "diagnosis.json")
    (tmp_path / "dangling").symlink_to("gone")
    (tmp_path / "bad.py").write_text("x = 1\n")
    before = sorted(tmp_path.rglob("*"))
    done = tumble("diagnose", *arguments, cwd=tmp_path)
    assert done.returncode == 2, done.stderr
    assert done.stdout == ""
    assert words in done.stderr
    assert done.stderr.startswith("tumblers: ")
    assert done.stderr.count("\n") == 1
    assert sorted(path for path in tmp_path.rglob("*") if "__pycache__" not in str(path)) == before


def test_help_has_examples(tmp_path: Path) -> None:
    done = tumble("diagnose", "--help", cwd=tmp_path)
    assert done.returncode == 0
    assert "Examples:\n" in done.stdout


class Computation:
    """Stands for the computation, in the place where the command finds it."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, result: Diagnosis | BaseException) -> None:
        self.result, self.asked = result, {}
        module = ModuleType("tumblers.diagnosis.diagnose")
        module.diagnose = self.diagnose  # type: ignore[attr-defined]
        monkeypatch.setitem(sys.modules, module.__name__, module)

    def diagnose(self, dataset: Dataset, **asked: Any) -> Diagnosis:
        self.asked = asked
        if isinstance(self.result, BaseException):
            raise self.result
        return self.result


def command(monkeypatch: pytest.MonkeyPatch, *arguments: object) -> int:
    monkeypatch.setattr(sys, "argv", ["tumblers", "diagnose", *map(str, arguments)])
    try:
        return run()
    except KeyboardInterrupt:
        return 130


def test_a_number_in_another_unit_is_told_before_the_minutes_of_a_diagnosis(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    heavy = replace(lab(tracks=False), robot=replace(lab().robot, mass_kg=0.0378))
    heavy.save(tmp_path / "data")
    Computation(monkeypatch, KeyboardInterrupt())
    assert command(monkeypatch, tmp_path / "data", "--out", tmp_path / "out") == 130
    assert capsys.readouterr().err.startswith("tumblers: warning: the robot has 1.1")


def test_the_command_writes_the_files_and_prints_the_summary(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    lab().save(tmp_path / "data")
    computation = Computation(monkeypatch, small())
    out = tmp_path / "out"
    effects = ("--effects", "draft_angle, size_error", "--effects", "draft_angle")
    arguments = (tmp_path / "data", "--out", out, *effects, "--jobs", 2, "--seed", 5)
    assert command(monkeypatch, *arguments) == 0
    said = capsys.readouterr()
    assert said.out.startswith(summary(small()))
    assert f"report: {out / 'report.html'}" in said.out
    assert said.err == ""
    assert {file.name for file in out.iterdir()} == set(FILES)
    asked = {"effects": ["draft_angle", "size_error"], "jobs": 2, "seed": 5, "progress": True}
    assert computation.asked == asked


def test_the_whole_catalogue_can_be_tried_beside_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    lab().save(tmp_path / "data")
    own = tmp_path / "own.py"
    own.write_text(WEAK_AMPLIFIER, encoding="utf-8")
    monkeypatch.setattr(catalogue, "_LOADED", {})
    listed = list(CATALOGUE)
    computation = Computation(monkeypatch, small())
    try:
        arguments = ("--out", tmp_path / "out", "--effects", f"catalogue,{own}", "--effects", "catalogue")
        assert command(monkeypatch, tmp_path / "data", *arguments) == 0
    finally:
        del CATALOGUE["weak_amplifier"]
    assert computation.asked["effects"] == [*listed, "weak_amplifier"]


@pytest.mark.parametrize(("error", "status"), [(KeyboardInterrupt(), 130), (OSError(28, "No space left"), 1)])
def test_what_fails_or_is_interrupted_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException, status: int
) -> None:
    lab().save(tmp_path / "data")
    before = sorted(tmp_path.rglob("*"))

    def full(*_: object) -> None:
        raise error

    Computation(monkeypatch, error)
    for _ in ("while it is computed", "while it is written"):
        assert command(monkeypatch, tmp_path / "data", "--out", tmp_path / "out") == status
        assert sorted(tmp_path.rglob("*")) == before
        Computation(monkeypatch, small())
        monkeypatch.setattr("tumblers.diagnosis.diagnosis.write_files", full)


def test_the_public_names_are_there() -> None:
    assert tumblers.Diagnosis is Diagnosis
    assert tumblers.effects.CATALOGUE is CATALOGUE
    assert tumblers.dataset.Dataset is Dataset
    assert tumblers.blind.__doc__
