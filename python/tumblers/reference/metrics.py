"""Speed, drift and twist of a run (docs/model.md, "Metrics").

Equations: speed is the displacement along y over the run's time; after one cycle `1/f` of the field drift is the
displacement along x and twist is `2 atan2(Q_y, Q_w)`, wrapped to (-180°, 180°], the turn about the body's long axis in
the swing-twist decomposition of `Q`.
"""

from __future__ import annotations

import math

import numpy as np

from .array import Array
from .rotation import axis_angle, matrix, product
from .trial import Run


def twist(quaternion: Array) -> float:
    """Twist [rad] in (-π, π] of `w, x, y, z`."""
    angle = 2.0 * math.atan2(float(quaternion[2]), float(quaternion[0]))
    return angle - 2.0 * math.pi * math.ceil((angle - math.pi) / (2.0 * math.pi))


def speed(run: Run) -> float:
    """Mean speed along y [m/s]."""
    return float((run.positions[-1, 1] - run.positions[0, 1]) / (run.times[-1] - run.times[0]))


def pose_at(run: Run, time: float) -> tuple[Array, Array]:
    """Position (3,) [m] and quaternion (4,) at `time` [s], between the two steps that enclose it.

    Linear in the position and along the geodesic in the orientation.
    """
    i = min(max(int(np.searchsorted(run.times, time, side="right")) - 1, 0), len(run.times) - 2)
    part = (time - float(run.times[i])) / float(run.times[i + 1] - run.times[i])
    q0, q1 = run.quaternions[i], run.quaternions[i + 1]
    if float(q0 @ q1) < 0.0:
        q1 = -q1
    turn = product(q1, q0 * np.array([1.0, -1.0, -1.0, -1.0]))
    sine = float(np.linalg.norm(turn[1:]))
    position = run.positions[i] + part * (run.positions[i + 1] - run.positions[i])
    if sine == 0.0:
        return position, q0
    angle = 2.0 * math.atan2(sine, float(turn[0]))
    return position, product(axis_angle(turn[1:], part * angle), q0)


def drift(run: Run, frequency: float) -> float:
    """Displacement along x [m] after one cycle of the field of `frequency` [Hz]."""
    return float(pose_at(run, 1.0 / frequency)[0][0] - run.positions[0, 0])


def cycle_twist(run: Run, frequency: float) -> float:
    """Twist [rad] after one cycle of the field of `frequency` [Hz]."""
    return twist(pose_at(run, 1.0 / frequency)[1])


def flipped(run: Run, frequency: float) -> bool:
    """Whether the twist after one cycle is beyond 45°."""
    return abs(cycle_twist(run, frequency)) > math.radians(45.0)


def tilt(quaternion: Array) -> float:
    """Angle [rad] by which the body's +y end points above the substrate."""
    return math.asin(max(-1.0, min(1.0, float(matrix(quaternion)[2, 1]))))
