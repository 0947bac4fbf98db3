"""Everything that this package raises on purpose."""

from __future__ import annotations

from os import PathLike, fspath
from typing import Self

__all__ = ["EffectError", "InputError", "SimulationError", "TumblersError", "reason", "shorten", "show", "unreadable"]

_LONGEST = 80


def show(value: object) -> str:
    """Return `value` as one short line of text."""
    try:
        text = " ".join(repr(value).split())
    except (RecursionError, ValueError):
        # Tables nested too deeply, and integers of more digits than Python writes.
        return f"a value of type {type(value).__name__} that is too long to show"
    return shorten(text)


def shorten(text: str) -> str:
    """Return a text, its end left out where it is too long for a line."""
    return text if len(text) <= _LONGEST else text[: _LONGEST - 3] + "..."


def reason(error: OSError) -> str:
    """Return what the system says of a failure."""
    return (error.strerror or "unknown reason").lower()


def unreadable(error: OSError | ValueError) -> str:
    """Return why a file could not be read as text."""
    match error:
        case FileNotFoundError():
            return "no such file"
        case IsADirectoryError():
            return "a directory"
        case OSError():
            return f"a file that cannot be read ({reason(error)})"
        case UnicodeDecodeError():
            return "bytes that are no UTF-8 text"
    return "a path with a NUL byte"


class TumblersError(Exception):
    """Root of the package's errors."""


class SimulationError(TumblersError):
    """A run that could not be carried out although its input is sound."""


class EffectError(TumblersError):
    """An effect of a user's own that fails when it is to edit a scenario."""


class InputError(TumblersError, ValueError):
    """A file, a key or a value that is refused; its text is one line.

    Parameters
    ----------
    key
        Where the value stands, such as ``robot.mass_kg``; None where the file as a whole is meant.
    found, expected
        What was found and what was expected, in words.
    file
        The file that it was read from, where there is one.
    """

    def __init__(self, key: str | None, found: str, expected: str, file: str | PathLike[str] | None = None) -> None:
        super().__init__(key, found, expected, file)
        self.key = key
        self.found = found
        self.expected = expected
        self.file = None if file is None else fspath(file)

    def __str__(self) -> str:
        """Return ``file: key: found ..., expected ...``."""
        text = ": ".join([*(part for part in (self.file, self.key) if part), f"found {self.found}"])
        return " ".join(f"{text}, expected {self.expected}".split())

    def in_file(self, file: str | PathLike[str]) -> Self:
        """Return this error with the file that it was found in, unless it names one.

        Parameters
        ----------
        file
            The file.
        """
        return self if self.file is not None else type(self)(self.key, self.found, self.expected, file)
