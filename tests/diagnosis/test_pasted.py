"""What of a diagnosis is run again: the effects and the scenario."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from tumblers import Scenario
from tumblers.diagnosis.diagnosis import Diagnosis
from tumblers.effects import CATALOGUE, catalogue, load_file
from tumblers.model import Model

from .example import no_gap, small
from .test_edges import WEAK_AMPLIFIER


@pytest.fixture
def amplified(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Diagnosis]:
    """A diagnosis whose cause is of a file of one's own, with switches that are not those of a scenario."""
    monkeypatch.setattr(catalogue, "_LOADED", {})
    (tmp_path / "weak_amplifier.py").write_text(WEAK_AMPLIFIER, encoding="utf-8")
    (kind,) = load_file(tmp_path / "weak_amplifier.py")
    module = kind.__module__
    yield replace(small(), model=Model(magnetic_torque="midpoint"), chosen=(kind.from_vector((0.9,)),))
    del CATALOGUE["weak_amplifier"], sys.modules[module]


def test_the_effects_say_what_they_were_found_with(amplified: Diagnosis) -> None:
    lines = amplified.effects_toml().splitlines()
    assert '# [model] magnetic_torque = "midpoint"' in lines
    steps = sorted({floor.step_s for floor in amplified.floors})
    assert any(line.startswith(f"# [run] step_s = {steps[0]:g}") for line in lines)
    assert "# weak_amplifier is not of the package: tumblers simulate --effects weak_amplifier.py ..." in lines
    assert "not of the package" not in small().effects_toml()
    bare = replace(amplified.scenario("slope30"), effects=(), model=Model())
    assert Scenario.from_toml(bare.to_toml() + "\n" + amplified.effects_toml()).effects == amplified.chosen


def test_nothing_found_is_nothing_to_paste() -> None:
    assert no_gap().effects_toml() == ""
    assert Scenario.from_toml(no_gap().scenario_toml()).effects == ()


def test_the_scenario_is_that_of_the_largest_gap(amplified: Diagnosis) -> None:
    gaps = amplified.gap.by_trial
    trial = max(gaps, key=lambda id_: gaps[id_][0])
    text = amplified.scenario_toml()
    assert text.startswith(f"# Trial {trial}, as it was diagnosed.\n")
    scenario = Scenario.from_toml(text)
    assert scenario == amplified.scenario(trial)
    assert scenario.model.magnetic_torque == "midpoint"


def test_an_effect_of_ones_own_is_run_from_the_command_line(amplified: Diagnosis, tmp_path: Path) -> None:
    amplified.save(tmp_path / "out")

    def tumble(*arguments: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "tumblers", *arguments]
        return subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, timeout=120, check=False)

    run = ("simulate", "out/scenario.toml", "--out", "run.nc")
    done = tumble(*run)
    assert done.returncode == 2
    assert "effect[0].name: found 'weak_amplifier'" in done.stderr
    done = tumble(*run, "--effects", "weak_amplifier.py")
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "run.nc").exists()
    done = tumble("view", "run.nc", "--effects", "weak_amplifier.py", "--snapshots", "above.png")
    assert (done.returncode, done.stderr) == (0, "")
    small = ("--drafts", "0", "--theta1", "0", "--theta2", "0", "--jobs", "1", "--out", "sweep.nc")
    done = tumble("sweep", "--robot", "out/scenario.toml", *small, "--effects", "weak_amplifier.py")
    assert (done.returncode, done.stderr) == (0, "")
    for wrong, words in (("gone.py", "gone.py: found no such file"), ("wind", "--effects: found 'wind', expected a")):
        done = tumble(*run, "--effects", f"weak_amplifier.py,{wrong}")
        assert done.returncode == 2
        assert words in done.stderr
        assert done.stderr.count("\n") == 1
