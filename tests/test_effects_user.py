from __future__ import annotations

import os
import pickle
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import ClassVar

import pytest

from tumblers import InputError, Scenario, preset_scenario, simulate
from tumblers.effects import CATALOGUE, Effect, Parameter, catalogue, effects_from_tables, load_file, register

PAGE = (Path(__file__).parents[1] / "docs" / "adding_an_effect.md").read_text(encoding="utf-8")
FILE, USE = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
NOMINAL = preset_scenario("cuboid_on_paper", duration_s=0.3)


@pytest.fixture(autouse=True)
def _as_it_was(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    before, modules = dict(CATALOGUE), set(sys.modules)
    monkeypatch.setattr(catalogue, "_LOADED", {})
    yield
    CATALOGUE.clear()
    CATALOGUE.update(before)
    for name in set(sys.modules) - modules:
        if name.startswith("tumblers_effects_"):
            del sys.modules[name]


def write(folder: Path, text: str, name: str = "own.py") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_the_pages_example_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(tmp_path, FILE, "coil_yaw.py")
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    exec(compile(USE, "adding_an_effect.md", "exec"), names)
    scenario = names["scenario"]
    assert isinstance(scenario, Scenario)
    # The robot rolls where the coils point.
    run = simulate(replace(scenario, run=replace(scenario.run, duration_s=2.0)))
    x, y, _ = run["position_m"].values[-1] - run["position_m"].values[0]
    assert -x / y == pytest.approx(0.0875, abs=0.03)
    assert Scenario.from_toml(scenario.to_toml()) == scenario


def test_a_users_effect_is_like_any_other(tmp_path: Path) -> None:
    (effect,) = load_file(write(tmp_path, FILE))
    assert CATALOGUE["coil_yaw"] is effect
    assert list(CATALOGUE)[-1] == "coil_yaw"
    assert effect().edit(NOMINAL) is NOMINAL
    one = effect.from_vector((5.0,))
    assert effects_from_tables([{"name": "coil_yaw", "yaw_deg": 5}]) == (one,)
    assert pickle.loads(pickle.dumps(one)) == one
    with pytest.raises(InputError, match=r"effect\[0\]\.yaw_deg: found nan, expected a finite number"):
        effects_from_tables([{"name": "coil_yaw", "yaw_deg": float("nan")}])


def test_a_file_is_run_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write(tmp_path, FILE)
    first = load_file(path)
    monkeypatch.chdir(tmp_path)
    assert load_file("own.py") == first
    assert load_file(os.fspath(path)) == first


def test_a_name_that_is_taken_is_refused(tmp_path: Path) -> None:
    taken = write(tmp_path, FILE.replace('"coil_yaw"', '"draft_angle"'))
    before = dict(CATALOGUE)
    with pytest.raises(InputError) as error:
        load_file(taken)
    assert str(error.value) == (f"{taken}: CoilYaw.name: found 'draft_angle', expected a name that no other effect has")
    load_file(write(tmp_path, FILE, "one.py"))
    with pytest.raises(InputError, match=r"CoilYaw\.name: found 'coil_yaw'"):
        load_file(write(tmp_path, FILE, "other.py"))
    CATALOGUE.pop("coil_yaw")
    assert before == CATALOGUE


def test_a_file_registers_all_its_effects_or_none(tmp_path: Path) -> None:
    other = FILE[FILE.index("@dataclass") :].replace("CoilYaw", "Second")
    before = dict(CATALOGUE)
    with pytest.raises(InputError, match=r"Second\.name: found 'coil_yaw'"):
        load_file(write(tmp_path, FILE + "\n\n" + other))
    assert before == CATALOGUE
    registering = FILE.replace("Effect, Parameter", "Effect, Parameter, register").replace("@data", "@register\n@data")
    with pytest.raises(InputError, match="ZeroDivisionError: division by zero"):
        load_file(write(tmp_path, registering + "\n\n1 / 0\n", "late.py"))
    assert before == CATALOGUE
    assert len(load_file(write(tmp_path, registering, "registering.py"))) == 1
    both = FILE.replace("coil_yaw", "first_yaw") + "\n\n" + other.replace("coil_yaw", "second_yaw")
    load_file(write(tmp_path, both, "both.py"))
    assert list(CATALOGUE)[-3:] == ["coil_yaw", "first_yaw", "second_yaw"]


def test_what_effects_are_made_from_is_none_itself(tmp_path: Path) -> None:
    shared = "class Shared(Effect):\n    def turned(self, x: float) -> float:\n        return 2.0 * x\n\n\n"
    text = FILE.replace("@dataclass", shared + "@dataclass").replace("CoilYaw(Effect)", "CoilYaw(Shared)")
    (effect,) = load_file(write(tmp_path, text))
    assert effect.name == "coil_yaw"
    with pytest.raises(InputError, match=r"Shared\.name: found None, expected a name"):
        load_file(write(tmp_path, "from tumblers.effects import Effect\n\n\n" + shared, "alone.py"))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x = 1\n", "found no effect, expected a subclass of tumblers.effects.Effect"),
        ("from tumblers.effects import Effect\n", "found no effect"),
        ("def (:\n", "found SyntaxError: "),
        ("import nothing_of_this_name\n", "found ModuleNotFoundError: No module named 'nothing_of_this_name'"),
        ("raise SystemExit(3)\n", "found SystemExit: 3, expected a Python file that runs"),
        (FILE.replace('"coil_yaw"', '"Coil yaw"'), "CoilYaw.name: found 'Coil yaw', expected a name in small letters"),
        (FILE.replace("def act", "def acts"), "coil_yaw: found no method `act`"),
        (FILE.replace("    Source: arithmetic.\n", ""), "coil_yaw.source: found None"),
        (FILE.replace("    yaw_deg: float = 0.0\n", "    yaw_deg: float\n"), "coil_yaw.yaw_deg: found no default"),
        (FILE.replace("yaw_deg: float = 0.0", "yaw_deg: float = 1.0"), "coil_yaw.parameters: found the fields"),
        (FILE.replace("yaw_deg: float = 0.0", "yaw: float = 0.0"), "coil_yaw.parameters: found the fields"),
        (FILE.replace("@dataclass(frozen=True, kw_only=True, slots=True)\n", ""), "coil_yaw.parameters: found the"),
        (FILE.replace("low=-10.0", "low=1.0"), "coil_yaw.yaw_deg: found a range from 1 to 10, expected one around 0"),
    ],
)
def test_an_incomplete_file_is_refused_in_one_line(tmp_path: Path, text: str, message: str) -> None:
    path, before, modules = write(tmp_path, text), dict(CATALOGUE), set(sys.modules)
    with pytest.raises(InputError) as error:
        load_file(path)
    assert str(error.value).startswith(f"{path}: {message}")
    assert "\n" not in str(error.value)
    assert before == CATALOGUE
    assert not [name for name in set(sys.modules) - modules if name.startswith("tumblers_effects_")]


