"""Pixels of an image, and metres on the substrate."""

from __future__ import annotations

import numpy as np

from ..errors import InputError
from .sensor import Sensor
from .track import Array

__all__ = ["to_substrate"]


def to_substrate(x_px: Array, y_px: Array, sensor: Sensor) -> tuple[Array, Array]:
    """Return x and y on the substrate, m, of a path in the image.

    Parameters
    ----------
    x_px, y_px
        To the right and downwards in the image, pixels, shape (n,); NaN in both where a frame was lost.
    sensor
        Scale, origin and axes.

    Raises
    ------
    InputError
        A sensor without a scale.
    """
    if sensor.micrometres_per_pixel is None:
        raise InputError("sensor.micrometres_per_pixel", "no such key", "the scale of the tracks that are in pixels")
    seen = np.flatnonzero(np.isfinite(x_px))
    if sensor.origin_px is not None:
        right, down = sensor.origin_px
    elif seen.size:
        right, down = float(x_px[seen[0]]), float(y_px[seen[0]])
    else:
        right = down = 0.0
    scale = 1e-6 * sensor.micrometres_per_pixel
    (x_right, x_down), (y_right, y_down) = sensor.x_axis_px, sensor.y_axis_px
    along, across = x_px - right, y_px - down
    return scale * (x_right * along + x_down * across), scale * (y_right * along + y_down * across)
