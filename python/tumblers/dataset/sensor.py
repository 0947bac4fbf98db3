"""`Sensor`: how well, and in which units, the tracks were measured."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot
from typing import Literal, get_args

from ..camera import Camera, TrackedPoint
from ..check import choice, number, pair
from ..errors import InputError, show

__all__ = [
    "HALF_A_FRAME",
    "MOST_PX",
    "TYPICAL_ANGLE_NOISE_DEG",
    "TYPICAL_POSITION_NOISE_M",
    "HeadingOf",
    "Pixel",
    "Sensor",
]

Pixel = tuple[float, float]
HeadingOf = Literal["end", "axis"]

# What stands in a dataset without tracks, for trials that are only proposed.
TYPICAL_POSITION_NOISE_M = 5.0e-6
TYPICAL_ANGLE_NOISE_DEG = 1.0

# What a clock is off by where nothing is stated, in frames.
HALF_A_FRAME = 0.5

# No image has a pixel so far out, and arithmetic with this is far from the ends of the floats.
MOST_PX = 1e9

_UNIT = 1e-12
# More noise than this tells nothing, and less no camera has, m and degrees.
_MOST_NOISE = {"position_noise_m": 1.0, "angle_noise_deg": 360.0, "z_noise_m": 1.0}
_LEAST_NOISE = 1e-12


@dataclass(frozen=True, kw_only=True, slots=True)
class Sensor:
    """A camera: its noise, its units and how far off it may be.

    Attributes
    ----------
    position_noise_m, angle_noise_deg
        One standard deviation of x and y, m, and of every angle, degrees.
    z_noise_m
        One standard deviation of z, m; `position_noise_m` if None.
    micrometres_per_pixel, frames_per_second
        Units of tracks in pixels and in frames.
    origin_px
        Pixel of the robot's start; the first frame in which a track has the robot if None.
    y_axis_px
        Direction of the substrate's +y in the image, whose x points right and y down; normalised.
    time_offset_s
        How far the track's clock may be off, s; half a frame if None, by `frames_per_second` or the track's own times.
    origin_tolerance_m, heading_tolerance_deg, scale_tolerance
        How far the track's origin (m), heading (degrees) and scale (a fraction) may be off.
    z_origin_tolerance_m
        How far the height may be off that the track takes for the substrate's, m: 0 where it is that of the robot's
        start, for the robot starts on the substrate. If None, a diagnosis takes 0, or `origin_tolerance_m` where the
        data clearly ask for it.
    tracked_point
        What the positions are of: ``body_centre``, the centre of the body's shape, or ``centre_of_mass``. If None, a
        diagnosis takes the shape's centre, unless by the other an offset of the mass alone explains all and is clearly
        likelier.
    heading_of
        What headings are of: the body's +y ``end``, or an ``axis`` of which nobody knows which end is which. If None,
        headings that all lie within half a turn are of an axis.

    Raises
    ------
    InputError
        A number, a direction or a word that is refused.
    """

    position_noise_m: float
    angle_noise_deg: float
    z_noise_m: float | None = None
    micrometres_per_pixel: float | None = None
    frames_per_second: float | None = None
    origin_px: Pixel | None = None
    y_axis_px: Pixel = (0.0, -1.0)
    time_offset_s: float | None = None
    origin_tolerance_m: float = 50e-6
    z_origin_tolerance_m: float | None = None
    heading_tolerance_deg: float = 2.0
    scale_tolerance: float = 0.005
    tracked_point: TrackedPoint | None = None
    heading_of: HeadingOf | None = None

    def __post_init__(self) -> None:
        def put(name: str, value: object) -> None:
            object.__setattr__(self, name, value)

        for name, most in _MOST_NOISE.items():
            if getattr(self, name) is not None or name != "z_noise_m":
                put(name, number(f"sensor.{name}", getattr(self, name), above=0.0, most=most))
                number(f"sensor.{name}", getattr(self, name), least=_LEAST_NOISE)
        for name in ("micrometres_per_pixel", "frames_per_second"):
            if getattr(self, name) is not None:
                put(name, number(f"sensor.{name}", getattr(self, name), above=0.0))
        if self.time_offset_s is not None:
            put("time_offset_s", number("sensor.time_offset_s", self.time_offset_s, least=0.0))
        put("origin_tolerance_m", number("sensor.origin_tolerance_m", self.origin_tolerance_m, least=0.0))
        if self.z_origin_tolerance_m is not None:
            put("z_origin_tolerance_m", number("sensor.z_origin_tolerance_m", self.z_origin_tolerance_m, least=0.0))
        heading = number("sensor.heading_tolerance_deg", self.heading_tolerance_deg, least=0.0, most=180.0)
        put("heading_tolerance_deg", heading)
        put("scale_tolerance", number("sensor.scale_tolerance", self.scale_tolerance, least=0.0, below=1.0))
        if self.origin_px is not None:
            put("origin_px", pair("sensor.origin_px", self.origin_px, most=MOST_PX))
        put("y_axis_px", _direction("sensor.y_axis_px", self.y_axis_px))
        if self.tracked_point is not None:
            choice("sensor.tracked_point", self.tracked_point, get_args(TrackedPoint))
        if self.heading_of is not None:
            choice("sensor.heading_of", self.heading_of, get_args(HeadingOf))

    @property
    def camera(self) -> Camera:
        """The camera of a run that is to be seen as the tracks are: of the point that was tracked."""
        return Camera() if self.tracked_point is None else Camera(tracked_point=self.tracked_point)

    @property
    def height_tolerance_m(self) -> float:
        """Within what the zero of heights is fitted, m: not at all where nothing is stated."""
        return self.z_origin_tolerance_m or 0.0

    @property
    def x_axis_px(self) -> Pixel:
        """Direction of the substrate's +x in the image: to the right of +y as seen from above, x = y × z."""
        right, down = self.y_axis_px
        return -down, right

    def frame_s(self, interval_s: float) -> float:
        """Return the time of a frame, s: by `frames_per_second` where it is stated.

        Parameters
        ----------
        interval_s
            Between two rows of a track, s, which may leave frames out: it counts where the camera's rate is not stated.
        """
        return interval_s if self.frames_per_second is None else 1.0 / self.frames_per_second

    def clock_tolerance_s(self, interval_s: float) -> float:
        """Return how far the clock of a track may be off, s.

        Parameters
        ----------
        interval_s
            Between two of its rows, s.
        """
        if self.time_offset_s is not None:
            return self.time_offset_s
        return HALF_A_FRAME * self.frame_s(interval_s)


def _direction(key: str, value: object) -> Pixel:
    x, y = pair(key, value)
    scale = max(abs(x), abs(y))
    if scale == 0.0:
        raise InputError(key, show(value), "a direction that is not zero")
    if abs(hypot(x, y) - 1.0) <= _UNIT:
        return x, y
    # The larger component first, so that no length under- or overflows.
    x, y = x / scale, y / scale
    return x / hypot(x, y), y / hypot(x, y)
