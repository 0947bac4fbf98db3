"""Random states to make a step from: every kind of contact and of motion on purpose."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import cos, radians, sin, tan
from typing import Literal
from zlib import crc32

import numpy as np
from scipy.spatial.transform import Rotation

from tumblers import Model, Robot, RotatingField, Run, Scenario, Substrate, _core, reference
from tumblers.model import MagneticTorque
from tumblers.reference.array import Array
from tumblers.reference.rotation import aligning, cayley, cross

from .robots import ROBOTS
from .twin import Twin

Place = Literal["face", "edge", "point", "falling", "airborne", "run"]
Motion = Literal["rest", "slide", "spin", "roll", "free"]

TORQUES: tuple[MagneticTorque, ...] = ("start_of_step", "end_of_step", "midpoint")
_PLACES: tuple[Place, ...] = ("face", "edge", "run", "point", "face", "falling", "edge", "run", "airborne", "point")
_MOTIONS: tuple[Motion, ...] = ("rest", "slide", "spin", "roll", "free")
_UP = np.array([0.0, 0.0, 1.0])
_WARM_UP = 60


@dataclass(frozen=True, eq=False)
class Case:
    """One step to solve, and how its state was made."""

    name: str
    twin: Twin
    state: reference.State
    time: float
    adhesion_force: float
    patch_centroid: Array


def cases(robot: str, torque: MagneticTorque, number: int) -> Iterator[Case]:
    """Yield `number` states of one robot, the same on every machine."""
    rng = np.random.default_rng(crc32(f"{robot} {torque}".encode()))
    for i in range(number):
        place, motion = _PLACES[i % len(_PLACES)], _MOTIONS[rng.integers(len(_MOTIONS))]
        name = f"{robot}, {torque}, {i}: {place}" + ("" if place == "run" else f", {motion}")
        scenario = _scenario(ROBOTS[robot], torque, rng)
        if place == "run":
            yield _from_run(name, scenario, rng)
        else:
            yield _placed(name, scenario, place, motion, rng)


def _scenario(robot: Robot, torque: MagneticTorque, rng: np.random.Generator) -> Scenario:
    substrate = Substrate(
        friction_coefficient=rng.choice([0.05, 0.3, 0.54, 0.8]).item(),
        friction_ellipsoid=(1.0, 1.0, rng.choice([0.1, 1e-4]).item()),
        adhesion_N_per_m2=rng.choice([0.0, 1.19, 26.18, 340.115]).item(),
        electrostatic_force_N=rng.choice([0.0, 2.2e-7, 6.54e-7]).item(),
        line_contact_width_m=rng.choice([0.0, 1e-6]).item(),
    )
    model = Model(
        magnetic_torque=torque,
        adhesion_acts_at=rng.choice(["ecp", "patch_centroid"]).item(),
        adhesion_enters=rng.choice(["normal", "normal", "friction_only"]).item(),
    )
    field = RotatingField(strength_T=rng.choice([0.01, 0.02]).item(), frequency_Hz=rng.choice([1.0, 5.0, 10.0]).item())
    step = rng.choice([1e-4, 2e-4, 5e-4]).item()
    run = Run(duration_s=_WARM_UP * step, step_s=step, incline_deg=max(0.0, rng.uniform(-20.0, 60.0)))
    return Scenario(robot=robot, substrate=substrate, field=field, run=run, model=model)


def _from_run(name: str, scenario: Scenario, rng: np.random.Generator) -> Case:
    """Return a state of a run of the core."""
    twin = Twin.of(scenario)
    run = _core.simulate(twin.core, 1)
    i = int(rng.integers(1, _WARM_UP))
    state = reference.State(
        run["position_m"][i],
        run["orientation"][i],
        run["linear_velocity_m_per_s"][i],
        run["angular_velocity_rad_per_s"][i],
    )
    return Case(name, twin, state, i * twin.reference.step, *twin.reference.adhesion_at(state))


def _placed(name: str, scenario: Scenario, place: Place, motion: Motion, rng: np.random.Generator) -> Case:
    """Return a state that is made up, in a field that the robot follows."""
    twin, field = Twin.of(scenario), scenario.field
    assert isinstance(field, RotatingField)
    body, step = twin.reference.body, twin.reference.step
    i = int(rng.integers(_WARM_UP))
    rotation = _orientation(body, place, rng)
    moment = rotation @ np.array(scenario.robot.magnetic_axis)
    # A little behind, so that the body may stay where it is, and far behind, so that it is thrown off.
    behind = radians(90.0 * 10.0 ** rng.uniform(-4.0, 0.0))
    towards = Rotation.from_rotvec(behind * _across(moment, rng)).apply(moment)
    axis = _across(towards, rng)
    start = Rotation.from_rotvec(-2.0 * np.pi * field.frequency_Hz * i * step * axis).apply(towards)
    field = replace(field, rotation_axis=tuple(axis), initial_direction=tuple(start))
    twin = Twin.of(replace(scenario, field=field))
    state = _moving(body, rotation, place, motion, step, rng)
    return Case(name, twin, state, i * step, *twin.reference.adhesion_at(state))


def _across(direction: Array, rng: np.random.Generator) -> Array:
    """Return a unit vector at right angles to `direction`."""
    across = cross(direction, rng.normal(size=3))
    return np.asarray(across / np.linalg.norm(across))


def _orientation(body: reference.Body, place: Place, rng: np.random.Generator) -> Array:
    """Return a rotation that lays a face or an edge of the body level, or any rotation."""
    kinds = {"face": ("face",), "edge": ("edge", "curved"), "falling": ("face", "edge")}.get(place, ())
    level = [cell for cell in body.cells if cell.kind in kinds and len(cell.points) > 1]
    if not level or (place == "falling" and rng.random() < 0.5):
        return np.asarray(Rotation.random(rng=rng).as_matrix())
    cell = level[rng.integers(len(level))]
    shares = rng.uniform(0.05, 1.0, size=len(cell.surfaces))
    point = cell.points[rng.integers(len(cell.points))]
    down = shares @ [body.surfaces[i].gradient(point) for i in sorted(cell.surfaces)]
    if cell.surfaces == {0} and isinstance(cone := body.surfaces[0], reference.Cone):
        # Any generator of a cone may be the lowest line, not only those at the ends.
        angle = rng.uniform(-0.9, 0.9) * min(rim.half_angle for rim in body.rims)
        down = np.array([tan(cone.slope), sin(angle), cos(angle)])
    turn = rng.uniform(0.0, 2.0 * np.pi)
    return cayley(tan(0.5 * turn) * _UP) @ aligning(down / np.linalg.norm(down), -_UP)


def _moving(
    body: reference.Body, rotation: Array, place: Place, motion: Motion, step: float, rng: np.random.Generator
) -> reference.State:
    """Return the body with its lowest point on the plane, or above it, in motion."""
    quaternion = np.roll(Rotation.from_matrix(rotation).as_quat(), 1)
    rotation = reference.State(np.zeros(3), quaternion).rotation
    lowest = body.lowest_height(rotation)
    speed = 10.0 ** rng.uniform(-4.0, -1.3)
    linear, angular = np.zeros(3), np.zeros(3)
    if motion in ("slide", "free"):
        angle = rng.uniform(-np.pi, np.pi)
        linear = speed * np.array([cos(angle), sin(angle), 0.0])
    if motion in ("spin", "free"):
        angular = speed / body.radius * rng.choice([-1.0, 1.0]) * _UP
    if motion in ("roll", "free"):
        turning = speed / body.radius * rng.normal(size=3)
        linear = linear - cross(turning, lowest * _UP)
        angular = angular + turning
    gap = 0.0
    if place == "falling":
        gap = body.radius * 10.0 ** rng.uniform(-5.0, -1.5)
        linear = linear - gap / step * rng.uniform(1.0, 3.0) * _UP
    elif place == "airborne":
        gap = body.radius * rng.uniform(0.1, 1.0)
        linear = linear + speed * rng.uniform(-0.1, 1.0) * _UP
    return reference.State(np.array([0.0, 0.0, gap - lowest]), quaternion, linear, angular)
