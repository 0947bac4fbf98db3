"""`SizeError`: the body is longer or higher."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import atan, cos, degrees, radians, sin, tan
from typing import TYPE_CHECKING, ClassVar

from ..shape import Cuboid, Curved, Ellipsoid, Hull, Shape, Spiked, SpikedEnds
from .base import Effect
from .parameter import Parameter

if TYPE_CHECKING:
    from ..scenario import Scenario

__all__ = ["SizeError"]


@dataclass(frozen=True, kw_only=True, slots=True)
class SizeError(Effect):
    """The body's extents along y and z are factors of the nominal ones; its width is not.

    y' = length_factor y, z' = height_factor z for every point of the body

    so for a cuboid, the spiked shapes, a hull and an ellipsoid. The curved shape stays a sector of a ring: the chord of
    its outer arc follows the first factor, the sagitta of that arc and the height of its ends the second, and so do its
    length and its height exactly, its inner arc nearly. With R, r and α its radii and half angle,
    tan(α'/2) = (height_factor / length_factor) tan(α/2), R' sin α' = length_factor R sin α,
    (R' - r') cos α' = height_factor (R - r) cos α. A mass and a magnetic volume that are given stay; where they follow
    from the shape they follow it. Not modelled: rounded edges, a width error.

    Source: arithmetic; Xie, Bi, Cappelleri, Chakraborty: the speed follows 2(L + H)f.

    Attributes
    ----------
    length_factor, height_factor
        No unit: 1 is neutral, 0.85 to 1.15 plausible (shrinkage of the polymer, resolution of the mould).
    """

    name: ClassVar[str] = "size_error"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            key="length_factor",
            neutral=1.0,
            low=0.85,
            high=1.15,
            unit="1",
            meaning="length over the nominal one",
            above=0.0,
        ),
        Parameter(
            key="height_factor",
            neutral=1.0,
            low=0.85,
            high=1.15,
            unit="1",
            meaning="height over the nominal one",
            above=0.0,
        ),
    )
    length_factor: float = 1.0
    height_factor: float = 1.0

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with its robot's shape stretched.

        Parameters
        ----------
        scenario
            What the effect adds to.
        """
        shape = _stretched(scenario.robot.shape, self.length_factor, self.height_factor)
        return replace(scenario, robot=replace(scenario.robot, shape=shape))


def _stretched(shape: Shape, y: float, z: float) -> Shape:
    match shape:
        case Cuboid():
            return replace(shape, length_m=shape.length_m * y, height_m=shape.height_m * z)
        case Spiked():
            return replace(
                shape,
                length_m=shape.length_m * y,
                height_m=shape.height_m * z,
                spike_base_m=shape.spike_base_m * y,
                overall_height_m=shape.overall_height_m * z,
            )
        case SpikedEnds():
            return replace(
                shape,
                length_m=shape.length_m * y,
                height_m=shape.height_m * z,
                spike_base_m=shape.spike_base_m * y,
                spike_height_m=shape.spike_height_m * z,
            )
        case Curved():
            return _stretched_sector(shape, y, z)
        case Hull():
            return replace(shape, vertices_m=tuple((vx, vy * y, vz * z) for vx, vy, vz in shape.vertices_m))
        case Ellipsoid():
            sx, sy, sz = shape.semi_axes_m
            return replace(shape, semi_axes_m=(sx, sy * y, sz * z))


def _stretched_sector(shape: Curved, y: float, z: float) -> Curved:
    angle = radians(shape.half_angle_deg)
    stretched = 2.0 * atan(z / y * tan(0.5 * angle))
    outer = y * shape.outer_radius_m * sin(angle) / sin(stretched)
    thickness = z * (shape.outer_radius_m - shape.inner_radius_m) * cos(angle) / cos(stretched)
    return replace(shape, outer_radius_m=outer, inner_radius_m=outer - thickness, half_angle_deg=degrees(stretched))
