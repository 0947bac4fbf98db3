from __future__ import annotations

import re
from pathlib import Path

import pytest
import typer.main

from tumblers.commands import app

PAGE = (Path(__file__).parents[2] / "docs" / "studies.md").read_text(encoding="utf-8")
COMMANDS = typer.main.get_command(app).commands  # type: ignore[attr-defined]
STUDIES = ("climb", "tolerance", "design", "convergence")


def options(command: str) -> set[str]:
    return {option for parameter in COMMANDS[command].params for option in parameter.opts}


@pytest.mark.parametrize("command", STUDIES)
def test_every_study_has_a_section_and_an_example(command: str) -> None:
    assert f"\n## {command}\n" in PAGE
    examples = re.findall(rf"^tumblers {command} (.*)$", PAGE, re.MULTILINE)
    assert examples
    for example in examples:
        assert set(re.findall(r"--[a-z0-9-]+", example)) <= options(command)


def test_options_that_a_section_names_exist() -> None:
    sections = dict(re.findall(r"^## (\w+)\n(.*?)(?=^## |\Z)", PAGE, re.MULTILINE | re.DOTALL))
    for command in STUDIES:
        named = set(re.findall(r"`(--[a-z0-9-]+)`", sections[command]))
        assert named
        assert named <= options(command)


def test_the_python_example_runs(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    from matplotlib import pyplot as plt

    plt.switch_backend("Agg")
    (example,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    exec(example, {})
    plt.close("all")
    limit, closed = map(float, capsys.readouterr().out.split())
    assert limit == pytest.approx(closed, abs=0.2)
