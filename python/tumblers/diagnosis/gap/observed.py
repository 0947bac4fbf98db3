"""`Observed`: what was measured in one trial, as numbers with their noise.

Of a robot that slides without a field, down a slope that should hold it, the first half of its way is compared, in
which it gathers speed; that it slides counts as an outcome. Where it catches again is up to the spot.

The heading of a body that tumbles end over end jumps by half a turn each time that it stands upright, if it is of an
end. A fit of an ellipse does not know which end is which: its headings all lie within half a turn, and are those of an
axis, which comes back to itself after half a turn. Of an end that never jumps either is the same.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import pi, radians

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from ...dataset import Dataset, LabTrial, Outcome
from ...field import StaticField

__all__ = ["CHANNELS", "Observed", "observe"]

Floats = NDArray[np.float64]

# The names that a diagnosis uses for what is compared along a track.
CHANNELS = ("x", "y", "z", "tilt", "heading", "twist")
# More frames than these add little, and their covariance costs the cube of their number.
_MOST_FRAMES = 160
# A robot without a field has slid if it went farther than this share of its length.
_SLID = 0.25
# Both ends of half a turn may be there, as decimals have them, rad.
_ROUNDING = 1e-6


@dataclass(frozen=True, eq=False)
class Observed:
    """One trial's measurements.

    Attributes
    ----------
    id
        The trial's.
    time_s
        Times of the frames that are compared, s, shape (n,); none for a trial without a track.
    values
        By channel, shape (n,), NaN where lost: ``x``, ``y``, ``z`` in m, ``tilt`` and ``heading`` in rad.
    orientation
        Unit quaternions, shape (n, 4), where the track has any; they take the place of ``tilt`` and ``heading``.
    noise
        One standard deviation by channel, m or rad.
    frame_interval_s
        Median time between the track's frames, s; 0 without a track.
    compared_interval_s
        The same between those that are compared: longer where most are lost, or more than are compared.
    slid_m
        Way that the robot slid without a field, m; 0 where it held, or where there is a field.
    outcome
        What was noted beside or instead of the track.
    frames, lost
        Number of frames in the file, and of those without any measurement.
    heading_turn
        After how much a heading comes back to itself, rad: 2π of an end of the body, π of an axis without ends.
    """

    id: str
    time_s: Floats
    values: dict[str, Floats]
    orientation: Floats | None
    noise: dict[str, float]
    frame_interval_s: float
    compared_interval_s: float
    slid_m: float
    outcome: Outcome | None
    frames: int
    lost: int
    heading_turn: float = 2.0 * pi

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of what is compared, in the order of `CHANNELS`."""
        turned = () if self.orientation is None else ("tilt", "heading", "twist")
        return tuple(name for name in CHANNELS if name in self.values or name in turned)

    def beginning(self, frames: int) -> Observed:
        """Return the first so many frames of what is compared."""
        return replace(
            self,
            time_s=self.time_s[:frames],
            values={name: values[:frames] for name, values in self.values.items()},
            orientation=None if self.orientation is None else self.orientation[:frames],
        )

    def found(self, channel: str) -> NDArray[np.bool_]:
        """Return in which frames a channel was not lost, shape (n,)."""
        if channel in self.values:
            return np.isfinite(self.values[channel])
        assert self.orientation is not None
        return np.asarray(np.isfinite(self.orientation).all(axis=1))


def observe(dataset: Dataset) -> tuple[Observed, ...]:
    """Return what was measured in each trial of a dataset.

    Parameters
    ----------
    dataset
        What the lab measured.
    """
    length_m = float(np.ptp(np.concatenate(dataset.robot.body().outline)[:, 1]))
    trials = [_observed(dataset, trial, length_m) for trial in dataset.trials]
    headings = [one.values["heading"] for one in trials if "heading" in one.values]
    stated = dataset.sensor.heading_of
    axis = stated == "axis" or (stated is None and _within_half_a_turn(np.concatenate([np.empty(0), *headings])))
    return tuple(replace(one, heading_turn=pi) if axis and "heading" in one.values else one for one in trials)


