"""`Parts`: a long computation in parts on the disk, so that the next call goes on where one stopped."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from .atomic import is_unfinished, write_files
from .errors import InputError, unreadable
from .regular_file import read_regular
from .same_settings import same_settings

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["SETTINGS", "Parts", "numbers_of", "parts_beside"]

T = TypeVar("T")

# The settings are the last file that goes: under another name they say that the rest is no longer wanted.
SETTINGS, _ENDED = "settings.json", "ended.json"
_SUFFIXES = (".json", ".nc")
_FOLDER = "a folder of these results, or none"
_EXPECTED = "a part of these results, or no such file: it is computed again"


class Parts:
    """Results that are kept in a folder, each in a file that is written whole or not at all.

    Parameters
    ----------
    folder
        The folder, made with the first part; None keeps nothing.
    settings
        What the results depend on, as JSON has it.

    Raises
    ------
    InputError
        A folder of other settings, or one that is not of parts.
    """

    def __init__(self, folder: Path | None, settings: Mapping[str, Any]) -> None:
        self.folder, self.settings = folder, settings
        self._begun()

    def _begun(self) -> bool:
        """Return whether the folder holds parts of these results, and refuse one that holds anything else."""
        if self.folder is None or not self.folder.exists():
            return False
        if not self.folder.is_dir():
            raise InputError("parts", f"the file {self.folder}", _FOLDER)
        file, ended = self.folder / SETTINGS, self.folder / _ENDED
        over = ended.exists() and not file.exists()
        # A folder that was made by a call that was killed before its first file is as good as none.
        if not over and not file.exists() and all(entry.name.startswith(".") for entry in self.folder.iterdir()):
            return False
        same_settings(_json(ended if over else file, _FOLDER), self.settings, self.folder)
        if over:
            self._clear()
        return not over

    def _begin(self) -> None:
        assert self.folder is not None
        self.folder.mkdir(exist_ok=True)
        try:
            write_files({self.folder / SETTINGS: _json_bytes(self.settings)})
        except BaseException:
            with suppress(OSError):
                self.folder.rmdir()
            raise

    def _files(self) -> list[Path]:
        """Return the parts that the folder holds, if it is of these results."""
        assert self.folder is not None
        kept = (entry for entry in self.folder.iterdir() if entry.suffix in _SUFFIXES and entry.name[0] != ".")
        return [entry for entry in kept if entry.name not in (SETTINGS, _ENDED) and entry.is_file()]

    def holds(self, name: str) -> bool:
        """Return whether a part of `part` is there already.

        Parameters
        ----------
        name
            Its name.
        """
        return self.folder is not None and self._begun() and (self.folder / f"{name}.json").exists()

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
        OSError
            The folder cannot be written to, or the disk is full.
        """
        return self._kept(f"{name}.json", compute, fits, partial(_json, expected=_EXPECTED), _json_bytes)

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
        OSError
            The folder cannot be written to, or the disk is full.
        """
        return self._kept(f"{name}.nc", compute, fits, _netcdf, _netcdf_bytes)

    def _kept(
        self,
        name: str,
        compute: Callable[[], T],
        fits: Callable[[T], bool],
        read: Callable[[Path], T],
        written: Callable[[T], bytes | memoryview],
    ) -> T:
        if self.folder is None:
            return compute()
        file = self.folder / name
        # Looked at each time: another process may have finished these results meanwhile, or begun other ones.
        if self._begun() and file.exists():
            held = read(file)
            if not fits(held):
                raise InputError("parts", f"something else in {file}", _EXPECTED)
            return held
        result = compute()
        if not self._begun():
            self._begin()
        write_files({file: written(result)})
        return result

    @contextmanager
    def resumable(self) -> Iterator[None]:
        """Say on Ctrl-C that what was done is kept, where anything was; where nothing was, nothing is left."""
        try:
            yield
        except BaseException as stopped:
            done = 0
            # Of other results that were begun there meanwhile, nothing is said.
            with suppress(InputError):
                done = len(self._files()) if self._begun() else 0
            if not done:
                self.discard()
            if not done or not isinstance(stopped, KeyboardInterrupt):
                raise
            sys.stderr.write(
                f"tumblers: interrupted, {done} parts kept in {self.folder}: the same command goes on from there\n"
            )
            raise SystemExit(130) from None

    def discard(self) -> None:
        """Remove the parts, once the whole is written, and their folder; what is not of these results stays."""
        # Who began other results there meanwhile keeps them; who ended the same ones has removed them.
        with suppress(InputError, FileNotFoundError):
            if self.folder is not None and self._begun():
                os.replace(self.folder / SETTINGS, self.folder / _ENDED)
                self._clear()

    def _clear(self) -> None:
        assert self.folder is not None
        left = [entry for entry in self.folder.iterdir() if is_unfinished(entry)]
        for file in [*left, *self._files(), self.folder / _ENDED]:
            file.unlink(missing_ok=True)
        with suppress(OSError):
            self.folder.rmdir()


def parts_beside(out: Path) -> Path:
    """Return the folder for the parts of a command's result.

    Parameters
    ----------
    out
        The file or the folder that the result goes to.
    """
    # Of `.` and of `..` the name has to be found.
    whole = out if out.name not in ("", "..") else out.resolve()
    return whole.parent / f"{whole.name}.parts"


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


def _json(file: Path, expected: str) -> Any:
    try:
        return json.loads(read_regular(file))
    except (json.JSONDecodeError, RecursionError):
        raise InputError("parts", f"text that is no JSON in {file}", expected) from None
    except (OSError, ValueError) as error:
        raise InputError("parts", f"{unreadable(error)} at {file}", expected) from None


def _json_bytes(value: Any) -> bytes:
    return json.dumps(value, indent=1).encode()


def _netcdf(file: Path) -> xr.Dataset:
    import xarray as xr

    try:
        with xr.open_dataset(file, engine="h5netcdf") as opened:
            return opened.load()
    except (OSError, ValueError, KeyError):
        raise InputError("parts", f"no netCDF in {file}", _EXPECTED) from None


def _netcdf_bytes(dataset: xr.Dataset) -> memoryview:
    from .netcdf import netcdf_bytes

    return netcdf_bytes(dataset)
