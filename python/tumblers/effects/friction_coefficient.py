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
    """The coefficient of friction is a factor of the nominal one, and may drift from the start of a trial to its end.

    μ'(t) = factor μ max(0, 1 + (k + drift) t)

    k is the nominal drift, which is 0 unless a lab says otherwise, and t counts from the start of each trial: a contact
    that runs in, wears or collects dust. Not modelled: friction that differs between rest and sliding, with the speed
    or with the place, and a drift that goes on from trial to trial.

    Source: Coulomb; Xie, Bi, Cappelleri, Chakraborty: μ from tilting the substrate until the robot slides; Blau 2005,
    Tribology International 38, 1007, on running-in. The drift is a first order of any law; its range is a choice.

    Attributes
    ----------
    factor
        No unit: 1 is neutral, 0.3 to 2.5 plausible (dry friction at this scale scatters by a factor of two).
    drift_per_s
        1/s: 0 is neutral, -1 to 1 plausible (all of it lost, or as much again, in a second).
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
        Parameter(
            key="drift_per_s",
            neutral=0.0,
            low=-1.0,
            high=1.0,
            unit="1/s",
            meaning="share by which the coefficient grows in a second",
            form=True,
        ),
    )
    factor: float = 1.0
    drift_per_s: float = 0.0

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with its coefficient of friction multiplied and drifting.

        Parameters
        ----------
        scenario
            What the effect adds to.
        """
        substrate = scenario.substrate
        coefficient, drift = substrate.friction_coefficient * self.factor, substrate.friction_drift_per_s
        if coefficient > 0.0:
            # What is not there does not drift.
            drift += self.drift_per_s
        return replace(
            scenario, substrate=replace(substrate, friction_coefficient=coefficient, friction_drift_per_s=drift)
        )