def _within_half_a_turn(headings: Floats) -> bool:
    """Return whether there are headings, rad, and half of the circle or more without any."""
    seen = np.sort(headings[np.isfinite(headings)] % (2.0 * pi))
    return len(seen) > 0 and float(np.diff(seen, append=seen[0] + 2.0 * pi).max()) >= pi - _ROUNDING


def _observed(dataset: Dataset, trial: LabTrial, length_m: float) -> Observed:
    sensor, track = dataset.sensor, trial.track
    empty = np.empty(0)
    if track is None:
        return Observed(trial.id, empty, {}, None, {}, 0.0, 0.0, 0.0, trial.outcome, 0, 0)
    found = np.zeros(len(track.time_s), dtype=bool)
    for column in track.channels.values():
        found |= np.isfinite(column)
    kept = np.flatnonzero(found)
    if not len(kept):
        return Observed(trial.id, empty, {}, None, {}, 0.0, 0.0, 0.0, trial.outcome, len(found), len(found))
    stride = float(np.median(np.diff(kept))) if len(kept) > 1 else 1.0
    if len(kept) > _MOST_FRAMES:
        stride *= len(kept) / _MOST_FRAMES
        kept = kept[np.unique(np.linspace(0, len(kept) - 1, _MOST_FRAMES).round().astype(int))]
    columns = {name: np.asarray(column, dtype=np.float64)[kept] for name, column in track.channels.items()}
    slid = 0.0
    off = isinstance(trial.field, StaticField) and trial.field.strength_T == 0.0
    if off and {"x_m", "y_m"} <= {*columns}:
        slid, count = _slide(columns, _SLID * length_m)
        kept, columns = kept[:count], {name: column[:count] for name, column in columns.items()}
    angle = radians(sensor.angle_noise_deg)
    height = sensor.position_noise_m if sensor.z_noise_m is None else sensor.z_noise_m
    noise = {"x": sensor.position_noise_m, "y": sensor.position_noise_m, "z": height}
    noise |= {"tilt": angle, "heading": angle, "twist": angle}
    values = {name[0]: columns[name] for name in ("x_m", "y_m", "z_m") if name in columns}
    orientation = None
    # Of quaternions that were lost throughout, only the columns are left.
    if "qw" in columns and np.isfinite(columns["qw"]).any():
        orientation = np.stack([columns[name] for name in ("qw", "qx", "qy", "qz")], axis=1)
    else:
        for name in ("tilt", "heading"):
            if f"{name}_deg" in columns:
                values[name] = np.radians(columns[f"{name}_deg"])
    interval = track.frame_interval_s if len(found) > 1 else 0.0
    return Observed(
        id=trial.id,
        time_s=np.asarray(track.time_s, dtype=np.float64)[kept],
        values=values,
        orientation=orientation,
        noise=noise,
        frame_interval_s=interval,
        compared_interval_s=stride * interval,
        slid_m=slid,
        outcome=trial.outcome,
        frames=len(track.time_s),
        lost=int(len(found) - found.sum()),
    )


def _slide(columns: dict[str, Floats], least_m: float) -> tuple[float, int]:
    """Return how far a robot slid, m, and how many frames there are until half of that; 0 and all where it held.

    By the middle of three frames: one in which something else was taken for the robot is no slide.
    """
    x, y = columns["x_m"], columns["y_m"]
    seen = np.flatnonzero(np.isfinite(x) & np.isfinite(y))
    if not len(seen):
        return 0.0, len(x)
    places = np.stack([x[seen], y[seen]])
    calm = median_filter(places, (1, 3), mode="mirror")
    if np.hypot(*(calm - calm[:, :1])).max() <= least_m:
        return 0.0, len(x)
    # Of one that slides the first frame and the last are its ends, not the middle of three.
    calm[:, [0, -1]] = places[:, [0, -1]]
    way = np.hypot(*(calm - calm[:, :1]))
    slid = float(way.max())
    return slid, int(seen[np.argmax(way > 0.5 * slid)])
