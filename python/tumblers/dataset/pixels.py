"""Pixels of an image, and metres on the substrate."""

from __future__ import annotations

import numpy as np

from ..errors import InputError
from .sensor import Sensor
from .track import Array

__all__ = ["to_substrate"]

# Frames after which a robot has left its start.
_LATE = 1.01


def to_substrate(x_px: Array, y_px: Array, time_s: Array, sensor: Sensor) -> tuple[Array, Array]:
    """Return x and y on the substrate, m, of a path in the image.

    Parameters
    ----------
    x_px, y_px
        To the right and downwards in the image, pixels, shape (n,); NaN in both where a frame was lost.
    time_s
        Times of the frames, s, shape (n,).
    sensor
        Scale, origin and axes.

    Raises
    ------
    InputError
        A sensor without a scale; or without an origin, where the robot was not seen at the start.
    """
    if sensor.micrometres_per_pixel is None:
        raise InputError("sensor.micrometres_per_pixel", "no such key", "the scale of the tracks that are in pixels")
    seen = np.flatnonzero(np.isfinite(x_px))
    if sensor.origin_px is not None:
        right, down = sensor.origin_px
    elif seen.size:
        late, interval = float(time_s[seen[0]]), float(np.median(np.diff(time_s))) if time_s.size > 1 else 0.0
        # Times that fall are refused with the whole track.
        if interval >= 0.0 and late > _LATE * interval:
            expected = f"the pixel of the robot's start: the first that is seen is at {late:g} s, when it has moved"
            raise InputError("sensor.origin_px", "no such key", expected)
        right, down = float(x_px[seen[0]]), float(y_px[seen[0]])
    else:
        right = down = 0.0
    scale = 1e-6 * sensor.micrometres_per_pixel
    (x_right, x_down), (y_right, y_down) = sensor.x_axis_px, sensor.y_axis_px
    along, across = x_px - right, y_px - down
    return scale * (x_right * along + x_down * across), scale * (y_right * along + y_down * across)
