"""Robots of every shape, in the sizes and materials of the paper."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial import ConvexHull, HalfspaceIntersection

from tumblers import ROBOTS as PRESETS
from tumblers import Ellipsoid, Hull, Robot
from tumblers.reference.array import Array


def _hull(points: Array) -> Hull:
    return Hull(vertices_m=tuple(tuple(points[i].tolist()) for i in ConvexHull(points).vertices))


def _stone() -> Hull:
    """Return a hull without symmetry whose faces are triangles, so that many meet in a vertex."""
    return _hull(2e-4 * np.random.default_rng(5).normal(size=(12, 3)))


def _crystal() -> Hull:
    """Return a hull without symmetry in every vertex of which three faces meet."""
    axes = np.concatenate([np.eye(3), -np.eye(3), [[0.6, 0.6, 0.6]]])
    normals = axes + np.random.default_rng(7).uniform(-0.2, 0.2, size=axes.shape)
    half_spaces = np.column_stack([normals, np.full(len(axes), -1.0)])
    return _hull(1.5e-4 * HalfspaceIntersection(half_spaces, np.zeros(3)).intersections)


def _preset(name: str) -> Robot:
    return PRESETS[name].value


_SPIKED = _preset("spiked_pdms")

ROBOTS: dict[str, Robot] = {
    "cuboid": _preset("cuboid"),
    "cuboid_drafted": _preset("cuboid_second_generation").with_draft(4.0),
    "spiked": _SPIKED.with_magnetization(10.0, 45.0),
    "spiked_drafted": _SPIKED.with_draft(10.0),
    "spiked_as_released": replace(_SPIKED.with_draft(6.0), draft_model="as_released"),
    "spiked_ends": _preset("spiked_ends_pdms").with_magnetization(10.0, 0.0),
    "spiked_ends_drafted": _preset("spiked_ends_su8").with_draft(8.0),
    "curved": _preset("curved_su8"),
    "curved_drafted": _preset("curved_su8").with_draft(2.0).with_magnetization(10.0, 90.0),
    "stone": replace(_SPIKED, shape=_stone()),
    "crystal": replace(_SPIKED, shape=_crystal()),
    "ellipsoid": replace(_SPIKED, shape=Ellipsoid(semi_axes_m=(1e-4, 2e-4, 1.5e-4))),
}
