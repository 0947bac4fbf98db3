"""`Track`: the poses of a run, and how well its contact was kept."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Track", "longest_stretch", "lowest_m"]

_Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Track:
    """Poses after every step.

    Attributes
    ----------
    step_s
        Time between two of them, s.
    position_m
        Centre of mass, m, shape (n, 3).
    orientation
        Unit quaternion w, x, y, z, body to substrate, shape (n, 4).
    """

    step_s: float
    position_m: _Floats
    orientation: _Floats

    def after(self, time_s: float) -> Track:
        """Return what follows `time_s`."""
        first = round(time_s / self.step_s)
        return Track(self.step_s, self.position_m[first:], self.orientation[first:])

    @property
    def speed_m_per_s(self) -> float:
        """Mean velocity along y, m/s."""
        return float((self.position_m[-1, 1] - self.position_m[0, 1]) / (self.step_s * (len(self.position_m) - 1)))


def lowest_m(track: Track, vertices_m: _Floats) -> _Floats:
    """Return the height of the body's lowest point above the plane, m, shape (n,).

    Parameters
    ----------
    track
        The poses.
    vertices_m
        The body's corners, body frame, m.
    """
    w, x, y, z = track.orientation.T
    # The last row of R, for quaternions that are of length one to rounding only.
    up = np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z], axis=1)
    up /= np.linalg.norm(up, axis=1, keepdims=True)
    depths: _Floats = (up @ vertices_m.T).min(axis=1) + track.position_m[:, 2]
    return depths


def longest_stretch(flags: NDArray[np.bool_]) -> tuple[int, int]:
    """Return where the longest unbroken stretch of true flags starts, and its length.

    Parameters
    ----------
    flags
        Shape (n,).
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8)))
    if not edges.size:
        return 0, 0
    starts, ends = edges[::2], edges[1::2]
    best = int(np.argmax(ends - starts))
    return int(starts[best]), int(ends[best] - starts[best])
