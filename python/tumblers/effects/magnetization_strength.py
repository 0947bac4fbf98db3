"""`MagnetizationStrength`: the moment is a factor of the nominal one."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

from .base import Effect
from .parameter import Parameter

if TYPE_CHECKING:
    from ..scenario import Scenario

__all__ = ["MagnetizationStrength"]


@dataclass(frozen=True, kw_only=True, slots=True)
class MagnetizationStrength(Effect):
    """The magnetic moment is a factor of the nominal one.

    |E|' = factor |E|

    Not modelled: a moment that grows with the field (a soft or unsaturated magnet).

    Source: Xie, Bi, Cappelleri, Chakraborty: the robots' |E| differs more than threefold between batches.

    Attributes
    ----------
    factor
        No unit: 1 is neutral, 0.4 to 1.6 plausible (the powder's share of the polymer, and how well it was magnetised).
    """

    name: ClassVar[str] = "magnetization_strength"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            key="factor", neutral=1.0, low=0.4, high=1.6, unit="1", meaning="moment over the nominal one", least=0.0
        ),
    )
    factor: float = 1.0

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with its robot's magnetization multiplied.

        Parameters
        ----------
        scenario
            What the effect adds to.
        """
        robot = scenario.robot
        return replace(scenario, robot=replace(robot, magnetization_A_per_m=robot.magnetization_A_per_m * self.factor))
