"""Files that are written whole or not at all."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import BinaryIO
from uuid import uuid4

try:
    import fcntl
except ModuleNotFoundError:  # Windows: what a killed process left stays there until someone removes it.
    fcntl = None  # type: ignore[assignment]

__all__ = ["is_unfinished", "write_files"]

_UNFINISHED = re.compile(r"\.(.+)\.[0-9a-f]{32}\.tmp")


def write_files(contents: Mapping[Path, bytes | memoryview]) -> None:
    """Write all files or none: each is complete under another name before the first takes its own.

    What an earlier call left of the same files when it was killed is removed.

    Parameters
    ----------
    contents
        The bytes of each file.

    Raises
    ------
    OSError
        A folder that is missing or cannot be written to, or a full disk.
    """
    _remove_abandoned(contents)
    with ExitStack() as stack:
        temporaries = {path: stack.enter_context(_written(path, content)) for path, content in contents.items()}
        for path, temporary in temporaries.items():
            os.replace(temporary, path)


def is_unfinished(path: Path) -> bool:
    """Return whether a file is what `write_files` left of one when it was killed.

    Parameters
    ----------
    path
        The file.
    """
    return _UNFINISHED.fullmatch(path.name) is not None


@contextmanager
def _written(path: Path, content: bytes | memoryview) -> Iterator[Path]:
    """Give the bytes under another name beside the file, which goes unless it was moved."""
    with _begun(path) as file:
        temporary = Path(file.name)
        try:
            file.write(content)
            file.flush()
            if fcntl is None:
                # Windows moves no file that is open.
                file.close()
            yield temporary
        finally:
            temporary.unlink(missing_ok=True)


def _begun(path: Path) -> BinaryIO:
    """Return a new file beside another one, locked: the system frees what a process locked, however that ends."""
    while True:
        temporary = path.with_name(f".{path.name}.{uuid4().hex}.tmp")
        file = temporary.open("xb")
        if fcntl is None:
            return file
        # Not every file system has locks; on one that has none, nobody takes the file for abandoned either.
        with suppress(OSError):
            fcntl.flock(file, fcntl.LOCK_EX)
        # Until it was locked it looked abandoned to whoever writes the same file.
        if temporary.exists():
            return file
        file.close()


def _remove_abandoned(paths: Iterable[Path]) -> None:
    """Remove what processes that are no more left of these files."""
    if fcntl is None:
        return
    for path in paths:
        # What cannot be looked at or removed is in nobody's way: the file itself is written beside it.
        with suppress(OSError):
            for entry in path.parent.iterdir():
                name = _UNFINISHED.fullmatch(entry.name)
                if name is not None and name[1] == path.name:
                    with suppress(OSError), entry.open("r+b") as file:
                        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                        entry.unlink()
