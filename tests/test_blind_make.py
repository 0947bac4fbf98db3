from __future__ import annotations

import json
import multiprocessing
import shutil
from collections import Counter
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from tumblers import InputError, dataset
from tumblers.blind import draw
from tumblers.blind.answer import seal
from tumblers.blind.commands import blind_app
from tumblers.blind.forms import law_of
from tumblers.blind.jitter import DIMENSIONS, NUMBERS, Jitter
from tumblers.blind.lab import Plan
from tumblers.blind.law import EffectLaw
from tumblers.blind.layout import draw_lab, world_scenario
from tumblers.blind.make import make
from tumblers.blind.records import read_records
from tumblers.blind.repeat import REPEAT_FORMAT
from tumblers.blind.repeated import Repeated
from tumblers.blind.schedule import Task, task
from tumblers.blind.strength import Strength, strength
from tumblers.blind.world import Scene, watch
from tumblers.dataset import load
from tumblers.effects.catalogue import CATALOGUE, get
from tumblers.field import StaticField
from tumblers.presets import drive

# Worlds without an effect are quick to draw.
SEED = next(seed for seed in range(1000) if [task(seed, i).kind for i in range(2)] == ["none", "none"])


def contents(directory: Path) -> dict[str, bytes]:
    return {str(p.relative_to(directory)): p.read_bytes() for p in sorted(directory.rglob("*")) if p.is_file()}


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("blind") / "two"
    make(directory, seed=SEED, count=2, jobs=2)
    return directory


def test_the_files_do_not_depend_on_the_number_of_processes(made: Path, tmp_path: Path) -> None:
    make(tmp_path / "again", seed=SEED, count=2, jobs=1)
    first, again = contents(made), contents(tmp_path / "again")
    tables = [json.loads(files.pop("answers.json"))["answers"] for files in (first, again)]
    seals = [[files.pop(name) for name in sorted(files) if name.endswith("seal.json")] for files in (first, again)]
    assert again == first
    truths = [[(entry["dataset"], entry["answer"]) for entry in table] for table in tables]
    assert truths[0] == truths[1]
    # Whoever knows the seed knows no salt, and so opens no seal.
    salts = {entry["salt"] for table in tables for entry in table}
    assert len(salts) == 4
    assert all(len(salt) == 32 for salt in salts)
    assert not set(seals[0]) & set(seals[1])


def test_a_set_loads_and_keeps_its_answers_apart(made: Path) -> None:
    assert sorted(p.name for p in made.iterdir()) == ["answers.json", "dataset-000", "dataset-001"]
    for folder in sorted(made.glob("dataset-*")):
        data = dataset.load(folder)
        assert 6 <= len(data.trials) <= 14
        assert "none" not in (folder / "dataset.toml").read_text()
        for trial in data.trials:
            if trial.track is not None:
                assert 30 <= trial.track.time_s.size <= 200


def test_seals_are_whole_and_a_changed_answer_is_named(made: Path, tmp_path: Path) -> None:
    seed, records = read_records(made, made / "answers.json")
    assert seed == SEED
    assert [r.answer.kind for r in records] == ["none", "none"]
    assert all(r.diagnosis is None for r in records)
    table = json.loads((made / "answers.json").read_text())
    table["answers"][1]["answer"]["strength_sigma"] = 1.0
    changed = tmp_path / "answers.json"
    changed.write_text(json.dumps(table))
    with pytest.raises(InputError, match=r"dataset-001: found an answer that is not the sealed one"):
        read_records(made, changed)


def test_what_a_repeat_wrote_is_read_again(made: Path, tmp_path: Path) -> None:
    folder = tmp_path / "set"
    shutil.copytree(made, folder)
    again = {"format": REPEAT_FORMAT, "version": "1", "seconds": 3.5, "threads": 4, "cores": 2, "same": True}
    (folder / "dataset-001" / "repeat.json").write_text(json.dumps(again))
    _, (first, second) = read_records(folder, folder / "answers.json")
    assert first.repeated is None
    # Before, what the processors did was not noted.
    trials = len(load(folder / "dataset-001").trials)
    assert second.repeated == Repeated(seconds=3.5, processor_s=None, threads=4, cores=2, same=True, trials=trials)
    (folder / "dataset-001" / "repeat.json").write_text(json.dumps({**again, "processor_s": 6.0}))
    assert read_records(folder, folder / "answers.json")[1][1].repeated == replace(second.repeated, processor_s=6.0)


def test_a_seal_does_not_depend_on_the_order_of_keys() -> None:
    assert seal("salt", {"a": 1.5, "b": [1]}) == seal("salt", {"b": [1], "a": 1.5})
    assert seal("salt", {"a": 1.5}) != seal("other", {"a": 1.5})


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"seed": -1}, "seed"),
        ({"seed": True}, "seed"),
        ({"count": 0}, "count"),
        ({"jobs": 0}, "jobs"),
        ({"jobs": 100_000}, "jobs"),
    ],
)
def test_refused_numbers_write_nothing(changes: dict[str, int], key: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=f"^{key}: found"):
        make(tmp_path / "new", **{"seed": 1, "count": 1, **changes})
    assert not (tmp_path / "new").exists()


