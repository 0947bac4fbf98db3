from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tumblers import InputError
from tumblers.blind.make import make, make_settings
from tumblers.blind.records import read_records
from tumblers.blind.run import run
from tumblers.blind.schedule import task
from tumblers.parts import Parts

from ..dataset_folder import one_outcome
from .kill import files_of, kill_until_done, small_disk

COMMAND = [sys.executable, "-m", "tumblers", "blind"]
# Worlds without an effect are quick to draw.
SEED = next(seed for seed in range(1000) if [task(seed, i).kind for i in range(2)] == ["none", "none"])


def data(directory: Path) -> dict[str, bytes]:
    """Return what depends on the seed alone: neither the answers nor the seals, in which a salt is."""
    return {name: content for name, content in files_of(directory).items() if not name.endswith(".json")}


def whole_parts(folder: Path) -> dict[str, bytes]:
    return {name: content for name, content in files_of(folder, "dataset-*.json").items() if name[0] != "."}


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder ``two`` of two datasets, and the parts that it was made from."""
    folder = tmp_path_factory.mktemp("blind")
    make(folder / "two", seed=SEED, count=2, parts=folder / "two.parts", jobs=2)
    return folder


@pytest.mark.skipif(os.name == "nt", reason="signals")
def test_sealed_datasets_that_are_killed_at_random_times_are_the_same(kept: Path, tmp_path: Path) -> None:
    command = [*COMMAND, "make", "--seed", str(SEED), "--count", "2", "--jobs", "1", "--out", "two"]
    parts = tmp_path / "two.parts"
    assert (
        kill_until_done(command, tmp_path, lambda: whole_parts(parts), tmp_path / "two" / "answers.json", 2, again=2)
        > 1
    )
    assert [file.name for file in tmp_path.iterdir()] == ["two"]
    assert data(tmp_path / "two") == data(kept / "two")
    # Every seal is that of its answer, whose salt is another one.
    seed, records = read_records(tmp_path / "two", tmp_path / "two" / "answers.json")
    assert (seed, [record.answer for record in records]) == (
        SEED,
        [record.answer for record in read_records(kept / "two", kept / "two" / "answers.json")[1]],
    )
    salts = [
        {entry["salt"] for entry in json.loads((folder / "two" / "answers.json").read_text())["answers"]}
        for folder in (kept, tmp_path)
    ]
    assert len(salts[0] | salts[1]) == 4


@pytest.mark.parametrize("there", [[], ["dataset-000"], ["dataset-000", "dataset-001"]])
def test_what_was_killed_while_it_was_written_goes_on(kept: Path, tmp_path: Path, there: list[str]) -> None:
    """A kill among the last moves is too rare to wait for: this is what it leaves."""
    shutil.copytree(kept / "two.parts", tmp_path / "two.parts")
    whole = files_of(kept / "two")
    for name in there:
        shutil.copytree(kept / "two" / name, tmp_path / "two" / name)
    # A diagnosis beside it is no reason to refuse it.
    for name in there:
        (tmp_path / "two" / name / "diagnosis.json").write_text("{}")
    make(tmp_path / "two", seed=SEED, count=2, parts=tmp_path / "two.parts", jobs=1)
    made = files_of(tmp_path / "two")
    assert {name: made[name] for name in whole} == whole
    assert {*made} - {*whole} == {f"{name}/diagnosis.json" for name in there}
    # And once more, where the answers are there, too.
    make(tmp_path / "two", seed=SEED, count=2, parts=tmp_path / "two.parts", jobs=1)
    assert files_of(tmp_path / "two") == made


@pytest.mark.skipif(os.name == "nt", reason="limits")
def test_a_full_disk_gets_one_line_and_the_parts_stay(kept: Path, tmp_path: Path) -> None:
    shutil.copytree(kept / "two.parts", tmp_path / "two.parts")
    before = files_of(tmp_path)
    command = [*COMMAND, "make", "--seed", str(SEED), "--count", "2", "--jobs", "1", "--out", "two"]
    environment = os.environ | {"PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(
        command,
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        env=environment,
        preexec_fn=small_disk(1000),
    )
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.startswith("tumblers: [Errno 27] File too large")
    assert done.stderr.count("\n") == 1
    assert files_of(tmp_path) == before
    assert not (tmp_path / "two").exists()
    assert subprocess.run(command, cwd=tmp_path, capture_output=True, check=False, env=environment).returncode == 0
    assert files_of(tmp_path / "two") == files_of(kept / "two")
    assert not (tmp_path / "two.parts").exists()


def test_other_datasets_are_never_mixed_in(kept: Path, tmp_path: Path) -> None:
    for folder in ("two", "two.parts"):
        shutil.copytree(kept / folder, tmp_path / folder)
    for name in ("dataset-001/dataset.toml", "answers.json", "dataset-002/mine"):
        file = tmp_path / "two" / name
        before = file.read_bytes() if file.exists() else None
        file.parent.mkdir(exist_ok=True)
        file.write_text("mine")
        held = files_of(tmp_path)
        with pytest.raises(InputError, match=r"^out: found datasets or answers in"):
            make(tmp_path / "two", seed=SEED, count=2, parts=tmp_path / "two.parts", jobs=1)
        assert files_of(tmp_path) == held
        if before is None:
            shutil.rmtree(file.parent)
        else:
            file.write_bytes(before)
    with pytest.raises(InputError, match=rf"^parts: found seed {SEED} in .*, expected seed {SEED + 1}"):
        make(tmp_path / "new", seed=SEED + 1, count=2, parts=tmp_path / "two.parts", jobs=1)
    with pytest.raises(InputError, match=r"^parts: found count 2 in .*, expected count 3"):
        make(tmp_path / "new", seed=SEED, count=3, parts=tmp_path / "two.parts", jobs=1)
    assert not (tmp_path / "new").exists()


def test_a_part_of_another_number_is_refused(kept: Path, tmp_path: Path) -> None:
    parts = tmp_path / "parts"
    shutil.copytree(kept / "two.parts", parts)
    shutil.copy(parts / "dataset-000.json", parts / "dataset-001.json")
    with pytest.raises(InputError, match=r"^parts: found something else in .*dataset-001\.json"):
        make(tmp_path / "new", seed=SEED, count=2, parts=parts, jobs=1)
    assert not (tmp_path / "new").exists()


def test_no_answer_lies_in_the_folder_before_the_whole_is_written(tmp_path: Path) -> None:
    class Stopped(Exception):
        pass

    def stop(done: int) -> None:
        raise Stopped

    with pytest.raises(Stopped):
        make(tmp_path / "two", seed=SEED, count=2, parts=tmp_path / "parts", jobs=1, progress=stop)
    assert not (tmp_path / "two").exists()
    assert len(whole_parts(tmp_path / "parts")) == 1
    assert Parts(tmp_path / "parts", make_settings(SEED, 2)).holds("dataset-000")


@pytest.mark.skipif(os.name == "nt", reason="signals")
def test_diagnoses_that_are_killed_at_random_times_are_the_same(tmp_path: Path) -> None:
    for number in range(4):
        for folder in ("whole", "killed"):
            one_outcome(3.0 + number).save(tmp_path / folder / f"dataset-{number:03d}")
    assert run(tmp_path / "whole", jobs=2) == (4, 0, 0)
    killed = tmp_path / "killed"

    def kept() -> dict[str, bytes]:
        return files_of(killed, "run.json")

    assert kill_until_done([*COMMAND, "run", "killed", "--jobs", "2"], tmp_path, kept, killed / "all", 7) > 1
    assert {*files_of(killed)} == {*files_of(tmp_path / "whole")}
    assert files_of(killed, "diagnosis.json") == files_of(tmp_path / "whole", "diagnosis.json")
