"""A folder that a command writes its files into."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from .atomic import try_to_write
from .errors import InputError, reason, show

__all__ = ["output_folder"]


def output_folder(option: str, folder: Path, names: Sequence[str]) -> None:
    """Refuse a folder that could not be written to in the end, before anything is computed.

    Parameters
    ----------
    option
        What it was given with.
    folder
        Where the files go; made later if missing.
    names
        The files' names, one at least.

    Raises
    ------
    InputError
        A file, a folder that can be neither made nor written to, or one that has folders by the files' names.
    """
    try:
        _check(option, folder, names)
        _try(folder, names[0])
    except OSError as error:
        raise InputError(option, f"{show(str(folder))}: {reason(error)}", "a folder that can be written to") from None


def _check(option: str, folder: Path, names: Iterable[str]) -> None:
    if folder.exists() and not folder.is_dir():
        raise InputError(option, f"the file '{folder}'", "a folder")
    if folder.is_symlink() and not folder.exists():
        raise InputError(option, f"the link '{folder}' to nothing", "a folder")
    if not folder.exists() and not folder.parent.is_dir():
        what = "is a file" if folder.parent.exists() else "does not"
        raise InputError(option, f"'{folder}'", f"a folder in one that exists, '{folder.parent}' {what}")
    for name in names:
        if (folder / name).is_dir():
            raise InputError(option, f"the folder '{folder / name}'", f"a folder in which {name} can be written")


def _try(folder: Path, name: str) -> None:
    """Begin a file in a folder and leave it as it was: what it allows does not say whether its file system does."""
    new = not folder.exists()
    if new:
        folder.mkdir()
    try:
        # Under a name that is written later, which removes what a kill left of it.
        try_to_write(folder / name)
    finally:
        if new:
            folder.rmdir()
