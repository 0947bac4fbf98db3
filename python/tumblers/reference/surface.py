"""Surfaces `f(ζ) = 0` that bound a convex body (docs/model.md, "Body").

Equations, with `ζ = (x, y, z)` in the body frame and every `f` in metres::

    half-space   f = n · ζ - c                                              ∇f = n
    cone         f = cos φ (ρ - ρ0 + (x - x0) tan φ),  ρ = hypot(y - y0, z - z0)
                 ∇f = (sin φ, cos φ (y - y0)/ρ, cos φ (z - z0)/ρ)
    ellipsoid    f = (b/2) (Σ (ζ_k - c_k)²/A_k² - 1),  b = min A            ∇f = b (ζ_k - c_k)/A_k²

A body is where every one of its `f` is at most 0.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np

from .array import Array


@dataclass(frozen=True, eq=False)
class HalfSpace:
    """`n · ζ ≤ c`.

    Parameters
    ----------
    normal : Array, shape (3,)
        Outward unit normal, body frame.
    offset : float
        `c` [m].
    """

    normal: Array
    offset: float

    def value(self, point: Array) -> float:
        """`f` [m] at `point`, shape (3,), body frame [m]."""
        n = self.normal
        return float(n[0] * point[0] + n[1] * point[1] + n[2] * point[2] - self.offset)

    def gradient(self, point: Array) -> Array:  # noqa: ARG002, RUF100
        """`∇f`, shape (3,), body frame, dimensionless."""
        return self.normal

    def shifted(self, by: Array) -> HalfSpace:
        """The same surface after the body frame's origin moved to `by` [m]."""
        return HalfSpace(self.normal, self.offset - float(self.normal @ by))


@dataclass(frozen=True, eq=False)
class Cone:
    """Cone about an axis parallel to body x; a cylinder where `slope` is 0.

    Parameters
    ----------
    apex_x, axis_y, axis_z : float
        `x0`, the place where the radius is `radius`, and the axis' `y0`, `z0` [m].
    radius : float
        `ρ0` [m].
    slope : float
        Draft angle `φ` [rad].
    """

    apex_x: float
    axis_y: float
    axis_z: float
    radius: float
    slope: float

    def value(self, point: Array) -> float:
        """`f` [m] at `point`, shape (3,), body frame [m]."""
        rho = float(np.hypot(point[1] - self.axis_y, point[2] - self.axis_z))
        cos, sin = float(np.cos(self.slope)), float(np.sin(self.slope))
        return cos * (rho - self.radius) + sin * (float(point[0]) - self.apex_x)

    def gradient(self, point: Array) -> Array:
        """`∇f`, shape (3,), body frame, dimensionless; radial part 0 on the axis, where it is not defined."""
        y, z = float(point[1]) - self.axis_y, float(point[2]) - self.axis_z
        rho = float(np.hypot(y, z))
        cos, sin = float(np.cos(self.slope)), float(np.sin(self.slope))
        if rho == 0.0:
            return np.array([sin, 0.0, 0.0])
        return np.array([sin, cos * y / rho, cos * z / rho])

    def radius_at(self, x: float) -> float:
        """Radius of the section at body `x` [m]."""
        return self.radius - (x - self.apex_x) * float(np.tan(self.slope))

    def shifted(self, by: Array) -> Cone:
        """The same surface after the body frame's origin moved to `by` [m]."""
        x, y, z = (float(b) for b in by)
        return Cone(self.apex_x - x, self.axis_y - y, self.axis_z - z, self.radius, self.slope)


@dataclass(frozen=True, eq=False)
class Ellipsoid:
    """Ellipsoid with axes along the body frame's.

    Parameters
    ----------
    semi_axes, centre : Array, shape (3,)
        `A` and `c` [m].
    """

    semi_axes: Array
    centre: Array = field(default_factory=lambda: np.zeros(3))

    def value(self, point: Array) -> float:
        """`f` [m] at `point`, shape (3,), body frame [m]."""
        scaled = (point - self.centre) / self.semi_axes
        return 0.5 * float(self.semi_axes.min()) * (float(scaled @ scaled) - 1.0)

    def gradient(self, point: Array) -> Array:
        """`∇f`, shape (3,), body frame, dimensionless."""
        return np.asarray(float(self.semi_axes.min()) * (point - self.centre) / self.semi_axes**2)

    def lowest(self, down: Array) -> Array:
        """Point farthest along the direction `down`, both body frame, shape (3,) [m]."""
        scaled = self.semi_axes * down
        return np.asarray(self.centre + self.semi_axes * scaled / np.linalg.norm(scaled))

    def shifted(self, by: Array) -> Ellipsoid:
        """The same surface after the body frame's origin moved to `by` [m]."""
        return Ellipsoid(self.semi_axes, self.centre - by)


Surface: TypeAlias = HalfSpace | Cone | Ellipsoid
