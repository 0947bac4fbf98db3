"""`AdhesionCoefficient`: C differs."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

from .base import Effect
from .parameter import Parameter

if TYPE_CHECKING:
    from ..scenario import Scenario

__all__ = ["AdhesionCoefficient"]


@dataclass(frozen=True, kw_only=True, slots=True)
class AdhesionCoefficient(Effect):
    """The adhesion per area is a factor of the nominal one.

    C' = factor C, in F_adh = C A

    A is the area that touches. Not modelled: adhesion that grows with the time of contact or with the load.

    Source: Xie, Bi, Cappelleri, Chakraborty: C of paper and of aluminium, in the text and in the released code.

    Attributes
    ----------
    factor
        No unit: 1 is neutral, 0 to 8 plausible (the paper's own two values for paper differ by three).
    """

    name: ClassVar[str] = "adhesion_coefficient"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            key="factor",
            neutral=1.0,
            low=0.0,
            high=8.0,
            unit="1",
            meaning="adhesion over the nominal one",
            least=0.0,
            fine=0.05,
        ),
    )
    factor: float = 1.0

    @classmethod
    def ranges(cls, scenario: Scenario) -> tuple[tuple[float, float], ...]:
        """Return the plausible range, and one alone where the nominal substrate has no adhesion.

        Parameters
        ----------
        scenario
            The nominal scenario.
        """
        return ((0.0, 8.0),) if scenario.substrate.adhesion_N_per_m2 > 0.0 else ((1.0, 1.0),)

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with its adhesion multiplied.

        Parameters
        ----------
        scenario
            What the effect adds to.
        """
        substrate = scenario.substrate
        return replace(
            scenario, substrate=replace(substrate, adhesion_N_per_m2=substrate.adhesion_N_per_m2 * self.factor)
        )
