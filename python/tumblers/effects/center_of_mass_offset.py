"""`CenterOfMassOffset`: the mass is not at the centre."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

from ..check import Vector
from .base import Effect
from .extents import extents_m
from .parameter import Parameter

if TYPE_CHECKING:
    from ..scenario import Scenario

__all__ = ["CenterOfMassOffset"]


@dataclass(frozen=True, kw_only=True, slots=True)
class CenterOfMassOffset(Effect):
    """The mass centre is off the body's geometric centre, body frame.

    c' = c + offset

    The inertia about the mass centre is taken unchanged, and the moment stays that of the whole body. Not modelled:
    what puts the mass there (a bubble, settled powder), which would change the inertia and the moment too.

    An offset along the axis about which the body turns (x, for one that tumbles forward) is not seen in its motion.

    Source: arithmetic; magnetic powder settles before the polymer is cured.

    Attributes
    ----------
    offset_m
        Along x, y, z of the body, m: 0 is neutral, a fifth of the half extents plausible.
    """

    name: ClassVar[str] = "center_of_mass_offset"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            key="offset_m[0]", neutral=0.0, low=-8e-05, high=8e-05, unit="m", meaning="offset along x of the body"
        ),
        Parameter(
            key="offset_m[1]", neutral=0.0, low=-8e-05, high=8e-05, unit="m", meaning="offset along y of the body"
        ),
        Parameter(
            key="offset_m[2]", neutral=0.0, low=-8e-05, high=8e-05, unit="m", meaning="offset along z of the body"
        ),
    )
    offset_m: Vector = (0.0, 0.0, 0.0)

    @classmethod
    def ranges(cls, scenario: Scenario) -> tuple[tuple[float, float], ...]:
        """Return a fifth of the half extents to either side.

        Parameters
        ----------
        scenario
            The nominal scenario.
        """
        return tuple((-0.1 * extent, 0.1 * extent) for extent in extents_m(scenario.robot))

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with its robot's mass centre moved.

        Parameters
        ----------
        scenario
            What the effect adds to.
        """
        x, y, z = scenario.robot.center_of_mass_m
        dx, dy, dz = self.offset_m
        robot = replace(scenario.robot, center_of_mass_m=(x + dx, y + dy, z + dz))
        return replace(scenario, robot=robot)
