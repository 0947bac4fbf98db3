"""`run`: diagnoses every dataset of a folder, without its answers."""

from __future__ import annotations

import json
from collections.abc import Collection
from concurrent.futures import Future, as_completed
from os import PathLike
from pathlib import Path
from time import perf_counter, process_time
from typing import NamedTuple

from ..atomic import write_files
from ..check import thread_count
from ..errors import InputError
from ..progress import OnProgress, native_call
from ..version import __version__
from .workers import workers

__all__ = ["DIAGNOSIS", "RECORD", "RECORD_FORMAT", "REPEAT", "Done", "run"]

DIAGNOSIS = "diagnosis.json"
# What was computed beside the diagnosis: how long it took, and by which version.
RECORD, RECORD_FORMAT = "run.json", "tumblers-blind-run/1"
# What `repeat` writes: of this diagnosis, so that another one takes it away.
REPEAT = "repeat.json"


class Done(NamedTuple):
    """How many datasets were diagnosed now, had been before, and failed."""

    diagnosed: int
    before: int
    failed: int


def run(
    directory: str | PathLike[str],
    *,
    jobs: int | None = None,
    threads: int = 1,
    only: Collection[int] | None = None,
    progress: bool | OnProgress = False,
) -> Done:
    """Write ``diagnosis.json`` beside every dataset that has none of this version; what is done stays done.

    Parameters
    ----------
    directory
        The folder that `make` wrote.
    jobs
        Number of processes, all cores by default; each diagnoses one dataset at a time.
    threads
        Threads of each diagnosis.
    only
        Numbers of the datasets to diagnose, all if None.
    progress
        True for a progress bar over the datasets, or a callback that is told how many are done.

    Raises
    ------
    InputError
        A folder without datasets, a number of a dataset that is not there, or a number of threads or processes that is
        refused.
    OSError
        A folder that cannot be written to, or a full disk.
    """
    thread_count("threads", threads)
    if jobs is not None:
        thread_count("jobs", jobs)
    named = [(path.name.removeprefix("dataset-"), path) for path in sorted(Path(directory).glob("dataset-*"))]
    # A copy, or an archive, beside them is none.
    folders = {int(number): path for number, path in named if number.isdecimal()}
    if not folders:
        raise InputError(None, "no datasets", "a folder of `tumblers blind make`", directory)
    for number in only or ():
        if number not in folders:
            raise InputError("only", str(number), f"numbers of datasets in '{directory}'")
    chosen = [path for number, path in folders.items() if only is None or number in only]
    waiting = [path for path in chosen if not _is_done(path)]
    failed = 0
    with native_call("diagnoses", len(waiting), progress) as on_progress, workers(jobs) as pool:
        futures: list[Future[bool]] = [pool.submit(_diagnose, path, threads) for path in waiting]
        for count, future in enumerate(as_completed(futures), start=1):
            failed += not future.result()
            if on_progress is not None:
                on_progress(count)
    return Done(len(waiting) - failed, len(chosen) - len(waiting), failed)


def _is_done(folder: Path) -> bool:
    try:
        record = json.loads((folder / RECORD).read_bytes())
    except (OSError, ValueError):
        return False
    same = isinstance(record, dict) and record.get("version") == __version__ and record.get("error") is None
    return same and (folder / DIAGNOSIS).exists()


def _diagnose(folder: Path, threads: int) -> bool:
    """Diagnose a dataset; an error goes to its record, for one that fails must not stop the others."""
    from ..dataset import load
    from ..diagnosis import diagnose

    # It is of what is written here now.
    (folder / REPEAT).unlink(missing_ok=True)
    start, worked = perf_counter(), process_time()
    files: dict[Path, bytes | memoryview] = {}
    error = None
    try:
        files[folder / DIAGNOSIS] = diagnose(load(folder), jobs=threads).to_json().encode()
    except Exception as raised:
        error = f"{type(raised).__name__}: {' '.join(str(raised).split())}"
        (folder / DIAGNOSIS).unlink(missing_ok=True)
    record = {
        "format": RECORD_FORMAT,
        "version": __version__,
        "seconds": perf_counter() - start,
        "processor_s": process_time() - worked,
        "threads": threads,
        "error": error,
    }
    # The record comes last: it says that the diagnosis is whole.
    write_files({**files, folder / RECORD: (json.dumps(record) + "\n").encode()})
    return error is None
