"""How far the world's numbers are from those that the lab believes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, replace
from typing import Any

import numpy as np

from ..field import TableField
from ..robot import Robot
from ..scenario import Scenario

__all__ = ["DIMENSIONS", "NUMBERS", "Jitter"]

# Standard deviations of the factors: of every number, and of every length of the shape.
NUMBERS, DIMENSIONS = 0.005, 0.001


@dataclass(frozen=True, kw_only=True, slots=True)
class Jitter:
    """Factors on the nominal numbers.

    Attributes
    ----------
    mass, magnetization, friction, adhesion, electrostatic, field
        Factors of the nominal value.
    dimensions
        A factor for each length of the shape.
    """

    mass: float = 1.0
    magnetization: float = 1.0
    friction: float = 1.0
    adhesion: float = 1.0
    electrostatic: float = 1.0
    field: float = 1.0
    dimensions: tuple[float, ...] = ()

    @classmethod
    def draw(cls, rng: np.random.Generator, robot: Robot) -> Jitter:
        """Return factors for a robot: half a per cent, and a tenth of a per cent for its lengths.

        Parameters
        ----------
        rng
            Where they come from.
        robot
            The robot.
        """
        names = [f.name for f in fields(cls) if f.name != "dimensions"]
        factors = {name: 1.0 + NUMBERS * float(rng.normal()) for name in names}
        lengths = tuple(1.0 + DIMENSIONS * float(rng.normal()) for _ in fields(robot.shape))
        return cls(**factors, dimensions=lengths)

    @classmethod
    def of_table(cls, table: Mapping[str, Any]) -> Jitter:
        """Return the factors that `table` has by name; 1 for those that are left out."""
        return cls(**{**table, "dimensions": tuple(table.get("dimensions", ()))})

    def each_raised(self) -> list[Jitter]:
        """Return the factors with one number after another raised by its standard deviation."""
        names = [f.name for f in fields(self) if f.name != "dimensions"]
        made = [replace(self, **{name: getattr(self, name) * (1.0 + NUMBERS)}) for name in names]
        for i, length in enumerate(self.dimensions):
            moved = (*self.dimensions[:i], length * (1.0 + DIMENSIONS), *self.dimensions[i + 1 :])
            made.append(replace(self, dimensions=moved))
        return made

    def edit(self, scenario: Scenario) -> Scenario:
        """Return a nominal scenario with the world's numbers.

        Parameters
        ----------
        scenario
            What the lab believes.
        """
        robot, substrate, drive = scenario.robot, scenario.substrate, scenario.field
        shape = robot.shape
        if self.dimensions:
            names = [f.name for f in fields(shape)]
            lengths = {n: k * getattr(shape, n) for n, k in zip(names, self.dimensions, strict=True)}
            shape = replace(shape, **lengths)
        robot = replace(
            robot,
            shape=shape,
            magnetization_A_per_m=self.magnetization * robot.magnetization_A_per_m,
            mass_kg=None if robot.mass_kg is None else self.mass * robot.mass_kg,
            density_kg_per_m3=None if robot.density_kg_per_m3 is None else self.mass * robot.density_kg_per_m3,
        )
        substrate = replace(
            substrate,
            friction_coefficient=self.friction * substrate.friction_coefficient,
            adhesion_N_per_m2=self.adhesion * substrate.adhesion_N_per_m2,
            electrostatic_force_N=self.electrostatic * substrate.electrostatic_force_N,
        )
        if isinstance(drive, TableField):
            drive = replace(
                drive, field_T=tuple((self.field * x, self.field * y, self.field * z) for x, y, z in drive.field_T)
            )
        else:
            drive = replace(drive, strength_T=self.field * drive.strength_T)
        return replace(scenario, robot=robot, substrate=substrate, field=drive)

    def table(self) -> dict[str, Any]:
        """Return the factors by name."""
        return asdict(self)
