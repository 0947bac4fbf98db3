"""The CSV of a tabulated field."""

from __future__ import annotations

from pathlib import Path

from .check import Vector, decimal
from .csv_rows import read_csv_rows
from .errors import InputError, show

__all__ = ["read_field_csv"]

_COLUMNS = ("time_s", "Bx_T", "By_T", "Bz_T")


def read_field_csv(key: str, path: Path) -> tuple[tuple[float, ...], tuple[Vector, ...]]:
    """Return the times (s) and the fields (T) of a CSV with columns time_s, Bx_T, By_T, Bz_T.

    Parameters
    ----------
    key
        The key that names the file, for errors.
    path
        The file.

    Raises
    ------
    InputError
        For `key`: a file that cannot be read, other columns, a cell that is not a finite number, or rows that are out
        of order or too few.
    """
    table = read_csv_rows(key, path, repr(str(path))[1:-1])
    header = table[0][1] if table else []
    if sorted(header) != sorted(_COLUMNS):
        raise InputError(
            key, f"{path} with the columns {show(header)}", f"the columns {', '.join(_COLUMNS)}, each once and no other"
        )
    rows = [_row(key, path, line, row, header) for line, row in table[1:]]
    if len(rows) < 2:
        raise InputError(key, f"{path} with {len(rows)} rows", "at least 2")
    for (line, _), before, row in zip(table[2:], rows, rows[1:], strict=False):
        if not row[0] > before[0]:
            raise InputError(key, f"{path} line {line} at {row[0]} s", f"a time after {before[0]} s")
    return tuple(row[0] for row in rows), tuple((row[1], row[2], row[3]) for row in rows)


def _row(key: str, path: Path, line: int, row: list[str], header: list[str]) -> list[float]:
    if len(row) != len(header):
        raise InputError(key, f"{path} line {line} with {len(row)} cells", f"{len(header)}")
    cells = dict(zip(header, row, strict=True))
    found = []
    for name in _COLUMNS:
        try:
            value = decimal(cells[name])
        except ValueError:
            value = float("nan")
        if not abs(value) < float("inf"):
            raise InputError(key, f"{path} line {line}: {name} {show(cells[name])}", "a finite number")
        found.append(value)
    return found
