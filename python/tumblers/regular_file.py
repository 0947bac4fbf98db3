"""`read_regular`: files that are named in other files."""

from __future__ import annotations

import errno
from pathlib import Path

__all__ = ["read_regular"]


def read_regular(path: Path) -> bytes:
    """Return the bytes of a file that is neither a pipe nor a device, for which one would wait without end.

    Parameters
    ----------
    path
        The file.

    Raises
    ------
    OSError
        A file that cannot be read, or that is no regular one.
    ValueError
        A path with a NUL byte.
    """
    if path.exists() and not path.is_file() and not path.is_dir():
        raise OSError(errno.EINVAL, "no regular file")
    return path.read_bytes()
