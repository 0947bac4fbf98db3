from __future__ import annotations

import re
from dataclasses import fields
from pathlib import Path

from tumblers import Initial, Model, Robot, Run, Scenario, Substrate
from tumblers.camera import Camera
from tumblers.field import FIELDS
from tumblers.relief import Relief
from tumblers.shape import SHAPES
from tumblers.surroundings import Surroundings

TEXT = (Path(__file__).parents[1] / "docs" / "scenario.md").read_text(encoding="utf-8")


def test_the_example_loads_and_can_be_run() -> None:
    example = re.search(r"```toml\n(.*?)```", TEXT, re.DOTALL)
    assert example is not None
    scenario = Scenario.from_toml(example[1])
    assert scenario.robot.draft_deg == 2.0
    assert scenario.run.rows == 201
    assert Scenario.from_toml(scenario.to_toml()) == scenario


def test_every_key_of_the_format_is_explained() -> None:
    parts = (
        *(Robot, Substrate, Run, Model, Initial, Relief, Surroundings, Camera),
        *SHAPES.values(),
        *FIELDS.values(),
    )
    for key in {f.name for part in parts for f in fields(part)}:
        assert f"`{key}" in TEXT, key


def test_the_effects_shown_are_effects() -> None:
    scenario, effects = re.findall(r"```toml\n(.*?)```", TEXT, re.DOTALL)
    loaded = Scenario.from_toml(f"{scenario}\n{effects}")
    assert [effect.name for effect in loaded.effects] == ["friction_coefficient", "stray_field_gradient"]
    assert loaded.effective().surroundings.force_N[1] > 0.0
