"""`make`: writes datasets whose truth is drawn at random and sealed."""

from __future__ import annotations

import json
import os
import secrets
import shutil
from collections.abc import Iterator, Mapping
from concurrent.futures import Future, as_completed
from contextlib import contextmanager
from functools import partial
from hashlib import sha256
from os import PathLike
from pathlib import Path
from typing import Any

from ..check import thread_count
from ..dataset import Dataset
from ..errors import InputError, show
from ..folder import output_folder
from ..parts import SETTINGS, Parts
from ..progress import OnProgress, native_call
from ..version import __version__
from .answer import Answer, seal
from .draw import draw_dataset
from .workers import workers

__all__ = ["ANSWERS", "ANSWERS_FORMAT", "SEAL", "SEAL_FORMAT", "make", "make_settings"]

ANSWERS, ANSWERS_FORMAT = "answers.json", "tumblers-answers/1"
SEAL, SEAL_FORMAT = "seal.json", "tumblers-seal/1"
_ENTRY = {"dataset": str, "salt": str, "answer": dict, "files": dict}


def make(
    directory: str | PathLike[str],
    *,
    seed: int,
    count: int,
    parts: str | PathLike[str] | None = None,
    jobs: int | None = None,
    progress: bool | OnProgress = False,
) -> None:
    """Write datasets to a folder, and their answers beside them.

    A folder ``dataset-000`` holds a dataset and ``seal.json``, the SHA-256 of its salted answer; ``answers.json`` holds
    the salts and the answers. All files are written at the end, or none. Datasets and answers depend on the seed
    alone; the salts are new each time, so that nobody who knows the seed can open a seal.

    Parameters
    ----------
    directory
        The folder; it is made if it does not exist.
    seed, count
        What everything is drawn from, and how many datasets there are to be.
    parts
        Folder for each dataset with its answer, from which a later call with the same settings goes on; none by
        default.
    jobs
        Number of processes, all cores by default. The datasets do not depend on it.
    progress
        True for a progress bar over the datasets, or a callback that is told how many are done.

    Raises
    ------
    InputError
        A number that is refused, a folder that holds datasets or answers already, or one in a folder that is missing;
        parts of other settings (key ``parts``).
    SimulationError
        A world could not be made.
    OSError
        A folder that cannot be written to, or a full disk.
    """
    for name, value, least in (("seed", seed, 0), ("count", count, 1)):
        if isinstance(value, bool) or not isinstance(value, int) or value < least:
            raise InputError(name, show(value), f"a whole number of at least {least}")
    if jobs is not None:
        thread_count("jobs", jobs)
    directory = Path(directory)
    output_folder("out", directory, [ANSWERS])
    if parts is not None:
        output_folder("parts", Path(parts), [SETTINGS])
    kept = Parts(None if parts is None else Path(parts), make_settings(seed, count))
    names = [f"dataset-{index:03d}" for index in range(count)]
    # Some are there already only where a call was killed while it wrote them, after all were drawn.
    there = directory.is_dir() and (any(directory.glob("dataset-*")) or (directory / ANSWERS).exists())
    if there and not all(kept.holds(name) for name in names):
        raise _taken(directory)
    entries = _drawn(kept, names, seed, jobs, progress)
    answers = [{key: entry[key] for key in ("dataset", "salt", "answer")} for entry in entries]
    table = {"format": ANSWERS_FORMAT, "seed": seed, "answers": answers}
    datasets = {entry["dataset"]: _files(entry) for entry in entries}
    _write(directory, datasets, (json.dumps(table, indent=1) + "\n").encode())


def make_settings(seed: int, count: int) -> dict[str, Any]:
    """Return what the parts of `make` depend on.

    Parameters
    ----------
    seed, count
        As for `make`.
    """
    return {"tumblers_version": __version__, "seed": seed, "count": count}


