"""`Parts`: a long computation in parts on the disk, so that the next call goes on where one stopped."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from shutil import rmtree
from typing import TYPE_CHECKING, Any

from .atomic import write_files
from .errors import InputError, unreadable

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["Parts", "numbers_of", "other_setting", "resumable"]

_SETTINGS = "settings.json"
_EXPECTED = "a part of these results, or no such file: it is computed again"


class Parts:
    """Results that are kept in a folder, each in a file that is written whole or not at all.

    Parameters
    ----------
    folder
        The folder, made if it is missing; None keeps nothing.
    settings
        What the results depend on, as JSON has it.

    Raises
    ------
    InputError
        A folder of other settings, or one that is not of parts.
    OSError
        The folder cannot be written to.
    """

    def __init__(self, folder: Path | None, settings: Mapping[str, Any]) -> None:
        self.folder = folder
        if folder is None:
            return
        file = folder / _SETTINGS
        # What a killed write left behind is no part; and one that was killed before its first file has no settings.
        for left in folder.glob(".*.tmp") if folder.exists() else ():
            left.unlink()
        if folder.exists() and any(folder.iterdir()):
            kept = _held(file, lambda held: isinstance(held, Mapping), "a folder of these results, or none")
            other = other_setting(kept, settings)
            if other is not None:
                found, expected = other
                raise InputError("parts", f"{found} in {folder}", f"{expected}, or another file")
            return
        folder.mkdir(exist_ok=True)
        write_files({file: json.dumps(settings, indent=1).encode()})

    def part(self, name: str, compute: Callable[[], Any], fits: Callable[[Any], bool]) -> Any:
        """Return a part: from its file, or computed and then kept.

        Parameters
        ----------
        name
            Its name.
        compute
            Returns it, in what JSON can hold.
        fits
            Whether what a file holds can be this part.

        Raises
        ------
        InputError
            A file that holds something else.
        """
        if self.folder is None:
            return compute()
        file = self.folder / f"{name}.json"
        if file.exists():
            return _held(file, fits, _EXPECTED)
        result = compute()
        write_files({file: json.dumps(result).encode()})
        return result

    def dataset(self, name: str, compute: Callable[[], xr.Dataset], fits: Callable[[xr.Dataset], bool]) -> xr.Dataset:
        """Return a part that is a Dataset: from its netCDF file, or computed and then kept.

        Parameters
        ----------
        name, compute, fits
            As for `part`.

        Raises
        ------
        InputError
            A file that holds something else.
        """
        if self.folder is None:
            return compute()
        import xarray as xr

        from .netcdf import save_netcdf

        file = self.folder / f"{name}.nc"
        if file.exists():
            try:
                with xr.open_dataset(file, engine="h5netcdf") as opened:
                    held = opened.load()
            except (OSError, ValueError, KeyError):
                raise InputError("parts", f"no netCDF in {file}", _EXPECTED) from None
            if not fits(held):
                raise InputError("parts", f"something else in {file}", _EXPECTED)
            return held
        result = compute()
        save_netcdf(result, file)
        return result


@contextmanager
def resumable(folder: Path) -> Iterator[None]:
    """Say on Ctrl-C that what was done is kept; where nothing was, the folder goes, too.

    Parameters
    ----------
    folder
        The folder of `Parts`.
    """
    try:
        yield
    except KeyboardInterrupt:
        names = [file.name for file in folder.iterdir()] if folder.exists() else []
        done = sum(name != _SETTINGS and not name.startswith(".") for name in names)
        if not done:
            if _SETTINGS in names:
                rmtree(folder)
            raise
        sys.stderr.write(f"tumblers: interrupted, {done} parts kept in {folder}: the same command goes on from there\n")
        raise SystemExit(130) from None


def numbers_of(count: int, value: object) -> bool:
    """Return whether a value is a list of so many numbers.

    Parameters
    ----------
    count, value
        How many, and what JSON held.
    """
    return (
        isinstance(value, list)
        and len(value) == count
        and all(isinstance(entry, int | float) and not isinstance(entry, bool) for entry in value)
    )


def _held(file: Path, fits: Callable[[Any], bool], expected: str) -> Any:
    try:
        held = json.loads(file.read_text(encoding="utf-8"))
    except json.JSONDecodeError:
        raise InputError("parts", f"text that is no JSON in {file}", expected) from None
    except (OSError, ValueError) as error:
        raise InputError("parts", f"{unreadable(error)} at {file}", expected) from None
    if not fits(held):
        raise InputError("parts", f"something else in {file}", expected)
    return held


def other_setting(kept: object, settings: Mapping[str, Any]) -> tuple[str, str] | None:
    """Return the first setting that differs, as it was kept and as it is; None if all are the same.

    Parameters
    ----------
    kept, settings
        Settings of the results that are there, and those wanted.
    """
    if not isinstance(kept, Mapping):
        return "no settings", "those of these results"
    for key in dict.fromkeys([*settings, *kept]):
        if kept.get(key) != settings.get(key):
            words = [_short(key, table.get(key)) for table in (kept, settings)]
            if words[0] == words[1]:
                words = [f"another {key}", f"this {key}"]
            return words[0], words[1]
    return None


def _short(key: str, value: object) -> str:
    text = json.dumps(value)
    return f"another {key}" if len(text) > 40 else f"{key} {text}"
