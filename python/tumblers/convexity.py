"""Points that a convex body cannot have as vertices."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from .check import Vector

__all__ = ["inner_point"]

# In parts of the size: a point that rounding put a little below a face is still a vertex.
_DEPTH = 1e-6
_SLIVER = 1e-12


def inner_point(points: Sequence[Vector], faces: Sequence[np.ndarray[Any, Any]]) -> int | None:
    """Return the index of the first point that lies inside all faces by more than a millionth of the size.

    Parameters
    ----------
    points
        What is asked about, m.
    faces
        Polygons of a hull around the origin, m, each of shape (k, 3).
    """
    places = np.asarray(points)
    size = np.abs(places).max()
    outermost = np.full(len(places), -np.inf)
    for face in faces:
        corners = face / size
        normal = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)
        area = np.linalg.norm(normal)
        if area > _SLIVER:
            normal = normal / area
            offset = float((corners @ normal).mean())
            normal, offset = (normal, offset) if offset >= 0.0 else (-normal, -offset)
            np.maximum(outermost, places @ normal / size - offset, out=outermost)
    inside = np.flatnonzero(outermost < -_DEPTH)
    return int(inside[0]) if inside.size else None
