"""Causes that are outside the catalogue: nothing in it has their form."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import cos, pi, radians, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from ..check import Vector
from ..field import RotatingField
from ..robot import Robot
from ..scenario import Scenario
from ..shape import Cuboid, Hull
from .law import Law, State

__all__ = ["OUTSIDE", "Outside"]

_EVERY = 8
Region = Mapping[str, tuple[float, float]]


@dataclass(frozen=True, kw_only=True)
class Outside(Law):
    """A cause that is outside the catalogue.

    Attributes
    ----------
    size
        How much of it there is, from 0 to 1.
    """

    size: float

    def with_size(self, size: float) -> Outside:
        """Return the same cause in another size.

        Parameters
        ----------
        size
            From 0 to 1.
        """
        return replace(self, size=size)

    def parameters(self) -> dict[str, Any]:
        """Return its numbers by name."""
        return {key: list(v) if isinstance(v, tuple) else v for key, v in vars(self).items()}

    def where(self) -> Region:
        """Return the part of the data in which it acts, by the axes of a diagnosis; empty if in all."""
        return {}


def _corners(robot: Robot) -> NDArray[np.float64]:
    points = np.concatenate(robot.body().outline)
    return np.asarray(points[ConvexHull(points).vertices])


def _with_hull(scenario: Scenario, points: NDArray[np.float64]) -> Scenario:
    """Return the scenario with another body of the same mass and the same moment."""
    robot = scenario.robot
    vertices: tuple[Vector, ...] = tuple((x, y, z) for x, y, z in points[np.sort(ConvexHull(points).vertices)].tolist())
    substrate = scenario.substrate
    if not isinstance(robot.shape, Cuboid):
        # The hull's slanted faces touch where the real body has none.
        substrate = replace(substrate, adhesion_N_per_m2=0.0)
    body = replace(
        robot,
        shape=Hull(vertices_m=vertices),
        mass_kg=robot.total_mass_kg,
        magnetic_volume_m3=robot.body().volume_m3 if robot.magnetic_volume_m3 is None else robot.magnetic_volume_m3,
        draft_deg=0.0,
    )
    return replace(scenario, robot=body, substrate=substrate)


@dataclass(frozen=True, kw_only=True)
class BrokenSpike(Outside):
    """A spike has lost its tip, or a cuboid one of its corners: a plane cuts the hull.

    Attributes
    ----------
    direction
        Outward normal of the cut, body frame.
    """

    direction: Vector

    @classmethod
    def draw(cls, rng: np.random.Generator, robot: Robot) -> BrokenSpike:
        """Return one for a robot."""
        corners = _corners(robot)
        if isinstance(robot.shape, Cuboid):
            direction = np.array([rng.choice([-1.0, 0.0, 1.0]) * 0.3, rng.choice([-1.0, 1.0]), rng.choice([-1.0, 1.0])])
            # The cut takes as much of the length as three times that of the height.
            direction[1] /= 3.0
        else:
            direction = corners[np.argmax(corners[:, 2] + 1e-3 * rng.choice([-1.0, 1.0]) * corners[:, 1])]
            direction = np.array([0.0, direction[1], rng.choice([-1.0, 1.0]) * direction[2]])
        x, y, z = (direction / np.linalg.norm(direction)).tolist()
        return cls(size=1.0, direction=(x, y, z))

    def settle(self, scenario: Scenario, trial: int) -> Scenario:  # noqa: ARG002
        """Return the scenario with the cut body."""
        corners = _corners(scenario.robot)
        height = corners @ np.asarray(self.direction)
        depth = self.size * 0.45 * float(height.max())
        limit = float(height.max()) - depth
        kept, lost = corners[height <= limit], corners[height > limit]
        along = (limit - kept @ np.asarray(self.direction))[:, None]
        rise = height[height > limit][None, :] - (kept @ np.asarray(self.direction))[:, None]
        cut = kept[:, None, :] + (along / rise)[:, :, None] * (lost[None, :, :] - kept[:, None, :])
        return _with_hull(scenario, np.concatenate([kept, cut.reshape(-1, 3)]))


@dataclass(frozen=True, kw_only=True)
class DustSpeck(Outside):
    """A speck of dust sticks to a face and stands proud of it by up to 40 µm.

    Attributes
    ----------
    place
        Where on the face, as shares of half the extents along x and y.
    side
        1 for the upper face, -1 for the lower.
    """

    place: tuple[float, float]
    side: float

    @classmethod
    def draw(cls, rng: np.random.Generator, robot: Robot) -> DustSpeck:  # noqa: ARG003
        """Return one for a robot."""
        place = (float(rng.uniform(-0.8, 0.8)), float(rng.choice([-1.0, 1.0]) * rng.uniform(0.2, 0.8)))
        return cls(size=1.0, place=place, side=float(rng.choice([-1.0, 1.0])))

    def settle(self, scenario: Scenario, trial: int) -> Scenario:  # noqa: ARG002
        """Return the scenario with the speck as one more corner of the hull."""
        corners = _corners(scenario.robot)
        half = 0.5 * np.ptp(corners, axis=0)
        x, y = self.place[0] * half[0], self.place[1] * half[1]
        hull = ConvexHull(corners)
        # The plane of the face over (x, y) is the lowest of those that look that way.
        normals, offsets = hull.equations[:, :3], hull.equations[:, 3]
        facing = self.side * normals[:, 2] > 1e-6
        heights = -(offsets[facing] + normals[facing, 0] * x + normals[facing, 1] * y) / normals[facing, 2]
        z = float(heights.min() if self.side > 0.0 else heights.max()) + self.side * (1e-7 + self.size * 4e-5)
        return _with_hull(scenario, np.concatenate([corners, [[x, y, z]]]))


@dataclass(frozen=True, kw_only=True)
class StickySpot(Outside):
    """In one place the substrate holds on to the robot, up to twenty times as much as elsewhere.

    Attributes
    ----------
    place_m
        From where to where along y, m.
    """

    every = _EVERY
    place_m: tuple[float, float]

    @classmethod
    def draw(cls, rng: np.random.Generator, robot: Robot) -> StickySpot:
        """Return one for a robot."""
        length = float(np.ptp(_corners(robot)[:, 1]))
        first = float(rng.uniform(0.5, 2.0)) * length
        return cls(size=1.0, place_m=(first, first + float(rng.uniform(1.0, 2.5)) * length))

    def piece(self, scenario: Scenario, time_s: float, state: State) -> Scenario:  # noqa: ARG002
        """Return the scenario with what holds on here."""
        if not self.place_m[0] <= state["position_m"][1] <= self.place_m[1]:
            return scenario
        substrate, weight = scenario.substrate, scenario.robot.total_mass_kg * scenario.run.gravity_m_per_s2
        more = substrate.electrostatic_force_N + 19.0 * self.size * max(weight, substrate.electrostatic_force_N)
        stickier = replace(
            substrate,
            adhesion_N_per_m2=(1.0 + 19.0 * self.size) * substrate.adhesion_N_per_m2,
            electrostatic_force_N=more,
        )
        return replace(scenario, substrate=stickier)

    def where(self) -> Region:
        """Return the place."""
        return {"position_y_m": self.place_m}


@dataclass(frozen=True, kw_only=True)
class BendingBody(Outside):
    """The body bends: its magnetic axis turns towards the field, by up to 25° at a right angle and at 10 mT."""

    every = 4

    @classmethod
    def draw(cls, rng: np.random.Generator, robot: Robot) -> BendingBody:  # noqa: ARG003
        """Return one for a robot."""
        return cls(size=1.0)

    def piece(self, scenario: Scenario, time_s: float, state: State) -> Scenario:
        """Return the scenario with the axis that this torque makes."""
        axis = np.asarray(scenario.robot.magnetic_axis)
        w, x, y, z = state["orientation"]
        back = np.array([w, -x, -y, -z])
        field = _turn(back, np.asarray(scenario.field.core().at(time_s)))
        bent = axis + self.size * radians(25.0) / 0.010 * (field - (field @ axis) * axis)
        bx, by, bz = (bent / np.linalg.norm(bent)).tolist()
        robot = replace(scenario.robot, magnetization_axis=(bx, by, bz), theta1_deg=None, theta2_deg=None)
        return replace(scenario, robot=robot)


def _turn(q: NDArray[np.float64], v: NDArray[np.float64]) -> NDArray[np.float64]:
    across = 2.0 * np.cross(q[1:], v)
    return np.asarray(v + q[0] * across + np.cross(q[1:], across))


@dataclass(frozen=True, kw_only=True)
class FadingMagnet(Outside):
    """The magnetization fades during each run, by up to 90 % within a second."""

    every = 4 * _EVERY

    @classmethod
    def draw(cls, rng: np.random.Generator, robot: Robot) -> FadingMagnet:  # noqa: ARG003
        """Return one for a robot."""
        return cls(size=1.0)

    def piece(self, scenario: Scenario, time_s: float, state: State) -> Scenario:  # noqa: ARG002
        """Return the scenario with what is left of the moment."""
        left = max(1.0 - 0.9 * self.size * time_s, 0.02)
        robot = replace(scenario.robot, magnetization_A_per_m=left * scenario.robot.magnetization_A_per_m)
        return replace(scenario, robot=robot)


@dataclass(frozen=True, kw_only=True)
class AmplifierDropout(Outside):
    """The amplifier falls short in a part of each cycle, down to nothing.

    Attributes
    ----------
    phase, share
        Where in the cycle it begins, and how much of the cycle it lasts, from 0 to 1.
    """

    every = _EVERY
    phase: float
    share: float

    @classmethod
    def draw(cls, rng: np.random.Generator, robot: Robot) -> AmplifierDropout:  # noqa: ARG003
        """Return one for a robot."""
        return cls(size=1.0, phase=float(rng.uniform(0.0, 1.0)), share=float(rng.uniform(0.1, 0.3)))

    def piece(self, scenario: Scenario, time_s: float, state: State) -> Scenario:  # noqa: ARG002
        """Return the scenario with what there is of its field."""
        field = scenario.field
        if not isinstance(field, RotatingField) or (time_s * field.frequency_Hz - self.phase) % 1.0 > self.share:
            return scenario
        return replace(scenario, field=replace(field, strength_T=(1.0 - self.size) * field.strength_T))

    def where(self) -> Region:
        """Return the part of the cycle."""
        return {"cycle_phase_deg": (360.0 * self.phase, 360.0 * (self.phase + self.share))}


@dataclass(frozen=True, kw_only=True)
class VibratingTable(Outside):
    """The table rocks: the direction of gravity swings by up to 40°.

    Attributes
    ----------
    frequency_Hz
        How fast, Hz.
    phase
        Where in its cycle it starts, rad.
    """

    every = _EVERY
    frequency_Hz: float
    phase: float

    @classmethod
    def draw(cls, rng: np.random.Generator, robot: Robot) -> VibratingTable:  # noqa: ARG003
        """Return one for a robot."""
        return cls(size=1.0, frequency_Hz=float(rng.uniform(10.0, 30.0)), phase=float(rng.uniform(0.0, 2.0 * pi)))

    def piece(self, scenario: Scenario, time_s: float, state: State) -> Scenario:  # noqa: ARG002
        """Return the scenario on the slope of the moment."""
        run = scenario.run
        swing = 40.0 * self.size * sin(2.0 * pi * self.frequency_Hz * time_s + self.phase)
        slope = max(-85.0, min(85.0, run.incline_deg + swing))
        return replace(scenario, run=replace(run, incline_deg=slope))


@dataclass(frozen=True, kw_only=True)
class PhaseJump(Outside):
    """The field's phase jumps in the middle of the run, by up to 150°.

    Attributes
    ----------
    time_s
        When, s.
    forwards
        1 if the field jumps ahead, -1 if it jumps back.
    """

    every = _EVERY
    time_s: float
    forwards: float

    @classmethod
    def draw(cls, rng: np.random.Generator, robot: Robot) -> PhaseJump:  # noqa: ARG003
        """Return one for a robot."""
        return cls(size=1.0, time_s=float(rng.uniform(0.2, 0.5)), forwards=float(rng.choice([-1.0, 1.0])))

    def piece(self, scenario: Scenario, time_s: float, state: State) -> Scenario:  # noqa: ARG002
        """Return the scenario with the field before or after the jump."""
        field = scenario.field
        if not isinstance(field, RotatingField) or time_s < self.time_s:
            return scenario
        angle = radians(150.0 * self.size * self.forwards)
        b0, q = np.asarray(field.initial_direction), np.cross(field.rotation_axis, field.initial_direction)
        x, y, z = (cos(angle) * b0 + sin(angle) * q).tolist()
        return replace(scenario, field=replace(field, initial_direction=(x, y, z)))

    def where(self) -> Region:
        """Return the times after the jump."""
        return {"time_s": (self.time_s, 10.0)}


@dataclass(frozen=True, kw_only=True)
class Gusts(Outside):
    """Gusts of wind push the robot, now this way and now that, with up to three times its weight.

    Attributes
    ----------
    seed
        What the gusts are drawn from.
    """

    seed: int

    @classmethod
    def draw(cls, rng: np.random.Generator, robot: Robot) -> Gusts:  # noqa: ARG003
        """Return one for a robot."""
        return cls(size=1.0, seed=int(rng.integers(2**31)))

    def settle(self, scenario: Scenario, trial: int) -> Scenario:
        """Return the scenario with this trial's gusts."""
        rng = np.random.default_rng([self.seed, trial])
        most = 3.0 * self.size * scenario.robot.total_mass_kg * scenario.run.gravity_m_per_s2
        times: list[float] = []
        rows: list[tuple[float, float, float, float, float, float]] = []
        time = 0.0
        while time < scenario.run.duration_s:
            time += float(rng.exponential(0.12))
            push, way, length = most * rng.uniform(0.3, 1.0), rng.uniform(0.0, 2.0 * pi), rng.uniform(0.02, 0.08)
            times += [time, time + float(length)]
            rows += [(float(push * cos(way)), float(push * sin(way)), 0.0, 0.0, 0.0, 0.0), (0.0,) * 6]
            time += float(length) + 1e-3
        wind = replace(scenario.surroundings, wrench_time_s=tuple(times), wrench_N_N_m=tuple(rows))
        return replace(scenario, surroundings=wind)


