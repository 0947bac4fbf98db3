"""What a camera reads off poses: the channels of a track, and the outcomes of a trial."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..dataset.climb import CLIMBED
from ..dataset.outcome import REST_SHARE
from .world import Poses, Scene

__all__ = ["STEEPEST_DEG", "channels_of", "climbed_share", "climbs", "mean_speed", "rest_tilt", "turn_between"]

# The heading of a rod that stands up is not seen.
STEEPEST_DEG = 75.0


def channels_of(poses: Poses) -> dict[str, NDArray[np.float64]]:
    """Return x_m, y_m, z_m, tilt_deg, heading_deg (not a number where the body stands up) and the quaternion.

    Parameters
    ----------
    poses
        Poses of n times.
    """
    w, x, y, z = poses.orientation.T
    along = np.stack([2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)])
    tilt = np.degrees(np.arcsin(np.clip(along[2], -1.0, 1.0)))
    heading = np.degrees(np.arctan2(-along[0], along[1]))
    heading = np.where(np.abs(tilt) > STEEPEST_DEG, np.nan, heading)
    positions = dict(zip(("x_m", "y_m", "z_m"), poses.position_m.T, strict=True))
    return {**positions, "tilt_deg": tilt, "heading_deg": heading, "qw": w, "qx": x, "qy": y, "qz": z}


def turn_between(first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the rotation that takes the first orientations to the second, substrate frame, degrees, shape (n, 3).

    Parameters
    ----------
    first, second
        Unit quaternions w, x, y, z, shape (n, 4).
    """
    w1, u1 = first[:, :1], -first[:, 1:]
    w2, u2 = second[:, :1], second[:, 1:]
    w = w2 * w1 - np.sum(u2 * u1, axis=1, keepdims=True)
    u = w2 * u1 + w1 * u2 + np.cross(u2, u1)
    sine = np.linalg.norm(u, axis=1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, np.abs(w))
    return np.asarray(np.degrees(np.sign(np.where(w == 0.0, 1.0, w)) * angle * u / np.maximum(sine, 1e-300)))


def mean_speed(scene: Scene, duration_s: float) -> float:
    """Return the displacement along +y over a trial's time, m/s."""
    y = scene.poses.position_m[:, 1]
    return float((y[-1] - y[0]) / duration_s)


def climbed_share(scene: Scene, way_m: float) -> float:
    """Return how far the robot got along +y, as a share of the way without slip."""
    y = scene.poses.position_m[:, 1]
    return float(y[-1] - y[0]) / way_m


def climbs(scene: Scene, way_m: float) -> bool:
    """Return whether a lab notes that the robot climbs, by the rule of its format."""
    return climbed_share(scene, way_m) >= CLIMBED


def rest_tilt(scene: Scene) -> float:
    """Return the mean tilt of the last third of a trial, degrees."""
    tilt: Sequence[float] = channels_of(scene.poses)["tilt_deg"].tolist()
    return float(np.mean(tilt[int((1.0 - REST_SHARE) * len(tilt)) :]))
