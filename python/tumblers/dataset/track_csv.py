"""The CSV of a track."""

from __future__ import annotations

import csv
import io
import re
from dataclasses import dataclass
from math import isfinite
from pathlib import Path

import numpy as np

from ..check import decimal
from ..csv_rows import read_csv_rows
from ..errors import InputError, show
from .pixels import to_substrate
from .sensor import MOST_PX, Sensor
from .track import CHANNELS, QUATERNION, Array, Track, find_disorder, find_fault

__all__ = ["TrackFile", "read_track_csv", "write_track_csv"]

_PIXELS = (("x_px", "y_px"), ("x", "y"))
# What trackpy and pandas write beside frame, x and y; it says nothing about where the robot is.
_PASSED_OVER = ("particle", "mass", "size", "ecc", "signal", "raw_mass", "ep")
# A column without a name, and what pandas makes of it.
_UNNAMED = re.compile(r"|Unnamed: [\d.]+")
_LOST = "a finite number, or an empty cell for a lost frame"


@dataclass(frozen=True, kw_only=True, slots=True)
class _Table:
    """The cells of a file, with what an error needs to name one of them."""

    key: str
    name: str
    lines: list[int]
    cells: dict[str, list[str]]

    def place(self, row: int, column: str) -> str:
        return f"{self.name} line {self.lines[row]}: {column}"

    def refuse(self, row: int, column: str, found: str, expected: str) -> InputError:
        return InputError(self.key, f"{self.place(row, column)} {found}", expected)

    def numbers(self, column: str, expected: str, *, lost: bool) -> Array:
        values = np.full(len(self.lines), np.nan)
        for row, cell in enumerate(self.cells[column]):
            if lost and not cell:
                continue
            try:
                values[row] = decimal(cell)
            except ValueError:
                raise self.refuse(row, column, show(cell), expected) from None
            if not isfinite(values[row]):
                raise self.refuse(row, column, show(cell), expected)
        return values


@dataclass(frozen=True, kw_only=True, slots=True)
class TrackFile:
    """A track, and where its rows stand in its file.

    Attributes
    ----------
    track
        The track.
    table, clock
        The cells, and the column of the times.
    """

    track: Track
    table: _Table
    clock: str

    def time_of(self, row: int) -> str:
        """Return the time of a row of the track, by its number, as it stands in the file."""
        words = f"{self.table.place(row, self.clock)} {show(self.table.cells[self.clock][row])}"
        return (
            words if self.clock == "time_s" else f"{words}, which is {self.track.time_s[row]:g} s by frames_per_second"
        )


def read_track_csv(key: str, path: Path, name: str, sensor: Sensor) -> TrackFile:
    """Return the track of a CSV.

    The times are a column ``time_s`` or, with `frames_per_second`, ``frame``. Beside it stand any of `CHANNELS`, where
    ``x_px, y_px`` (beside ``frame`` also ``x, y``, as trackpy writes them) may stand for ``x_m, y_m``.

    Parameters
    ----------
    key
        The key that names the file, for errors.
    path, name
        The file, and what to call it in errors.
    sensor
        Units of pixels and frames.

    Raises
    ------
    InputError
        A file that cannot be read, other columns, two particles, a cell that is no number, rows that are out of order,
        or units that the sensor does not state.
    """
    table = _read(key, path, name)
    clock, pixels = _columns(table)
    _one_particle(table, pixels or ())
    time = _times(table, clock, sensor)
    channels = {column: table.numbers(column, _LOST, lost=True) for column in CHANNELS if column in table.cells}
    if pixels is not None:
        x, y = (table.numbers(column, _LOST, lost=True) for column in pixels)
        for row in np.flatnonzero(np.isnan(x) != np.isnan(y)):
            empty, other = pixels if np.isnan(x[row]) else pixels[::-1]
            raise table.refuse(int(row), empty, f"an empty cell beside one of {other}", "both pixels or none")
        for column, values in zip(pixels, (x, y), strict=True):
            for row in np.flatnonzero(np.abs(values) > MOST_PX):
                found = show(table.cells[column][row])
                raise table.refuse(int(row), column, found, f"a pixel of an image, at most {MOST_PX:g}")
        channels["x_m"], channels["y_m"] = to_substrate(x, y, time, sensor, name)
    fault = find_fault(time, channels)
    if fault is not None:
        column, found = fault.column, fault.found
        if column not in table.cells and pixels is not None:
            column, (x_cell, y_cell) = pixels[0], (show(table.cells[pixel][fault.row]) for pixel in pixels)
            scale = f"{sensor.micrometres_per_pixel:g} micrometres_per_pixel"
            found = f"{x_cell} and {pixels[1]} {y_cell}, of which {scale} make {fault.column} {found}"
        raise table.refuse(fault.row, column, found, fault.expected)
    return TrackFile(track=Track(time_s=time, channels=channels), table=table, clock=clock)


