"""`ContactCompliance`: the body or the substrate yields."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

from .base import Effect
from .parameter import Parameter

if TYPE_CHECKING:
    from ..scenario import Scenario

__all__ = ["ContactCompliance"]


@dataclass(frozen=True, kw_only=True, slots=True)
class ContactCompliance(Effect):
    """The body or the substrate yields under the normal force.

    0 ≤ N ⊥ gap + c' N ≥ 0, c' = c + compliance

    One spring without damping for the whole contact. Not modelled: a stiffness that grows with the area that touches,
    losses in the material, and a patch that grows with the load (see `line_contact_adhesion`).

    Source: Hooke.

    Attributes
    ----------
    compliance_m_per_N
        m/N: 0 is neutral, 0 to 30 plausible (30 lets a load of 1 µN sink by 30 µm, as a loose sheet of paper does).
    """

    name: ClassVar[str] = "contact_compliance"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            key="compliance_m_per_N",
            neutral=0.0,
            low=0.0,
            high=30.0,
            unit="m/N",
            meaning="yield per normal force",
            least=0.0,
            fine=0.02,
        ),
    )
    # A body of 40 µg on 1 m/N bounces within a millisecond.
    longest_step_s: ClassVar[float] = 1.25e-4
    compliance_m_per_N: float = 0.0

    @classmethod
    def starts(cls, scenario: Scenario) -> tuple[tuple[float, ...], ...]:  # noqa: ARG003
        """Return compliances that are apart by factors of ten.

        Parameters
        ----------
        scenario
            The nominal scenario.
        """
        return ((0.03,), (0.3,), (3.0,))

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with its substrate made softer.

        Parameters
        ----------
        scenario
            What the effect adds to.
        """
        substrate = scenario.substrate
        compliance = substrate.compliance_m_per_N + self.compliance_m_per_N
        return replace(scenario, substrate=replace(substrate, compliance_m_per_N=compliance))
