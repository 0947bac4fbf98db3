"""A small lab: the paper's cuboid on paper, seen with noise, by a clock and a camera that are slightly off."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import cos, radians, sin
from typing import Any

import numpy as np
import pytest

from tumblers import _core
from tumblers.dataset import Dataset, LabTrial, Outcome, Sensor, Track
from tumblers.diagnosis.fitting.fitter import Fitter
from tumblers.diagnosis.gap.comparison import Comparison, Residual
from tumblers.diagnosis.gap.job import Job
from tumblers.diagnosis.gap.pose import body_axis, heading_of, tilt_of
from tumblers.diagnosis.gap.simulator import LONGEST_STEP_S, Simulator
from tumblers.effects.base import Effect
from tumblers.effects.friction_coefficient import FrictionCoefficient
from tumblers.field import Field, StaticField
from tumblers.model import Model
from tumblers.presets import ROBOTS, SUBSTRATES, drive

# Of a fit whose differences do not matter.
NOTHING = Residual((), *np.empty((4, 0)))

FRAMES_PER_SECOND = 60.0
POSITION_NOISE_M, ANGLE_NOISE_DEG = 3e-6, 1.0

UPWARDS = StaticField(strength_T=0.003, direction=(0.0, 0.0, 1.0))
# Name, field, slope in degrees.
PLANS: tuple[tuple[str, Field, float], ...] = (
    ("f02", drive(0.010, 2.0), 0.0),
    ("f05", drive(0.010, 5.0), 0.0),
    ("f10", drive(0.010, 10.0), 0.0),
    ("s30", drive(0.020, 2.0), 30.0),
    ("still", UPWARDS, 0.0),
)
OFF = StaticField(strength_T=0.0, direction=(0.0, 1.0, 0.0))
# A robot that lies on a slope: it slides where friction is a quarter below the nominal one.
LYING: tuple[tuple[str, Field, float], ...] = (("lying", OFF, 50.0),)


def quiet(_phase: str, _done: int, _total: int) -> None:
    """Tell nobody."""


def rollouts_made(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Count the rollouts of each batch from now on."""
    made: list[int] = []
    native = _core.rollouts

    def rollouts(trials: list[Any], *rest: Any, **more: Any) -> list[Any]:
        made.append(len(trials))
        return list(native(trials, *rest, **more))

    monkeypatch.setattr(_core, "rollouts", rollouts)
    return made


def plan(fields: Sequence[tuple[str, Field, float]] = PLANS, duration_s: float = 0.6) -> Dataset:
    """Return the trials that a lab means to make; nothing has been seen yet but that the robot moved."""
    return Dataset(
        title="a small lab",
        robot=ROBOTS["cuboid"].value,
        substrate=SUBSTRATES["paper"].value,
        model=Model(magnetic_torque="midpoint"),
        sensor=Sensor(position_noise_m=POSITION_NOISE_M, angle_noise_deg=ANGLE_NOISE_DEG),
        trials=tuple(
            LabTrial(id=name, field=field, duration_s=duration_s, incline_deg=slope, outcome=Outcome(climbs=True))
            for name, field, slope in fields
        ),
    )


