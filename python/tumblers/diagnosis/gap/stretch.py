"""`Stretch`: what of a trial is compared, all of it or its beginning."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray

from ... import _core
from .floor import Floor
from .pose import Path
from .reading import Reader

__all__ = ["Stretch"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Stretch:
    """Some of a trial's time.

    Attributes
    ----------
    reader, floor
        Of its frames alone. A beginning has no outcomes: they are of the whole.
    counts
        Which of the whole trial's numbers are compared, shape (n,).
    native
        The measurements with their noise, as the native module takes them.
    """

    reader: Reader
    floor: Floor
    counts: NDArray[np.bool_]
    native: _core.Measured

    @classmethod
    def whole(cls, reader: Reader, floor: Floor, native: _core.Measured | None = None) -> Stretch:
        """Return all of a trial.

        Parameters
        ----------
        reader, floor
            Of the trial.
        native
            What a former stretch of the same had; made if None.
        """
        made = _native(reader, floor, floor.tracked) if native is None else native
        return cls(reader, floor, np.ones(floor.size, dtype=bool), made)

    @classmethod
    def beginning(cls, reader: Reader, floor: Floor, last_s: float) -> Stretch:
        """Return the frames of a trial up to a time.

        A whitened difference depends on the frames before it alone, so that a beginning is compared as in the whole.

        Parameters
        ----------
        reader, floor
            Of all of the trial.
        last_s
            Time of the last frame at most, s.
        """
        frames = int(np.searchsorted(reader.observed.time_s, last_s, side="right"))
        begun, noise = reader.beginning(frames), floor.beginning(frames)
        return cls(begun, noise, floor.counts(frames), _native(begun, noise, floor.tracked))

    def seen(self, path: Path | None) -> _core._Seen:
        """Return a path, and the scaled differences of the outcomes: constant, and by the camera's scale, shape (k, 2).

        Parameters
        ----------
        path
            The model's; None where it cannot be run.
        """
        if path is None:
            return None, np.empty((0, 2))
        lines = np.empty((len(self.floor.outcome_scale), 2))
        if len(lines):
            terms, by_scale = self.reader.outcome_lines(path)
            for line, (name, scale) in zip(lines, self.floor.outcome_scale.items(), strict=True):
                line[:] = scale * terms[name], scale * by_scale.get(name, 0.0)
        return (path.interval_s, path.clock_s, path.poses), lines

    def whitened(self, path: Path, local: Floats, shared: Floats) -> Floats:
        """Return the whitened differences of the whole trial, 0 for what is not compared, shape (n,).

        Parameters
        ----------
        path
            The model's.
        local
            Clock (s) and origin (x, y, z in m), shape (4,).
        shared
            The camera's heading (rad) and scale, and how far the nominal numbers are off, shape (2 + `SHARED`,).
        """
        return self.over_all(self.native.whitened(self.seen(path), local.tolist(), shared.tolist()))

    def over_all(self, compared: Floats) -> Floats:
        """Return differences of what is compared among those of the whole trial, 0 for all others, shape (n,).

        Parameters
        ----------
        compared
            Shape (k,).
        """
        values = np.zeros(len(self.counts))
        values[self.counts] = compared
        return values


def _native(reader: Reader, floor: Floor, tracked: int) -> _core.Measured:
    """Return measurements with their noise, of a track that has so many numbers as a whole."""
    observed, columns = reader.observed, []
    for name, kept in floor.valid.items():
        kind, values = name, observed.values.get(name, np.empty(0))[:, None]
        if name not in observed.values:
            assert observed.orientation is not None
            kind, values = f"turn_{name}", observed.orientation
        elif name == "heading" and observed.heading_turn < 2.0 * pi:
            kind = "axis_heading"
        columns.append((kind, observed.time_s[kept], values[kept], floor.whiten[name]))
    return _core.Measured(columns, floor.tolerance, len(floor.outcome_scale), tracked)
