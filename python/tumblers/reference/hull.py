"""Convex hulls as half-spaces, vertices and incidence."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull  # type: ignore[import-untyped, unused-ignore]

from .array import Array
from .surface import HalfSpace

_COPLANAR = 1e-9


@dataclass(frozen=True, eq=False)
class Hull:
    """A polytope.

    Parameters
    ----------
    surfaces : tuple of HalfSpace
        One per face, coplanar triangles merged.
    vertices : Array, shape (n, 3)
        [m].
    incidence : tuple of frozenset of int, length n
        Faces through each vertex.
    triangles : Array, shape (t, 3, 3)
        Corners of the surface's triangles [m].
    """

    surfaces: tuple[HalfSpace, ...]
    vertices: Array
    incidence: tuple[frozenset[int], ...]
    triangles: Array


def convex_hull(points: Array) -> Hull:
    """Convex hull of `points`, shape (k, 3) [m].

    Two triangles are of one face where normals and offsets agree to 1e-9 (of the size). Points inside a face or an edge
    are no vertices.
    """
    size = float(np.ptp(points, axis=0).max())
    hull = ConvexHull(points / size)
    planes: list[Array] = []
    for plane in hull.equations:
        if not any(np.abs(plane - other).max() < _COPLANAR for other in planes):
            planes.append(plane)
    surfaces = tuple(HalfSpace(np.asarray(p[:3] / np.linalg.norm(p[:3])), float(-p[3] * size)) for p in planes)
    vertices, incidence = [], []
    for i in hull.vertices:
        on = [j for j, p in enumerate(planes) if abs(float(p[:3] @ points[i]) / size + p[3]) < 10.0 * _COPLANAR]
        if np.linalg.matrix_rank(np.array([surfaces[j].normal for j in on]), tol=1e-7) == 3:
            vertices.append(points[i])
            incidence.append(frozenset(on))
    return Hull(surfaces, np.array(vertices), tuple(incidence), points[hull.simplices])
