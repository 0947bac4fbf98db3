"""Reading what was written beside a blind dataset again, as far as the score looks at it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from math import isfinite
from pathlib import Path
from typing import Any, get_args

from ..diagnosis.diagnosis import FORMAT
from ..diagnosis.result import Verdict
from ..errors import InputError, show, unreadable

__all__ = ["FLAG", "NUMBER", "TEXT", "read_diagnosis", "read_table", "read_timing"]

# Stands for a key of any name.
_ANY = ""
NUMBER, TEXT, FLAG = "a number", "a text", "true or false"
_NUMBER_OR_NULL = "a number or null"

_SHRINK = {"estimate": _NUMBER_OR_NULL}
_INTERVAL = {"estimate": _NUMBER_OR_NULL, "low": _NUMBER_OR_NULL, "high": _NUMBER_OR_NULL}
_DIAGNOSIS: dict[str, Any] = {
    "verdict": get_args(Verdict),
    "effects": [{"name": TEXT, "parameters": {_ANY: _INTERVAL}, "confounded_with": [TEXT]}],
    "ranking": [{"effects": [TEXT], "probability": NUMBER}],
    "gap": {
        "noise_floor": NUMBER,
        "before": _NUMBER_OR_NULL,
        "after_nuisance_only": _NUMBER_OR_NULL,
        "after": _NUMBER_OR_NULL,
        "shrink": _SHRINK,
    },
    "where": [{"axis": TEXT}],
}
_TRIAL, _REGION = {"value": TEXT}, {"low": _NUMBER_OR_NULL, "high": _NUMBER_OR_NULL}
_TIMING: dict[str, Any] = {"seconds": NUMBER, "threads": NUMBER}


def read_diagnosis(path: Path) -> dict[str, Any]:
    """Return the table of a ``diagnosis.json``, whose keys that are scored are as they should be.

    Parameters
    ----------
    path
        The file.

    Raises
    ------
    InputError
        A file that cannot be read or is no diagnosis, or a key that is missing or of another kind.
    """
    table = read_table(path, FORMAT)
    _expect(path, "", table, _DIAGNOSIS)
    for i, region in enumerate(table["where"]):
        if region["axis"] == "trial":
            _expect(path, f"where[{i}]", region, _TRIAL)
        elif "low" in region or "high" in region:
            _expect(path, f"where[{i}]", region, _REGION)
    return table


def read_timing(path: Path, version: str, also: Mapping[str, str]) -> dict[str, Any]:
    """Return the table of a record of how long a diagnosis took; empty where there is none.

    Parameters
    ----------
    path
        The file.
    version
        What its ``format`` has to be.
    also
        Further keys, and what each has to be.

    Raises
    ------
    InputError
        A file that cannot be read or is no such record, or a key that is missing or of another kind.
    """
    if not path.exists():
        return {}
    table = read_table(path, version)
    _expect(path, "", table, {**_TIMING, **also})
    return table


def read_table(path: Path, version: str) -> dict[str, Any]:
    """Return the table of a JSON file of a format.

    Parameters
    ----------
    path
        The file.
    version
        What its ``format`` has to be.

    Raises
    ------
    InputError
        A file that cannot be read, is no JSON, or is of another format.
    """
    try:
        table = json.loads(path.read_bytes())
    except OSError as error:
        raise InputError(None, unreadable(error), f"a {version} file", path) from None
    except (RecursionError, ValueError):
        raise InputError(None, "malformed JSON", f"a {version} file", path) from None
    if not isinstance(table, dict) or table.get("format") != version:
        raise InputError(
            "format", show(table.get("format") if isinstance(table, dict) else table), f"'{version}'", path
        )
    return table


def _expect(path: Path, key: str, value: Any, shape: Any) -> None:
    """Refuse a value that has not a shape: a table of shapes, a list of one, any of some words, or a kind."""
    if isinstance(shape, dict):
        if not isinstance(value, dict):
            raise InputError(key, show(value), "a table", path)
        for name in value if _ANY in shape else shape:
            inner = f"{key}.{name}" if key else name
            if name not in value:
                raise InputError(inner, "no such key", "one", path)
            _expect(path, inner, value[name], shape.get(_ANY, shape.get(name)))
    elif isinstance(shape, list):
        if not isinstance(value, list):
            raise InputError(key, show(value), "a list", path)
        for i, entry in enumerate(value):
            _expect(path, f"{key}[{i}]", entry, shape[0])
    elif isinstance(shape, tuple):
        if value not in shape:
            raise InputError(key, show(value), " or ".join(shape), path)
    elif not _is(value, shape):
        raise InputError(key, show(value), shape, path)


def _is(value: Any, kind: str) -> bool:
    if value is None:
        return kind == _NUMBER_OR_NULL
    if kind == TEXT:
        return isinstance(value, str)
    if kind == FLAG:
        return isinstance(value, bool)
    try:
        return isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)
    except OverflowError:
        return False
