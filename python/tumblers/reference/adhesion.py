"""Contact patch and adhesion (docs/model.md, "Adhesion").

Equation: `p_a = h C (A + w ℓ)`, with `A` the real area that touches and `ℓ` the length of real edges that touch outside
any touching area.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from .array import Array
from .body import Body

# A point this near to the plane touches it, as a part of the body's radius.
TOUCHING = 1e-9


class ContactMode(IntEnum):
    """What of the convex body touches the plane."""

    AIRBORNE = 0
    POINT = 1
    LINE = 2
    SURFACE = 3


@dataclass(frozen=True, eq=False)
class Patch:
    """What touches at the end of a step.

    Parameters
    ----------
    mode : ContactMode
        Of the convex hull.
    area, length : float
        `A` [m²] and `ℓ` [m] of the real body.
    area_centroid, length_centroid : Array, shape (3,)
        Substrate frame [m]; the touching point where there is neither.
    """

    mode: ContactMode
    area: float
    length: float
    area_centroid: Array
    length_centroid: Array

    def force(self, coefficient: float, line_width: float) -> float:
        """`C (A + w ℓ)` [N]."""
        return coefficient * (self.area + line_width * self.length)

    def centroid(self, line_width: float) -> Array:
        """Centre of the adhesion, shape (3,), substrate frame [m]."""
        strip = line_width * self.length
        if self.area + strip == 0.0:
            return self.length_centroid
        return np.asarray((self.area * self.area_centroid + strip * self.length_centroid) / (self.area + strip))


def touching_patch(body: Body, position: Array, rotation: Array, touch: Array) -> Patch:
    """The patch of a body that touches the plane at least in `touch`.

    Parameters
    ----------
    body : Body
        The body.
    position, rotation : Array, shapes (3,) and (3, 3)
        Pose.
    touch : Array, shape (3,)
        A touching point, substrate frame [m].
    """
    best: tuple[int, Patch] = (1, Patch(ContactMode.POINT, 0.0, 0.0, touch, touch))
    for cell in body.cells:
        points = body.cell_points(cell, rotation)
        if len(points) <= best[0]:
            continue
        # The plane is where it is touched; it may have yielded.
        if float(np.abs(position[2] - touch[2] + points @ rotation[2]).max()) > TOUCHING * body.radius:
            continue
        if cell.kind == "curved":
            length, middle = body.generator(cell, rotation)
            place = position + rotation @ middle
            best = (len(points), Patch(ContactMode.LINE, 0.0, length, place, place))
            continue
        mode = ContactMode.SURFACE if cell.kind == "face" else ContactMode.LINE
        area_place, length_place = position + rotation @ cell.area_centroid, position + rotation @ cell.length_centroid
        if cell.length == 0.0:
            length_place = area_place if cell.area > 0.0 else position + rotation @ cell.points.mean(axis=0)
        best = (len(points), Patch(mode, cell.area, cell.length, area_place, length_place))
    return best[1]


def patch_at(body: Body, position: Array, rotation: Array) -> Patch:
    """The patch of a pose; airborne where the lowest point is above the plane."""
    lowest = min(body.anchors(rotation), key=lambda anchor: float(rotation[2] @ anchor.point))
    place = np.asarray(position + rotation @ lowest.point)
    if float(place[2]) > TOUCHING * body.radius:
        return Patch(ContactMode.AIRBORNE, 0.0, 0.0, place, place)
    return touching_patch(body, position, rotation, place)
