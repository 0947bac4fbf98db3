"""`FrictionCoefficient`: μ differs."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

from .base import Effect
from .parameter import Parameter

if TYPE_CHECKING:
    from ..scenario import Scenario

__all__ = ["FrictionCoefficient"]


@dataclass(frozen=True, kw_only=True, slots=True)
class FrictionCoefficient(Effect):
    """The coefficient of friction is a factor of the nominal one.

    μ' = factor μ

    Not modelled: friction that differs between rest and sliding, with the speed, with time or with the place.

    Source: Coulomb; Xie, Bi, Cappelleri, Chakraborty: μ from tilting the substrate until the robot slides.

    Attributes
    ----------
    factor
        No unit: 1 is neutral, 0.3 to 2.5 plausible (dry friction at this scale scatters by a factor of two).
    """

    name: ClassVar[str] = "friction_coefficient"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            key="factor",
            neutral=1.0,
            low=0.3,
            high=2.5,
            unit="1",
            meaning="coefficient over the nominal one",
            least=0.0,
        ),
    )
    factor: float = 1.0

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with its coefficient of friction multiplied.

        Parameters
        ----------
        scenario
            What the effect adds to.
        """
        substrate = scenario.substrate
        return replace(
            scenario,
            substrate=replace(substrate, friction_coefficient=substrate.friction_coefficient * self.factor),
        )