def test_a_folder_that_is_taken_is_refused(made: Path, tmp_path: Path) -> None:
    before = contents(made)
    with pytest.raises(InputError, match="datasets or answers"):
        make(made, seed=1, count=1)
    assert contents(made) == before
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="expected a folder"):
        make(tmp_path / "file", seed=1, count=1)
    with pytest.raises(
        InputError, match=r"^out: found '.*/a/b', expected a folder in one that exists, '.*/a' does not"
    ):
        make(tmp_path / "a" / "b", seed=1, count=1)
    assert not (tmp_path / "a").exists()


def test_an_interrupted_make_leaves_nothing(tmp_path: Path) -> None:
    def stop(done: int) -> None:
        raise KeyboardInterrupt

    (tmp_path / "there").mkdir()
    for name in ("there", "new"):
        with pytest.raises(KeyboardInterrupt):
            make(tmp_path / name, seed=SEED, count=2, jobs=1, progress=stop)
    assert multiprocessing.active_children() == []
    assert [p.name for p in tmp_path.iterdir()] == ["there"]
    assert not any((tmp_path / "there").iterdir())


def test_every_effect_has_its_turn_in_forty_datasets() -> None:
    for seed in range(5):
        tasks = [task(seed, i) for i in range(40)]
        assert {t.names[0] for t in tasks if t.kind == "one"} == set(CATALOGUE)
        assert Counter(t.kind for t in tasks) == {"none": 8, "one": 20, "two": 6, "outside": 6}
        assert all(len(set(t.names)) == 2 for t in tasks if t.kind == "two")


def test_strength_takes_out_what_the_sensor_may_be_off() -> None:
    lab, jitter = draw_lab(np.random.default_rng(2))
    # A lab whose zero of z is left open would be diagnosed twice where a cause raises the robot.
    assert lab.sensor.z_origin_tolerance_m == 0.0
    frames = [lab.frames(plan) for plan in lab.plans]
    tracked = [i for i, plan in enumerate(lab.plans) if plan.tracked]
    alone = lab.with_plans(tuple(lab.plans[i] for i in tracked))
    scenarios = [world_scenario(lab, lab.plans[i], jitter) for i in tracked]
    plain = [watch(s, (), frames[i], solver="reduced") for s, i in zip(scenarios, tracked, strict=True)]
    assert strength(alone, plain, plain).sigma == 0.0
    shifted = [scene.__class__(scene.time_s, _moved(scene.poses, 20e-6), *_rest(scene)) for scene in plain]
    assert strength(alone, shifted, plain).sigma < 1e-6
    far = [scene.__class__(scene.time_s, _moved(scene.poses, 80e-6), *_rest(scene)) for scene in plain]
    # At most 30 of 80 µm are left once 50 µm are taken out; the camera's heading takes some of them.
    channels = len([c for c in lab.channels if not c.startswith("q")]) + 3 * ("qw" in lab.channels)
    most = 30e-6 / lab.sensor.position_noise_m / np.sqrt(channels)
    assert 0.2 * most < strength(alone, far, plain).sigma < 1.1 * most


def test_strength_takes_out_what_the_nominal_numbers_may_be_off() -> None:
    lab, jitter = draw_lab(np.random.default_rng(2))
    frames = [lab.frames(plan) for plan in lab.plans]

    def seen(other: Jitter) -> list[Scene]:
        scenarios = [world_scenario(lab, plan, other) for plan in lab.plans]
        return [watch(s, (), f, solver="reduced") for s, f in zip(scenarios, frames, strict=True)]

    plain, each = seen(jitter), jitter.each_raised()
    assert len(each) == 6 + len(jitter.dimensions)
    moved = [seen(other) for other in each]
    # The first length, by its standard deviation and by ten: one is taken out, and what the others do of it.
    first, *others = jitter.dimensions
    assert each[6] == replace(jitter, dimensions=(first * (1.0 + DIMENSIONS), *others))
    assert strength(lab, moved[6], plain).sigma > 0.1
    assert strength(lab, moved[6], plain, moved).sigma < 1e-6
    much = seen(replace(jitter, dimensions=(first * (1.0 + 10.0 * DIMENSIONS), *others)))
    whole, left = strength(lab, much, plain), strength(lab, much, plain, moved)
    assert 0.5 * whole.sigma < left.sigma < 0.95 * whole.sigma
    # What is taken out of one trial does not appear in another.
    bare = strength(lab, [much[0], *plain[1:]], plain, moved).by_trial
    assert bare[0] > 1.0
    assert max(bare[1:]) == 0.0


