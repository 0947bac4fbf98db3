"""`Scaled`: a case in the millimetres, milligrams and seconds that both peers run in."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import units
from .case import Case

__all__ = ["Scaled"]


@dataclass(frozen=True)
class Scaled:
    """What a run starts with.

    Attributes
    ----------
    position, velocity
        Of the centre of mass, mm and mm/s.
    moment
        In the body, so that the torque in a field in T is in mg mm²/s².
    attraction
        F_elect along z, mg mm/s².
    """

    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    moment: NDArray[np.float64]
    attraction: float

    @classmethod
    def of(cls, case: Case) -> Scaled:
        """Return the start of a case."""
        scenario = case.scenario
        return cls(
            case.start_m * units.LENGTH,
            np.array(scenario.initial.linear_velocity_m_per_s) * units.LENGTH,
            np.array(scenario.robot.magnetic_moment_A_m2) * units.TORQUE,
            -scenario.substrate.electrostatic_force_N * units.FORCE,
        )
