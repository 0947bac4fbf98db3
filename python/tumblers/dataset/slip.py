"""Numbers of a dataset that are likely in another unit than their key says: possible, but in no lab of this field."""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot, radians, sin
from typing import TYPE_CHECKING

import numpy as np
from scipy.constants import g as standard_gravity

from ..field import Field, RotatingField, TableField
from .climb import way_without_slip_m
from .sensor import Sensor
from .track import ANGLES, POSITIONS, Track

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
# Times the robot's weight: on a clean substrate the attraction is of its order.
_MOST_ATTRACTION = 1e4
# What no camera around a microscope tells, degrees: one degree in radians is less.
_LEAST_ANGLE_NOISE_DEG = 0.05
# Noise of one standard deviation never spreads so many frames less than this share of it, unless all are one number.
_LEAST_SPREAD, _FEW_FRAMES = 0.3, 10
# Of a body that tumbles: tilts in radians end just above 1.57, and lie over all between, as those of noise do not.
_MOST_RAD, _LEAST_RAD, _EVEN = 1.65, 1.2, 0.5
# Times the way without slip, beside what a slope adds.
_MOST_SPEED = 20.0


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
    attraction, weight = dataset.substrate.electrostatic_force_N, robot.total_mass_kg * standard_gravity
    if attraction > _MOST_ATTRACTION * weight:
        times = attraction / weight
        yield f"electrostatic_force_N = {attraction:.3g} is {times:.3g} times the robot's weight: is it in N?"
    tracks = [trial.track for trial in dataset.trials if trial.track is not None]
    if tracks and sensor.position_noise_m > body.size_m:
        yield f"position_noise_m = {sensor.position_noise_m:.3g} is more than the robot's own size: is it in m?"
    turned = any(name in track.channels for track in tracks for name in ANGLES)
    if turned and sensor.angle_noise_deg < _LEAST_ANGLE_NOISE_DEG:
        yield f"angle_noise_deg = {sensor.angle_noise_deg:.3g} is finer than a camera tells: is it in degrees?"


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
    for trial in dataset.trials:
        if trial.track is not None and trial.id not in far:
            yield from _of_track(trial.id, trial.track, dataset)
        if isinstance(trial.field, RotatingField) and trial.track is not None and _in_radians(trial.track):
            yield f"tilt_deg of {trial.id} is between -1.6 and 1.6 while the field turns: is it in degrees?"
        speed = None if trial.outcome is None else trial.outcome.mean_speed_m_per_s
        if speed is not None:
            rolls = way_without_slip_m(dataset.robot, trial.field, trial.duration_s) / trial.duration_s
            slides = 0.5 * standard_gravity * sin(radians(abs(trial.incline_deg))) * trial.duration_s
            if abs(speed) > _MOST_SPEED * rolls + slides:
                beside = f"{speed:.3g}, and rolling without slip makes {rolls:.3g}"
                yield f"mean_speed_m_per_s of {trial.id} is {beside}: is it in m/s?"


def _of_track(id_: str, track: Track, dataset: Dataset) -> Iterator[str]:
    sensor = dataset.sensor
    spread, away = _spread_m(track), _begins_away_m(track, sensor)
    if 0.0 < spread < _LEAST_SPREAD * sensor.position_noise_m:
        yield (
            f"the positions of {id_} differ by {spread:.3g} m at most, less than position_noise_m makes of a robot at "
            "rest: are they in m, is micrometres_per_pixel in µm?"
        )
    if away > sensor.origin_tolerance_m + dataset.robot.body().size_m:
        yield (
            f"the track of {id_} begins {away:.3g} m from its origin: are x and y from where the robot starts, is "
            "origin_px that pixel?"
        )


def _strength_T(field: Field) -> float:
    if isinstance(field, TableField):
        return max(hypot(*row) for row in field.field_T)
    return field.strength_T


def _way_m(track: Track) -> float:
    seen = [np.abs(track.channels[name]) for name in POSITIONS if name in track.channels]
    return max((float(np.max(column, initial=0.0, where=~np.isnan(column))) for column in seen), default=0.0)


def _spread_m(track: Track) -> float:
    """Return by how much the positions of a track differ at most, 0 of too few frames."""
    seen = [column[~np.isnan(column)] for name, column in track.channels.items() if name in POSITIONS]
    return max((float(np.ptp(column)) for column in seen if len(column) >= _FEW_FRAMES), default=0.0)


def _begins_away_m(track: Track, sensor: Sensor) -> float:
    """Return how far along x or y the first frame is from the origin, 0 where it is not from the start or was lost."""
    if not len(track.time_s) or track.time_s[0] > sensor.clock_tolerance_s(track.frame_interval_s):
        return 0.0
    first = [abs(float(track.channels[name][0])) for name in ("x_m", "y_m") if name in track.channels]
    return max((value for value in first if not np.isnan(value)), default=0.0)


def _in_radians(track: Track) -> bool:
    """Return whether the tilts of a track look like those of a tumbling robot in radians."""
    tilts = track.channels.get("tilt_deg", np.empty(0))
    tilts = tilts[~np.isnan(tilts)]
    if len(tilts) < 3 * _FEW_FRAMES:
        return False
    most = float(np.max(np.abs(tilts)))
    return _LEAST_RAD < most < _MOST_RAD and float(np.sqrt(np.mean(tilts**2))) > _EVEN * most
