"""Sections of a TOML file: to and from the frozen dataclasses that hold them."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import MISSING, fields
from difflib import get_close_matches
from typing import TYPE_CHECKING, TypeVar

from .errors import InputError, show

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

__all__ = [
    "as_section",
    "known_keys",
    "read_section",
    "require_table",
    "required_keys",
    "write_entry",
    "write_section",
    "write_value",
]

T = TypeVar("T", bound="DataclassInstance")


def require_table(name: str, value: object) -> Mapping[str, object]:
    """Return `value` if it is a table, or raise `InputError`."""
    if not isinstance(value, Mapping):
        raise InputError(name, show(value), "a table")
    return value


def known_keys(section: str, table: Mapping[str, object], known: Iterable[str], required: Iterable[str]) -> None:
    """Refuse a key of `table` that is not in `known`, and a missing one of `required`."""
    prefix = f"{section}." if section else ""
    names = list(known)
    for key in table:
        if key not in names:
            near = get_close_matches(key, names, 1)
            found = f"an unknown key (did you mean {near[0]}?)" if near else "an unknown key"
            raise InputError(f"{prefix}{show(key)[1:-1]}", found, f"one of {', '.join(names)}")
    for key in required:
        if key not in table:
            raise InputError(f"{prefix}{key}", "no such key", f"a value for {key}" if section else f"{key} in the file")


def required_keys(cls: type[DataclassInstance]) -> list[str]:
    """Return the names of the fields that have no default."""
    return [f.name for f in fields(cls) if f.default is MISSING and f.default_factory is MISSING]


def read_section(cls: type[T], section: str, value: object, also: Iterable[str] = ()) -> T:
    """Return the dataclass `cls` made from a table whose keys are its fields.

    Parameters
    ----------
    section
        The table's name, for errors.
    value
        What the file holds under that name.
    also
        Keys that belong to the table but not to the dataclass.
    """
    table = require_table(section, value)
    names = [f.name for f in fields(cls)]
    known_keys(section, table, [*also, *names], required_keys(cls))
    return cls(**{key: entry for key, entry in table.items() if key in names})


def as_section(instance: DataclassInstance) -> dict[str, object]:
    """Return the fields of a dataclass that are set, in order."""
    values = {f.name: getattr(instance, f.name) for f in fields(instance)}
    return {key: value for key, value in values.items() if value is not None}


def write_section(name: str, table: Mapping[str, object]) -> str:
    """Return a table of numbers, words and (nested) lists of numbers as TOML."""
    return _titled(f"[{name}]", table)


def write_entry(name: str, table: Mapping[str, object]) -> str:
    """Return one table of the array of tables `name` as TOML."""
    return _titled(f"[[{name}]]", table)


def _titled(title: str, table: Mapping[str, object]) -> str:
    return "\n".join([title, *(f"{key} = {write_value(value)}" for key, value in table.items())]) + "\n"


def write_value(value: object) -> str:
    """Return a truth value, a number, a word, a list or an inline table of such as TOML."""
    match value:
        case bool():
            return "true" if value else "false"
        case str():
            # Printable text needs no other escapes than those of JSON.
            return json.dumps(value, ensure_ascii=False)
        case float():
            return repr(value)
        case tuple() | list():
            return f"[{', '.join(write_value(entry) for entry in value)}]"
        case Mapping():
            return f"{{ {', '.join(f'{key} = {write_value(entry)}' for key, entry in value.items())} }}"
    raise TypeError(f"no TOML for {value!r}")
