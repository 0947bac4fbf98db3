"""`ElectrostaticForce`: F_elect differs."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

from ..errors import InputError, show
from .base import Effect
from .parameter import Parameter

if TYPE_CHECKING:
    from ..scenario import Scenario

__all__ = ["ElectrostaticForce"]


@dataclass(frozen=True, kw_only=True, slots=True)
class ElectrostaticForce(Effect):
    """The attraction towards the substrate is larger or smaller.

    F_elect' = F_elect + added_force

    It acts at the mass centre, whatever the pose, as in the paper. Not modelled: charge that decays, or an attraction
    that depends on the gap or the pose.

    Source: Xie, Bi, Cappelleri, Chakraborty: F_elect of paper, in the text and in the released code, differs fivefold.

    Attributes
    ----------
    added_force_N
        N: 0 is neutral; plausible is from -F_elect to twice F_elect or twice the weight, whichever is more. A total
        below zero is refused.
    """

    name: ClassVar[str] = "electrostatic_force"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            key="added_force_N", neutral=0.0, low=-1e-06, high=1e-06, unit="N", meaning="force added to the attraction"
        ),
    )
    added_force_N: float = 0.0

    @classmethod
    def ranges(cls, scenario: Scenario) -> tuple[tuple[float, float], ...]:
        """Return from no attraction to twice the nominal one or the weight.

        Parameters
        ----------
        scenario
            The nominal scenario.
        """
        nominal = scenario.substrate.electrostatic_force_N
        weight = scenario.robot.total_mass_kg * scenario.run.gravity_m_per_s2
        return ((-nominal, 2.0 * max(nominal, weight)),)

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with its attraction changed.

        Parameters
        ----------
        scenario
            What the effect adds to.
        """
        substrate = scenario.substrate
        total = substrate.electrostatic_force_N + self.added_force_N
        if total < 0.0:
            expected = f"at least {-substrate.electrostatic_force_N:g} N, which leaves no attraction"
            raise InputError(f"{self.name}.added_force_N", show(self.added_force_N), expected)
        return replace(scenario, substrate=replace(substrate, electrostatic_force_N=total))
