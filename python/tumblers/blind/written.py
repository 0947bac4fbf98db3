"""Reading what was written beside a blind dataset again, as far as the score looks at it."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, get_args

from ..check import choice, number, sequence, text, thread_count
from ..diagnosis.diagnosis import FORMAT
from ..diagnosis.result import Verdict
from ..errors import InputError, show, unreadable
from ..section import known_keys, require_table
from .repeat import REPEAT_FORMAT
from .run import DIAGNOSIS, RECORD, RECORD_FORMAT, REPEAT

__all__ = ["read_diagnosis", "read_repeat", "read_run", "read_table"]


def read_diagnosis(folder: Path) -> dict[str, Any] | None:
    """Return the table of a dataset's ``diagnosis.json``, the keys that are scored checked; None where there is none.

    Parameters
    ----------
    folder
        The dataset's.

    Raises
    ------
    InputError
        As `read_table`, or a key that is missing or of another kind.
    """
    return _read(folder / DIAGNOSIS, FORMAT, _diagnosis)


def read_run(folder: Path) -> dict[str, Any] | None:
    """Return the record of a dataset's diagnosis as `read_diagnosis` does."""
    return _read(folder / RECORD, RECORD_FORMAT, _run)


def read_repeat(folder: Path) -> dict[str, Any] | None:
    """Return the record of its repetition as `read_diagnosis` does."""
    return _read(folder / REPEAT, REPEAT_FORMAT, _repeat)


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


def _read(path: Path, version: str, check: Callable[[dict[str, Any]], None]) -> dict[str, Any] | None:
    if not path.exists():
        return None
    table = read_table(path, version)
    try:
        check(table)
    except InputError as error:
        raise error.in_file(path) from None
    return table


def _diagnosis(table: dict[str, Any]) -> None:
    _with_keys("", table, "verdict", "effects", "ranking", "gap", "where")
    choice("verdict", table["verdict"], get_args(Verdict))
    sequence("effects", table["effects"], "a list of effects", _effect)
    sequence("ranking", table["ranking"], "a list of hypotheses", _ranked)
    gap = _with_keys("gap", table["gap"], "noise_floor", "before", "after_nuisance_only", "after", "shrink")
    number("gap.noise_floor", gap["noise_floor"])
    for name in ("before", "after_nuisance_only", "after"):
        _number_or_null(f"gap.{name}", gap[name])
    _number_or_null("gap.shrink.estimate", _with_keys("gap.shrink", gap["shrink"], "estimate")["estimate"])
    sequence("where", table["where"], "a list of regions", _region)


def _effect(key: str, value: object) -> None:
    effect = _with_keys(key, value, "name", "parameters", "confounded_with")
    _name(f"{key}.name", effect["name"])
    sequence(f"{key}.confounded_with", effect["confounded_with"], "a list of names", _name)
    for name, interval in require_table(f"{key}.parameters", effect["parameters"]).items():
        mine = f"{key}.parameters.{name}"
        for end in ("estimate", "low", "high"):
            _number_or_null(f"{mine}.{end}", _with_keys(mine, interval, end)[end])


def _ranked(key: str, value: object) -> None:
    hypothesis = _with_keys(key, value, "effects", "probability")
    sequence(f"{key}.effects", hypothesis["effects"], "a list of names", _name)
    number(f"{key}.probability", hypothesis["probability"])


def _region(key: str, value: object) -> None:
    region = _with_keys(key, value, "axis")
    if _name(f"{key}.axis", region["axis"]) == "trial":
        _name(f"{key}.value", _with_keys(key, region, "value")["value"])
    elif "low" in region or "high" in region:
        for end in ("low", "high"):
            _number_or_null(f"{key}.{end}", _with_keys(key, region, end)[end])


def _run(table: dict[str, Any]) -> None:
    _with_keys("", table, "seconds", "threads", "version")
    number("seconds", table["seconds"])
    number("threads", table["threads"])
    text("version", table["version"], "a version")


def _repeat(table: dict[str, Any]) -> None:
    _with_keys("", table, "seconds", "threads", "cores", "same")
    number("seconds", table["seconds"])
    thread_count("threads", table["threads"])
    # Not every system says how many cores a process may use.
    if table["cores"] is not None:
        number("cores", table["cores"], least=1.0)
    # Diagnoses of before did not note it.
    _number_or_null("processor_s", table.get("processor_s"))
    if not isinstance(table["same"], bool):
        raise InputError("same", show(table["same"]), "true or false")


def _with_keys(key: str, value: object, *names: str) -> Mapping[str, Any]:
    """Return a table that has some keys, others being as good."""
    table = require_table(key, value)
    known_keys(key, table, table, names)
    return table


def _name(key: str, value: object) -> str:
    return text(key, value, "a name")


def _number_or_null(key: str, value: object) -> None:
    if value is not None:
        number(key, value)
