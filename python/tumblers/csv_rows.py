"""The rows of a CSV file that is named in another file."""

from __future__ import annotations

import csv
from pathlib import Path

from .errors import InputError, unreadable
from .regular_file import read_regular

__all__ = ["read_csv_rows"]


def read_csv_rows(key: str, path: Path, name: str) -> list[tuple[int, list[str]]]:
    """Return the rows with anything in them, each with the line in which it ends and its cells without spaces around.

    Parameters
    ----------
    key
        The key that names the file, for errors.
    path, name
        The file, and what to call it in errors.

    Raises
    ------
    InputError
        For `key`: a file that cannot be read, or that is no CSV.
    """
    try:
        # With the line breaks: a quoted cell may hold one.
        lines = read_regular(path).decode("utf-8-sig").splitlines(keepends=True)
    except (OSError, ValueError) as error:
        raise InputError(key, f"{unreadable(error)}: {name}", "a readable CSV file") from None
    reader = csv.reader(lines, strict=True, skipinitialspace=True)
    try:
        rows = [(reader.line_num, [cell.strip() for cell in row]) for row in reader]
    except csv.Error as error:
        raise InputError(key, f"{name}: {error}", "a CSV file") from None
    # A spreadsheet leaves rows of empty cells behind.
    rows = [(line, cells) for line, cells in rows if any(cells)]
    line, header = rows[0] if rows else (0, [])
    # As a spreadsheet writes it where numbers have decimal commas.
    for separator, word in ((";", "semicolons"), ("\t", "tabs")):
        if len(header) == 1 and separator in header[0]:
            expected = "commas between columns, and points in numbers"
            raise InputError(key, f"{name} line {line} with {word} between columns", expected)
    return rows
