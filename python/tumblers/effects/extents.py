"""Extents of a robot's body."""

from __future__ import annotations

import numpy as np

from ..check import Vector
from ..robot import Robot

__all__ = ["extents_m"]


def extents_m(robot: Robot) -> Vector:
    """Return the extents of the body along its x, y and z, m.

    Parameters
    ----------
    robot
        The robot.

    Raises
    ------
    InputError
        A shape that is refused.
    """
    x, y, z = np.ptp(np.concatenate(robot.body().outline), axis=0)
    return float(x), float(y), float(z)
