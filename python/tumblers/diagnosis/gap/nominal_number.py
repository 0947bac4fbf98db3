"""The nominal numbers that a lab may be off in, and how each is moved by a share of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from functools import partial

from ...dataset.tolerance import Tolerance
from ...effects.size_error import SizeError
from ...field import RotatingField, StaticField, TableField
from ...scenario import Scenario
from .job import Edit

__all__ = ["NUMBERS", "moved_by"]

# By the names of `Tolerance`, in their order.
NUMBERS = tuple(each.name for each in fields(Tolerance))


def moved_by(tolerance: Tolerance) -> tuple[Edit, ...]:
    """Return what moves each of `NUMBERS` up by its tolerance.

    Parameters
    ----------
    tolerance
        How well the lab knows them.
    """
    return tuple(partial(_MOVES[name], getattr(tolerance, name)) for name in NUMBERS)


def _mass(share: float, scenario: Scenario) -> Scenario:
    robot = scenario.robot
    # The magnetic moment keeps its own tolerance, and follows the volume, not the mass.
    return replace(scenario, robot=replace(robot, mass_kg=robot.total_mass_kg * (1.0 + share)))


def _moment(share: float, scenario: Scenario) -> Scenario:
    robot = scenario.robot
    return replace(scenario, robot=replace(robot, magnetization_A_per_m=robot.magnetization_A_per_m * (1.0 + share)))


def _field(share: float, scenario: Scenario) -> Scenario:
    field, factor = scenario.field, 1.0 + share
    if isinstance(field, TableField):
        rows = tuple((x * factor, y * factor, z * factor) for x, y, z in field.field_T)
        return replace(scenario, field=replace(field, field_T=rows))
    assert isinstance(field, RotatingField | StaticField)
    return replace(scenario, field=replace(field, strength_T=field.strength_T * factor))


def _substrate(key: str, share: float, scenario: Scenario) -> Scenario:
    value = getattr(scenario.substrate, key) * (1.0 + share)
    return replace(scenario, substrate=replace(scenario.substrate, **{key: value}))


def _size(which: str, share: float, scenario: Scenario) -> Scenario:
    return SizeError(**{f"{which}_factor": 1.0 + share}).edit(scenario)


_MOVES: Mapping[str, Callable[[float, Scenario], Scenario]] = {
    "mass": _mass,
    "magnetization": _moment,
    "field_strength": _field,
    "friction_coefficient": partial(_substrate, "friction_coefficient"),
    "adhesion": partial(_substrate, "adhesion_N_per_m2"),
    "electrostatic_force": partial(_substrate, "electrostatic_force_N"),
    "length": partial(_size, "length"),
    "height": partial(_size, "height"),
}
