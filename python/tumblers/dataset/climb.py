"""What counts as climbing: a share of the way without slip."""

from __future__ import annotations

from ..field import Field, RotatingField
from ..robot import Robot

__all__ = ["CLIMBED", "way_without_slip_m"]

# Share of the way without slip along +y from which a robot has climbed.
CLIMBED = 0.1


def way_without_slip_m(robot: Robot, field: Field, duration_s: float) -> float:
    """Return hull perimeter × cycles, m: the way of rolling without slip on the level.

    Parameters
    ----------
    robot, field
        Of a trial. In a field that does not rotate it is one perimeter.
    duration_s
        Time of the trial, s.
    """
    way = robot.body().hull_perimeter_m
    return way * field.frequency_Hz * duration_s if isinstance(field, RotatingField) else way
