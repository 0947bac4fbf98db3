"""Mass properties of uniform solids, by Gauss-Legendre quadrature over sections at constant body x.

Equations: with the section's moments `A, ∫y, ∫z, ∫y², ∫z², ∫yz` at `x`,

    volume = ∫ A dx,   centroid = (∫ x A, ∫∫y, ∫∫z) / volume,   J = tr(S) 1 - S,   S = ∫ ζζᵀ dV - volume c cᵀ

Polygon moments are Green's sums over the sides; an annular sector whose straight ends are inset by `d` subtends the
half angle `θ(r) = α - asin(d/r)` at the radius `r`, and its moments are one more quadrature over `r`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .array import Array

_ORDER = 24


@dataclass(frozen=True, eq=False)
class MassProperties:
    """Volume [m³], centroid, shape (3,) [m], and inertia about it per unit mass, shape (3, 3) [m²], body axes."""

    volume: float
    centroid: Array
    inertia_per_mass: Array


def quadrature(low: float, high: float) -> tuple[Array, Array]:
    """Gauss-Legendre nodes and weights on `[low, high]`, shapes (24,)."""
    nodes, weights = np.polynomial.legendre.leggauss(_ORDER)
    half = 0.5 * (high - low)
    return low + half * (nodes + 1.0), half * weights


def polygon_moments(points: Array) -> Array:
    """`A, ∫y, ∫z, ∫y², ∫z², ∫yz`, shape (6,), of a simple polygon.

    Parameters
    ----------
    points : Array, shape (k, 2)
        Corners `(y, z)` [m] in order, either way round.
    """
    y0, z0 = points[:, 0], points[:, 1]
    y1, z1 = np.roll(y0, -1), np.roll(z0, -1)
    c = y0 * z1 - y1 * z0
    moments = np.array(
        [
            c.sum() / 2.0,
            ((y0 + y1) * c).sum() / 6.0,
            ((z0 + z1) * c).sum() / 6.0,
            ((y0 * y0 + y0 * y1 + y1 * y1) * c).sum() / 12.0,
            ((z0 * z0 + z0 * z1 + z1 * z1) * c).sum() / 12.0,
            ((2.0 * y0 * z0 + y0 * z1 + y1 * z0 + 2.0 * y1 * z1) * c).sum() / 24.0,
        ]
    )
    return np.asarray(moments * np.sign(moments[0]))


def sector_moments(inner: float, outer: float, half_angle: float, inset: float) -> Array:
    """`A, ∫y, ∫z, ∫y², ∫z², ∫yz`, shape (6,), of an annular sector about +z, centred on the origin.

    Parameters
    ----------
    inner, outer : float
        Radii [m].
    half_angle : float
        `α` [rad].
    inset : float
        `d`, the distance of the straight ends from the radial lines at `±α` [m].
    """
    r, w = quadrature(inner, outer)
    theta = half_angle - np.arcsin(inset / r)
    sin, cos = np.sin(theta), np.cos(theta)
    return np.array(
        [
            float(w @ (2.0 * theta * r)),
            0.0,
            float(w @ (2.0 * sin * r**2)),
            float(w @ (r**3 * (theta - sin * cos))),
            float(w @ (r**3 * (theta + sin * cos))),
            0.0,
        ]
    )


def swept(width: float, section: Callable[[float], Array]) -> MassProperties:
    """Mass properties of the solid whose section at `x` in `[-W/2, W/2]` has the moments `section(x)`.

    Parameters
    ----------
    width : float
        `W` [m].
    section : Callable
        Body x [m] to moments, shape (6,).
    """
    x, w = quadrature(-0.5 * width, 0.5 * width)
    m = np.array([section(float(xi)) for xi in x])
    total = w @ m
    volume = float(total[0])
    first = np.array([float(w @ (x * m[:, 0])), total[1], total[2]])
    xx, xy, xz = (float(w @ column) for column in (x * x * m[:, 0], x * m[:, 1], x * m[:, 2]))
    second = np.array([[xx, xy, xz], [xy, total[3], total[5]], [xz, total[5], total[4]]])
    return _about_centroid(volume, first, second)


def tetrahedra(apex: Array, triangles: Array) -> MassProperties:
    """Mass properties of a convex solid cut into tetrahedra between an inner point and its surface.

    With corners `v_i` of a tetrahedron of volume `V`: `∫ ζζᵀ = V/20 (Σ v_i v_iᵀ + (Σ v_i)(Σ v_i)ᵀ)`.

    Parameters
    ----------
    apex : Array, shape (3,)
        A point inside [m].
    triangles : Array, shape (n, 3, 3)
        Corners of the surface's triangles [m].
    """
    volume, first, second = 0.0, np.zeros(3), np.zeros((3, 3))
    for triangle in triangles:
        corners = np.vstack([triangle, apex])
        part = abs(float(np.linalg.det(triangle - apex))) / 6.0
        total = corners.sum(axis=0)
        volume += part
        first += part * total / 4.0
        second += part / 20.0 * (corners.T @ corners + np.outer(total, total))
    return _about_centroid(volume, first, second)


def _about_centroid(volume: float, first: Array, second: Array) -> MassProperties:
    centroid = first / volume
    spread = second / volume - np.outer(centroid, centroid)
    return MassProperties(volume, np.asarray(centroid), np.asarray(np.trace(spread) * np.eye(3) - spread))
