"""Magnetic fields over time, substrate frame, tesla."""

from __future__ import annotations

from dataclasses import dataclass, fields
from math import radians
from pathlib import Path
from typing import ClassVar

from . import _core
from .check import Vector, choice, direction, number, sequence, text, vector
from .errors import InputError, show
from .field_csv import read_field_csv
from .section import as_section, known_keys, read_section, require_table

__all__ = [
    "FIELDS",
    "Field",
    "RotatingField",
    "StaticField",
    "TableField",
    "field_from_table",
    "field_to_table",
    "in_its_csv",
]

_RIGHT_ANGLE = 1e-6
_COVER = 1e-9


@dataclass(frozen=True, kw_only=True, slots=True)
class RotatingField:
    """B(t) = B [b0 cos ωt + ρ (a × b0) sin(ωt + δ)].

    Attributes
    ----------
    strength_T, frequency_Hz
        B, T, and ω/2π, Hz.
    rotation_axis, initial_direction
        a and b0, at right angles, normalised. The defaults roll the robot towards +y.
    quadrature_ratio, phase_error_deg
        ρ and δ, degrees: what the second phase has too much of. At 1 and 0 the field turns on a circle.

    Raises
    ------
    InputError
        A number that is refused, or vectors that are not at right angles.
    """

    kind: ClassVar[str] = "rotating"
    strength_T: float
    frequency_Hz: float
    rotation_axis: Vector = (-1.0, 0.0, 0.0)
    initial_direction: Vector = (0.0, 1.0, 0.0)
    quadrature_ratio: float = 1.0
    phase_error_deg: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "strength_T", number("field.strength_T", self.strength_T, least=0.0))
        object.__setattr__(self, "frequency_Hz", number("field.frequency_Hz", self.frequency_Hz, above=0.0))
        a = direction("field.rotation_axis", self.rotation_axis)
        b = direction("field.initial_direction", self.initial_direction)
        cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
        if abs(cosine) > _RIGHT_ANGLE:
            found = f"a direction whose cosine with rotation_axis is {cosine:.3g}"
            raise InputError("field.initial_direction", found, "one at right angles to rotation_axis")
        object.__setattr__(self, "rotation_axis", a)
        object.__setattr__(self, "initial_direction", b)
        object.__setattr__(self, "quadrature_ratio", number("field.quadrature_ratio", self.quadrature_ratio, least=0.0))
        object.__setattr__(self, "phase_error_deg", number("field.phase_error_deg", self.phase_error_deg))

    def core(self) -> _core.Field:
        """Return the native field."""
        return _core.Field.rotating(
            self.strength_T,
            self.frequency_Hz,
            self.rotation_axis,
            self.initial_direction,
            self.quadrature_ratio,
            radians(self.phase_error_deg),
        )


@dataclass(frozen=True, kw_only=True, slots=True)
class StaticField:
    """A constant field of `strength_T` (T) along `direction` (normalised)."""

    kind: ClassVar[str] = "static"
    strength_T: float
    direction: Vector

    def __post_init__(self) -> None:
        object.__setattr__(self, "strength_T", number("field.strength_T", self.strength_T, least=0.0))
        object.__setattr__(self, "direction", direction("field.direction", self.direction))

    def core(self) -> _core.Field:
        """Return the native field."""
        return _core.Field.uniform(self.strength_T, self.direction)


@dataclass(frozen=True, kw_only=True, slots=True)
class TableField:
    """A field that is linear between the rows of a table.

    Attributes
    ----------
    time_s
        Increasing times, s, shape (n,), n ≥ 2.
    field_T
        B at these times, T, shape (n, 3).

    Raises
    ------
    InputError
        A number that is refused, times that do not increase, or lists of different length.
    """

    kind: ClassVar[str] = "table"
    time_s: tuple[float, ...]
    field_T: tuple[Vector, ...]

    def __post_init__(self) -> None:
        times = sequence("field.time_s", self.time_s, "a list of numbers", number)
        values = sequence("field.field_T", self.field_T, "a list of [Bx, By, Bz]", vector)
        if len(times) < 2:
            raise InputError("field.time_s", f"{len(times)} rows", "at least 2")
        if len(values) != len(times):
            raise InputError("field.field_T", f"{len(values)} rows", f"{len(times)}, as many as in time_s")
        for i in range(1, len(times)):
            if not times[i] > times[i - 1]:
                raise InputError(f"field.time_s[{i}]", show(times[i]), f"a time after {times[i - 1]} s")
        object.__setattr__(self, "time_s", times)
        object.__setattr__(self, "field_T", values)

    def covers(self, duration_s: float) -> None:
        """Refuse a table that does not cover a run.

        Parameters
        ----------
        duration_s
            Time of the run, s.

        Raises
        ------
        InputError
            A table that starts after 0 or ends before `duration_s`.
        """
        first, last = self.time_s[0], self.time_s[-1]
        if first > _COVER * duration_s or last < duration_s * (1.0 - _COVER):
            raise InputError("field.time_s", f"{first} s to {last} s", f"rows that cover 0 s to {duration_s} s")

    def core(self) -> _core.Field:
        """Return the native field."""
        return _core.Field.table(self.time_s, self.field_T)


Field = RotatingField | StaticField | TableField
FIELDS: dict[str, type[Field]] = {field.kind: field for field in (RotatingField, StaticField, TableField)}


def field_from_table(value: object, directory: Path, section: str = "field") -> Field:
    """Return the field of a TOML table; `directory` is where a relative ``csv`` is looked for."""
    table = require_table(section, value)
    if "kind" not in table:
        raise InputError(f"{section}.kind", "no such key", " or ".join(FIELDS))
    kind = FIELDS[choice(f"{section}.kind", table["kind"], list(FIELDS))]
    if kind is TableField and "time_s" not in table and "field_T" not in table:
        known_keys(section, table, ["kind", "csv", *(f.name for f in fields(kind))], ["csv"])
        times, values = read_field_csv(f"{section}.csv", directory / text(f"{section}.csv", table["csv"], "a path"))
        return TableField(time_s=times, field_T=values)
    return read_section(kind, section, table, also=["kind"])


def in_its_csv(error: InputError, table: object) -> InputError:
    """Return an error, that of rows which do not cover a run with the CSV that they were read from.

    Parameters
    ----------
    error
        Of a section ``field`` or of what it is part of.
    table
        The TOML table of that section.
    """
    if error.key != "field.time_s" or not isinstance(table, dict) or "csv" not in table:
        return error
    return InputError("field.csv", f"{show(table['csv'])} with rows from {error.found}", error.expected, error.file)


def field_to_table(field: Field) -> dict[str, object]:
    """Return the TOML table that `field_from_table` reads; the rows of a table travel inside it."""
    return {"kind": field.kind, **as_section(field)}
