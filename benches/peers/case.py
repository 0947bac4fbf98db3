"""`Case`: what both engines run, as a scenario of this package."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, radians, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tumblers.field import RotatingField, StaticField
from tumblers.initial import Initial
from tumblers.presets import preset_scenario
from tumblers.run import Run
from tumblers.scenario import Scenario
from tumblers.shape import Cuboid
from tumblers.substrate import Substrate

__all__ = [
    "FINE_STEP_S",
    "SLIDING_M_PER_S",
    "STEP_S",
    "Case",
    "at_rest",
    "in_flight",
    "on_slope",
    "part_of",
    "sliding",
    "tumbling",
]

STEP_S = 5e-4
# Points of the outline that are one vertex, in parts of the size.
_SAME = 1e-9
# From here the robot falls for a quarter of a second and does not land: F_elect pulls at any height.
_HEIGHT_M, _FALL_S = 1.0, 0.25
_SLOPE_DEG, _CREEP_S = 10.0, 2.0
_SLIDING_FRICTION, _SLIDING_S = 0.5, 0.1
# Froude's number is that of 6 m/s and a box a thousand times as large, and the finer step that of its 2 ms.
SLIDING_M_PER_S = 6.0 / 1000.0**0.5
FINE_STEP_S = 2e-3 / 1000.0**0.5
_NO_FIELD = StaticField(strength_T=0.0, direction=(0.0, 1.0, 0.0))
# name: experiment
_TUMBLING = {"cuboid": "cuboid_on_paper", "spiked": "spiked", "spiked ends": "spiked_ends"}


@dataclass(frozen=True)
class Case:
    """A scenario with a name.

    Attributes
    ----------
    name
        What the tables call it.
    scenario
        Robot, substrate, field, time, step and start.
    """

    name: str
    scenario: Scenario

    @property
    def steps(self) -> int:
        """Number of steps of one run."""
        return self.scenario.run.steps

    @property
    def is_box(self) -> bool:
        """Whether a peer's own box is the robot's hull."""
        return isinstance(self.scenario.robot.shape, Cuboid)

    @property
    def start_m(self) -> NDArray[np.float64]:
        """Centre of mass at the start, m, of a body that lies level: what the peers' runs start with.

        Raises
        ------
        ValueError
            A start that is turned or turns.
        """
        initial = self.scenario.initial
        if initial.orientation is not None or any(initial.angular_velocity_rad_per_s):
            raise ValueError(f"{self.name}: found a start that is turned or turns, expected one that lies level")
        if initial.position_m is not None:
            return np.array(initial.position_m)
        return np.array([0.0, 0.0, -self.vertices_m[:, 2].min()])

    @property
    def vertices_m(self) -> NDArray[np.float64]:
        """Corners of the real body, which hold those of its hull, body frame, m, shape (n, 3)."""
        corners = np.concatenate(self.scenario.robot.body().outline)
        size = np.abs(corners).max()
        _, first = np.unique(np.round(corners / (size * _SAME)), axis=0, return_index=True)
        return np.ascontiguousarray(corners[first])


def tumbling() -> list[Case]:
    """Return the cuboid on paper (10 mT, 5 Hz) and both spiked hulls on aluminium (20 mT, 1 Hz), 2000 steps each."""
    return [Case(name, preset_scenario(experiment, step_s=STEP_S)) for name, experiment in _TUMBLING.items()]


def in_flight() -> Case:
    """Return the cuboid in its field, falling."""
    scenario = tumbling()[0].scenario
    run = replace(scenario.run, duration_s=_FALL_S)
    return Case("in flight", replace(scenario, run=run, initial=Initial(position_m=(0.0, 0.0, _HEIGHT_M))))


def at_rest() -> Case:
    """Return the cuboid on a face, without a field."""
    return Case("at rest on a face", replace(tumbling()[0].scenario, field=_NO_FIELD))


def on_slope() -> Case:
    """Return the cuboid on a slope of 10° with μ = 0.3, of which the friction angle is 16.7°; no other attraction."""
    scenario = tumbling()[0].scenario
    substrate = Substrate(friction_coefficient=scenario.substrate.friction_coefficient)
    run = Run(duration_s=_CREEP_S, step_s=STEP_S, incline_deg=_SLOPE_DEG)
    return Case("slope", replace(scenario, field=_NO_FIELD, substrate=substrate, run=run))


def sliding(step_s: float) -> Case:
    """Return the cuboid sliding along its length with μ = 0.5 and no other attraction.

    Its speed is that of the same Froude number v²/(g L) as 6 m/s of a box a thousand times as large.

    Parameters
    ----------
    step_s
        Step, s.
    """
    return Case(
        f"sliding, step {1e6 * step_s:.3g} µs",
        replace(
            tumbling()[0].scenario,
            field=_NO_FIELD,
            substrate=Substrate(friction_coefficient=_SLIDING_FRICTION),
            run=Run(duration_s=_SLIDING_S, step_s=step_s),
            initial=Initial(linear_velocity_m_per_s=(0.0, SLIDING_M_PER_S, 0.0)),
        ),
    )


def part_of(case: Case, rows: Any, first: int, steps: int, name: str) -> Case:
    """Return a part of a run of a rotating field as a case of its own, whose field starts where it was.

    Parameters
    ----------
    case
        The whole run.
    rows
        What `tumblers.simulate` returned for it, a row for every step.
    first, steps
        The row that it starts with, and its length.
    name
        Its name.
    """
    scenario = case.scenario
    field = scenario.field
    assert isinstance(field, RotatingField)
    angle = radians(360.0 * field.frequency_Hz * float(rows["time"][first]))
    start, axis = np.array(field.initial_direction), np.array(field.rotation_axis)
    direction = start * cos(angle) + np.cross(axis, start) * sin(angle)

    def row(key: str) -> Any:
        return tuple(float(value) for value in rows[key].values[first])

    initial = Initial(
        position_m=row("position_m"),
        orientation=row("orientation"),
        linear_velocity_m_per_s=row("linear_velocity_m_per_s"),
        angular_velocity_rad_per_s=row("angular_velocity_rad_per_s"),
    )
    turned = replace(field, initial_direction=(float(direction[0]), float(direction[1]), float(direction[2])))
    run = replace(scenario.run, duration_s=steps * scenario.run.step_s)
    return Case(name, replace(scenario, field=turned, run=run, initial=initial))
