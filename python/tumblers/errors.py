"""Everything that this package raises on purpose."""

from __future__ import annotations

import re
from os import PathLike, fspath
from typing import Self

__all__ = ["InputError", "SimulationError", "TumblersError", "show"]

_LONGEST = 80


def show(value: object) -> str:
    """Return `value` as one short line of text."""
    text = " ".join(repr(value).split())
    return text if len(text) <= _LONGEST else text[: _LONGEST - 3] + "..."


class TumblersError(Exception):
    """Root of the package's errors."""


class SimulationError(TumblersError):
    """A run that could not be carried out although its input is sound."""


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
        """Return this error with the file that it was found in, unless it names one."""
        return self if self.file is not None else type(self)(self.key, self.found, self.expected, file)

    @classmethod
    def from_core(cls, key: str, error: Exception, expected: str) -> Self:
        """Return what the native module says about `key` as this error."""
        text = " ".join(str(error).split())
        match = re.fullmatch(r"(.*?), expected (.*)", text)
        if match is None:
            return cls(key, text, expected)
        return cls(key, match[1].removeprefix(f"{key.rsplit('.', 1)[-1]} is "), match[2])
