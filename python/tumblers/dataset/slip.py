"""Numbers of a dataset that are likely in another unit than their key says: possible, but in no lab of this field."""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot
from typing import TYPE_CHECKING

import numpy as np

from ..field import Field, TableField
from .track import POSITIONS, Track

if TYPE_CHECKING:
    from .dataset import Dataset

__all__ = ["likely_slips"]

# What coils and magnets around a microscope do not reach, T; no magnet has more than iron saturated has, A/m.
_MOST_FIELD_T = 1.0
_MOST_MAGNETIZATION_A_PER_M = 2e6
# An aerogel, and osmium with room for a slip in the volume, kg/m³.
_LEAST_DENSITY, _MOST_DENSITY = 10.0, 25e3
# From the centre to the farthest point; a microrobot has a hundredth of it, m.
_MOST_SIZE_M = 0.05
# Rubber on a dry rough face has about a third of it.
_MOST_FRICTION = 10.0
# More than the length of a substrate under a microscope, m.
_MOST_WAY_M = 1.0


def likely_slips(dataset: Dataset) -> tuple[str, ...]:
    """Return sentences on numbers that are likely in another unit, none where there are none.

    Parameters
    ----------
    dataset
        A sound dataset: nothing of this makes it less so, and a large experiment may have such numbers.
    """
    return (*_of_robot(dataset), *_of_trials(dataset))


def _of_robot(dataset: Dataset) -> Iterator[str]:
    robot, sensor = dataset.robot, dataset.sensor
    body = robot.body()
    if body.size_m > _MOST_SIZE_M:
        yield f"the robot reaches {body.size_m:.3g} m from its centre: are its lengths in m?"
    density = robot.total_mass_kg / body.volume_m3
    if not _LEAST_DENSITY <= density <= _MOST_DENSITY:
        key = "density_kg_per_m3" if robot.mass_kg is None else "mass_kg"
        yield f"the robot has {density:.3g} kg/m³ by mass and volume: is {key} in its unit, are the lengths in m?"
    volume = body.volume_m3 if robot.magnetic_volume_m3 is None else robot.magnetic_volume_m3
    if volume > 2.0 * body.volume_m3:
        times = volume / body.volume_m3
        yield f"magnetic_volume_m3 = {volume:.3g} is {times:.3g} times the robot's volume: is it in m³?"
    if robot.magnetization_A_per_m > _MOST_MAGNETIZATION_A_PER_M:
        yield f"magnetization_A_per_m = {robot.magnetization_A_per_m:.3g} is more than any magnet has: is it in A/m?"
    friction = dataset.substrate.friction_coefficient
    if friction > _MOST_FRICTION:
        yield f"friction_coefficient = {friction:.3g} is more than a substrate has: is it force over force?"
    if any(trial.track is not None for trial in dataset.trials) and sensor.position_noise_m > body.size_m:
        yield f"position_noise_m = {sensor.position_noise_m:.3g} is more than the robot's own size: is it in m?"


def _of_trials(dataset: Dataset) -> Iterator[str]:
    strengths = {trial.id: _strength_T(trial.field) for trial in dataset.trials}
    strong = {id_: strength for id_, strength in strengths.items() if strength > _MOST_FIELD_T}
    if strong:
        most = max(strong, key=strong.__getitem__)
        of = "" if len(strong) == 1 else f", as in {len(strong)} trials"
        yield f"the field of {most} is {strong[most]:.3g} T strong{of}, more than a lab's coils give: is it in T?"
    ways = {trial.id: _way_m(trial.track) for trial in dataset.trials if trial.track is not None}
    far = [id_ for id_, way in ways.items() if way > _MOST_WAY_M]
    if far:
        most = max(far, key=ways.__getitem__)
        yield f"the track of {most} reaches {ways[most]:.3g} m from its origin: are its positions in m?"


def _strength_T(field: Field) -> float:
    if isinstance(field, TableField):
        return max(hypot(*row) for row in field.field_T)
    return field.strength_T


def _way_m(track: Track) -> float:
    seen = [np.abs(track.channels[name]) for name in POSITIONS if name in track.channels]
    return max((float(np.max(column, initial=0.0, where=~np.isnan(column))) for column in seen), default=0.0)
