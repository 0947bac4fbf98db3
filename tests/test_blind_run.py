from __future__ import annotations

import json
import os
import sys
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from types import ModuleType, SimpleNamespace

import pytest

import tumblers
from tumblers import InputError
from tumblers.blind.repeat import repeat
from tumblers.blind.run import _diagnose, _is_done, run
from tumblers.dataset import Dataset

from .dataset_folder import one_outcome

THREADS = 2


def write(folder: Path, trials: int = 1) -> Path:
    dataset = one_outcome()
    named = (replace(dataset.trials[0], id=f"{dataset.trials[0].id}{n}") for n in range(trials))
    replace(dataset, trials=tuple(named)).save(folder)
    return folder


@pytest.fixture
def diagnose(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """A diagnosis that takes no time; the list holds what it returns or raises."""
    says: list[object] = ['{"format": "tumblers-diagnosis/1"}']

    def stand_in(dataset: Dataset, *, jobs: int) -> SimpleNamespace:
        assert jobs == THREADS
        if isinstance(says[0], Exception):
            raise says[0]
        return SimpleNamespace(to_json=lambda: says[0])

    module = ModuleType("tumblers.diagnosis")
    module.diagnose = stand_in  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "tumblers.diagnosis", module)
    return says


def test_a_diagnosis_and_its_record_are_written(diagnose: list[object], tmp_path: Path) -> None:
    folder = write(tmp_path / "dataset-000")
    # The answers lie beside the datasets, and must not be needed.
    assert not _is_done(folder)
    assert _diagnose(folder, THREADS)
    assert (folder / "diagnosis.json").read_text() == diagnose[0]
    record = json.loads((folder / "run.json").read_text())
    assert (record["version"], record["error"]) == (tumblers.__version__, None)
    assert record["seconds"] >= 0.0
    assert record["threads"] == THREADS
    assert _is_done(folder)


def test_the_slowest_are_diagnosed_again_for_the_same_answer(
    diagnose: list[object], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The first had others beside it.
    for number, (seconds, processor_s) in enumerate(((9.0, 2.0), (5.0, 5.0), (3.0, 3.0))):
        folder = write(tmp_path / f"dataset-{number:03d}")
        _diagnose(folder, THREADS)
        record = json.loads((folder / "run.json").read_text())
        assert record["processor_s"] > 0.0
        (folder / "run.json").write_text(json.dumps({**record, "seconds": seconds, "processor_s": processor_s}))
    # Here and not in a process of their own, where the stand-in is not.
    pool = SimpleNamespace(submit=lambda call, *of: SimpleNamespace(result=lambda: call(*of)))
    monkeypatch.setattr("tumblers.blind.repeat.workers", lambda _jobs: nullcontext(pool))
    assert repeat(tmp_path, count=2, threads=THREADS) == {"dataset-001": True, "dataset-002": True}
    assert not (tmp_path / "dataset-000" / "repeat.json").exists()
    diagnose[0] = '{"format": "tumblers-diagnosis/1", "verdict": "no_gap"}'
    assert repeat(tmp_path, count=1, threads=THREADS) == {"dataset-001": False}
    again = json.loads((tmp_path / "dataset-001" / "repeat.json").read_text())
    assert (again["same"], again["threads"]) == (False, THREADS)
    assert 1 <= again["cores"] <= (os.cpu_count() or 1)
    assert again["processor_s"] > 0.0
    # Another diagnosis has not been repeated.
    _diagnose(tmp_path / "dataset-001", THREADS)
    assert not (tmp_path / "dataset-001" / "repeat.json").exists()


def test_those_with_more_trials_are_diagnosed_again_beside_those_whose_time_has_to_hold(
    diagnose: list[object], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for number, trials in enumerate((12, 13, 14)):
        folder = write(tmp_path / f"dataset-{number:03d}", trials)
        _diagnose(folder, THREADS)
        record = json.loads((folder / "run.json").read_text())
        (folder / "run.json").write_text(json.dumps({**record, "processor_s": 1.0 + number}))
    pool = SimpleNamespace(submit=lambda call, *of: SimpleNamespace(result=lambda: call(*of)))
    monkeypatch.setattr("tumblers.blind.repeat.workers", lambda _jobs: nullcontext(pool))
    assert list(repeat(tmp_path, count=1, threads=THREADS)) == ["dataset-000", "dataset-002"]


def test_another_version_or_a_failure_is_not_done(diagnose: list[object], tmp_path: Path) -> None:
    folder = write(tmp_path / "dataset-000")
    _diagnose(folder, THREADS)
    record = json.loads((folder / "run.json").read_text())
    (folder / "run.json").write_text(json.dumps({**record, "version": "0"}))
    assert not _is_done(folder)
    diagnose[0] = InputError("trial", "nothing", "something")
    assert not _diagnose(folder, THREADS)
    assert not (folder / "diagnosis.json").exists()
    assert (
        json.loads((folder / "run.json").read_text())["error"] == "InputError: trial: found nothing, expected something"
    )
    assert not _is_done(folder)
    (folder / "run.json").write_text("{")
    assert not _is_done(folder)


def test_no_thread_is_refused_before_anything_is_diagnosed(tmp_path: Path) -> None:
    for wrong in ({"threads": 0}, {"jobs": 0}, {"jobs": 1025}):
        ((key, value),) = wrong.items()
        with pytest.raises(InputError, match=f"^{key}: found {value}, expected a whole number of at least 1"):
            run(tmp_path, **wrong)


def test_what_is_done_stays_done(diagnose: list[object], tmp_path: Path) -> None:
    _diagnose(write(tmp_path / "dataset-000"), THREADS)
    assert run(tmp_path, jobs=1) == (0, 1, 0)


def test_what_lies_beside_the_datasets_is_none(diagnose: list[object], tmp_path: Path) -> None:
    assert diagnose
    _diagnose(write(tmp_path / "dataset-000"), THREADS)
    (tmp_path / "dataset-000.zip").touch()
    (tmp_path / "dataset-1 (copy)").mkdir()
    assert run(tmp_path, jobs=1) == (0, 1, 0)


def test_a_folder_without_datasets_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no datasets"):
        run(tmp_path)
    write(tmp_path / "dataset-000")
    with pytest.raises(InputError, match=r"^only: found 3"):
        run(tmp_path, only=[3])
