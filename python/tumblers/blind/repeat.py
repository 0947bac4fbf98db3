"""`repeat`: diagnoses the slowest datasets again, one after another, for their time alone and for the same answer."""

from __future__ import annotations

import json
import os
from os import PathLike
from pathlib import Path
from time import perf_counter, process_time

from ..atomic import write_files
from ..check import thread_count
from ..dataset import load
from ..errors import InputError
from ..progress import OnProgress, native_call
from ..version import __version__
from .repeated import TRIALS
from .run import DIAGNOSIS, RECORD, REPEAT
from .workers import workers

__all__ = ["REPEAT_FORMAT", "repeat"]

REPEAT_FORMAT = "tumblers-blind-repeat/1"


def repeat(
    directory: str | PathLike[str], *, count: int, threads: int, progress: bool | OnProgress = False
) -> dict[str, bool]:
    """Diagnose the datasets that took longest again, nothing beside them, and write ``repeat.json`` to each.

    Longest is by the processors' time, or on the wall where `run` has not noted that, of those with up to
    `TRIALS` trials, whose time has to hold; and of those with more.

    Parameters
    ----------
    directory
        The folder in which `run` has diagnosed.
    count
        How many of either.
    threads
        Threads of a diagnosis.
    progress
        True for a progress bar over the datasets, or a callback that is told how many are done.

    Returns
    -------
    dict
        Dataset to whether the diagnosis is the same, byte for byte.

    Raises
    ------
    InputError
        A number below 1, or a folder without diagnoses of this version.
    TumblersError
        A dataset that cannot be diagnosed any more.
    OSError
        A folder that cannot be written to, or a full disk.
    """
    if count < 1:
        raise InputError("count", str(count), "a whole number of at least 1")
    thread_count("threads", threads)
    found = {path.parent: _seconds(path) for path in Path(directory).glob(f"dataset-*/{RECORD}")}
    took = {folder: seconds for folder, seconds in found.items() if seconds is not None}
    if not took:
        raise InputError(None, "no diagnoses of this version", "a folder of `tumblers blind run`", directory)
    longest_first = sorted(took, key=lambda folder: (-took[folder], folder.name))
    timed = [folder for folder in longest_first if _trials(folder) <= TRIALS]
    slowest = timed[:count] + [folder for folder in longest_first if folder not in timed][:count]
    same = {}
    with native_call("diagnoses", len(slowest), progress) as on_progress, workers(1) as pool:
        for number, folder in enumerate(slowest, start=1):
            same[folder.name] = pool.submit(_again, folder, threads).result()
            if on_progress is not None:
                on_progress(number)
    return same


def _seconds(path: Path) -> float | None:
    try:
        record = json.loads(path.read_bytes())
    except (OSError, ValueError):
        return None
    done = isinstance(record, dict) and record.get("version") == __version__ and record.get("error") is None
    if not done or not (path.parent / DIAGNOSIS).exists():
        return None
    # What ran beside it counts on the wall.
    return float(record.get("processor_s", record["seconds"]))


def _trials(folder: Path) -> int:
    return len(load(folder).trials)


def _cores() -> int | None:
    """Return how many cores this process may use, where that can be known: threads say little without."""
    usable = getattr(os, "sched_getaffinity", None)
    return os.cpu_count() if usable is None else len(usable(0))


def _again(folder: Path, threads: int) -> bool:
    from ..diagnosis import diagnose

    start, worked = perf_counter(), process_time()
    text = diagnose(load(folder), jobs=threads).to_json().encode()
    same = text == (folder / DIAGNOSIS).read_bytes()
    record = {
        "format": REPEAT_FORMAT,
        "version": __version__,
        "seconds": perf_counter() - start,
        "processor_s": process_time() - worked,
        "threads": threads,
        "cores": _cores(),
        "same": same,
    }
    write_files({folder / REPEAT: (json.dumps(record) + "\n").encode()})
    return same
