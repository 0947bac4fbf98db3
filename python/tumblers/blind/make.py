"""`make`: writes datasets whose truth is drawn at random and sealed."""

from __future__ import annotations

import json
import os
import secrets
import shutil
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from functools import partial
from multiprocessing import get_context
from os import PathLike
from pathlib import Path
from uuid import uuid4

from ..check import thread_count
from ..dataset import Dataset
from ..errors import InputError, show
from ..progress import OnProgress, native_call
from .answer import Answer, seal
from .draw import draw_dataset

__all__ = ["ANSWERS", "ANSWERS_FORMAT", "SEAL", "SEAL_FORMAT", "make", "workers"]

ANSWERS, ANSWERS_FORMAT = "answers.json", "tumblers-answers/1"
SEAL, SEAL_FORMAT = "seal.json", "tumblers-seal/1"
# What the linear algebra of a worker may take: its sums depend on the number of threads.
_ONE_THREAD = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


def make(
    directory: str | PathLike[str],
    *,
    seed: int,
    count: int,
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
    jobs
        Number of processes, all cores by default. The datasets do not depend on it.
    progress
        True for a progress bar over the datasets, or a callback that is told how many are done.

    Raises
    ------
    InputError
        A number that is refused, a folder that holds datasets or answers already, or one in a folder that is missing.
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
    if directory.exists() and not directory.is_dir():
        raise InputError("out", f"the file '{directory}'", "a folder")
    if not directory.parent.is_dir():
        raise InputError("out", f"'{directory}'", f"a folder in one that exists, '{directory.parent}' does not")
    if directory.is_dir() and (any(directory.glob("dataset-*")) or (directory / ANSWERS).exists()):
        raise InputError("out", f"datasets or answers in '{directory}'", "a folder without any")
    with _staging(directory) as staging, native_call("datasets", count, progress) as on_progress:
        answers = []
        with workers(jobs) as pool:
            for index, (dataset, answer) in enumerate(pool.map(partial(draw_dataset, seed), range(count))):
                answers.append(_write(staging, index, dataset, answer))
                if on_progress is not None:
                    on_progress(index + 1)
        text = json.dumps({"format": ANSWERS_FORMAT, "seed": seed, "answers": answers}, indent=1)
        (staging / ANSWERS).write_text(text + "\n", encoding="utf-8")


def _write(staging: Path, index: int, dataset: Dataset, answer: Answer) -> dict[str, object]:
    name = f"dataset-{index:03d}"
    salt = secrets.token_hex(16)
    table = answer.table()
    dataset.save(staging / name)
    sealed = {"format": SEAL_FORMAT, "sha256": seal(salt, table)}
    (staging / name / SEAL).write_text(json.dumps(sealed) + "\n", encoding="utf-8")
    return {"dataset": name, "salt": salt, "answer": table}


@contextmanager
def _staging(directory: Path) -> Iterator[Path]:
    """Give a folder whose contents move to `directory` at the end, and vanish where something fails."""
    made = not directory.exists()
    directory.mkdir(exist_ok=True)
    staging = directory / f".making-{uuid4().hex}"
    try:
        staging.mkdir()
        yield staging
        # The answers come last: a folder that has them is complete.
        for entry in sorted(staging.iterdir(), key=lambda path: (path.name == ANSWERS, path.name)):
            os.replace(entry, directory / entry.name)
    finally:
        shutil.rmtree(staging, ignore_errors=True)
        if made and not any(directory.iterdir()):
            directory.rmdir()


@contextmanager
def workers(jobs: int | None) -> Iterator[ProcessPoolExecutor]:
    """Give a pool of processes whose linear algebra has one thread each.

    Parameters
    ----------
    jobs
        Number of processes, all cores if None.
    """
    before = {name: os.environ.get(name) for name in _ONE_THREAD}
    os.environ.update(dict.fromkeys(_ONE_THREAD, "1"))
    pool = ProcessPoolExecutor(jobs, mp_context=get_context("spawn"))
    try:
        yield pool
    except BaseException:
        # The pool forgets its processes when it is shut down, and would wait for what they are at.
        processes = list(pool._processes.values())
        pool.shutdown(wait=False, cancel_futures=True)
        for process in processes:
            process.terminate()
        for process in processes:
            process.join()
        raise
    finally:
        pool.shutdown(cancel_futures=True)
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
