"""`Camera`: how a run is seen."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import cos, radians, sin
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .check import choice, number, pair

__all__ = ["Camera", "TrackedPoint"]

TrackedPoint = Literal["body_centre", "centre_of_mass"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Camera:
    """A camera that looks down on the substrate; it changes what is measured, not what moves.

    Attributes
    ----------
    scale
        Length seen over true length.
    heading_deg
        Angle by which what is seen is turned about +z, from +y towards -x, degrees.
    origin_m
        Where the substrate's origin is seen, (x, y), m.
    time_offset_s
        The field's time when the camera's clock says 0, s.
    tracked_point
        What a position that is seen is of: ``body_centre``, the centre of the body's shape, or ``centre_of_mass``.

    Raises
    ------
    InputError
        A number or a word that is refused.
    """

    scale: float = 1.0
    heading_deg: float = 0.0
    origin_m: tuple[float, float] = (0.0, 0.0)
    time_offset_s: float = 0.0
    tracked_point: TrackedPoint = "body_centre"

    def __post_init__(self) -> None:
        object.__setattr__(self, "scale", number("camera.scale", self.scale, above=0.0))
        object.__setattr__(self, "heading_deg", number("camera.heading_deg", self.heading_deg))
        object.__setattr__(self, "origin_m", pair("camera.origin_m", self.origin_m))
        object.__setattr__(self, "time_offset_s", number("camera.time_offset_s", self.time_offset_s))
        choice("camera.tracked_point", self.tracked_point, get_args(TrackedPoint))

    @property
    def perfect(self) -> Camera:
        """The camera that is not off, of the same point."""
        return _perfect(self.tracked_point)

    def tracked_m(self, center_of_mass_m: ArrayLike) -> NDArray[np.float64]:
        """Return where on the body the tracked point is, from the centre of mass, body frame, m, shape (3,).

        Parameters
        ----------
        center_of_mass_m
            The centre of mass, from the centre of the shape, body frame, m, shape (3,).
        """
        if self.tracked_point == "centre_of_mass":
            return np.zeros(3)
        return -np.array(center_of_mass_m, dtype=np.float64)

    def tracked_position(
        self, position_m: NDArray[np.float64], orientation: NDArray[np.float64], center_of_mass_m: ArrayLike
    ) -> NDArray[np.float64]:
        """Return where the tracked point is, substrate frame, m, shape (n, 3): r + R(q) p.

        Parameters
        ----------
        position_m
            Of the centre of mass, r, substrate frame, m, shape (n, 3).
        orientation
            Unit quaternions q, w, x, y, z, body to substrate, shape (n, 4).
        center_of_mass_m
            From the centre of the shape, -p, body frame, m, shape (3,).
        """
        place = self.tracked_m(center_of_mass_m)
        if not place.any():
            return position_m
        w, v = orientation[:, :1], orientation[:, 1:]
        cross = np.cross(v, place)
        return np.asarray(position_m + (place + 2.0 * (w * cross + np.cross(v, cross))))

    def seen_position(self, position_m: ArrayLike) -> NDArray[np.float64]:
        """Return positions as they are seen: x and y turned, scaled and from another origin, z as it is.

        Parameters
        ----------
        position_m
            Positions, substrate frame, m, shape (..., 3).
        """
        seen: NDArray[np.float64] = np.array(position_m, dtype=np.float64)
        if (self.scale, self.heading_deg, *self.origin_m) == (1.0, 0.0, 0.0, 0.0):
            return seen
        x, y = seen[..., 0].copy(), seen[..., 1].copy()
        c, s = cos(radians(self.heading_deg)), sin(radians(self.heading_deg))
        seen[..., 0] = self.scale * (c * x - s * y) + self.origin_m[0]
        seen[..., 1] = self.scale * (s * x + c * y) + self.origin_m[1]
        return seen

    def seen_orientation(self, orientation: ArrayLike) -> NDArray[np.float64]:
        """Return orientations as they are seen, turned by the heading about +z.

        Parameters
        ----------
        orientation
            Unit quaternions w, x, y, z, body to substrate, shape (..., 4).
        """
        seen: NDArray[np.float64] = np.array(orientation, dtype=np.float64)
        if self.heading_deg == 0.0:
            return seen
        w, x, y, z = (seen[..., i].copy() for i in range(4))
        c, s = cos(0.5 * radians(self.heading_deg)), sin(0.5 * radians(self.heading_deg))
        turned: Any = (c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w)
        return np.stack(turned, axis=-1)


# A diagnosis asks for it several times a run.
@cache
def _perfect(tracked_point: TrackedPoint) -> Camera:
    return Camera(tracked_point=tracked_point)