def write_track_csv(track: Track) -> str:
    """Return the CSV that `read_track_csv` reads to the same bits.

    Parameters
    ----------
    track
        The track.
    """
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(["time_s", *track.channels])
    for row in zip(track.time_s.tolist(), *(values.tolist() for values in track.channels.values()), strict=True):
        writer.writerow(repr(value) if isfinite(value) else "" for value in row)
    return file.getvalue()


def _read(key: str, path: Path, name: str) -> _Table:
    rows = read_csv_rows(key, path, name)
    header = rows[0][1] if rows else []
    for line, row in rows[1:]:
        if len(row) != len(header):
            raise InputError(key, f"{name} line {line} with {len(row)} cells", f"{len(header)}")
    cells: dict[str, list[str]] = {}
    for i, column in enumerate(header):
        entries = [row[i] for _, row in rows[1:]]
        # pandas writes an index without a name first, and says nothing with it; a spreadsheet leaves empty columns.
        if _UNNAMED.fullmatch(column) and (i == 0 or not any(entries)):
            continue
        # What trackpy filters has its frames twice: as the index, and as a column.
        if column in cells and (column != "frame" or _values(entries) != _values(cells[column])):
            expected = "each column once" if column != "frame" else "the same frames in both"
            raise InputError(key, f"{name} with two columns {show(column)}", expected)
        cells[column] = entries
    return _Table(key=key, name=name, lines=[line for line, _ in rows[1:]], cells=cells)


def _times(table: _Table, clock: str, sensor: Sensor) -> Array:
    """Return the times, s, shape (n,)."""
    rate = sensor.frames_per_second if clock == "frame" else 1.0
    if rate is None:
        raise InputError("sensor.frames_per_second", "no such key", f"it, for the frames of {table.name}")
    expected = "a whole number" if clock == "frame" else "a finite number"
    values, cells = table.numbers(clock, expected, lost=False), table.cells[clock]
    if clock == "frame":
        for row in np.flatnonzero(values != np.round(values)):
            raise table.refuse(int(row), clock, show(cells[row]), expected)
    if (disorder := find_disorder(values, lambda row: show(cells[row]))) is not None:
        raise table.refuse(disorder.row, clock, disorder.found, disorder.expected)
    with np.errstate(over="ignore"):
        time: Array = values / rate
    if (fault := find_fault(time, {})) is not None:
        found = f"{show(cells[fault.row])}, which {rate:g} frames_per_second make {fault.found}"
        raise table.refuse(fault.row, clock, found, fault.expected)
    return time


def _columns(table: _Table) -> tuple[str, tuple[str, str] | None]:
    """Return the column of the times and the columns of the pixels, if any."""

    def refuse(expected: str) -> InputError:
        return InputError(table.key, f"{table.name} with the columns {show(list(table.cells))}", expected)

    clocks = [column for column in ("time_s", "frame") if column in table.cells]
    if len(clocks) != 1:
        raise refuse("one column time_s, or one column frame")
    trackpy = clocks == ["frame"]
    pairs = [pair for pair in _PIXELS if pair[0] in table.cells or pair[1] in table.cells]
    if not trackpy and ("x", "y") in pairs:
        raise refuse("x_m and y_m, or x_px and y_px, beside time_s")
    metres = "x_m" in table.cells or "y_m" in table.cells
    if len(pairs) + metres > 1 or any(column not in table.cells for pair in pairs for column in pair):
        raise refuse("x and y once, both in pixels or in metres")
    known = [*clocks, *CHANNELS, *(column for pair in pairs for column in pair), *(_PASSED_OVER if trackpy else ())]
    for column in table.cells:
        if column not in known:
            raise InputError(
                table.key,
                f"{table.name} with a column {show(column)}",
                f"time_s and any of {', '.join(CHANNELS)}, or frame, x, y",
            )
    if not pairs and not any(column in table.cells for column in CHANNELS):
        raise refuse(f"any of {', '.join(CHANNELS)} beside {clocks[0]}")
    if any(column in table.cells for column in QUATERNION) and not all(column in table.cells for column in QUATERNION):
        raise refuse(f"all of {', '.join(QUATERNION)} or none")
    return clocks[0], pairs[0] if pairs else None


def _one_particle(table: _Table, pixels: tuple[str, ...]) -> None:
    cells = table.cells.get("particle", [])
    measured = [table.cells[column] for column in (*pixels, *CHANNELS) if column in table.cells]
    # Where a frame was lost there may be no particle, but nothing is seen of none beside one.
    counted = [cell for row, cell in enumerate(cells) if cell or any(column[row] for column in measured)]
    particles = dict(zip(_values(counted), counted, strict=True))
    if len(particles) > 1:
        found = f"{table.name} with the particles {show(sorted(particles.values()))}"
        raise InputError(table.key, found, "the rows of a single one")


def _values(cells: list[str]) -> list[float | str]:
    """Return what cells say, so that two ways to write a number are one."""
    return [_value(cell) for cell in cells]


def _value(cell: str) -> float | str:
    try:
        value = decimal(cell)
    except ValueError:
        return cell
    return value if isfinite(value) else cell