def _moved(poses, by_m):  # type: ignore[no-untyped-def]
    return type(poses)(poses.position_m + np.array([by_m, 0.0, 0.0]), poses.orientation)


def _rest(scene):  # type: ignore[no-untyped-def]
    return scene.before, scene.after, scene.step_s, scene.converged


def test_the_command_refuses_in_one_line(made: Path) -> None:
    done = CliRunner().invoke(blind_app, ["make", "--seed", "1", "--count", "0", "--out", str(made / "new")])
    assert isinstance(done.exception, InputError)
    assert str(done.exception) == "--count: found 0, expected a whole number of at least 1"
    done = CliRunner().invoke(blind_app, ["run", str(made / "none")])
    assert isinstance(done.exception, InputError)
    done = CliRunner().invoke(blind_app, ["run", str(made), "--jobs", "0"])
    assert str(done.exception) == "--jobs: found 0, expected a whole number of at least 1 and at most 1024"
    done = CliRunner().invoke(blind_app, ["run", str(made), "--only", "7"])
    assert str(done.exception).startswith("--only: found 7, expected numbers of datasets in")
    done = CliRunner().invoke(blind_app, ["score", str(made), "--answers", str(made / "dataset-000" / "seal.json")])
    assert "expected 'tumblers-answers/1'" in str(done.exception)


@pytest.mark.parametrize(
    ("axis", "region", "expected"),
    [
        ("time_s", (0.3, 10.0), (0.3, 2.0)),
        ("position_y_m", (1e-3, 2e-3), (1e-3, 2e-3)),
        # A frame of the 5 Hz film at 60 per second has 30 degrees; the outcome and the still field show nothing of it.
        ("cycle_phase_deg", (100.0, 102.0), (86.0, 116.0)),
        ("cycle_phase_deg", (100.0, 140.0), (100.0, 140.0)),
    ],
)
def test_a_region_is_no_narrower_than_what_the_lab_films(
    axis: str, region: tuple[float, float], expected: tuple[float, float]
) -> None:
    still = StaticField(strength_T=0.003, direction=(0.0, 0.0, 1.0))
    plans = (
        Plan(id="slow", field=drive(0.01, 1.0), duration_s=2.0),
        Plan(id="fast", field=drive(0.01, 5.0), duration_s=1.0),
        Plan(id="still", field=still, duration_s=1.0),
        Plan(id="mean", field=drive(0.01, 8.0), duration_s=1.0, tracked=False, outcome="speed"),
    )
    lab = SimpleNamespace(plans=plans, frames_per_second=60.0)
    shown = Strength(5.0, (1.0, 6.0, 9.0, 8.0))
    assert draw._as_filmed(lab, shown, axis, region) == pytest.approx(expected)  # type: ignore[arg-type]