def test_a_file_that_is_none_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"none\.py: found no such file, expected a Python file with effects"):
        load_file(tmp_path / "none.py")
    with pytest.raises(InputError, match="found a directory"):
        load_file(tmp_path)
    with pytest.raises(InputError, match=r"found the suffix '.txt', expected a Python file, .py"):
        load_file(write(tmp_path, FILE, "own.txt"))


@pytest.mark.parametrize("what", [3, int, None])
def test_what_is_no_effect_is_not_registered(what: object) -> None:
    with pytest.raises(InputError, match=r"expected a subclass of tumblers\.effects\.Effect"):
        register(what)


def test_a_class_is_registered_as_it_stands() -> None:
    @register
    @dataclass(frozen=True, kw_only=True, slots=True)
    class Thrust(Effect):
        """F' = F + thrust."""

        name: ClassVar[str] = "thrust"
        parameters: ClassVar[tuple[Parameter, ...]] = tuple(
            Parameter(key=f"thrust_N[{i}]", neutral=0.0, low=-1e-7, high=1e-7, unit="N", meaning="a push")
            for i in range(2)
        )
        source: ClassVar[str] = "none"
        thrust_N: tuple[float, float] = (0.0, 0.0)

        def act(self, scenario: Scenario) -> Scenario:
            force = (*self.thrust_N, 0.0)
            return replace(scenario, surroundings=replace(scenario.surroundings, force_N=force))

    assert CATALOGUE["thrust"] is Thrust
    assert register(Thrust) is Thrust
    assert len(Thrust.starts(NOMINAL)) == 4
    scenario = replace(NOMINAL, effects=(Thrust(thrust_N=(0.0, 1e-7)),))
    assert Scenario.from_toml(scenario.to_toml()) == scenario
    assert scenario.effective().surroundings.force_N == (0.0, 1e-7, 0.0)
