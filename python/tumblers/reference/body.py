"""The body: a convex set for contact, the real body's mass and touching areas (docs/model.md, "Body")."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from .array import Array
from .cell import Cell
from .surface import Cone, Ellipsoid, HalfSpace, Surface


@dataclass(frozen=True, eq=False)
class Rim:
    """Arc where the cone meets a side plane.

    Parameters
    ----------
    surfaces : frozenset of int
        The cone and the side plane.
    centre : Array, shape (3,)
        [m], body frame.
    radius : float
        [m].
    half_angle : float
        The arc reaches this far [rad] to both sides of body +z.
    """

    surfaces: frozenset[int]
    centre: Array
    radius: float
    half_angle: float

    def lowest(self, down: Array) -> Array | None:
        """Inner point of the arc farthest along `down`, shape (3,), body frame [m]; None if it is an end."""
        angle = float(np.arctan2(down[1], down[2]))
        if abs(angle) >= self.half_angle:
            return None
        return np.asarray(self.centre + self.radius * np.array([0.0, np.sin(angle), np.cos(angle)]))

    def moved(self, by: Array) -> Rim:
        """The same arc after the body frame's origin moved to `by`, shape (3,) [m]."""
        return replace(self, centre=self.centre - by)

    def farthest(self) -> float:
        """Greatest distance of a point of the arc from the origin [m]."""
        angles = np.append(np.linspace(-self.half_angle, self.half_angle, 181), 0.0)
        circle = np.stack([0.0 * angles, np.sin(angles), np.cos(angles)], axis=1)
        return float(np.linalg.norm(self.centre + self.radius * circle, axis=1).max())


@dataclass(frozen=True, eq=False)
class Anchor:
    """A point that may be lowest, shape (3,), body frame [m], and the surfaces through it."""

    point: Array
    surfaces: frozenset[int]


@dataclass(frozen=True, eq=False)
class Body:
    """A body, origin at its centre of mass.

    Parameters
    ----------
    surfaces : tuple of Surface
        `f_1..f_m`.
    cells : tuple of Cell
        Vertices, edges, faces, curved cells.
    rims : tuple of Rim
        Arcs; empty for a polytope.
    volume : float
        Of the real body [m³].
    inertia_per_mass : Array, shape (3, 3)
        Of the real body about the centre of mass [m²], body axes.
    radius : float
        `ℓ`, the greatest distance of a point from the centre of mass [m].
    """

    surfaces: tuple[Surface, ...]
    cells: tuple[Cell, ...]
    rims: tuple[Rim, ...]
    volume: float
    inertia_per_mass: Array
    radius: float

    def with_centre_of_mass(self, offset: Array) -> Body:
        """This body with its centre of mass, and the origin with it, at `offset`, shape (3,), body frame [m].

        The inertia about the centre of mass stays what it is. The radius of an ellipsoid is a bound.
        """
        surfaces = tuple(surface.shifted(offset) for surface in self.surfaces)
        cells = tuple(cell.moved(offset) for cell in self.cells)
        rims = tuple(rim.moved(offset) for rim in self.rims)
        far = [float(np.linalg.norm(point)) for cell in cells for point in cell.points]
        far += [rim.farthest() for rim in rims]
        far += [float(np.linalg.norm(s.centre) + s.semi_axes.max()) for s in surfaces if isinstance(s, Ellipsoid)]
        return replace(self, surfaces=surfaces, cells=cells, rims=rims, radius=max(far))

    def values(self, point: Array) -> Array:
        """All `f_i` [m], shape (m,), at `point`, shape (3,), body frame [m]."""
        return np.array([surface.value(point) for surface in self.surfaces])

    def gradients(self, point: Array) -> Array:
        """All `∇f_i`, shape (m, 3), at `point`, shape (3,), both body frame."""
        return np.array([surface.gradient(point) for surface in self.surfaces])

    def anchors(self, rotation: Array) -> Iterator[Anchor]:
        """Points of which at least one is lowest when the body is turned by `rotation`, shape (3, 3)."""
        down = -rotation[2]
        for cell in self.cells:
            if cell.kind == "vertex":
                yield Anchor(cell.points[0], cell.surfaces)
        for rim in self.rims:
            point = rim.lowest(down)
            if point is not None:
                yield Anchor(point, rim.surfaces)
        for i, surface in enumerate(self.surfaces):
            if isinstance(surface, Ellipsoid):
                yield Anchor(surface.lowest(down), frozenset({i}))

    def lowest_height(self, rotation: Array) -> float:
        """`z` [m] of the lowest point relative to the centre of mass."""
        return min(float(rotation[2] @ anchor.point) for anchor in self.anchors(rotation))

    def cell_points(self, cell: Cell, rotation: Array) -> Array:
        """Points, shape (k, 3), body frame [m], that all touch when the whole cell touches; empty if it cannot."""
        if cell.kind != "curved":
            return cell.points
        down = -rotation[2]
        (index, *_) = cell.surfaces
        surface = self.surfaces[index]
        if isinstance(surface, Ellipsoid):
            return surface.lowest(down)[None]
        lowest = [rim.lowest(down) for rim in self.rims if cell.surfaces <= rim.surfaces]
        points = [point for point in lowest if point is not None]
        return np.array(points) if points and len(points) == len(lowest) else np.zeros((0, 3))

    def generator(self, cell: Cell, rotation: Array) -> tuple[float, Array]:
        """Length [m] and middle, shape (3,), body frame [m], of the lowest generator of the cone of `cell`.

        The straight line on the cone that is lowest, cut to the part inside every half-space.
        """
        (index,) = (i for i in cell.surfaces if isinstance(self.surfaces[i], Cone))
        cone = self.surfaces[index]
        assert isinstance(cone, Cone)
        down = -rotation[2]
        angle = float(np.arctan2(down[1], down[2]))
        radial = np.array([0.0, np.sin(angle), np.cos(angle)])
        start = np.array([cone.apex_x, cone.axis_y, cone.axis_z]) + cone.radius * radial
        along = np.array([1.0, 0.0, 0.0]) - float(np.tan(cone.slope)) * radial
        cuts = []
        for surface in self.surfaces:
            if isinstance(surface, HalfSpace):
                rate = float(surface.normal @ along)
                if abs(rate) > 1e-12:
                    cuts.append(-surface.value(start) / rate)
        inside = [
            (low, high)
            for low, high in pairwise(sorted(cuts))
            if self.values(start + 0.5 * (low + high) * along).max() <= 1e-9 * self.radius
        ]
        if not inside:
            return 0.0, start
        low, high = inside[0][0], inside[-1][1]
        return (high - low) * float(np.linalg.norm(along)), start + 0.5 * (low + high) * along
