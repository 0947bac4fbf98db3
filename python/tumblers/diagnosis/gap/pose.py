"""Poses between the rows of a rollout, and what a camera reads from them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ... import _core

__all__ = ["Path", "body_axis", "heading_of", "nearer_turn", "relative_turn", "tilt_of"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Path:
    """The seen poses of one run at even times.

    Attributes
    ----------
    interval_s
        Time between rows, s.
    poses
        The tracked point, substrate frame as the camera sees it, m, and the unit quaternion w, x, y, z, body to
        substrate, of one sign along the path, side by side so that a time is looked up once, shape (n, 7).
    contact_mode
        0 airborne, 1 point, 2 line, 3 surface, shape (n,).
    clock_s
        The field's time when the camera's clock says 0, s.
    """

    interval_s: float
    poses: Floats
    contact_mode: NDArray[np.int8]
    clock_s: float = 0.0

    @property
    def position_m(self) -> Floats:
        """The tracked point, m, shape (n, 3)."""
        return self.poses[:, :3]

    @property
    def orientation(self) -> Floats:
        """The unit quaternions, shape (n, 4)."""
        return self.poses[:, 3:]

    def at(self, time_s: Floats) -> tuple[Floats, Floats]:
        """Return positions (k, 3) and unit quaternions (k, 4) at times (k,), the ends held.

        Parameters
        ----------
        time_s
            Times of the field, s.
        """
        place = np.clip(time_s / self.interval_s, 0.0, len(self.poses) - 1.0 - _core.END_ROWS)
        row = place.astype(np.intp)
        share = (place - row)[:, None]
        between = self.poses[row] * (1.0 - share) + self.poses[row + 1] * share
        position, turned = between[:, :3], between[:, 3:]
        return position, turned / np.sqrt(np.einsum("ij,ij->i", turned, turned))[:, None]

    def mode_at(self, time_s: Floats) -> NDArray[np.int8]:
        """Return the contact mode at times of the field (k,), s."""
        row = np.clip(np.rint(time_s / self.interval_s), 0, len(self.contact_mode) - 1).astype(np.intp)
        return self.contact_mode[row]


def body_axis(orientation: Floats) -> Floats:
    """Return the body's +y axis in the substrate frame, shape (n, 3), of quaternions (n, 4)."""
    w, x, y, z = orientation.T
    return np.stack([2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)], axis=1)


def tilt_of(axis: Floats) -> Floats:
    """Return the angle of the long axis above the substrate, rad, shape (n,), of axes (n, 3)."""
    return np.arcsin(np.clip(axis[:, 2], -1.0, 1.0))


def heading_of(axis: Floats) -> Floats:
    """Return the angle of the long axis's projection from +y towards -x, rad, shape (n,), of axes (n, 3)."""
    return np.arctan2(-axis[:, 0], axis[:, 1])


def relative_turn(model: Floats, measured: Floats) -> Floats:
    """Return the rotation from model to measurement as a vector in the body frame, rad, shape (n, 3).

    Parameters
    ----------
    model, measured
        Unit quaternions w, x, y, z, shape (n, 4).
    """
    w1, x1, y1, z1 = model.T
    w2, x2, y2, z2 = measured.T
    w = w1 * w2 + x1 * x2 + y1 * y2 + z1 * z2
    v = np.stack(
        [
            w1 * x2 - x1 * w2 - y1 * z2 + z1 * y2,
            w1 * y2 - y1 * w2 - z1 * x2 + x1 * z2,
            w1 * z2 - z1 * w2 - x1 * y2 + y1 * x2,
        ],
        axis=1,
    )
    v = np.where((w < 0.0)[:, None], -v, v)
    sine = np.linalg.norm(v, axis=1)
    angle = 2.0 * np.arctan2(sine, np.abs(w))
    scale = np.where(sine > 1e-12, angle / np.maximum(sine, 1e-12), 2.0)
    return np.asarray(v * scale[:, None], dtype=np.float64)


def nearer_turn(turn: Floats, other: Floats) -> Floats:
    """Return rotation vectors, or those of the same rotations the other way round where these are nearer to others.

    Parameters
    ----------
    turn, other
        Rotation vectors, rad, shape (n, 3).
    """
    angle = np.linalg.norm(turn, axis=1, keepdims=True)
    around = turn * (1.0 - 2.0 * np.pi / np.maximum(angle, 1e-12))
    nearer = np.linalg.norm(around - other, axis=1) < np.linalg.norm(turn - other, axis=1)
    return np.asarray(np.where(nearer[:, None], around, turn), dtype=np.float64)
