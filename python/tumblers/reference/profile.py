"""Convex profiles with draft (docs/model.md, "Body").

Equations: face `i` at body `x` is the line `n_i · (y, z) = c_i - (x + W/2) tan φ_i`, hence the half-space of unit
normal `(sin φ_i, cos φ_i n_i)`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .array import Array
from .surface import HalfSpace


@dataclass(frozen=True, eq=False)
class Profile:
    """Convex profile whose faces move inward along x.

    Parameters
    ----------
    normals : Array, shape (k, 2)
        Outward unit normals `(y, z)`, in order.
    offsets : Array, shape (k,)
        `c_i` [m].
    slopes : Array, shape (k,)
        `tan φ_i`.
    width : float
        `W` [m].
    """

    normals: Array
    offsets: Array
    slopes: Array
    width: float

    def corners(self, x: float) -> Array:
        """Corners, shape (k, 2), at body x [m]; corner `i` is between the faces `i` and `i + 1`."""
        n, m = self.normals, np.roll(self.normals, -1, axis=0)
        c = self.offsets - (x + 0.5 * self.width) * self.slopes
        d = np.roll(c, -1)
        det = n[:, 0] * m[:, 1] - n[:, 1] * m[:, 0]
        corners = np.stack([(c * m[:, 1] - d * n[:, 1]) / det, (n[:, 0] * d - m[:, 0] * c) / det], axis=1)
        tangents = np.stack([-n[:, 1], n[:, 0]], axis=1)
        if (np.einsum("ij,ij->i", corners - np.roll(corners, 1, axis=0), tangents) <= 0.0).any():
            raise ValueError(f"draft: a face of the profile vanishes at x = {x} m, expected a smaller draft or width")
        return corners

    def half_spaces(self) -> list[HalfSpace]:
        """Profile faces in order, then the side planes at -W/2 and +W/2, of the untranslated body."""
        half = 0.5 * self.width
        faces = []
        for (ny, nz), c, slope in zip(self.normals, self.offsets, self.slopes, strict=True):
            cos = 1.0 / math.sqrt(1.0 + slope * slope)
            faces.append(HalfSpace(cos * np.array([slope, ny, nz]), float(cos * (c - half * slope))))
        return [*faces, HalfSpace(np.array([-1.0, 0.0, 0.0]), half), HalfSpace(np.array([1.0, 0.0, 0.0]), half)]


def profile_through(corners: Array, slopes: Sequence[float], width: float) -> Profile:
    """Profile of the convex polygon `corners`, shape (k, 2), counterclockwise; face `i` ends in corner `i`."""
    side = corners - np.roll(corners, 1, axis=0)
    normals = np.stack([side[:, 1], -side[:, 0]], axis=1) / np.linalg.norm(side, axis=1)[:, None]
    return Profile(normals, np.einsum("ij,ij->i", normals, corners), np.array(slopes), width)
