"""Cells: the faces, edges and vertices of a convex body, with what of them is real (docs/model.md, "Adhesion").

A cell is named by the surfaces whose `f_i` vanish on it. Its `area` and `length` are those of the real, non-convex body
that touch when the whole cell lies on the plane: a hull face that is bridged by air has no area, its real edges then
count as isolated lines.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations, pairwise
from typing import Literal

import numpy as np

from .array import Array
from .rotation import cross
from .surface import HalfSpace, Surface

Kind = Literal["vertex", "edge", "face", "curved"]


@dataclass(frozen=True, eq=False)
class Cell:
    """One face, edge or vertex.

    Parameters
    ----------
    surfaces : frozenset of int
        Indices of the surfaces that it lies on.
    kind : Kind
        `curved` for anything on a cone or an ellipsoid but its corners.
    points : Array, shape (k, 3)
        Its corners [m], body frame; empty for an ellipsoid.
    area : float
        Real area [m²].
    area_centroid : Array, shape (3,)
        Centroid of `area` [m], body frame.
    length : float
        Length of real edges outside any real area [m].
    length_centroid : Array, shape (3,)
        Centroid of `length` [m], body frame.
    """

    surfaces: frozenset[int]
    kind: Kind
    points: Array
    area: float = 0.0
    area_centroid: Array = field(default_factory=lambda: np.zeros(3))
    length: float = 0.0
    length_centroid: Array = field(default_factory=lambda: np.zeros(3))

    def moved(self, by: Array) -> Cell:
        """The same cell after the body frame's origin moved to `by`, shape (3,) [m]."""
        return replace(
            self,
            points=self.points - by,
            area_centroid=self.area_centroid - by,
            length_centroid=self.length_centroid - by,
        )


def ring(points: Array, normal: Array) -> Array:
    """`points`, shape (k, 3), of a convex planar polygon in order about `normal`, shape (3,)."""
    centre = points.mean(axis=0)
    first = points[0] - centre
    second = cross(normal, first)
    angles = np.arctan2((points - centre) @ second, (points - centre) @ first)
    return np.asarray(points[np.argsort(angles)])


def polygon_area(points: Array, normal: Array) -> tuple[float, Array]:
    """Area [m²] and centroid, shape (3,) [m], of a planar polygon `points`, shape (k, 3), in order."""
    fan = [
        (0.5 * float(normal @ cross(b - points[0], c - points[0])), (points[0] + b + c) / 3.0)
        for b, c in pairwise(points[1:])
    ]
    area = sum(part for part, _ in fan)
    centroid = sum((part * middle for part, middle in fan), np.zeros(3)) / area
    return abs(area), np.asarray(centroid)


def polytope_cells(
    surfaces: Sequence[Surface],
    vertices: Array,
    incidence: Sequence[frozenset[int]],
    bridged: frozenset[frozenset[int]] = frozenset(),
    real_areas: Mapping[int, tuple[float, Array]] | None = None,
) -> tuple[Cell, ...]:
    """Vertices, edges and faces of a polytope, in this order.

    Parameters
    ----------
    surfaces : sequence of Surface
        All half-spaces; other surfaces are passed over.
    vertices : Array, shape (n, 3)
        [m], body frame.
    incidence : sequence of frozenset of int, length n
        Surfaces through each vertex.
    bridged : frozenset of frozenset of int
        Faces (one surface) and edges (two) of the hull with air behind them.
    real_areas : mapping, optional
        Surface to real area [m²] and its centroid [m], where the face is not the hull's whole one.
    """
    real_areas = real_areas or {}
    cells = [Cell(on, "vertex", vertices[[i]]) for i, on in enumerate(incidence)]
    edges = []
    for a, b in combinations(range(len(vertices)), 2):
        shared = incidence[a] & incidence[b]
        if len(shared) != 2 or any(shared < on for i, on in enumerate(incidence) if i not in (a, b)):
            continue
        points = vertices[[a, b]]
        length = 0.0 if shared in bridged else float(np.linalg.norm(points[1] - points[0]))
        edges.append(Cell(shared, "edge", points, length=length, length_centroid=points.mean(axis=0)))
    for i, surface in enumerate(surfaces):
        if not isinstance(surface, HalfSpace):
            continue
        points = ring(vertices[[i in on for on in incidence]], surface.normal)
        name = frozenset({i})
        if name in bridged:
            lines = [edge for edge in edges if i in edge.surfaces and edge.length > 0.0]
            length = sum(edge.length for edge in lines)
            middle = sum((edge.length * edge.length_centroid for edge in lines), np.zeros(3)) / length
            cells.append(Cell(name, "face", points, length=length, length_centroid=np.asarray(middle)))
        else:
            area, centroid = real_areas[i] if i in real_areas else polygon_area(points, surface.normal)
            cells.append(Cell(name, "face", points, area, centroid))
    return tuple(cells[: len(vertices)] + edges + cells[len(vertices) :])
