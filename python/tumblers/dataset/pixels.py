"""Pixels of an image, and metres on the substrate."""

from __future__ import annotations

import numpy as np

from ..errors import InputError
from .sensor import Sensor
from .track import Array, median_interval_s

__all__ = ["to_substrate"]

# Frames by which the first that is seen may be late: as many as a clock may be off, and as many as a robot may be late
# by that does not move farther in them than an origin may be off.
_PUNCTUAL, _LATE = 0.51, 1.01


def to_substrate(x_px: Array, y_px: Array, time_s: Array, sensor: Sensor, name: str) -> tuple[Array, Array]:
    """Return x and y on the substrate, m, of a path in the image.

    Parameters
    ----------
    x_px, y_px
        To the right and downwards in the image, pixels, at most `MOST_PX`, shape (n,); NaN in both where a frame was
        lost.
    time_s
        Increasing times of the frames, s, shape (n,).
    sensor
        Scale, origin and axes.
    name
        Of the track's file, for errors.

    Raises
    ------
    InputError
        A sensor without a scale; or without an origin, where the robot was not seen at the start.
    """
    if sensor.micrometres_per_pixel is None:
        raise InputError("sensor.micrometres_per_pixel", "no such key", f"the scale of the pixels in {name}")
    seen = np.flatnonzero(np.isfinite(x_px))
    if sensor.origin_px is not None:
        right, down = sensor.origin_px
    elif seen.size:
        late, interval = float(time_s[seen[0]]), median_interval_s(time_s) if time_s.size > 1 else 0.0
        moved = 1e-6 * sensor.micrometres_per_pixel * _moved_px(x_px[seen], y_px[seen], time_s[seen])
        left = late > _PUNCTUAL * interval and moved > sensor.origin_tolerance_m
        if late > _LATE * interval or left:
            way = f" some {1e6 * moved:.0f} µm" if moved > 0.0 else ""
            expected = (
                f"the pixel of the robot's start: the first in {name} is at {late:g} s, when it has moved{way} "
                "since the field's start, time 0"
            )
            raise InputError("sensor.origin_px", "no such key", expected)
        right, down = float(x_px[seen[0]]), float(y_px[seen[0]])
    else:
        right = down = 0.0
    scale = 1e-6 * sensor.micrometres_per_pixel
    (x_right, x_down), (y_right, y_down) = sensor.x_axis_px, sensor.y_axis_px
    along, across = x_px - right, y_px - down
    # By a scale that is out of all bounds the places become infinite, and are refused as such.
    with np.errstate(over="ignore"):
        return scale * (x_right * along + x_down * across), scale * (y_right * along + y_down * across)


def _moved_px(x_px: Array, y_px: Array, time_s: Array) -> float:
    """Return how far a robot has come by the first frame that has it, at the pace of the first two, pixels."""
    if time_s.size < 2:
        return 0.0
    step = float(np.hypot(x_px[1] - x_px[0], y_px[1] - y_px[0]))
    # As Python's floats, which become infinite without a warning.
    first, second = float(time_s[0]), float(time_s[1])
    return step * first / (second - first)
