"""`Stretch`: what of a trial is compared, all of it or its beginning."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

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
    """

    reader: Reader
    floor: Floor
    counts: NDArray[np.bool_]

    @classmethod
    def whole(cls, reader: Reader, floor: Floor) -> Stretch:
        """Return all of a trial."""
        return cls(reader, floor, np.ones(floor.size, dtype=bool))

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
        return cls(reader.beginning(frames), floor.beginning(frames), floor.counts(frames))

    def outcomes(self, path: Path, camera: Floats) -> Floats:
        """Return the scaled differences of the outcomes that count, shape (k,).

        Parameters
        ----------
        path
            The model's.
        camera
            Heading (rad) and scale, shape (2,).
        """
        if not self.floor.outcome_scale:
            return np.empty(0)
        terms = self.reader.outcome_terms(path, camera)
        return np.array([terms[name] * scale for name, scale in self.floor.outcome_scale.items()])

    def whitened(self, path: Path, local: Floats, shared: Floats) -> Floats:
        """Return the whitened differences of the whole trial, 0 for what is not compared, shape (n,).

        Parameters
        ----------
        path
            The model's.
        local
            Clock (s) and origin (x, y in m), shape (3,).
        shared
            The camera's heading (rad) and scale, and how far the nominal numbers are off, shape (2 + `SHARED`,).
        """
        differences = self.reader.differences(path, local, shared[:2])
        parts = [self.floor.whiten[name] @ differences[name][kept] for name, kept in self.floor.valid.items()]
        parts.append(self.outcomes(path, shared[:2]))
        values = np.zeros(len(self.counts))
        values[self.counts] = np.concatenate(parts) - self.floor.tolerance @ shared[2:]
        return values
