"""MuJoCo's side: a run that follows the field, and its exact replay without an interpreter."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import units
from .case import Case
from .clock import Contestant
from .mujoco_model import Settings, xml
from .scaled import Scaled
from .track import Track, longest_stretch

__all__ = ["VERSION", "Recording", "recorded", "replayed", "stepped", "stretch_on_a_line"]

mujoco: Any = import_module("mujoco")
rollout: Any = import_module("mujoco.rollout")
VERSION: str = mujoco.__version__
_FULL = mujoco.mjtState.mjSTATE_FULLPHYSICS
# Force on the centre of mass in the world, and torque in the body, which cost MuJoCo least.
_APPLIED = int(mujoco.mjtState.mjSTATE_QFRC_APPLIED)

_Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Recording:
    """A run under a torque that followed the robot, step by step.

    Attributes
    ----------
    model
        MuJoCo's model.
    controls
        Force and torque of every step, shape (n, 6).
    track
        Poses after every step.
    contacts
        Number of contacts of every step.
    states, warmstarts
        Before every step, shape (n + 1, ...).
    """

    model: Any
    controls: _Floats
    track: Track
    contacts: NDArray[np.int64]
    states: _Floats
    warmstarts: _Floats

    def part(self, first: int, steps: int) -> Recording:
        """Return a part of the run."""
        last = first + steps
        track = Track(self.track.step_s, self.track.position_m[first:last], self.track.orientation[first:last])
        return Recording(
            self.model,
            self.controls[first:last],
            track,
            self.contacts[first:last],
            self.states[first : last + 1],
            self.warmstarts[first : last + 1],
        )


def recorded(case: Case, settings: Settings, settle_s: float = 0.0) -> Recording:
    """Run a case with the magnetic torque of each step's start, as MuJoCo's callers would.

    Parameters
    ----------
    case, settings
        What is run.
    settle_s
        How long it lies at rest before it gets its velocity, s.
    """
    scenario, scaled = case.scenario, Scaled.of(case)
    model = mujoco.MjModel.from_xml_string(xml(case, settings))
    data = mujoco.MjData(model)
    data.qpos[:3] = scaled.position
    data.qfrc_applied[2] = scaled.attraction
    mujoco.mj_step(model, data, nstep=round(settle_s / scenario.run.step_s))
    data.qvel[:3] += scaled.velocity
    data.time = 0.0

    steps, h, field = case.steps, scenario.run.step_s, scenario.field.core()
    controls = np.zeros((steps, 6))
    poses = np.empty((steps, 7))
    contacts = np.empty(steps, dtype=np.int64)
    states = np.empty((steps + 1, mujoco.mj_stateSize(model, _FULL)))
    warmstarts = np.empty((steps + 1, model.nv))
    rotation = np.empty(9)
    for k in range(steps):
        mujoco.mj_getState(model, data, states[k], _FULL)
        warmstarts[k] = data.qacc_warmstart
        mujoco.mju_quat2Mat(rotation, data.qpos[3:])
        controls[k, 2] = scaled.attraction
        controls[k, 3:] = np.cross(scaled.moment, rotation.reshape(3, 3).T @ np.array(field.at(k * h)))
        data.qfrc_applied[:] = controls[k]
        mujoco.mj_step(model, data)
        poses[k] = data.qpos
        contacts[k] = data.ncon
    mujoco.mj_getState(model, data, states[steps], _FULL)
    warmstarts[steps] = data.qacc_warmstart
    track = Track(h, poses[:, :3] / units.LENGTH, poses[:, 3:])
    return Recording(model, controls, track, contacts, states, warmstarts)


def stretch_on_a_line(recording: Recording) -> Recording:
    """Return the longest stretch of a run with two contacts in every step: a box on an edge."""
    return recording.part(*longest_stretch(recording.contacts == 2))


def replayed(recording: Recording, copies: int, threads: int) -> Contestant:
    """Return ``mujoco.rollout`` of a recorded run, which keeps no states.

    Parameters
    ----------
    recording
        The run.
    copies, threads
        How many times at once, on how many threads.

    Raises
    ------
    RuntimeError
        The replay is another motion than the recorded one.
    """
    model, steps = recording.model, len(recording.controls)
    pool = rollout.Rollout(nthread=0 if threads == 1 else threads)
    data = [mujoco.MjData(model) for _ in range(threads)]

    def tiled(values: _Floats) -> _Floats:
        return np.ascontiguousarray(np.repeat(values[None], copies, axis=0))

    start, warmstart = tiled(recording.states[0]), tiled(recording.warmstarts[0])
    control, models = tiled(recording.controls), [model] * copies
    state = np.empty((copies, steps, start.shape[1]))
    _roll(pool, models, data, steps, start, control, warmstart, state)
    if not np.array_equal(state[:, -1], tiled(recording.states[-1])):
        raise RuntimeError("mujoco.rollout made another motion of the recorded torque")
    return Contestant(lambda: _roll(pool, models, data, steps, start, control, warmstart, None), copies * steps)


def _roll(
    pool: Any,
    models: list[Any],
    data: list[Any],
    steps: int,
    start: _Floats,
    control: _Floats,
    warmstart: _Floats,
    state: _Floats | None,
) -> None:
    pool.rollout(
        models,
        data,
        start,
        control,
        control_spec=_APPLIED,
        skip_checks=True,
        nstep=steps,
        initial_warmstart=warmstart,
        state=state,
    )


def stepped(case: Case, settings: Settings, copies: int) -> Contestant:
    """Return one native ``mj_step`` of many steps, of a robot at rest in no field.

    Parameters
    ----------
    case, settings
        What is run.
    copies
        How many times the case's steps.
    """
    model = mujoco.MjModel.from_xml_string(xml(case, settings))
    data = mujoco.MjData(model)
    data.qfrc_applied[2] = Scaled.of(case).attraction
    steps = copies * case.steps
    return Contestant(lambda: mujoco.mj_step(model, data, nstep=steps), steps)
