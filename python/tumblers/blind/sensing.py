"""What is written down of a scene: noise, lost frames, a clock and a camera that are slightly off."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..camera import Camera
from ..dataset import LabTrial, Outcome, Track
from .lab import Lab, Plan
from .strength import SIGMA_DEG, speed_sigma
from .view import channels_of, climbs, mean_speed, rest_tilt
from .world import Poses, Scene

__all__ = ["Nuisances", "measure"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Nuisances:
    """How far the measurement is off, within the sensor's stated tolerances.

    Attributes
    ----------
    heading_deg, scale
        Of the camera.
    origin_m
        Where each trial's track begins, x and y, m.
    clock_s
        By how much each trial's frames are late, s.
    """

    heading_deg: float
    scale: float
    origin_m: tuple[tuple[float, float], ...]
    clock_s: tuple[float, ...]

    @classmethod
    def draw(cls, rng: np.random.Generator, lab: Lab) -> Nuisances:
        """Return nuisances for a lab.

        Parameters
        ----------
        rng
            Where they come from.
        lab
            The lab.
        """
        origins = np.clip(rng.normal(0.0, 15e-6, size=(len(lab.plans), 2)), -48e-6, 48e-6).tolist()
        late = 0.49 / lab.frames_per_second
        return cls(
            heading_deg=float(np.clip(rng.normal(0.0, 0.7), -1.9, 1.9)),
            scale=float(np.clip(rng.normal(1.0, 0.0015), 0.9952, 1.0048)),
            origin_m=tuple((x, y) for x, y in origins),
            clock_s=tuple(rng.uniform(-late, late, size=len(lab.plans)).tolist()),
        )

    def table(self) -> dict[str, Any]:
        """Return the numbers by name."""
        return asdict(self)


def measure(lab: Lab, number: int, scene: Scene, nuisances: Nuisances, rng: np.random.Generator) -> LabTrial:
    """Return a trial as the lab writes it down.

    Parameters
    ----------
    lab
        The lab.
    number
        The plan's place among the lab's plans.
    scene
        What happened, at the frames' true times.
    nuisances
        How far the measurement is off.
    rng
        Where the noise comes from.
    """
    plan = lab.plans[number]
    camera = Camera(scale=nuisances.scale, heading_deg=nuisances.heading_deg)
    poses = Poses(camera.seen_position(scene.poses.position_m), camera.seen_orientation(scene.poses.orientation))
    seen = Scene(scene.time_s, poses, scene.before, scene.after, scene.step_s, scene.converged)
    return LabTrial(
        id=plan.id,
        field=plan.field,
        incline_deg=plan.incline_deg,
        duration_s=plan.duration_s,
        track=_track(lab, plan, poses, nuisances.origin_m[number], rng) if plan.tracked else None,
        outcome=_outcome(lab, plan, seen, rng),
    )


def _track(lab: Lab, plan: Plan, poses: Poses, origin_m: tuple[float, float], rng: np.random.Generator) -> Track:
    sensor, count = lab.sensor, len(poses.position_m)
    noisy = Poses(
        poses.position_m + np.array([*origin_m, 0.0]) + sensor.position_noise_m * rng.normal(size=(count, 3)),
        _shaken(poses.orientation, np.radians(sensor.angle_noise_deg) * rng.normal(size=(count, 3))),
    )
    true, channels = channels_of(poses), channels_of(noisy)
    for name in ("tilt_deg", "heading_deg"):
        channels[name] = true[name] + sensor.angle_noise_deg * rng.normal(size=count)
    channels["heading_deg"] = (channels["heading_deg"] + 180.0) % 360.0 - 180.0
    lost = rng.random(count) < rng.uniform(0.0, 0.1)
    if rng.random() < 0.2:
        lost[int(count * rng.uniform(0.7, 0.9)) :] = True
    lost |= np.max(np.abs(poses.position_m[:, :2]), axis=1) > lab.view_m
    digits = {"x_m": 9, "y_m": 9, "z_m": 9, "tilt_deg": 4, "heading_deg": 4}
    kept = {n: np.where(lost, np.nan, np.round(channels[n], digits.get(n, 7))) for n in lab.channels}
    return Track(time_s=np.round(lab.frames(plan), 9), channels=kept)


def _shaken(orientation: NDArray[np.float64], turns: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return orientations that are turned by small rotation vectors, rad."""
    angle = np.maximum(np.linalg.norm(turns, axis=1, keepdims=True), 1e-300)
    w, u = np.cos(0.5 * angle), np.sin(0.5 * angle) * turns / angle
    w0, u0 = orientation[:, :1], orientation[:, 1:]
    return np.concatenate([w * w0 - np.sum(u * u0, axis=1, keepdims=True), w * u0 + w0 * u + np.cross(u, u0)], axis=1)


def _outcome(lab: Lab, plan: Plan, scene: Scene, rng: np.random.Generator) -> Outcome | None:
    if plan.outcome == "speed":
        speed = mean_speed(scene, plan.duration_s)
        sigma = float(f"{speed_sigma(speed):.3g}")
        return Outcome(mean_speed_m_per_s=round(speed + sigma * float(rng.normal()), 9), sigma_m_per_s=sigma)
    if plan.outcome == "tilt":
        tilt = rest_tilt(scene) + SIGMA_DEG * float(rng.normal())
        return Outcome(tilt_deg=round(min(max(tilt, -90.0), 90.0), 2), sigma_deg=SIGMA_DEG)
    if plan.outcome == "climbs":
        return Outcome(climbs=climbs(scene, lab.way_m(plan)))
    return None