def _drawn(
    kept: Parts, names: list[str], seed: int, jobs: int | None, progress: bool | OnProgress
) -> list[dict[str, Any]]:
    """Return each dataset's files with its salt and its answer: those that are kept, and the others drawn."""
    with native_call("datasets", len(names), progress) as on_progress, workers(jobs) as pool:

        def drawn(index: int) -> Future[tuple[Dataset, Answer]]:
            return pool.submit(draw_dataset, seed, index)

        def entry(index: int, future: Future[tuple[Dataset, Answer]] | None) -> dict[str, Any]:
            name = names[index]
            made: dict[str, Any] = kept.part(
                name,
                lambda: _entry(name, *(future or drawn(index)).result()),
                partial(_fits, name),
            )
            return made

        held = [index for index, name in enumerate(names) if kept.holds(name)]
        found = {index: entry(index, None) for index in held}
        futures = {drawn(index): index for index in range(len(names)) if index not in found}
        if held and on_progress is not None:
            on_progress(len(held))
        for future in as_completed(futures):
            found[futures[future]] = entry(futures[future], future)
            if on_progress is not None:
                on_progress(len(found))
    return [found[index] for index in range(len(names))]


def _entry(name: str, dataset: Dataset, answer: Answer) -> dict[str, Any]:
    return {"dataset": name, "salt": secrets.token_hex(16), "answer": answer.table(), "files": dataset.texts()}


def _fits(name: str, held: object) -> bool:
    if not isinstance(held, dict) or {*held} != {*_ENTRY} or held["dataset"] != name:
        return False
    return all(isinstance(held[key], kind) for key, kind in _ENTRY.items())


def _files(entry: Mapping[str, Any]) -> dict[str, bytes]:
    """Return the files of a dataset's folder, its seal among them."""
    sealed = {"format": SEAL_FORMAT, "sha256": seal(entry["salt"], entry["answer"])}
    return {name: text.encode() for name, text in entry["files"].items()} | {SEAL: (json.dumps(sealed) + "\n").encode()}


def _write(directory: Path, datasets: Mapping[str, Mapping[str, bytes]], answers: bytes) -> None:
    """Write all datasets and the answers, but for what a call that was killed has written already."""
    waiting = []
    if not {path.name for path in directory.glob("dataset-*")} <= {*datasets}:
        raise _taken(directory)
    for name, files in datasets.items():
        if not (directory / name).exists():
            waiting.append(name)
        elif not all(_same(directory / name / file, content) for file, content in files.items()):
            raise _taken(directory)
    if (directory / ANSWERS).exists() and not _same(directory / ANSWERS, answers):
        raise _taken(directory)
    # The same name in each call that goes on from the same parts, and in no other; it tells no salt.
    seals = b"".join(files[SEAL] for files in datasets.values())
    with _staging(directory, f".making-{sha256(seals).hexdigest()[:32]}") as staging:
        for name in waiting:
            for file, content in datasets[name].items():
                path = staging / name / file
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(content)
        (staging / ANSWERS).write_bytes(answers)


def _same(path: Path, content: bytes) -> bool:
    return path.is_file() and path.read_bytes() == content


def _taken(directory: Path) -> InputError:
    return InputError("out", f"datasets or answers in '{directory}'", "a folder without any")


@contextmanager
def _staging(directory: Path, name: str) -> Iterator[Path]:
    """Give a folder whose contents move to `directory` at the end, and vanish where something fails."""
    made = not directory.exists()
    directory.mkdir(exist_ok=True)
    staging = directory / name
    try:
        # What a call that was killed here left.
        shutil.rmtree(staging, ignore_errors=True)
        staging.mkdir()
        yield staging
        # The answers come last: a folder that has them is complete.
        for entry in sorted(staging.iterdir(), key=lambda path: (path.name == ANSWERS, path.name)):
            os.replace(entry, directory / entry.name)
    finally:
        shutil.rmtree(staging, ignore_errors=True)
        if made and not any(directory.iterdir()):
            directory.rmdir()
