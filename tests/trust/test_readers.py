"""Readers of files: what they are given they read, or refuse in one line (`make fuzz` gives them more)."""

from __future__ import annotations

import json
import os
import re
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tumblers import InputError, Scenario, dataset
from tumblers.blind.answer import seal
from tumblers.blind.make import ANSWERS_FORMAT, SEAL
from tumblers.blind.page import page_of
from tumblers.blind.records import read_records
from tumblers.blind.score import Scores, score_records

from ..dataset_folder import write_dataset
from .files import ANSWER, DATASET, DIAGNOSIS, FIELD, REPEAT, RUN, SCENARIO, TRACK, mutated

# `TUMBLERS_FUZZ_EXAMPLES=5000` for the long run.
EXAMPLES = int(os.environ.get("TUMBLERS_FUZZ_EXAMPLES", "60"))
LONG = EXAMPLES > 1000
# Far longer than any of these files takes, even on a machine that is busy: whatever is waited for so long never comes.
HANGS_S = 20
fuzz = settings(
    max_examples=EXAMPLES,
    deadline=None,
    derandomize=not LONG,
    database=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)


@contextmanager
def in_time() -> Iterator[None]:
    """Fail where something is waited for without end."""

    def end(_signal: int, _frame: FrameType | None) -> None:
        raise TimeoutError("a file was still being read after a long time")

    before = signal.signal(signal.SIGALRM, end)
    signal.alarm(HANGS_S)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def listing(folder: Path) -> dict[str, tuple[int, int]]:
    """Return the size and the time of every file of a folder, links not followed."""
    stats = {str(path.relative_to(folder)): path.lstat() for path in folder.rglob("*")}
    return {name: (stat.st_size, stat.st_mtime_ns) for name, stat in stats.items()}


