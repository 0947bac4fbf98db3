"""`Family`: shapes of one kind that differ in a few lengths and angles."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from math import radians, sin

from ..errors import InputError
from ..robot import Robot
from ..shape import Cuboid, Curved, Shape, Spiked, SpikedEnds

__all__ = ["Family", "Parameter", "family_of"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Parameter:
    """A length or an angle that is free.

    Attributes
    ----------
    name, meaning
        Its name, which ends in its unit, and what it is.
    low, high
        Its bounds.
    """

    name: str
    meaning: str
    low: float
    high: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Family:
    """Robots of one kind of shape, one length and width, one density and one magnetization.

    Attributes
    ----------
    base
        The robot that the family is around, its magnetic volume that of its body.
    parameters
        What is free.
    start
        The base robot's own parameters.
    shape
        Makes a shape of parameters.
    """

    base: Robot
    parameters: tuple[Parameter, ...]
    start: tuple[float, ...]
    shape: Callable[[Sequence[float]], Shape]

    def robot(self, values: Sequence[float]) -> Robot:
        """Return the robot with these parameters.

        Parameters
        ----------
        values
            One of each of `parameters`, in their order.
        """
        return replace(self.base, shape=self.shape([float(value) for value in values]))

    def values(self, unit: Iterable[float]) -> tuple[float, ...]:
        """Return the parameters at a place in the unit cube between their bounds.

        Parameters
        ----------
        unit
            A number from 0 to 1 for each of `parameters`.
        """
        return tuple(p.low + (p.high - p.low) * float(u) for p, u in zip(self.parameters, unit, strict=True))


def family_of(robot: Robot) -> Family:
    """Return the family around a robot: its length, width and material are kept, mass and moment follow the volume.

    Bounds are shares of the length, so that they hold for every size: bars 0.12 to 0.4 thick, spikes 0.05 to 0.6 high
    on bases of 0.1 to 0.9 (half of that at each of two ends); curved bars 0.06 to 0.3 thick over the same chord, with a
    half angle of 5° to 60°; cuboids 0.12 to 1 high.

    Parameters
    ----------
    robot
        A cuboid, spiked, spiked_ends or curved robot; its errors are left out.

    Raises
    ------
    InputError
        A robot of another shape.
    """
    robot = replace(robot.with_draft(0.0).with_magnetization(0.0, 0.0), center_of_mass_m=(0.0, 0.0, 0.0))
    volume = robot.body().volume_m3
    magnetic = volume if robot.magnetic_volume_m3 is None else robot.magnetic_volume_m3
    base = replace(
        robot,
        mass_kg=None,
        density_kg_per_m3=robot.total_mass_kg / volume,
        magnetic_volume_m3=None,
        magnetization_A_per_m=robot.magnetization_A_per_m * magnetic / volume,
    )
    parameters, start, shape = _free(base.shape)
    return Family(base=base, parameters=parameters, start=start, shape=shape)


def _free(shape: Shape) -> tuple[tuple[Parameter, ...], tuple[float, ...], Callable[[Sequence[float]], Shape]]:
    def share(name: str, meaning: str, low: float, high: float, length: float) -> Parameter:
        return Parameter(name=name, meaning=meaning, low=low * length, high=high * length)

    if isinstance(shape, Cuboid):
        cuboid = shape
        return (
            (share("height_m", "height", 0.12, 1.0, shape.length_m),),
            (shape.height_m,),
            lambda v: replace(cuboid, height_m=v[0]),
        )
    if isinstance(shape, Spiked):
        spiked = shape
        return (
            (
                share("height_m", "thickness of the bar", 0.12, 0.4, shape.length_m),
                share("spike_base_m", "base of a spike", 0.1, 0.9, shape.length_m),
                share("spike_height_m", "height of a spike above the bar", 0.05, 0.6, shape.length_m),
            ),
            (shape.height_m, shape.spike_base_m, 0.5 * (shape.overall_height_m - shape.height_m)),
            lambda v: replace(spiked, height_m=v[0], spike_base_m=v[1], overall_height_m=v[0] + 2.0 * v[2]),
        )
    if isinstance(shape, SpikedEnds):
        ends = shape
        return (
            (
                share("height_m", "thickness of the bar", 0.12, 0.4, shape.length_m),
                share("spike_base_m", "base of a spike", 0.05, 0.45, shape.length_m),
                share("spike_height_m", "height of a spike above the bar", 0.05, 0.6, shape.length_m),
            ),
            (shape.height_m, shape.spike_base_m, shape.spike_height_m),
            lambda v: replace(ends, height_m=v[0], spike_base_m=v[1], spike_height_m=v[2]),
        )
    if isinstance(shape, Curved):
        curved, chord = shape, 2.0 * shape.outer_radius_m * sin(radians(shape.half_angle_deg))

        def bent(v: Sequence[float]) -> Curved:
            outer = chord / (2.0 * sin(radians(v[1])))
            return replace(curved, outer_radius_m=outer, inner_radius_m=outer - v[0], half_angle_deg=v[1])

        return (
            (
                share("thickness_m", "thickness of the bar", 0.06, 0.3, chord),
                Parameter(name="half_angle_deg", meaning="half angle, over the same chord", low=5.0, high=60.0),
            ),
            (shape.outer_radius_m - shape.inner_radius_m, shape.half_angle_deg),
            bent,
        )
    raise InputError("robot.shape", repr(shape.kind), "cuboid, spiked, spiked_ends or curved")
