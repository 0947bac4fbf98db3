"""Files that are written whole or not at all."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from uuid import uuid4

__all__ = ["is_unfinished", "write_files"]

_UNFINISHED = re.compile(r"\..+\.[0-9a-f]{32}\.tmp")


def write_files(contents: Mapping[Path, bytes | memoryview]) -> None:
    """Write all files or none: each is complete under another name before the first takes its own.

    Parameters
    ----------
    contents
        The bytes of each file.

    Raises
    ------
    OSError
        A folder that is missing or cannot be written to, or a full disk.
    """
    temporaries = {path: path.with_name(f".{path.name}.{uuid4().hex}.tmp") for path in contents}
    with ExitStack() as stack:
        for path, temporary in temporaries.items():
            stack.callback(temporary.unlink, missing_ok=True)
            temporary.write_bytes(contents[path])
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
