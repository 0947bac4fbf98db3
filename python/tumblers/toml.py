"""TOML texts, with errors of one line."""

from __future__ import annotations

import re
import tomllib
from typing import Any

from .errors import InputError

__all__ = ["parse_toml"]

_TWICE = re.compile(r"Cannot (?:overwrite a value|declare .* twice|mutate .*) \(at (?:line (\d+)|end)")
_KEY = re.compile(r"\s*(\[.*?\]+|[\w.\"'-]+(?=\s*=))")


def parse_toml(text: str) -> dict[str, Any]:
    """Return the table of a TOML text.

    Parameters
    ----------
    text
        The file's contents.

    Raises
    ------
    InputError
        Malformed TOML; a key that stands twice is named where its line shows it.
    """
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise InputError(None, "malformed TOML: brackets nested too deeply", "valid TOML") from None
    except tomllib.TOMLDecodeError as error:
        raise InputError(None, f"malformed TOML: {_twice(text, str(error)) or error}", "valid TOML") from None
    except ValueError:
        # Beside malformed TOML only what `int` refuses.
        raise InputError(None, "malformed TOML: an integer of too many digits", "valid TOML") from None


def _twice(text: str, message: str) -> str | None:
    found = _TWICE.match(message)
    if found is None:
        return None
    lines = text.replace("\r\n", "\n").rstrip("\n").split("\n")
    line = int(found[1] or len(lines))
    key = _KEY.match(lines[line - 1])
    return f"{key[1]} a second time (at line {line})" if key else None