def test_a_lab_whose_numbers_cannot_be_moved_is_drawn_again(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[Jitter] = []
    scenes = draw._World.scenes

    def first_diverges(self: draw._World, *rest: Any) -> list[Scene]:
        seen.append(self.jitter)
        if len(seen) == 1:
            raise ArithmeticError("diverged")
        return scenes(self, *rest)

    monkeypatch.setattr(draw._World, "scenes", first_diverges)
    world = draw._draw_world(np.random.default_rng(3))
    assert world is not None
    assert len(world.moved) == len(world.jitter.each_raised())
    assert world.jitter.mass != seen[0].mass


@pytest.mark.parametrize(("shown", "count"), [((1.0, 9.0), None), ((9.0, 1.0), 2), ((9.0, 9.0), 2)])
def test_a_pair_whose_first_effect_hardly_shows_is_none(
    shown: tuple[float, float], count: int | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    sized = sized_pair(shown, [7.0, 5.0], monkeypatch)
    assert (None if sized is None else len(sized)) == count


@pytest.fixture(scope="module")
def world() -> draw._World:
    found = draw._draw_world(np.random.default_rng(3))
    assert found is not None
    return found


def test_a_pair_that_shows_clearly_beside_each_other_is_taken_before_one_that_does_not(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    shown = iter([(9.0, 2.0), (3.0, 9.0), None, (5.0, 9.0), (9.0, 9.0)])

    def sizes(*_rest: Any) -> list[draw._Sized] | None:
        beside = next(shown)
        return None if beside is None else [draw._Sized(None, 1.0, 9.0, sigma) for sigma in beside]  # type: ignore[arg-type]

    monkeypatch.setattr(draw, "_draw_world", lambda _rng: SimpleNamespace(repeats=lambda _laws: True))
    monkeypatch.setattr(draw, "_sizes", sizes)
    monkeypatch.setattr(draw._Sized, "law", None)
    monkeypatch.setattr(draw, "_measured", lambda _kind, _world, sized, *_rest: [one.beside for one in sized])
    about = Task(kind="two", names=("viscous_drag", "size_error"))
    assert draw._draw(about, np.random.default_rng(0), 0) == [5.0, 9.0]
    # None is clear: the strongest of what there is.
    shown = iter([(9.0, 2.0), (3.0, 9.0), *[None] * 10])
    assert draw._draw(about, np.random.default_rng(0), 0) == [3.0, 9.0]


def test_two_causes_that_cannot_be_at_work_together_show_nothing(
    world: draw._World, monkeypatch: pytest.MonkeyPatch
) -> None:

    def diverges(*_rest: Any) -> list[Scene]:
        raise ArithmeticError("diverged")

    monkeypatch.setattr(draw._World, "scenes", diverges)
    drag = EffectLaw(get("viscous_drag").from_vector([2e-2]))
    assert world.beside([drag, drag]) == [0.0, 0.0]


@pytest.mark.parametrize(
    ("beside", "weakest"), [([7.0, 5.0], 5.0), ([12.0, 20.0], 9.0), ([1.1, 7.0], 1.1), ([7.0, 0.9], None)]
)
def test_a_pair_is_as_strong_as_the_less_that_either_shows_alone_or_beside_the_other(
    beside: list[float], weakest: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    sized = sized_pair((10.0, 9.0), beside, monkeypatch)
    assert (None if sized is None else draw._weakest(sized)) == weakest
    # What is written down is the strength alone.
    assert sized is None or [one.sigma for one in sized] == [10.0, 9.0]


def sized_pair(
    alone: tuple[float, float], beside: list[float], monkeypatch: pytest.MonkeyPatch
) -> list[draw._Sized] | None:
    """Return two causes that show so much, each alone and beside the other."""
    names = ("viscous_drag", "size_error")
    by_name = dict(zip(names, alone, strict=True))
    monkeypatch.setattr(draw, "_size", lambda _world, cause, _target: draw._Sized(cause, 1.0, by_name[cause.name]))
    rng = np.random.default_rng(0)
    lab, _ = draw_lab(rng)
    world = SimpleNamespace(lab=lab, beside=lambda _laws: beside)
    return draw._sizes(world, "two", names, (False, False), 9.0, rng)  # type: ignore[arg-type]


def test_beside_what_does_nothing_a_cause_shows_as_much_as_alone(world: draw._World) -> None:
    drag = EffectLaw(get("viscous_drag").from_vector([2e-2]))
    nothing = EffectLaw(get("magnetization_strength").from_vector([1.0]))
    alone = world.strength([drag])
    assert alone is not None
    assert alone.sigma > 1.0
    assert world.beside([drag, nothing]) == [alone.sigma, 0.0]
    assert world.beside([nothing, drag]) == [0.0, alone.sigma]


def test_what_an_error_of_a_number_does_beside_another_cause_is_not_what_a_cause_shows(world: draw._World) -> None:
    drag = EffectLaw(get("viscous_drag").from_vector([2e-2]))
    # As much as a standard deviation of the nominal number, which is taken out of what a cause shows.
    stronger = EffectLaw(get("magnetization_strength").from_vector([1.0 + NUMBERS]))
    with_nothing_taken_out = strength(world.lab, world.scenes([drag, stronger]), world.scenes([drag])).sigma
    assert with_nothing_taken_out > 1e-2
    # What rounding leaves where a motion is steep.
    assert world.beside([drag, stronger])[1] < 1e-4 * with_nothing_taken_out


def test_laws_stay_in_their_order_beside_each_other(world: draw._World) -> None:
    """A coil's roll-off finds no rotating field where another law has made a table of it."""
    distorted = law_of(get("field_ellipticity").from_vector([0.9, 5.0]), "third_harmonic", 3)
    slow = EffectLaw(get("field_rolloff").from_vector([5e-3]))
    last, first = world.beside([distorted, slow]), world.beside([slow, distorted])
    assert last[1] == 0.0
    assert min(last[0], *first) > 0.1


def test_another_step_is_no_excuse_for_numbers_that_are_off(
    world: draw._World, monkeypatch: pytest.MonkeyPatch
) -> None:
    scenes, weaker = draw._World.scenes, replace(world.jitter, field=0.5 * world.jitter.field)

    def another(self: draw._World, *rest: Any, finer: float = 1.0) -> list[Scene]:
        # In a finer step the world does what another number would.
        return scenes(replace(self, jitter=weaker) if finer < 1.0 else self, *rest)

    open_ = replace(world, moved=(tuple(replace(world, jitter=weaker).scenes([])),))
    assert strength(world.lab, open_.moved[0], world.plain).sigma > draw.QUIET_SIGMA
    assert open_.repeats([])
    monkeypatch.setattr(draw._World, "scenes", another)
    assert not open_.repeats([])
