"""The robots' shapes (docs/model.md, "Body").

The draft `geometric` insets every face of the profile by `(x + W/2) tan φ`; `as_released` takes `n tan φ` for the
slanted faces of the spiked robots, `n` twice the slanted edge's length in millimetres. The origin is the real body's
centre of mass.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Literal

import numpy as np

from .array import Array
from .body import Body, Rim
from .cell import Cell, polytope_cells
from .hull import convex_hull
from .mass_properties import MassProperties, polygon_moments, sector_moments, swept, tetrahedra
from .profile import Profile, profile_through
from .surface import Cone, Ellipsoid, Surface

DraftModel = Literal["geometric", "as_released"]


def _profile_body(profile: Profile, real: Callable[[Array], Array], bridged: Sequence[int], air_sides: bool) -> Body:
    """Body of a profile; `real` makes the real profile of the hull's corners, the faces `bridged` hide air.

    `air_sides`: the real side planes do not reach the bridged faces, so the hull edges there are of air.
    """
    k, half = len(profile.offsets), 0.5 * profile.width
    mass = swept(profile.width, lambda x: polygon_moments(real(profile.corners(x))))
    vertices, incidence, areas = [], [], {}
    for side, x in ((k, -half), (k + 1, half)):
        corners = profile.corners(x)
        vertices += [np.array([x, y, z]) for y, z in corners]
        incidence += [frozenset({i, (i + 1) % k, side}) for i in range(k)]
        section = polygon_moments(real(corners))
        areas[side] = (float(section[0]), np.array([x, section[1] / section[0], section[2] / section[0]]))
    air = {frozenset({i}) for i in bridged}
    if air_sides:
        air |= {frozenset({i, side}) for i in bridged for side in (k, k + 1)}
    surfaces: list[Surface] = list(profile.half_spaces())
    cells = polytope_cells(surfaces, np.array(vertices), incidence, frozenset(air), areas)
    return _centred(surfaces, cells, (), mass)


def _centred(surfaces: Sequence[Surface], cells: Sequence[Cell], rims: Sequence[Rim], mass: MassProperties) -> Body:
    made = Body(tuple(surfaces), tuple(cells), tuple(rims), mass.volume, mass.inertia_per_mass, 0.0)
    return made.with_centre_of_mass(mass.centroid)


def cuboid(length: float, width: float, height: float, draft: float = 0.0) -> Body:
    """Block of `length` along y, `width` along x, `height` along z [m], with `draft` [rad]."""
    y, z = 0.5 * length, 0.5 * height
    corners = np.array([[y, -z], [y, z], [-y, z], [-y, -z]])
    profile = profile_through(np.roll(corners, -1, axis=0), [math.tan(draft)] * 4, width)
    return _profile_body(profile, lambda hull: hull, (), False)


def spiked(
    length: float,
    width: float,
    height: float,
    spike_base: float,
    overall_height: float,
    draft: float = 0.0,
    draft_model: DraftModel = "geometric",
) -> Body:
    """Bar with one triangular spike above and one below its middle.

    Parameters
    ----------
    length, width, height : float
        Bar [m].
    spike_base, overall_height : float
        Base of a spike on the bar, tip to tip [m].
    draft : float
        `φ` [rad].
    draft_model : DraftModel
        See the module.
    """
    y, z, tip = 0.5 * length, 0.5 * height, 0.5 * overall_height
    corners = np.array([[y, z], [0.0, tip], [-y, z], [-y, -z], [0.0, -tip], [y, -z]])
    end = math.tan(draft)
    slanted = end * _released_factor(math.hypot(y, tip - z), draft_model)
    profile = profile_through(corners, [end, slanted, slanted, end, slanted, slanted], width)
    run = 0.5 * spike_base / (tip - z)

    def real(hull: Array) -> Array:
        upper_right, upper, upper_left, lower_left, lower, lower_right = hull
        top, bottom = (upper[1] - upper_right[1]) * run, (lower_right[1] - lower[1]) * run
        return np.array(
            [
                upper_right,
                [upper[0] + top, upper_right[1]],
                upper,
                [upper[0] - top, upper_left[1]],
                upper_left,
                lower_left,
                [lower[0] - bottom, lower_left[1]],
                lower,
                [lower[0] + bottom, lower_right[1]],
                lower_right,
            ]
        )

    return _profile_body(profile, real, (1, 2, 4, 5), True)


def spiked_ends(
    length: float,
    width: float,
    height: float,
    spike_base: float,
    spike_height: float,
    draft: float = 0.0,
    draft_model: DraftModel = "geometric",
) -> Body:
    """Bar with four triangular spikes, at both ends above and below.

    The base of a spike reaches from the bar's end inward, its tip is above the base's middle, so its outer face is the
    slanted face of the hull and real; the hull's top and bottom, from tip to tip, are of air.

    Parameters
    ----------
    length, width, height : float
        Bar [m].
    spike_base, spike_height : float
        Of one spike [m].
    draft : float
        `φ` [rad].
    draft_model : DraftModel
        See the module.
    """
    y, z = 0.5 * length, 0.5 * height
    tip_y, tip_z, run = y - 0.5 * spike_base, z + spike_height, 0.5 * spike_base / spike_height
    upper = [[y, z], [tip_y, tip_z], [-tip_y, tip_z], [-y, z]]
    corners = np.array(upper + [[a, -b] for a, b in reversed(upper)])
    end = math.tan(draft)
    slanted = end * _released_factor(math.hypot(0.5 * spike_base, spike_height), draft_model)
    slopes = [end, slanted, end, slanted, end, slanted, end, slanted]

    def inner(tip: Array, corner: Array) -> list[float]:
        towards_middle = -math.copysign(abs(tip[1] - corner[1]) * run, tip[0])
        return [tip[0] + towards_middle, corner[1]]

    def real(hull: Array) -> Array:
        out: list[Array | list[float]] = []
        for first in (0, 4):
            corner_a, tip_a, tip_b, corner_b = hull[first : first + 4]
            out += [corner_a, tip_a, inner(tip_a, corner_a), inner(tip_b, corner_b), tip_b, corner_b]
        return np.array(out)

    return _profile_body(profile_through(corners, slopes, width), real, (2, 6), True)


def _released_factor(slanted_edge: float, draft_model: DraftModel) -> float:
    if draft_model == "geometric":
        return 1.0
    if draft_model != "as_released":
        raise ValueError(f"draft_model: found {draft_model!r}, expected geometric or as_released")
    return 2.0 * slanted_edge * 1e3


def curved(outer_radius: float, inner_radius: float, half_angle: float, width: float, draft: float = 0.0) -> Body:
    """Annular sector about +z, swept along x; its hull closes the concave side with the chord.

    Surfaces: the outer cone, the end planes at +y and -y, the chord plane, the side planes at -W/2 and +W/2.

    Parameters
    ----------
    outer_radius, inner_radius : float
        `Ro`, `Ri` [m].
    half_angle : float
        `α` [rad].
    width : float
        `W` [m].
    draft : float
        `φ` [rad].
    """
    sin, cos, tan, half = math.sin(half_angle), math.cos(half_angle), math.tan(draft), 0.5 * width
    normals = np.array([[cos, -sin], [-cos, -sin], [0.0, -1.0]])
    planes = Profile(normals, np.array([0.0, 0.0, -inner_radius * cos]), np.full(3, tan), width)
    cone = Cone(-half, 0.0, 0.0, outer_radius, draft)
    surfaces: list[Surface] = [cone, *planes.half_spaces()]

    def inner_corner(inset: float) -> tuple[float, float]:
        z = inner_radius * cos + inset
        return (z * sin - inset) / cos, z

    def section(x: float) -> Array:
        inset = (x + half) * tan
        return sector_moments(math.hypot(*inner_corner(inset)), outer_radius - inset, half_angle, inset)

    vertices, incidence, areas, rims = [], [], {}, []
    for side, x in ((4, -half), (5, half)):
        inset = (x + half) * tan
        radius, (inner_y, inner_z) = outer_radius - inset, inner_corner(inset)
        reach = half_angle - math.asin(inset / radius)
        outer_y, outer_z = radius * math.sin(reach), radius * math.cos(reach)
        if reach <= 0.0 or inner_y <= 0.0 or math.hypot(inner_y, inner_z) >= radius:
            raise ValueError(f"draft: a face of the profile vanishes at x = {x} m, expected a smaller draft or width")
        vertices += [[x, outer_y, outer_z], [x, inner_y, inner_z], [x, -outer_y, outer_z], [x, -inner_y, inner_z]]
        incidence += [frozenset(on) for on in ({0, 1, side}, {1, 3, side}, {0, 2, side}, {2, 3, side})]
        moments = section(x)
        areas[side] = (float(moments[0]), np.array([x, 0.0, moments[2] / moments[0]]))
        rims.append(Rim(frozenset({0, side}), np.array([x, 0.0, 0.0]), radius, reach))
    # An end plane, s t - d n + x e_x, goes from the chord to the cone: s² = ρ² - d² with ρ = outer_radius - d.
    nodes, weights = np.polynomial.legendre.leggauss(24)
    total, first = 0.0, np.zeros(3)
    for node, weight in zip(nodes, weights, strict=True):
        inset = half * (1.0 + node) * tan
        low = (inner_radius * cos + inset - inset * sin) / cos
        high = math.sqrt((outer_radius - inset) ** 2 - inset**2)
        strip, middle = weight * (high - low), 0.5 * (low + high)
        total += strip
        first += strip * np.array([half * node, middle * sin - inset * cos, middle * cos + inset * sin])
    for end, sign in ((1, 1.0), (2, -1.0)):
        areas[end] = (total * half / math.cos(draft), np.array([1.0, sign, 1.0]) * first / total)
    corners = np.array(vertices)
    air = frozenset({frozenset({3}), frozenset({3, 4}), frozenset({3, 5})})
    cells = [cell for cell in polytope_cells(surfaces, corners, incidence, air, areas) if 0 not in cell.surfaces]
    vertex_cells = [Cell(on, "vertex", corners[[i]]) for i, on in enumerate(incidence) if 0 in on]
    edges = []
    for end in (1, 2):
        points = corners[[{0, end} <= on for on in incidence]]
        # With draft this edge is a conic that bulges outwards: it touches in a point, and no line of it counts.
        length = width if draft == 0.0 else 0.0
        kind: Literal["edge", "curved"] = "edge" if draft == 0.0 else "curved"
        name = frozenset({0, end})
        edges.append(Cell(name, kind, points, length=length, length_centroid=points.mean(axis=0)))
    arcs = [Cell(rim.surfaces, "curved", corners[[rim.surfaces <= on for on in incidence]]) for rim in rims]
    outer = Cell(frozenset({0}), "curved", corners[[0 in on for on in incidence]])
    return _centred(surfaces, [*vertex_cells, *cells, *edges, *arcs, outer], rims, swept(width, section))


def ellipsoid(semi_axes: Sequence[float]) -> Body:
    """Ellipsoid of `semi_axes`, length 3 [m], along the body frame's axes."""
    a = np.array(semi_axes, dtype=float)
    inertia = np.diag([(a[1] ** 2 + a[2] ** 2), (a[0] ** 2 + a[2] ** 2), (a[0] ** 2 + a[1] ** 2)]) / 5.0
    cell = Cell(frozenset({0}), "curved", np.zeros((0, 3)))
    return Body((Ellipsoid(a),), (cell,), (), float(4.0 / 3.0 * math.pi * a.prod()), inertia, float(a.max()))


def hull(vertices: Sequence[Sequence[float]] | Array) -> Body:
    """Convex hull of `vertices`, shape (k, 3) [m]; the origin given is the centre of mass.

    The inertia is that of the uniform hull about its own centroid.
    """
    shape = convex_hull(np.array(vertices, dtype=float))
    inside = min(surface.offset for surface in shape.surfaces)
    if inside <= 0.0:
        raise ValueError("vertices_m: found a hull without the origin inside, expected the centre of mass inside")
    mass = tetrahedra(shape.vertices.mean(axis=0), shape.triangles)
    cells = polytope_cells(shape.surfaces, shape.vertices, shape.incidence)
    radius = float(np.linalg.norm(shape.vertices, axis=1).max())
    return Body(shape.surfaces, cells, (), mass.volume, mass.inertia_per_mass, radius)
