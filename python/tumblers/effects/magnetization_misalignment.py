"""`MagnetizationMisalignment`: the magnetic axis is off."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import atan2, cos, degrees, hypot, radians, sin
from typing import TYPE_CHECKING, ClassVar

from .base import Effect
from .parameter import Parameter

if TYPE_CHECKING:
    from ..scenario import Scenario

__all__ = ["MagnetizationMisalignment"]


@dataclass(frozen=True, kw_only=True, slots=True)
class MagnetizationMisalignment(Effect):
    """The magnetic axis is turned by θ1 in the direction θ2.

    u' = R u, R the shortest rotation that takes +y to (sin θ2 sin θ1, cos θ1, cos θ2 sin θ1)

    u is the nominal axis in the body frame; where it is +y, u' is the paper's own axis with errors. Not modelled: an
    axis that differs within the body, or one that the field turns.

    Source: Xie, Bi, Cappelleri, Chakraborty: magnetization errors in manufacturing.

    Attributes
    ----------
    theta1_deg
        θ1, degrees: 0 is neutral, 0 to 30 plausible (the paper's first robots had 27).
    theta2_deg
        θ2, degrees: from +z towards +x of the body; any value, without effect where θ1 is 0.
    """

    name: ClassVar[str] = "magnetization_misalignment"
    # An error has no preferred direction: neither of its components is neutral by itself.
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            key="theta1_deg",
            neutral=0.0,
            low=0.0,
            high=30.0,
            unit="degrees",
            meaning="angle between the axis and the nominal one",
            always=True,
        ),
        Parameter(
            key="theta2_deg",
            neutral=0.0,
            low=-180.0,
            high=180.0,
            unit="degrees",
            meaning="direction of the error about the long axis",
            turns=True,
            always=True,
        ),
    )
    theta1_deg: float = 0.0
    theta2_deg: float = 0.0

    def is_neutral(self) -> bool:
        """Whether θ1 is zero, whatever θ2 is."""
        return self.theta1_deg == 0.0

    @classmethod
    def starts(cls, scenario: Scenario) -> tuple[tuple[float, ...], ...]:  # noqa: ARG003
        """Return errors of 8° to each side, and of 2° and 15° up and to a side.

        Parameters
        ----------
        scenario
            The nominal scenario.
        """
        eights = ((8.0, 0.0), (8.0, 90.0), (8.0, 180.0), (8.0, -90.0))
        return ((2.0, 0.0), (2.0, 90.0), *eights, (15.0, 0.0), (15.0, 90.0))

    @classmethod
    def to_fit(cls, values: Sequence[float]) -> tuple[float, ...]:
        """Return θ1 (cos θ2, sin θ2), degrees: what is smooth around neutral and has no end at ±180°.

        Parameters
        ----------
        values
            θ1 and θ2, degrees.
        """
        theta1, theta2 = values[0], radians(values[1])
        return theta1 * cos(theta2), theta1 * sin(theta2)

    @classmethod
    def from_fit(cls, coordinates: Sequence[float]) -> tuple[float, ...]:
        """Return θ1 and θ2, degrees.

        Parameters
        ----------
        coordinates
            θ1 (cos θ2, sin θ2), degrees.
        """
        up, side = coordinates
        return hypot(up, side), degrees(atan2(side, up))

    @classmethod
    def fit_ranges(cls, scenario: Scenario) -> tuple[tuple[float, float], ...]:
        """Return the range of either coordinate: θ1's, both ways.

        Parameters
        ----------
        scenario
            The nominal scenario.
        """
        _, most = cls.ranges(scenario)[0]
        return ((-most, most), (-most, most))

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with its robot's magnetic axis turned.

        Parameters
        ----------
        scenario
            What the effect adds to.
        """
        theta1, theta2 = radians(self.theta1_deg), radians(self.theta2_deg)
        c, s = cos(theta1), sin(theta1)
        # Rodrigues' formula about k = (cos θ2, 0, -sin θ2), which is at right angles to +y and to where it goes.
        kx, kz = cos(theta2), -sin(theta2)
        x, y, z = scenario.robot.magnetic_axis
        along = (kx * x + kz * z) * (1.0 - c)
        axis = (c * x - s * kz * y + kx * along, c * y + s * (kz * x - kx * z), c * z + s * kx * y + kz * along)
        robot = replace(scenario.robot, magnetization_axis=axis, theta1_deg=None, theta2_deg=None)
        return replace(scenario, robot=robot)
