"""`StrayFieldGradient`: a gradient of the field pulls the robot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import hypot
from typing import TYPE_CHECKING, ClassVar

from ..check import Vector
from ..field import RotatingField
from .base import Effect
from .parameter import Parameter

if TYPE_CHECKING:
    from ..scenario import Scenario

__all__ = ["StrayFieldGradient"]

_REFERENCE_HZ = 10.0
# Coordinates of a fit up to this one mean an exponent of zero: where no field rotates 0⁰ is 1, and 0 to any power above
# it is 0, so that a fit whose steps left zero would lose the pull there. It is twice the longest step of a derivative.
_EVEN = 0.3


@dataclass(frozen=True, kw_only=True, slots=True)
class StrayFieldGradient(Effect):
    """A gradient of the field pulls the robot, possibly more at a high frequency.

    F' = F + V_m |E| G (f / 10 Hz)^n

    The force is constant over a run, substrate frame, at the mass centre: what is left of (M · ∇)B, averaged over the
    turning moment. f is the frequency of a rotating field, and 0 in a static or tabulated one, where 0⁰ = 1. Not
    modelled: the force's swing within a cycle, a gradient that varies over the workspace, and that of Maxwell's
    equations between its components.

    Source: Xie, Bi, Cappelleri, Chakraborty: faster than the model at 15 Hz, stray gradients suspected; F = ∇(M · B).

    Attributes
    ----------
    gradient_T_per_m
        G along x, y, z, T/m: 0 is neutral, -0.15 to 0.15 plausible (coils off their centre by a few millimetres).
    frequency_exponent
        n, no unit: 0 to 3 plausible, without effect where G is 0.
    """

    name: ClassVar[str] = "stray_field_gradient"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            key="gradient_T_per_m[0]", neutral=0.0, low=-0.15, high=0.15, unit="T/m", meaning="pull along x per moment"
        ),
        Parameter(
            key="gradient_T_per_m[1]", neutral=0.0, low=-0.15, high=0.15, unit="T/m", meaning="pull along y per moment"
        ),
        Parameter(
            key="gradient_T_per_m[2]", neutral=0.0, low=-0.15, high=0.15, unit="T/m", meaning="pull along z per moment"
        ),
        Parameter(
            key="frequency_exponent",
            neutral=0.0,
            low=0.0,
            high=3.0,
            unit="1",
            meaning="power of the frequency that the pull grows with",
            least=0.0,
        ),
    )
    gradient_T_per_m: Vector = (0.0, 0.0, 0.0)
    frequency_exponent: float = 0.0

    def is_neutral(self) -> bool:
        """Whether there is no gradient, whatever the exponent is."""
        return not any(self.gradient_T_per_m)

    @classmethod
    def starts(cls, scenario: Scenario) -> tuple[tuple[float, ...], ...]:  # noqa: ARG003
        """Return pulls of a third of the range each way, and two along y that grow with the frequency.

        Parameters
        ----------
        scenario
            The nominal scenario.
        """
        return (
            (-0.05, 0.0, 0.0, 0.0),
            (0.05, 0.0, 0.0, 0.0),
            (0.0, -0.05, 0.0, 0.0),
            (0.0, 0.05, 0.0, 0.0),
            (0.0, 0.0, -0.05, 0.0),
            (0.0, 0.0, 0.05, 0.0),
            (0.0, -0.05, 0.0, 2.0),
            (0.0, 0.05, 0.0, 2.0),
        )

    @classmethod
    def to_fit(cls, values: Sequence[float]) -> tuple[float, ...]:
        """Return the gradient, and the exponent beyond the coordinates that mean zero.

        Parameters
        ----------
        values
            Of the parameters, in their order.
        """
        *gradient, exponent = values
        most = cls.parameters[-1].high
        return (*gradient, _EVEN + exponent * (1.0 - _EVEN / most) if exponent > 0.0 else 0.0)

    @classmethod
    def from_fit(cls, coordinates: Sequence[float]) -> tuple[float, ...]:
        """Return the gradient and the exponent at a fit's coordinates.

        Parameters
        ----------
        coordinates
            As many as there are parameters.
        """
        *gradient, beyond = coordinates
        most = cls.parameters[-1].high
        return (*gradient, max(beyond - _EVEN, 0.0) / (1.0 - _EVEN / most))

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with the pull added to the force on the robot.

        Parameters
        ----------
        scenario
            What the effect adds to.
        """
        frequency = scenario.field.frequency_Hz if isinstance(scenario.field, RotatingField) else 0.0
        moment = hypot(*scenario.robot.magnetic_moment_A_m2)
        pull = moment * (frequency / _REFERENCE_HZ) ** self.frequency_exponent
        x, y, z = scenario.surroundings.force_N
        gx, gy, gz = self.gradient_T_per_m
        force = (x + pull * gx, y + pull * gy, z + pull * gz)
        return replace(scenario, surroundings=replace(scenario.surroundings, force_N=force))