def measure(
    planned: Dataset,
    effects: tuple[Effect, ...] = (),
    *,
    seed: int = 0,
    clock_frames: float = 0.0,
    origin_m: float = 0.0,
    heading_deg: float = 0.0,
    scale: float = 1.0,
    divisor: int = 4,
    coarse: bool = False,
    quaternions: bool = False,
) -> Dataset:
    """Return what is seen of planned trials: the tracks of a world that has `effects`.

    Parameters
    ----------
    planned
        The trials.
    effects
        What the world has beside the nominal model.
    seed
        Of the noise.
    clock_frames, origin_m, heading_deg, scale
        By how much every track's clock (frames), its origin (m, each trial in its own direction), the camera's heading
        and scale are off.
    divisor
        By how much the world's step is smaller than the model's.
    coarse
        Whether the world is computed in the longest step and, where none is stated, the formats' own torque scheme.
    quaternions
        Whether the camera sees whole orientations, not tilt and heading.
    """
    rng = np.random.default_rng(seed)
    simulator = Simulator(planned, 1)
    edit = simulator.coarse if coarse else None
    paths = simulator.run([Job(i, effects, divisor=divisor, edit=edit) for i in range(len(planned.trials))])
    trials = []
    for path, trial in zip(paths, planned.trials, strict=True):
        assert path is not None
        time = np.arange(0.0, trial.duration_s - 0.01, 1.0 / FRAMES_PER_SECOND)
        place, turned = path.at(time + path.clock_s + clock_frames / FRAMES_PER_SECOND)
        angle, way = radians(heading_deg), rng.uniform(0.0, 2.0 * np.pi)
        x, y = (
            scale * (cos(angle) * place[:, 0] - sin(angle) * place[:, 1]),
            scale * (sin(angle) * place[:, 0] + cos(angle) * place[:, 1]),
        )
        place = np.stack([x + origin_m * cos(way), y + origin_m * sin(way), place[:, 2]])
        place += rng.normal(0.0, POSITION_NOISE_M, place.shape)
        channels = dict(zip(("x_m", "y_m", "z_m"), place, strict=True))
        if quaternions:
            channels |= dict(zip(("qw", "qx", "qy", "qz"), noisy(turned, rng).T, strict=True))
        else:
            axis = body_axis(turned)
            noise = rng.normal(0.0, ANGLE_NOISE_DEG, (2, len(time)))
            channels["tilt_deg"] = np.degrees(tilt_of(axis)) + noise[0]
            wide = np.maximum(0.1, np.cos(tilt_of(axis)))
            channels["heading_deg"] = np.degrees(heading_of(axis)) + heading_deg + noise[1] / wide
        trials.append(replace(trial, outcome=None, track=Track(time_s=time, channels=channels)))
    return replace(planned, trials=tuple(trials))


def noisy(turned: np.ndarray, rng: np.random.Generator) -> np.ndarray:  # type: ignore[type-arg]
    """Return quaternions turned a little about their body's axes."""
    half = 0.5 * np.radians(rng.normal(0.0, ANGLE_NOISE_DEG, (len(turned), 3)))
    w, v = turned[:, :1], turned[:, 1:]
    moved = np.hstack([w - np.sum(v * half, axis=1, keepdims=True), v + w * half + np.cross(v, half)])
    return moved / np.linalg.norm(moved, axis=1, keepdims=True)


def without(dataset: Dataset, trial: str, lost: slice) -> Dataset:
    """Return a dataset in which a trial's frames are lost."""

    def blind(track: Track) -> Track:
        columns = {name: np.array(values) for name, values in track.channels.items()}
        for values in columns.values():
            values[lost] = np.nan
        return Track(time_s=track.time_s, channels=columns)

    trials = tuple(
        replace(t, track=blind(t.track)) if t.id == trial and t.track is not None else t for t in dataset.trials
    )
    return replace(dataset, trials=trials)


def folded(dataset: Dataset, low_deg: float) -> Dataset:
    """Return a dataset whose headings are those of an axis, within half a turn that begins at an angle."""

    def fold(track: Track) -> Track:
        heading = (track.channels["heading_deg"] - low_deg) % 180.0 + low_deg
        return Track(time_s=track.time_s, channels={**track.channels, "heading_deg": heading})

    trials = (replace(t, track=None if t.track is None else fold(t.track)) for t in dataset.trials)
    return replace(dataset, trials=tuple(trials))


def thinned(dataset: Dataset, every: int) -> Dataset:
    """Return a dataset in which one of so many frames is kept of each track."""

    def thin(track: Track) -> Track:
        channels = {name: values[::every] for name, values in track.channels.items()}
        return Track(time_s=track.time_s[::every], channels=channels)

    trials = (trial if trial.track is None else replace(trial, track=thin(trial.track)) for trial in dataset.trials)
    return replace(dataset, trials=tuple(trials))


def coarse_lab(*truth: Effect) -> Fitter:
    """Return what was measured in a fine step, before a nominal model in a step that nothing asked to be shorter."""
    dataset = measure(plan(PLANS[:3]), truth, divisor=16)
    comparison = Comparison(dataset, Simulator(dataset))
    comparison.simulator.step_s = [LONGEST_STEP_S] * len(dataset.trials)
    comparison._start()
    return Fitter(comparison)


def sliding_factor(slope_deg: float = 50.0) -> float:
    """Return a factor of friction with which the body slides by about half its length."""
    simulator = Simulator(plan((("lying", OFF, slope_deg),)))
    low, high = 0.3, 1.0
    for _ in range(20):
        middle = 0.5 * (low + high)
        path = simulator.run([Job(0, (FrictionCoefficient(factor=middle),))])[0]
        assert path is not None
        low, high = (middle, high) if path.position_m[-1, 1] < -4e-4 else (low, middle)
    return low
