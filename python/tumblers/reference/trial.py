"""A whole run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .array import Array
from .parameters import State, Trial
from .relief import Relief
from .stepper import StepSolution, step


@dataclass(frozen=True, eq=False)
class Run:
    """Poses and solutions of a run of `n` steps.

    Parameters
    ----------
    times : Array, shape (n + 1,)
        [s].
    states : tuple of State, length n + 1
        The first is the start.
    steps : tuple of StepSolution, length n
        The solution of every step.
    """

    times: Array
    states: tuple[State, ...]
    steps: tuple[StepSolution, ...]

    @property
    def positions(self) -> Array:
        """`q` [m], shape (n + 1, 3), substrate frame."""
        return np.array([state.position for state in self.states])

    @property
    def quaternions(self) -> Array:
        """`Q`, shape (n + 1, 4), body to substrate."""
        return np.array([state.quaternion for state in self.states])

    def seen(self, relief: Relief) -> tuple[Array, Array]:
        """Positions, shape (n + 1, 3) [m], and quaternions, shape (n + 1, 4), as they are seen on `relief`."""
        poses = [relief.seen(state.position, state.quaternion) for state in self.states]
        return np.array([position for position, _ in poses]), np.array([quaternion for _, quaternion in poses])


def run(trial: Trial, start: State | None = None) -> Run:
    """Simulate `trial` from `start`, or from rest with the body's axes along the substrate's.

    The first step's adhesion is that of the patch that the start rests on.
    """
    state = trial.resting_state() if start is None else start
    force, centroid = trial.adhesion_at(state)
    count = round(trial.duration / trial.step)
    states, steps = [state], []
    for i in range(count):
        solution = step(trial, state, i * trial.step, force, centroid)
        state = solution.state
        force = solution.next_patch.force(trial.adhesion_coefficient, trial.line_width)
        centroid = solution.next_patch.centroid(trial.line_width)
        states.append(state)
        steps.append(solution)
    times: Array = np.arange(count + 1, dtype=np.float64) * trial.step
    return Run(times, tuple(states), tuple(steps))
