"""Shapes of robots; lengths in metres, body frame: y along the length, x the width, z the height."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import lru_cache
from math import radians
from typing import ClassVar

from . import _core
from .check import Vector, number, sequence, vector
from .convexity import inner_point
from .errors import InputError, show

__all__ = ["SHAPES", "Cuboid", "Curved", "Ellipsoid", "Hull", "Shape", "Spiked", "SpikedEnds"]


# Far beyond any robot, and well inside what the geometry can square and divide.
_SHORTEST_M, _LONGEST_M = 1e-9, 1e3


def _length(key: str, value: object) -> float:
    return number(key, value, least=_SHORTEST_M, most=_LONGEST_M)


def _lengths(shape: object, names: tuple[str, ...]) -> None:
    for name in names:
        object.__setattr__(shape, name, _length(f"robot.{name}", getattr(shape, name)))


def _less(name: str, value: float, limit: float, words: str) -> None:
    if not value < limit:
        raise InputError(f"robot.{name}", show(value), f"less than {words}, which is {limit:g}")


@dataclass(frozen=True, kw_only=True, slots=True)
class Cuboid:
    """A cuboid `length_m` × `width_m` × `height_m`."""

    kind: ClassVar[str] = "cuboid"
    length_m: float
    width_m: float
    height_m: float

    def __post_init__(self) -> None:
        _lengths(self, ("length_m", "width_m", "height_m"))

    def body(self, draft_rad: float, as_released: bool) -> _core.Body:
        """Return the native body with a draft.

        Parameters
        ----------
        draft_rad
            Inward draft of the sides, rad.
        as_released
            Whether slanted faces take the draft as the released code does.
        """
        return _core.Body.cuboid(self.length_m, self.width_m, self.height_m, draft_rad)


@dataclass(frozen=True, kw_only=True, slots=True)
class Spiked:
    """A bar with one spike above and one below its middle, `overall_height_m` from tip to tip."""

    kind: ClassVar[str] = "spiked"
    length_m: float
    width_m: float
    height_m: float
    spike_base_m: float
    overall_height_m: float

    def __post_init__(self) -> None:
        _lengths(self, tuple(f.name for f in fields(self)))
        _less("spike_base_m", self.spike_base_m, self.length_m, "length_m")
        _less("height_m", self.height_m, self.overall_height_m, "overall_height_m")

    def body(self, draft_rad: float, as_released: bool) -> _core.Body:
        """Return the native body with a draft.

        Parameters
        ----------
        draft_rad
            Inward draft of the sides, rad.
        as_released
            Whether slanted faces take the draft as the released code does.
        """
        return _core.Body.spiked(
            self.length_m,
            self.width_m,
            self.height_m,
            self.spike_base_m,
            self.overall_height_m,
            draft_rad,
            as_released,
        )


@dataclass(frozen=True, kw_only=True, slots=True)
class SpikedEnds:
    """A bar with a spike above and one below each of its ends."""

    kind: ClassVar[str] = "spiked_ends"
    length_m: float
    width_m: float
    height_m: float
    spike_base_m: float
    spike_height_m: float

    def __post_init__(self) -> None:
        _lengths(self, tuple(f.name for f in fields(self)))
        _less("spike_base_m", self.spike_base_m, 0.5 * self.length_m, "half of length_m")

    def body(self, draft_rad: float, as_released: bool) -> _core.Body:
        """Return the native body with a draft.

        Parameters
        ----------
        draft_rad
            Inward draft of the sides, rad.
        as_released
            Whether slanted faces take the draft as the released code does.
        """
        return _core.Body.spiked_ends(
            self.length_m,
            self.width_m,
            self.height_m,
            self.spike_base_m,
            self.spike_height_m,
            draft_rad,
            as_released,
        )


@dataclass(frozen=True, kw_only=True, slots=True)
class Curved:
    """A prism over an annular sector."""

    kind: ClassVar[str] = "curved"
    width_m: float
    outer_radius_m: float
    inner_radius_m: float
    half_angle_deg: float

    def __post_init__(self) -> None:
        _lengths(self, ("width_m", "outer_radius_m", "inner_radius_m"))
        half_angle = number("robot.half_angle_deg", self.half_angle_deg, above=0.0, below=90.0)
        object.__setattr__(self, "half_angle_deg", half_angle)
        _less("inner_radius_m", self.inner_radius_m, self.outer_radius_m, "outer_radius_m")

    def body(self, draft_rad: float, as_released: bool) -> _core.Body:
        """Return the native body with a draft.

        Parameters
        ----------
        draft_rad
            Inward draft of the sides, rad.
        as_released
            Whether slanted faces take the draft as the released code does.
        """
        half_angle = radians(self.half_angle_deg)
        return _core.Body.curved(self.outer_radius_m, self.inner_radius_m, half_angle, self.width_m, draft_rad)


@dataclass(frozen=True, kw_only=True, slots=True)
class Ellipsoid:
    """An ellipsoid with semi-axes along x, y, z of the body frame."""

    kind: ClassVar[str] = "ellipsoid"
    semi_axes_m: Vector

    def __post_init__(self) -> None:
        axes = vector("robot.semi_axes_m", self.semi_axes_m)
        for i, axis in enumerate(axes):
            _length(f"robot.semi_axes_m[{i}]", axis)
        object.__setattr__(self, "semi_axes_m", axes)

    def body(self, draft_rad: float, as_released: bool) -> _core.Body:
        """Return the native body; it has no sides that a draft could taper.

        Parameters
        ----------
        draft_rad
            Inward draft of the sides, rad.
        as_released
            Whether slanted faces take the draft as the released code does.
        """
        _undrafted(self.kind, draft_rad)
        return _core.Body.ellipsoid(self.semi_axes_m)


@dataclass(frozen=True, kw_only=True, slots=True)
class Hull:
    """A convex polyhedron by its vertices, body frame, centre of mass at the origin.

    A point that lies inside the hull of the others by more than a millionth of the size is refused: such points do not
    describe a convex body.
    """

    kind: ClassVar[str] = "hull"
    vertices_m: tuple[Vector, ...]

    def __post_init__(self) -> None:
        key = "robot.vertices_m"
        vertices = sequence(key, self.vertices_m, "a list of points [x, y, z]", vector)
        distinct = len(set(vertices))
        if distinct < 4:
            points = "no points" if distinct == 0 else f"{distinct} distinct point{'s' if distinct > 1 else ''}"
            raise InputError(key, points, "at least 4")
        farthest = max(abs(coordinate) for vertex in vertices for coordinate in vertex)
        if not _SHORTEST_M <= farthest <= _LONGEST_M:
            found = f"points up to {farthest:g} m from the origin"
            raise InputError(key, found, f"between {_SHORTEST_M:g} m and {_LONGEST_M:g} m")
        object.__setattr__(self, "vertices_m", vertices)

    def body(self, draft_rad: float, as_released: bool) -> _core.Body:
        """Return the native body; a draft is a matter of the vertices themselves.

        Parameters
        ----------
        draft_rad
            Inward draft of the sides, rad.
        as_released
            Whether slanted faces take the draft as the released code does.
        """
        _undrafted(self.kind, draft_rad)
        return _hull(self.vertices_m)


@lru_cache(maxsize=64)
def _hull(vertices: tuple[Vector, ...]) -> _core.Body:
    body = _core.Body.hull(vertices)
    inside = inner_point(vertices, body.outline)
    if inside is not None:
        found = f"{show(list(vertices[inside]))} inside the hull of the others"
        raise InputError(f"robot.vertices_m[{inside}]", found, "the vertices of a convex body")
    return body


def _undrafted(kind: str, draft_rad: float) -> None:
    if draft_rad != 0.0:
        raise InputError("robot.draft_deg", f"a draft of the shape {kind}", "0 for this shape")


Shape = Cuboid | Spiked | SpikedEnds | Curved | Hull | Ellipsoid
SHAPES: dict[str, type[Shape]] = {shape.kind: shape for shape in (Cuboid, Spiked, SpikedEnds, Curved, Hull, Ellipsoid)}
