"""`Guide`: where a robot was seen along y, to which a run is drawn, and `Nudge`, how.

What was seen is taken back to the substrate frame and the field's clock first, through the sensor as a hypothesis has
it and as its nuisances were fitted: where x was seen too, a run that is right is drawn nowhere but by noise.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import degrees
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...camera import Camera
from ...dataset import LabTrial

__all__ = ["Guide", "Nudge"]

Floats = NDArray[np.float64]

# Places are at odds with both neighbours where they are off the middle of them by so many times as much as most are.
_AT_ODDS = 12.0
# A camera that shows less of a length along y than this share, with x not seen, says little of y.
_LEAST_SEEN = 0.9


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
            The trial's clock (s) and origin (x, y, z in m), shape (4,).
        camera
            Heading (rad) and scale, shape (2,).
        """
        (clock, x, y, _), (heading, scale) = local.tolist(), camera.tolist()
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
        Of the tracked point, m, shape (n,); no x where none was measured.
    """

    time_s: Floats
    x_m: Floats | None
    y_m: Floats

    @classmethod
    def of(cls, trial: LabTrial) -> Guide | None:
        """Return a trial's guide; None where the robot was seen in less than two frames.

        Frames that are at odds with both neighbours are left out: something else was taken for the robot. Where x is
        lost and y is not, x is taken between its neighbours.

        Parameters
        ----------
        trial
            Of a lab.
        """
        track = trial.track
        if track is None or "y_m" not in track.channels:
            return None
        time, y, x = track.time_s, track.channels["y_m"], track.channels.get("x_m")
        seen = np.flatnonzero(np.isfinite(y))
        seen = seen[~_at_odds(y[seen])]
        if len(seen) < 2:
            return None
        if x is not None:
            known = np.isfinite(x)
            x = np.interp(time[seen], time[known], x[known]) if known.any() else None
        return cls(time[seen], x, y[seen])

    def behind(self, cameras: Sequence[Camera]) -> tuple[Floats, Floats] | None:
        """Return the field's times, s, and the true places along y, m, shape (n,) each.

        None where cameras that are turned by more than some 25° show too little of y without x. Where x was not
        measured, the robot is taken to have stayed at x = 0: seen by a camera that is turned, a drift looks like y.

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
        if turned[1, 1] < _LEAST_SEEN * np.linalg.norm(turned[:, 1]):
            return None
        return times, (self.y_m - y) / turned[1, 1]


def _at_odds(places: Floats) -> NDArray[np.bool_]:
    """Return which places are far from the middle of both neighbours, shape (n,)."""
    off = np.zeros(len(places))
    off[1:-1] = np.abs(places[1:-1] - 0.5 * (places[:-2] + places[2:]))
    usual = float(np.median(off[1:-1])) if len(places) > 2 else 0.0
    return np.asarray((off > _AT_ODDS * usual) & (usual > 0.0))
