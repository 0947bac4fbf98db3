"""`Track`: where a robot was seen, frame by frame."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, show

__all__ = [
    "ANGLES",
    "CHANNELS",
    "POSITIONS",
    "QUATERNION",
    "Array",
    "Fault",
    "Track",
    "find_disorder",
    "find_fault",
    "median_interval_s",
]

Array = NDArray[np.float64]

POSITIONS = ("x_m", "y_m", "z_m")
QUATERNION = ("qw", "qx", "qy", "qz")
ANGLES = (*QUATERNION, "tilt_deg", "heading_deg")
CHANNELS = (*POSITIONS, *ANGLES)

# Metres from the start within which a microrobot is seen: what is farther was written in another unit.
_FARTHEST_M = 10.0
# A quaternion that was measured or rounded is still meant to have length one.
_QUATERNION_UNIT = 0.05
# An angle above the substrate that noise may still have made; what turns on and on is another angle.
_STEEPEST_DEG = 120.0
# One this close to length one is left as it is, so that what has been normalised stays the same bits.
_UNIT = 1e-12


class Fault(NamedTuple):
    """The first row of a track that is refused, its column, and why."""

    row: int
    column: str
    found: str
    expected: str


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Track:
    """Channels over time, substrate frame; NaN where a frame was lost.

    Attributes
    ----------
    time_s
        Increasing times since the field's start, s, shape (n,).
    channels
        One array of shape (n,) for each measured one of `CHANNELS`, in their order: x_m, y_m, z_m (m), qw, qx, qy, qz
        (unit quaternion, body to substrate; normalised), tilt_deg, heading_deg (degrees).

    Raises
    ------
    InputError
        No channel or an unknown one, arrays of other shapes, times that do not increase, a value that is infinite or
        farther than a microrobot goes, or quaternions that are incomplete or far from length one.
    """

    time_s: Array
    channels: Mapping[str, Array]

    def __post_init__(self) -> None:
        time = _column("track.time_s", self.time_s)
        if not isinstance(self.channels, Mapping) or not self.channels:
            raise InputError("track.channels", show(self.channels), f"any of {', '.join(CHANNELS)}")
        for name in self.channels:
            if name not in CHANNELS:
                raise InputError(f"track.{name}", "an unknown channel", f"one of {', '.join(CHANNELS)}")
        channels = {n: _column(f"track.{n}", self.channels[n]) for n in CHANNELS if n in self.channels}
        for name, values in channels.items():
            if values.shape != time.shape:
                raise InputError(f"track.{name}", f"{values.size} values", f"{time.size}, as many as in time_s")
        for name in QUATERNION:
            if name not in channels and any(other in channels for other in QUATERNION):
                raise InputError(f"track.{name}", "no such channel", f"all of {', '.join(QUATERNION)} or none")
        fault = find_fault(time, channels)
        if fault is not None:
            raise InputError(f"track.{fault.column}[{fault.row}]", fault.found, fault.expected)
        if "qw" in channels:
            length = _length(channels)
            length[np.abs(length - 1.0) <= _UNIT] = 1.0
            channels |= {name: channels[name] / length for name in QUATERNION}
        for values in (time, *channels.values()):
            values.setflags(write=False)
        object.__setattr__(self, "time_s", time)
        object.__setattr__(self, "channels", channels)

    @property
    def frames(self) -> int:
        """Number of frames in which at least one channel was seen."""
        return int(np.any([np.isfinite(values) for values in self.channels.values()], axis=0).sum())

    @property
    def frame_interval_s(self) -> float:
        """Median time between two rows, s; NaN with fewer than two."""
        return median_interval_s(self.time_s)


def median_interval_s(time_s: Array) -> float:
    """Return the median time between two rows, s; NaN with fewer than two, infinite where it is past the floats.

    Parameters
    ----------
    time_s
        Increasing times, s, shape (n,).
    """
    with np.errstate(over="ignore"):
        return float(np.median(np.diff(time_s))) if time_s.size > 1 else float("nan")


def find_disorder(times: Array, words: Callable[[int], str]) -> Fault | None:
    """Return the first row that is not later than the one before it, or None.

    Parameters
    ----------
    times
        In any unit, finite, shape (n,).
    words
        What to call the time of a row, by its number.
    """
    for row in np.flatnonzero(times[1:] <= times[:-1]).tolist():
        after = "a second time" if times[row + 1] == times[row] else f"after {words(row)}"
        return Fault(row + 1, "time_s", f"{words(row + 1)} {after}", "times that increase")
    return None


def find_fault(time_s: Array, channels: Mapping[str, Array]) -> Fault | None:
    """Return what is wrong with the rows of a track whose columns are all there, or None.

    Parameters
    ----------
    time_s
        Times, s, shape (n,).
    channels
        Arrays of shape (n,) by their names in `CHANNELS`, a quaternion complete.
    """
    for row in np.flatnonzero(~np.isfinite(time_s)):
        return Fault(int(row), "time_s", show(float(time_s[row])), "a finite number")
    if (disorder := find_disorder(time_s, lambda row: f"{time_s[row]:g} s")) is not None:
        return disorder
    for name, values in channels.items():
        for row in np.flatnonzero(np.isinf(values)):
            return Fault(int(row), name, show(float(values[row])), "a finite number, or none for a lost frame")
    for name in POSITIONS:
        for row in np.flatnonzero(np.abs(channels.get(name, np.empty(0))) > _FARTHEST_M):
            return Fault(
                int(row), name, f"{channels[name][row]:g} m", f"metres, at most {_FARTHEST_M:g} from the start"
            )
    for row in np.flatnonzero(np.abs(channels.get("tilt_deg", np.empty(0))) > _STEEPEST_DEG):
        found = f"{channels['tilt_deg'][row]:g} degrees"
        return Fault(int(row), "tilt_deg", found, "the angle above the substrate, from -90 to 90 but for noise")
    if "qw" not in channels:
        return None
    known = np.isfinite([channels[name] for name in QUATERNION])
    for row in np.flatnonzero(known.any(axis=0) & ~known.all(axis=0)):
        name = QUATERNION[int(np.argmin(known[:, row]))]
        return Fault(int(row), name, "an empty cell beside the others", "a whole quaternion or none")
    length = _length(channels)
    for row in np.flatnonzero(np.abs(length - 1.0) > _QUATERNION_UNIT):
        return Fault(int(row), "qw", f"a quaternion of length {length[row]:.4g}", "length 1")
    return None


def _length(channels: Mapping[str, Array]) -> Array:
    # Components past 1e150 are no unit quaternion in any case: their square may overflow.
    with np.errstate(over="ignore"):
        length: Array = np.sqrt(np.sum([channels[name] ** 2 for name in QUATERNION], axis=0))
    return length


def _column(key: str, value: object) -> Array:
    expected = "an array of numbers of shape (n,)"
    try:
        found = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(key, show(value), expected) from None
    if found.ndim != 1:
        raise InputError(key, f"shape {found.shape}", expected)
    return found
