"""`ViscousDrag`: a fluid drags on translation and rotation."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cbrt, pi, prod
from typing import TYPE_CHECKING, ClassVar

from .base import Effect
from .extents import extents_m
from .parameter import Parameter

if TYPE_CHECKING:
    from ..scenario import Scenario

__all__ = ["ViscousDrag"]


@dataclass(frozen=True, kw_only=True, slots=True)
class ViscousDrag(Effect):
    """A fluid drags on translation and rotation, as on a sphere in creeping flow far from any wall.

    F = -6π η a v, T = -8π η a³ ω, a = (L W H)^(1/3) / 2

    η is the viscosity, and a half of the geometric mean of the body's three extents. Both add to the nominal drags. Not
    modelled: the body's form, the nearness of the substrate (which raises both), buoyancy, and inertia of the fluid.

    Source: Stokes 1851, Trans. Camb. Phil. Soc. 9, 8; Lamb, Hydrodynamics, §334 and §337.

    Attributes
    ----------
    viscosity_Pa_s
        η, Pa s: 0 is neutral, 0 to 0.1 plausible (air 1.8e-5, water 1e-3, silicone oil from 5e-3).
    """

    name: ClassVar[str] = "viscous_drag"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            key="viscosity_Pa_s",
            neutral=0.0,
            low=0.0,
            high=0.1,
            unit="Pa s",
            meaning="viscosity of the fluid around the robot",
            least=0.0,
            fine=2e-4,
        ),
    )
    viscosity_Pa_s: float = 0.0

    @classmethod
    def starts(cls, scenario: Scenario) -> tuple[tuple[float, ...], ...]:  # noqa: ARG003
        """Return the viscosity of water, and ten times less and more.

        Parameters
        ----------
        scenario
            The nominal scenario.
        """
        return ((1e-4,), (1e-3,), (1e-2,))

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with a fluid around its robot.

        Parameters
        ----------
        scenario
            What the effect adds to.
        """
        surroundings = scenario.surroundings
        radius = 0.5 * cbrt(prod(extents_m(scenario.robot)))
        linear = surroundings.translational_drag_N_s_per_m + 6.0 * pi * self.viscosity_Pa_s * radius
        angular = surroundings.rotational_drag_N_m_s + 8.0 * pi * self.viscosity_Pa_s * radius**3
        return replace(
            scenario,
            surroundings=replace(surroundings, translational_drag_N_s_per_m=linear, rotational_drag_N_m_s=angular),
        )