def is_sound_or_refused(read: Callable[[], object], folder: Path, file: Path) -> InputError | None:
    """Read, and return the refusal if there is one; nothing else may happen, and nothing may be written."""
    before = listing(folder)
    refusal = None
    with in_time():
        try:
            read()
        except InputError as error:
            refusal = error
    assert listing(folder) == before
    if refusal is not None:
        line = str(refusal)
        assert line.isprintable() or "\n" not in line
        assert line.startswith(str(file))
        assert re.search(r": found .*, expected .", line, re.DOTALL)
        assert len(line) < 2000 + len(str(file))
    return refusal


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with a scenario and a dataset, with traps in it and beside it."""
    folder = write_dataset(tmp_path / "data", DATASET, TRACK)
    (folder / "field.csv").write_text(FIELD)
    (folder / "scenario.toml").write_text(SCENARIO)
    (folder / "up").symlink_to(tmp_path)
    return folder


def test_the_files_that_are_mutated_are_sound(folder: Path) -> None:
    assert Scenario.load(folder / "scenario.toml").effects
    assert len(dataset.load(folder).trials) == 2


@fuzz
@given(contents=mutated(SCENARIO))
def test_any_scenario_is_read_or_refused(folder: Path, contents: bytes) -> None:
    file = folder / "scenario.toml"
    file.write_bytes(contents)
    is_sound_or_refused(lambda: Scenario.load(file), folder, file)


@fuzz
@given(contents=mutated(FIELD))
def test_any_table_of_a_field_is_read_or_refused(folder: Path, contents: bytes) -> None:
    (folder / "field.csv").write_bytes(contents)
    is_sound_or_refused(lambda: Scenario.load(folder / "scenario.toml"), folder, folder / "scenario.toml")


@fuzz
@given(contents=mutated(DATASET))
def test_any_dataset_is_read_or_refused(folder: Path, contents: bytes) -> None:
    (folder / "dataset.toml").write_bytes(contents)
    is_sound_or_refused(lambda: dataset.load(folder), folder, folder / "dataset.toml")


@fuzz
@given(contents=mutated(TRACK))
def test_any_track_is_read_or_refused(folder: Path, contents: bytes) -> None:
    (folder / "tracks" / "f05.csv").write_bytes(contents)
    is_sound_or_refused(lambda: dataset.load(folder), folder, folder / "dataset.toml")


@fuzz
@given(contents=st.one_of(st.binary(max_size=300), st.text(max_size=300).map(lambda text: text.encode())))
def test_any_bytes_are_read_or_refused(folder: Path, contents: bytes) -> None:
    for name in ("scenario.toml", "dataset.toml", "tracks/f05.csv", "field.csv"):
        kept = (folder / name).read_bytes()
        (folder / name).write_bytes(contents)
        read = Scenario.load if name == "scenario.toml" else dataset.load
        file = folder / ("scenario.toml" if name == "scenario.toml" else "dataset.toml")
        is_sound_or_refused(lambda read=read, file=file: read(file), folder, file)  # type: ignore[misc]
        (folder / name).write_bytes(kept)


def answers(entry: object, **more: object) -> str:
    """Return the text of answers.json with one entry."""
    return json.dumps({"format": ANSWERS_FORMAT, "seed": 3, "answers": [entry], **more}, indent=1)


def sealed(folder: Path, text: str) -> None:
    """Write answers, and seals of whatever answers can be found in them, so that reading them gets past the seals."""
    (folder / "answers.json").write_bytes(text.encode("utf-8", "surrogatepass"))
    made = folder / "dataset-000"
    made.mkdir(exist_ok=True)
    try:
        (entry,) = json.loads(text)["answers"]
        sha256 = seal(entry["salt"], entry["answer"])
    except (ValueError, KeyError, TypeError, RecursionError, AttributeError):
        sha256 = "0"
    (made / SEAL).write_text(json.dumps({"format": "tumblers-seal/1", "sha256": sha256}))


@fuzz
@given(data=st.data())
def test_any_answers_are_read_or_refused(tmp_path: Path, data: st.DataObject) -> None:
    sound = answers({"dataset": "dataset-000", "salt": "abc", "answer": ANSWER})
    sealed(tmp_path, data.draw(mutated(sound)).decode("utf-8", "surrogateescape").encode("utf-8", "replace").decode())
    file = tmp_path / "answers.json"
    is_sound_or_refused(lambda: read_records(tmp_path, file), tmp_path, file.parent)


def test_the_answers_that_are_mutated_are_sound(tmp_path: Path) -> None:
    sealed(tmp_path, answers({"dataset": "dataset-000", "salt": "abc", "answer": ANSWER}))
    seed, records = read_records(tmp_path, tmp_path / "answers.json")
    assert (seed, records[0].truth) == (3, ("viscous_drag",))


WRITTEN = {"diagnosis.json": DIAGNOSIS, "run.json": RUN, "repeat.json": REPEAT}


def diagnosed(folder: Path) -> Path:
    """Write what there is of one dataset, all of it sound, and return the dataset's folder."""
    sealed(folder, answers({"dataset": "dataset-000", "salt": "abc", "answer": ANSWER}))
    for name, table in WRITTEN.items():
        (folder / "dataset-000" / name).write_text(json.dumps(table, indent=1))
    return folder / "dataset-000"


def score(folder: Path) -> Scores:
    """Score a folder, its ties not simulated, and write the page."""
    seed, records = read_records(folder, folder / "answers.json")
    scores = score_records(records, seed, lambda _: 0.0)
    page_of(scores)
    return scores


@pytest.mark.parametrize("name", WRITTEN)
@fuzz
@given(data=st.data())
def test_any_diagnosis_is_scored_or_refused(tmp_path: Path, name: str, data: st.DataObject) -> None:
    file = diagnosed(tmp_path) / name
    file.write_bytes(data.draw(mutated(json.dumps(WRITTEN[name], indent=1))))
    is_sound_or_refused(lambda: score(tmp_path), tmp_path, file)


def test_the_diagnosis_that_is_mutated_is_sound(tmp_path: Path) -> None:
    diagnosed(tmp_path)
    scores = score(tmp_path)
    assert (scores.drawn, scores.explained.hits) == (1, 1)


# Named: what the fuzz, or reading the readers beside it, has found. Each was another exception or no end.

TOO_MUCH = {
    "an integer of more digits than Python converts": "9" * 5000,
    "a hexadecimal integer of more digits than Python writes": "0x" + "f" * 5000,
    "tables that are nested deeper than Python writes": "{ " + "a." * 3000 + "a = 1 }",
    "a date that is none": "2000-02-30",
}


