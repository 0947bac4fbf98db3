"""`FrictionAnisotropy`: friction differs along x and along y."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

from .base import Effect
from .parameter import Parameter

if TYPE_CHECKING:
    from ..scenario import Scenario

__all__ = ["FrictionAnisotropy"]


@dataclass(frozen=True, kw_only=True, slots=True)
class FrictionAnisotropy(Effect):
    """The axes of the friction ellipsoid along x and along y are factors of the nominal ones.

    (e_t, e_o)' = (e_t_factor e_t, e_o_factor e_o), in (p_t/e_t)² + (p_o/e_o)² + (p_r/e_r)² ≤ μ² p_n²

    The axes are those of the substrate (a grain, scratches), x and y. Not modelled: axes at another angle, or axes that
    turn with the robot. Where nothing spins, both factors together are the same as a factor of μ.

    Source: Goyal, Ruina, Papadopoulos 1991, Wear 143, 307; the friction ellipsoid of the paper.

    Attributes
    ----------
    e_t_factor, e_o_factor
        No unit: 1 is neutral, 0.4 to 2.5 plausible.
    """

    name: ClassVar[str] = "friction_anisotropy"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            key="e_t_factor",
            neutral=1.0,
            low=0.4,
            high=2.5,
            unit="1",
            meaning="friction along x over the nominal one",
            above=0.0,
        ),
        Parameter(
            key="e_o_factor",
            neutral=1.0,
            low=0.4,
            high=2.5,
            unit="1",
            meaning="friction along y over the nominal one",
            above=0.0,
        ),
    )
    e_t_factor: float = 1.0
    e_o_factor: float = 1.0

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with its friction ellipsoid stretched.

        Parameters
        ----------
        scenario
            What the effect adds to.
        """
        e_t, e_o, e_r = scenario.substrate.friction_ellipsoid
        ellipsoid = (e_t * self.e_t_factor, e_o * self.e_o_factor, e_r)
        return replace(scenario, substrate=replace(scenario.substrate, friction_ellipsoid=ellipsoid))
