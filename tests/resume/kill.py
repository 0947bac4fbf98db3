"""Kills a command for real, at random times, until it ends by itself."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

__all__ = ["files_of", "kill_until_done", "small_disk"]

_MOST = 60


def files_of(folder: Path, pattern: str = "*") -> dict[str, bytes]:
    """Return the files below a folder, none of a folder that is not there."""
    while True:
        # What runs may tidy up while it is looked at.
        with suppress(FileNotFoundError):
            return {
                str(file.relative_to(folder)): file.read_bytes() for file in folder.rglob(pattern) if file.is_file()
            }


def small_disk(limit: int) -> Callable[[], None]:
    """Return what a process does first, so that no file of it gets more than so many bytes, as on a full disk."""

    def limited() -> None:
        import resource

        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    return limited


def kill_until_done(
    command: Sequence[str], cwd: Path, kept: Callable[[], dict[str, bytes]], whole: Path, seed: int, *, again: int = 0
) -> int:
    """Run a command, kill it and run it again until it ends; return how often it was killed.

    Parameters
    ----------
    command, cwd
        What to run, and where.
    kept
        What is done so far, by its name: none of it may change or be lost before the whole is there.
    whole
        The file that is there when all is done.
    seed
        Of the times.
    again
        The command's status where all is done already: a kill may come after its last file.
    """
    draw = random.Random(seed)
    seen: dict[str, bytes] = {}
    for kills in range(_MOST):
        # In a session of its own, so that what it starts is found.
        process = subprocess.Popen(
            command, cwd=cwd, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, start_new_session=True
        )
        # One in four dies while it starts, the others soon after a part more.
        if draw.random() > 0.25:
            while process.poll() is None and len(kept()) <= len(seen):
                time.sleep(0.001)
        try:
            _, err = process.communicate(timeout=draw.uniform(0.0, 0.05))
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL)
            process.communicate()
            _wait_for_all_of(process.pid)
            now = kept()
            assert seen.items() <= now.items() or whole.exists()
            seen = now
            continue
        assert process.returncode == 0 or (process.returncode == again and whole.exists()), err.decode()
        return kills
    raise AssertionError(f"not done after {_MOST} kills")


def _wait_for_all_of(session: int) -> None:
    """Wait until nothing is left of what a killed process started: that has to end by itself."""
    if not Path("/proc/self/stat").exists():
        return
    end = time.monotonic() + 30.0
    while _living(session):
        assert time.monotonic() < end, "processes live on that wait for one that was killed"
        time.sleep(0.01)


def _living(session: int) -> bool:
    for process in os.scandir("/proc"):
        if process.name.isdigit():
            try:
                stat = Path(process.path, "stat").read_text()
            except OSError:
                continue
            # Behind the name: state, parent, group, session.
            state, _, _, of, *_ = stat.rpartition(")")[2].split()
            if int(of) == session and state not in "ZX":
                return True
    return False