@pytest.mark.parametrize("value", TOO_MUCH.values(), ids=TOO_MUCH)
@pytest.mark.parametrize("text", [SCENARIO, DATASET], ids=["scenario", "dataset"])
def test_a_value_that_python_cannot_show_is_refused(folder: Path, text: str, value: str) -> None:
    file = folder / ("scenario.toml" if text == SCENARIO else "dataset.toml")
    read = Scenario.load if text == SCENARIO else dataset.load
    for key in ("magnetization_A_per_m", "friction_coefficient"):
        file.write_text(re.sub(rf"{key} = .*", lambda _, key=key: f"{key} = {value}", text))  # type: ignore[misc]
        assert is_sound_or_refused(lambda: read(file), folder, file) is not None


@pytest.mark.parametrize("value", TOO_MUCH.values(), ids=TOO_MUCH)
def test_a_title_that_python_cannot_show_is_refused(folder: Path, value: str) -> None:
    file = folder / "dataset.toml"
    file.write_text(DATASET.replace('"two trials"', value))
    assert is_sound_or_refused(lambda: dataset.load(folder), folder, file) is not None


@pytest.mark.parametrize("name", ["pipe.csv", "loop.csv", "tracks", "a" * 300, "a\\u0000"])
def test_a_scenario_waits_for_no_pipe(folder: Path, name: str) -> None:
    file = folder / "scenario.toml"
    file.write_text(SCENARIO.replace('"field.csv"', f'"{name}"'))
    assert is_sound_or_refused(lambda: Scenario.load(file), folder, file) is not None


OUTSIDE = [
    "../outside.csv",
    "tracks/../../outside.csv",
    "link.csv",
    "up/outside.csv",
    "/etc/passwd",
    "pipe.csv",
    "loop.csv",
]


@pytest.mark.parametrize("name", OUTSIDE)
def test_no_file_of_a_dataset_is_outside_its_folder(folder: Path, name: str) -> None:
    file = folder / "dataset.toml"
    for inside in ("tracks/f05.csv", "field.csv"):
        file.write_text(DATASET.replace(inside, name))
        refusal = is_sound_or_refused(lambda: dataset.load(folder), folder, file)
        assert refusal is not None
        assert refusal.key is not None
        assert refusal.key.startswith("trial[")


@pytest.mark.parametrize("kind", ["link", "pipe"])
def test_the_dataset_toml_of_a_folder_is_a_file_in_it(folder: Path, tmp_path: Path, kind: str) -> None:
    file = folder / "dataset.toml"
    file.rename(tmp_path / "elsewhere.toml")
    if kind == "link":
        file.symlink_to(tmp_path / "elsewhere.toml")
    else:
        os.mkfifo(file)
    assert is_sound_or_refused(lambda: dataset.load(folder), folder, file) is not None


SALT_OF_NO_TEXT = "\ud800"
REFUSED_ANSWERS: dict[str, dict[str, Any]] = {
    "a dataset that is no name": {"dataset": 5},
    "a dataset above the folder": {"dataset": "../dataset-000"},
    "a dataset anywhere": {"dataset": "/etc"},
    "the folder itself": {"dataset": "."},
    "a salt that is no text": {"salt": SALT_OF_NO_TEXT},
    "a number that JSON does not have": {"answer": {**ANSWER, "jitter_sigma": float("nan")}},
    "places that are no table": {"answer": {**ANSWER, "where": [1]}},
    "a place past the floats": {"answer": {**ANSWER, "where": {"time": [10**400, 1]}}},
}


@pytest.mark.parametrize("change", REFUSED_ANSWERS.values(), ids=REFUSED_ANSWERS)
def test_answers_of_another_form_are_refused(tmp_path: Path, change: dict[str, Any]) -> None:
    folder = tmp_path / "blind"
    folder.mkdir()
    sealed(folder, answers({"dataset": "dataset-000", "salt": "abc", "answer": ANSWER, **change}))
    if "dataset" in change:
        # What is above the folder would answer too.
        (folder / "dataset-000").rename(tmp_path / "dataset-000")
    file = folder / "answers.json"
    assert is_sound_or_refused(lambda: read_records(folder, file), folder, folder) is not None


@pytest.mark.parametrize(
    "text", ["[" * 100_000, '{"a":' * 100_000, answers({}, seed=float("inf")), "9" * 5000, "\ufeff{}"]
)
def test_json_past_any_measure_is_refused(tmp_path: Path, text: str) -> None:
    file = tmp_path / "answers.json"
    file.write_text(text)
    assert is_sound_or_refused(lambda: read_records(tmp_path, file), tmp_path, file) is not None
