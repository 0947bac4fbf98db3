"""`Guide`: where a robot was seen along y, to which a run is drawn, and `Nudge`, how.

What was seen is taken back to the substrate frame and the field's clock first, through the sensor as a hypothesis has
it and as its nuisances were fitted: a run that is right is drawn nowhere but by noise.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import degrees
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..camera import Camera
from ..dataset import LabTrial

__all__ = ["Guide", "Nudge"]

Floats = NDArray[np.float64]

# Frames farther apart than so many of their median interval have lost ones between them.
_LOST = 1.5
# A camera that shows less of a length along y than this share, with x not seen, says nothing of y.
_LEAST_SEEN = 0.5


class Nudge(NamedTuple):
    """How a run is drawn to where the robot was seen.

    Attributes
    ----------
    rate_per_s
        How fast, 1/s, above 0.
    sensor
        How the sensor is off beside what the effects make of it.
    """

    rate_per_s: float
    sensor: Camera

    @classmethod
    def of(cls, rate_per_s: float, local: Floats, camera: Floats) -> Nudge:
        """Return the nudge of a trial with the sensor as it was fitted.

        Parameters
        ----------
        rate_per_s
            How fast, 1/s.
        local
            The trial's clock (s) and origin (x, y in m), shape (3,).
        camera
            Heading (rad) and scale, shape (2,).
        """
        (clock, x, y), (heading, scale) = local.tolist(), camera.tolist()
        off = Camera(scale=1.0 + scale, heading_deg=degrees(heading), origin_m=(x, y), time_offset_s=clock)
        return cls(rate_per_s, off)


@dataclass(frozen=True, eq=False)
class Guide:
    """Where a robot was seen from above.

    Attributes
    ----------
    time_s
        By the sensor's clock, s, shape (n,).
    x_m, y_m
        Of the tracked point, m, shape (n,), NaN in a row that stands for lost frames; no x where none was measured.
    """

    time_s: Floats
    x_m: Floats | None
    y_m: Floats

    @classmethod
    def of(cls, trial: LabTrial) -> Guide | None:
        """Return a trial's guide; None where no two neighbouring frames say where the robot was.

        Parameters
        ----------
        trial
            Of a lab.
        """
        track = trial.track
        if track is None or "y_m" not in track.channels:
            return None
        y, x = track.channels["y_m"], track.channels.get("x_m")
        if x is not None and not np.isfinite(x).any():
            x = None
        seen = np.isfinite(y) if x is None else np.isfinite(y) & np.isfinite(x)
        times = track.time_s[seen]
        apart = np.diff(times) > _LOST * track.frame_interval_s
        if len(times) < 2 or apart.all():
            return None
        after = np.flatnonzero(apart) + 1
        between = 0.5 * (times[after - 1] + times[after])

        def with_gaps(values: Floats) -> Floats:
            return np.insert(values[seen], after, np.nan)

        return cls(np.insert(times, after, between), None if x is None else with_gaps(x), with_gaps(y))

    def behind(self, cameras: Sequence[Camera]) -> tuple[Floats, Floats] | None:
        """Return the field's times, s, and the true places along y, m, shape (n,) each, NaN between lost frames.

        None where cameras that are turned so far show nothing of y. Where x was not measured, the robot is taken to
        have stayed at x = 0.

        Parameters
        ----------
        cameras
            Through which it was seen, one after another, the first nearest to the robot.
        """
        # What is seen of the origin, and of a metre along x and along y: it is linear in the place.
        corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
        for camera in cameras:
            corners = camera.seen_position(corners)
        (x, y), turned = corners[0, :2], (corners[1:, :2] - corners[0, :2]).T
        times = self.time_s + sum(camera.time_offset_s for camera in cameras)
        if self.x_m is not None:
            return times, np.linalg.solve(turned, np.stack([self.x_m - x, self.y_m - y]))[1]
        if abs(turned[1, 1]) < _LEAST_SEEN * np.linalg.norm(turned[:, 1]):
            return None
        return times, (self.y_m - y) / turned[1, 1]
