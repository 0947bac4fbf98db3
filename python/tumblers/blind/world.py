"""The world: steps of the unreduced formulation whose laws may change on the way, and what there is to see of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..field import TableField
from ..scenario import Scenario
from .law import Law, State

__all__ = ["Poses", "Scene", "Solver", "watch"]

Solver = Literal["reduced", "general"]


@dataclass(frozen=True, eq=False, slots=True)
class Poses:
    """Poses of the tracked point, the body's geometric centre, as the camera of the scenario sees them.

    Attributes
    ----------
    position_m, orientation
        Position, m, shape (n, 3), and unit quaternion w, x, y, z, shape (n, 4).
    """

    position_m: NDArray[np.float64]
    orientation: NDArray[np.float64]


@dataclass(frozen=True, eq=False, slots=True)
class Scene:
    """What a run shows at given times.

    Attributes
    ----------
    time_s
        Times, s, shape (n,).
    poses
        The poses at these times.
    before, after
        The poses at the ends of the step that holds each time.
    step_s
        The step, s.
    converged
        Whether every step was solved.
    """

    time_s: NDArray[np.float64]
    poses: Poses
    before: Poses
    after: Poses
    step_s: float
    converged: bool


def watch(
    scenario: Scenario,
    laws: Sequence[Law],
    times_s: NDArray[np.float64],
    *,
    trial: int = 0,
    solver: Solver = "general",
    filmed: bool = True,
) -> Scene:
    """Run a scenario under laws and return its poses at given times.

    A step that the unreduced formulation's solver does not solve is no physics: the run is then made again with the
    reduced one.

    Parameters
    ----------
    scenario
        What the laws start from; its duration is that of the times.
    laws
        The world's laws, in their order.
    times_s
        Increasing times of at least 0, s, shape (n,).
    trial
        The trial's number in its dataset.
    solver
        The solver to try first.
    filmed
        Whether the times are those of the camera's clock, or the field's.

    Raises
    ------
    InputError
        A scenario that the laws make and that is refused.
    ArithmeticError
        The motion diverged.
    """
    if filmed:
        times_s = times_s + _settled(scenario, laws, trial).camera.time_offset_s
        if isinstance(scenario.field, TableField):
            times_s = np.minimum(times_s, scenario.field.time_s[-1])
    scene = _watch(scenario, laws, times_s, trial, solver)
    return scene if scene.converged or solver == "reduced" else _watch(scenario, laws, times_s, trial, "reduced")


def _watch(scenario: Scenario, laws: Sequence[Law], times_s: NDArray[np.float64], trial: int, solver: Solver) -> Scene:
    h = scenario.run.fixed_step_s
    frames = np.maximum(times_s, 0.0)
    first = np.floor(frames / h * (1.0 + 1e-12)).astype(int)
    last = int(first[-1]) + 1
    if isinstance(scenario.field, TableField):
        # What is left of a table after its last whole step is not run.
        last = min(last, int(scenario.field.time_s[-1] / h * (1.0 + 1e-12)))
        first = np.minimum(first, last - 1)
    scenario = replace(scenario, run=replace(scenario.run, duration_s=last * h, output_every_s=None))
    scenario = _settled(scenario, laws, trial)
    exchanging = [law for law in laws if law.every > 0]
    every = min((law.every for law in exchanging), default=last)
    stops = np.unique(np.concatenate([first, first + 1, np.arange(0, last, every), [last]]))

    native = scenario.trial()
    walk = _core.Walk(native, solver)
    states: dict[int, State] = {0: _start(scenario)}
    present, converged, done = scenario, True, 0
    for stop in stops[1:].tolist():
        if exchanging and done % every == 0:
            now = scenario
            for law in exchanging:
                now = law.piece(now, done * h, states[done])
            if now != present:
                present, native = now, now.trial()
        states[stop] = walk.advance(native, stop - done)
        converged = converged and bool(states[stop]["converged"])
        done = stop

    before = _poses(scenario, laws, [states[i] for i in first.tolist()])
    after = _poses(scenario, laws, [states[i + 1] for i in first.tolist()])
    share = np.clip(frames / h - first, 0.0, 1.0)[:, None]
    between = Poses(
        position_m=before.position_m + share * (after.position_m - before.position_m),
        orientation=_normalised(before.orientation + share * (after.orientation - before.orientation)),
    )
    return Scene(times_s, between, before, after, h, converged)


def _settled(scenario: Scenario, laws: Sequence[Law], trial: int) -> Scenario:
    for law in laws:
        scenario = law.settle(scenario, trial)
    return scenario.effective()


def _start(scenario: Scenario) -> State:
    # One step is the shortest run that there is; its first row is the start.
    once = replace(scenario, run=replace(scenario.run, duration_s=scenario.run.fixed_step_s))
    rows = _core.rollouts([once.trial()], [1], 1)[0]
    position, orientation = rows["position_m"][0], rows["orientation"][0]
    still = np.zeros(3)
    return {
        "time_s": 0.0,
        "position_m": position,
        "orientation": orientation,
        "linear_velocity_m_per_s": still,
        "angular_velocity_rad_per_s": still,
        "seen_position_m": position,
        "seen_orientation": orientation,
        "contact_mode": int(rows["contact_mode"][0]),
        "normal_force_N": 0.0,
        "converged": True,
    }


def _poses(scenario: Scenario, laws: Sequence[Law], states: Sequence[State]) -> Poses:
    orientation = np.stack([state["seen_orientation"] for state in states])
    position = np.stack([state["seen_position_m"] for state in states])
    camera = scenario.camera
    position = camera.tracked_position(position, orientation, scenario.robot.center_of_mass_m)
    for law in laws:
        position = law.seen(position)
    return Poses(camera.seen_position(position), _continuous(camera.seen_orientation(orientation)))


def _continuous(orientation: NDArray[np.float64]) -> NDArray[np.float64]:
    flips = np.cumprod(np.where(np.sum(orientation[1:] * orientation[:-1], axis=1) < 0.0, -1.0, 1.0))
    orientation[1:] *= flips[:, None]
    return orientation


def _normalised(orientation: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(orientation / np.linalg.norm(orientation, axis=1, keepdims=True))