@dataclass(frozen=True, kw_only=True)
class FlickeringFrequency(Outside):
    """The field's rotation slows down and speeds up by up to 60° of phase.

    Attributes
    ----------
    frequency_Hz
        How often, Hz.
    """

    every = _EVERY
    frequency_Hz: float

    @classmethod
    def draw(cls, rng: np.random.Generator, robot: Robot) -> FlickeringFrequency:  # noqa: ARG003
        """Return one for a robot."""
        return cls(size=1.0, frequency_Hz=float(rng.uniform(1.3, 4.0)))

    def piece(self, scenario: Scenario, time_s: float, state: State) -> Scenario:  # noqa: ARG002
        """Return the scenario with the field's phase of the moment."""
        field = scenario.field
        if not isinstance(field, RotatingField):
            return scenario
        angle = radians(60.0 * self.size) * sin(2.0 * pi * self.frequency_Hz * time_s)
        b0, q = np.asarray(field.initial_direction), np.cross(field.rotation_axis, field.initial_direction)
        x, y, z = (cos(angle) * b0 + sin(angle) * q).tolist()
        return replace(scenario, field=replace(field, initial_direction=(x, y, z)))


OUTSIDE: dict[str, Callable[[np.random.Generator, Robot], Outside]] = {
    "broken_spike": BrokenSpike.draw,
    "dust_speck": DustSpeck.draw,
    "sticky_spot": StickySpot.draw,
    "bending_body": BendingBody.draw,
    "fading_magnet": FadingMagnet.draw,
    "amplifier_dropout": AmplifierDropout.draw,
    "vibrating_table": VibratingTable.draw,
    "phase_jump": PhaseJump.draw,
    "gusts": Gusts.draw,
    "flickering_frequency": FlickeringFrequency.draw,
}
