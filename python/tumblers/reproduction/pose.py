"""`Pose`: how a robot is set down at the start."""

from __future__ import annotations

from math import sqrt
from typing import Literal

from ..initial import Initial

__all__ = ["Pose", "initial"]

Pose = Literal["lying", "stated", "upside_down", "on_side", "on_end"]

# The text's q_z (in the substrate's frame on an incline too, where it states q_z / cos φ along the vertical); half of
# it for the half-size robots.
_STATED_M = {
    "cuboid": 100e-6,
    "cuboid_second_generation": 100e-6,
    "spiked_su8": 325e-6,
    "spiked_ends_su8": 275e-6,
    "curved_su8": 220e-6,
    "spiked_pdms": 162.5e-6,
    "spiked_ends_pdms": 137.5e-6,
}
_HALF = sqrt(0.5)
_TURNED: dict[Pose, tuple[float, float, float, float]] = {
    "upside_down": (0.0, 0.0, 1.0, 0.0),
    "on_side": (_HALF, 0.0, _HALF, 0.0),
    "on_end": (_HALF, _HALF, 0.0, 0.0),
}


def initial(pose: Pose, robot: str) -> Initial:
    """Return the state in which a robot is set down, at rest.

    Parameters
    ----------
    pose
        ``lying`` at rest on the substrate; ``stated``, its centre as high as the text says, from where it falls;
        ``upside_down`` and ``on_side``, turned by 180° and by 90° about the long axis; ``on_end``, the long axis up.
    robot
        Key of `tumblers.ROBOTS`.
    """
    if pose == "stated":
        return Initial(position_m=(0.0, 0.0, _STATED_M[robot]), orientation=(1.0, 0.0, 0.0, 0.0))
    return Initial(orientation=_TURNED.get(pose))
