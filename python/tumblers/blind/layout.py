"""Draws labs: robots, cameras and the trials that a lab would make of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import cycle
from math import cos, radians, sin

import numpy as np

from ..dataset import Sensor
from ..dataset.climb import CLIMBED
from ..field import Field, RotatingField, StaticField, TableField
from ..presets import ROBOTS, SUBSTRATES
from ..robot import Robot
from ..scenario import Scenario
from .jitter import Jitter
from .lab import Lab, Plan
from .strength import Strength, strength
from .view import climbed_share, rest_tilt
from .world import Scene, watch

__all__ = ["FINER", "STEADY_SIGMA", "draw_lab", "jitter_strength", "world_scenario"]

_PAIRS = (
    ("cuboid", "paper", 0.010),
    ("cuboid_second_generation", "paper", 0.010),
    ("cuboid_second_generation", "aluminium", 0.010),
    ("spiked_pdms", "aluminium_pdms", 0.020),
    ("spiked_ends_pdms", "aluminium_pdms", 0.020),
)
_FREQUENCIES_HZ = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0)
_TRIES = 12
# Of a robot that gets on by such shares of the way without slip a lab would not note whether it climbs.
_DOUBTFUL = (0.5 * CLIMBED, 2.0 * CLIMBED)
# A lab keeps the trials that repeat: those in which the numbers' jitter and the step stay below the noise.
STEADY_SIGMA = 1.0
# The other step of the world, in which a motion has to repeat, over its own.
FINER = 0.7


def world_scenario(lab: Lab, plan: Plan, jitter: Jitter) -> Scenario:
    """Return a plan as the world has it before its laws.

    Parameters
    ----------
    lab, plan
        What the lab believes.
    jitter
        How far it is off.
    """
    return jitter.edit(lab.scenario(plan))


def draw_lab(rng: np.random.Generator) -> tuple[Lab, Jitter]:
    """Return a lab with 6 to 14 trials, and how far the world's numbers are from those it believes.

    Parameters
    ----------
    rng
        Where they come from.
    """
    robot_name, substrate_name, strength_T = _PAIRS[int(rng.integers(len(_PAIRS)))]
    robot, substrate = ROBOTS[robot_name].value, SUBSTRATES[substrate_name].value
    angles: tuple[str, ...] = ("qw", "qx", "qy", "qz")
    if rng.random() >= 0.25:
        angles = tuple(n for n, p in (("tilt_deg", 0.7), ("heading_deg", 0.6)) if rng.random() < p)
    lab = Lab(
        robot=robot,
        substrate=substrate,
        sensor=Sensor(
            position_noise_m=round(float(rng.uniform(1.5e-6, 4e-6)), 8),
            angle_noise_deg=round(float(rng.uniform(0.5, 1.5)), 2),
            tracked_point="body_centre",
            z_origin_tolerance_m=0.0,
        ),
        channels=("x_m", "y_m", *(("z_m",) if rng.random() < 0.6 else ()), *angles),
        frames_per_second=float(rng.choice([50.0, 60.0, 75.0, 90.0, 100.0, 120.0])),
        view_m=float(rng.uniform(9e-3, 2.2e-2)),
        step_s=round(float(rng.uniform(1.2e-4, 1.6e-4)), 7),
    )
    jitter = Jitter.draw(rng, robot)
    plans: list[Plan] = []

    def keep(count: int, draw: Callable[[str], Plan], name: str) -> None:
        for _ in range(count):
            for _ in range(_TRIES):
                plan = draw(f"{name}{1 + sum(p.id.startswith(name) for p in plans)}")
                if not _planned(plan, plans) and _repeats(lab, plan, jitter):
                    plans.append(plan)
                    break

    def duration(frequency: float) -> float:
        # Between 40 and 160 frames, and most of a turn.
        low = max(0.6, 40.0 / lab.frames_per_second, 0.7 / frequency)
        high = max(min(1.6, 160.0 / lab.frames_per_second), low)
        return round(float(rng.uniform(low, high)), 2)

    frequencies = cycle(rng.permutation(_FREQUENCIES_HZ).tolist())
    weight = robot.total_mass_kg * 9.8
    length = float(np.ptp(np.concatenate(robot.body().outline)[:, 1]))
    moment = float(np.linalg.norm(robot.magnetic_moment_A_m2))
    lifting_T = (weight + substrate.electrostatic_force_N) * 0.5 * length / moment

    def speed(name: str) -> Plan:
        frequency = next(frequencies)
        field = RotatingField(strength_T=strength_T, frequency_Hz=frequency)
        return Plan(id=name, field=field, duration_s=duration(frequency))

    def back(name: str) -> Plan:
        plan = speed(name)
        assert isinstance(plan.field, RotatingField)
        return replace(plan, field=replace(plan.field, rotation_axis=(1.0, 0.0, 0.0)))

    def slope(name: str) -> Plan:
        frequency = float(rng.choice([1.0, 1.5, 2.0, 3.0]))
        critical = _slide_deg(substrate.friction_coefficient, substrate.electrostatic_force_N / weight)
        angle = float(rng.choice([rng.uniform(5.0, 40.0), critical * rng.uniform(0.7, 1.15)]))
        field = RotatingField(strength_T=2.0 * strength_T if strength_T < 0.02 else strength_T, frequency_Hz=frequency)
        plan = Plan(id=name, field=field, duration_s=duration(frequency), incline_deg=round(min(angle, 60.0), 1))
        return replace(plan, tracked=False, outcome="climbs") if rng.random() < 0.25 else plan

    def tilt(name: str) -> Plan:
        steepness = radians(float(rng.uniform(35.0, 75.0)))
        way = (0.0, cos(steepness), sin(steepness))
        strength = round(lifting_T * float(rng.uniform(1.2, 3.5)), 6)
        time = duration(2.0)
        if rng.random() < 0.5:
            ramp = round(0.5 * time, 2)
            rows = tuple((0.0, k * strength * way[1], k * strength * way[2]) for k in (0.0, 1.0, 1.0))
            drive: Field = TableField(time_s=(0.0, ramp, time + 0.1), field_T=rows)
            return Plan(id=name, field=drive, duration_s=time, outcome="tilt" if rng.random() < 0.3 else "")
        drive = StaticField(strength_T=strength, direction=way)
        return Plan(id=name, field=drive, duration_s=time, tracked=False, outcome="tilt")

    def low(name: str) -> Plan:
        frequency = float(rng.choice([1.0, 2.0, 3.0]))
        field = RotatingField(strength_T=round(lifting_T * float(rng.uniform(1.1, 2.5)), 6), frequency_Hz=frequency)
        return Plan(id=name, field=field, duration_s=duration(frequency))

    def hold(name: str) -> Plan:
        # No field: does it lie still on the slope?
        area = (0.0 if lab.robot.shape.kind != "cuboid" else substrate.adhesion_N_per_m2) * _face_m2(robot)
        critical = _slide_deg(substrate.friction_coefficient, (substrate.electrostatic_force_N + area) / weight)
        slope_deg = round(critical * float(rng.uniform(0.8, 0.98)), 1)
        drive = StaticField(strength_T=0.0, direction=(0.0, 1.0, 0.0))
        return Plan(id=name, field=drive, duration_s=duration(2.0), incline_deg=slope_deg)

    def mean(name: str) -> Plan:
        return replace(speed(name), tracked=False, outcome="speed")

    keep(int(rng.integers(3, 6)), speed, "speed")
    keep(int(rng.random() < 0.7), back, "back")
    keep(int(rng.integers(1, 4)), slope, "slope")
    keep(int(rng.integers(1, 4)), tilt, "tilt")
    keep(int(rng.random() < 0.75), low, "low")
    keep(int(rng.random() < 0.5), hold, "hold")
    keep(int(rng.integers(0, 3)), mean, "mean")
    return lab.with_plans(tuple(plans)), jitter


def jitter_strength(lab: Lab, jitter: Jitter) -> Strength:
    """Return how much a world without causes shows of its jitter and of its step.

    Parameters
    ----------
    lab, jitter
        What the lab believes, and how far it is off.

    Raises
    ------
    ArithmeticError
        The motion diverged.
    """
    frames = [lab.frames(plan) for plan in lab.plans]
    pairs = list(zip(lab.plans, frames, strict=True))
    nominal = [watch(_finer(lab.scenario(plan)), (), times, solver="reduced") for plan, times in pairs]
    world = [watch(world_scenario(lab, plan, jitter), (), times, solver="reduced") for plan, times in pairs]
    return strength(lab, world, nominal)


def _slide_deg(friction: float, attraction: float) -> float:
    """Return the slope at which μ (cos φ + F/W) = sin φ, at most 80 degrees."""
    slopes = np.radians(np.arange(0.0, 80.0, 0.25))
    holds = friction * (np.cos(slopes) + attraction) >= np.sin(slopes)
    return float(np.degrees(slopes[holds][-1]))


def _face_m2(robot: Robot) -> float:
    x, y, _ = np.ptp(np.concatenate(robot.body().outline), axis=0)
    return float(x * y)


def _planned(plan: Plan, plans: list[Plan]) -> bool:
    def conditions(plan: Plan) -> tuple[object, ...]:
        return plan.field, plan.incline_deg, plan.tracked

    return any(conditions(plan) == conditions(other) for other in plans)


def _repeats(lab: Lab, plan: Plan, jitter: Jitter) -> bool:
    """Return whether the lab's model foretells a trial of the world, and the robot stays where it is seen."""
    alone = lab.with_plans((plan,))
    frames = lab.frames(plan)
    try:
        nominal = watch(_finer(lab.scenario(plan)), (), frames, solver="reduced")
        world = watch(world_scenario(lab, plan, jitter), (), frames, solver="reduced")
    except ArithmeticError:
        return False
    if not _sensible(plan, nominal, lab):
        return False
    return strength(alone, [world], [nominal]).sigma <= STEADY_SIGMA


def _finer(scenario: Scenario) -> Scenario:
    return replace(scenario, run=replace(scenario.run, step_s=FINER * scenario.run.fixed_step_s))


def _sensible(plan: Plan, scene: Scene, lab: Lab) -> bool:
    farthest = np.max(np.abs(scene.poses.position_m), axis=1)
    if plan.outcome == "climbs":
        low, high = _DOUBTFUL
        return not low < climbed_share(scene, lab.way_m(plan)) < high
    if plan.outcome == "tilt" and plan.tracked is False:
        return 2.0 < rest_tilt(scene) < 85.0
    return not plan.tracked or int(np.sum(farthest <= lab.view_m)) >= 40
