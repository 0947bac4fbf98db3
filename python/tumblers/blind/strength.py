"""How strongly a cause shows in what a lab measures: in standard deviations of the noise."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

from .lab import Lab, Plan
from .view import channels_of, climbs, mean_speed, rest_tilt, turn_between
from .world import Scene

__all__ = ["SIGMA_DEG", "Strength", "speed_sigma", "strength"]

# What an outcome's noise is.
SIGMA_DEG = 1.0
_SPEED_SHARE, _LEAST_SPEED = 0.01, 3e-5
# A robot that climbs and one that does not are told apart with this many standard deviations.
_CLIMB_SIGMA = 3.0
# So many standard deviations of each nominal number are taken out: of ten at once, as many as they are off together.
_MOST_OFF = 1.0
_ORIGIN, _CLOCK, _PER_TRIAL = 0, 2, 3


@dataclass(frozen=True, slots=True)
class Strength:
    """Root mean square of a difference in units of the noise, after what is within tolerances is taken out.

    Attributes
    ----------
    sigma
        Over all numbers of the dataset.
    by_trial
        Over those of each trial.
    """

    sigma: float
    by_trial: tuple[float, ...]


def speed_sigma(speed_m_per_s: float) -> float:
    """Return the standard deviation of a mean speed, m/s."""
    return max(_SPEED_SHARE * abs(speed_m_per_s), _LEAST_SPEED)


def strength(
    lab: Lab, scenes: Sequence[Scene], others: Sequence[Scene], moved: Sequence[Sequence[Scene]] = ()
) -> Strength:
    """Return how much the scenes differ from others of the same lab.

    Taken out, by bounded least squares, is what the sensor's stated tolerances allow: the origin and the clock of each
    trial, the heading and the scale of the camera; and one standard deviation of each nominal number. A trial shows no
    more than it does with nothing taken out: what is taken out of all must not appear where nothing was.

    Parameters
    ----------
    lab
        Where the scenes were made.
    scenes, others
        A scene for each plan, with and without a cause.
    moved
        The others with one nominal number after another moved by its standard deviation, a scene for each plan.
    """
    count, shared = len(lab.plans), 2 + len(moved)
    blocks: list[NDArray[np.float64]] = []
    sides: list[NDArray[np.float64]] = []
    for i, plan in enumerate(lab.plans):
        matrix, side = _rows(lab, plan, scenes[i], others[i], [those[i] for those in moved])
        block = np.zeros((side.size, _PER_TRIAL * count + shared))
        block[:, _PER_TRIAL * i : _PER_TRIAL * (i + 1)] = matrix[:, :_PER_TRIAL]
        block[:, -shared:] = matrix[:, _PER_TRIAL:]
        blocks.append(block)
        sides.append(side)
    sensor = lab.sensor
    clock = 0.5 / lab.frames_per_second if sensor.time_offset_s is None else sensor.time_offset_s
    per_trial = [sensor.origin_tolerance_m, sensor.origin_tolerance_m, clock]
    camera = [sensor.heading_tolerance_deg, sensor.scale_tolerance]
    bound = np.array([*(per_trial * count), *camera, *([_MOST_OFF] * len(moved))])
    # In units of their bounds the columns are alike, and a square system of the same solution is quick to solve.
    matrix, side = np.concatenate(blocks) * bound, np.concatenate(sides)
    q, r = np.linalg.qr(matrix)
    found = lsq_linear(r, q.T @ side, bounds=(-1.0, 1.0), method="bvls" if r.shape[0] == r.shape[1] else "trf").x
    rests = [s - b * bound @ found for b, s in zip(blocks, sides, strict=True)]
    each = zip(rests, sides, strict=True)
    means = [min(float(np.mean(a**2)), float(np.mean(b**2))) if a.size else 0.0 for a, b in each]
    whole = np.concatenate(rests)
    return Strength(float(np.sqrt(np.mean(whole**2))), tuple(float(np.sqrt(mean)) for mean in means))


def _rows(
    lab: Lab, plan: Plan, scene: Scene, other: Scene, moved: Sequence[Scene]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the columns (x0, y0, clock, heading, scale, numbers) and the difference, both over the noise."""
    matrices: list[NDArray[np.float64]] = []
    sides: list[NDArray[np.float64]] = []

    def add(
        differences: Sequence[NDArray[np.float64]], sigma: float, columns: dict[int, NDArray[np.float64] | float]
    ) -> None:
        difference, *changes = differences
        matrix = np.zeros((difference.size, _PER_TRIAL + 2 + len(changes)))
        for column, values in [*columns.items(), *enumerate(changes, _PER_TRIAL + 2)]:
            matrix[:, column] = values
        seen = np.isfinite(difference) & np.all(np.isfinite(matrix), axis=1) & inside
        matrices.append(matrix[seen] / sigma)
        sides.append(difference[seen] / sigma)

    if plan.tracked:
        inside = np.max(np.abs(scene.poses.position_m[:, :2]), axis=1) <= lab.view_m
        nominal = channels_of(other.poses)
        seen = [channels_of(one.poses) for one in (scene, *moved)]
        late, early = channels_of(other.after), channels_of(other.before)
        h = other.step_s
        x, y = nominal["x_m"], nominal["y_m"]
        per_degree = np.pi / 180.0
        nuisances: dict[str, dict[int, NDArray[np.float64] | float]] = {
            "x_m": {0: 1.0, 3: -y * per_degree, 4: x},
            "y_m": {1: 1.0, 3: x * per_degree, 4: y},
            "z_m": {},
            "tilt_deg": {},
            "heading_deg": {3: 1.0},
        }
        for name, columns in nuisances.items():
            if name not in lab.channels:
                continue
            differences, rate = [one[name] - nominal[name] for one in seen], (late[name] - early[name]) / h
            if name == "heading_deg":
                differences, rate = [(d + 180.0) % 360.0 - 180.0 for d in differences], 0.0 * rate
            sigma = lab.sensor.position_noise_m if name.endswith("_m") else lab.sensor.angle_noise_deg
            add(differences, sigma, {**columns, _CLOCK: rate})
        if "qw" in lab.channels:
            turns = [turn_between(other.poses.orientation, one.poses.orientation) for one in (scene, *moved)]
            rates = turn_between(other.before.orientation, other.after.orientation) / h
            for i in range(3):
                columns = {_CLOCK: rates[:, i], 3: 1.0 if i == 2 else 0.0}
                add([turn[:, i] for turn in turns], lab.sensor.angle_noise_deg, columns)
    inside = np.array([True])

    def add_outcome(measured: Callable[[Scene], float], sigma: float) -> None:
        without = measured(other)
        add([np.array([measured(one) - without]) for one in (scene, *moved)], sigma, {})

    if plan.outcome == "speed":
        add_outcome(lambda one: mean_speed(one, plan.duration_s), speed_sigma(mean_speed(other, plan.duration_s)))
    if plan.outcome == "tilt":
        add_outcome(rest_tilt, SIGMA_DEG)
    if plan.outcome == "climbs":
        add_outcome(lambda one: float(climbs(one, lab.way_m(plan))), 1.0 / _CLIMB_SIGMA)
    return np.concatenate(matrices), np.concatenate(sides)
