"""Files that are written whole or not at all."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping
from contextlib import ExitStack, suppress
from errno import EISDIR
from pathlib import Path
from platform import node
from uuid import uuid4
from zlib import crc32

__all__ = ["is_unfinished", "try_to_write", "write_files"]

# Behind the file's name: the machine and the process that write it, and a number of its own.
_UNFINISHED = re.compile(r"\.(.+)\.([0-9a-f]{8})([0-9a-f]{8})[0-9a-f]{16}\.tmp")


def write_files(contents: Mapping[Path, bytes | memoryview]) -> None:
    """Write all files or none: each is complete under another name before the first takes its own.

    What an earlier process of this machine left of the same files when it was killed is removed.

    Parameters
    ----------
    contents
        The bytes of each file.

    Raises
    ------
    OSError
        A folder that is missing or cannot be written to, a full disk, or a folder that has a file's name.
    """
    for path in contents:
        # Found out after others have taken their names, it would be too late.
        if path.is_dir():
            raise IsADirectoryError(EISDIR, os.strerror(EISDIR), str(path))
    _remove_abandoned(contents)
    temporaries = {path: _unfinished(path) for path in contents}
    with ExitStack() as stack:
        for path, temporary in temporaries.items():
            stack.callback(temporary.unlink, missing_ok=True)
            temporary.write_bytes(contents[path])
        for path, temporary in temporaries.items():
            os.replace(temporary, path)


def try_to_write(path: Path) -> None:
    """Begin a file as `write_files` does, under another name, and leave nothing of it.

    Parameters
    ----------
    path
        The file.

    Raises
    ------
    OSError
        A folder that is missing or cannot be written to, or a name that is too long.
    """
    temporary = _unfinished(path)
    try:
        temporary.touch(exist_ok=False)
    finally:
        temporary.unlink(missing_ok=True)


def is_unfinished(path: Path) -> bool:
    """Return whether a file is what `write_files` left of one when it was killed.

    Parameters
    ----------
    path
        The file.
    """
    return _UNFINISHED.fullmatch(path.name) is not None


def _unfinished(path: Path) -> Path:
    """Return another name beside a file, which no other call has."""
    return path.with_name(f".{path.name}.{_machine():08x}{os.getpid():08x}{uuid4().hex[:16]}.tmp")


def _machine() -> int:
    return crc32(node().encode())


def _remove_abandoned(paths: Iterable[Path]) -> None:
    """Remove what processes of this machine that are no more left of these files."""
    # Windows asks after a process in another way: there such a file stays until someone removes it.
    if os.name == "nt":
        return
    wanted = set(paths)
    for folder in {path.parent for path in wanted}:
        # What cannot be looked at or removed is in nobody's way: the file itself is written beside it.
        with suppress(OSError):
            for entry in folder.iterdir():
                name = _UNFINISHED.fullmatch(entry.name)
                if name is None or folder / name[1] not in wanted or int(name[2], 16) != _machine():
                    continue
                if not _is_alive(int(name[3], 16)):
                    entry.unlink(missing_ok=True)


def _is_alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (PermissionError, OverflowError):
        # Someone else's, or no number of a process: nothing to remove.
        pass
    return True
