"""One step of the simulation: solve its problem, move the pose, find the patch."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .adhesion import ContactMode, Patch, touching_patch
from .array import Array
from .parameters import State, Trial
from .problem import StepProblem
from .rotation import step_quaternion
from .solver import solve


@dataclass(frozen=True, eq=False)
class StepSolution:
    """All unknowns of a step, SI, substrate frame, and what follows from them.

    Parameters
    ----------
    V : Array, shape (6,)
        `V⁺ = [v; ω]` [m/s, rad/s].
    a1, a2 : Array, shape (3,)
        Closest points of the body and of the half-space below the plane [m].
    p : Array, shape (3,)
        `p_t`, `p_o` [N s], `p_r` [N m s].
    l : Array, shape (m,)
        Multipliers of the body's surfaces; entry `k` is a length [m].
    l_plane, sigma, p_n : float
        Multiplier of the plane [-], `σ` [m/s], normal impulse [N s].
    k : int
        Index of the active surface with the largest multiplier.
    residual : float
        Scaled natural residual.
    mode : ContactMode
        At the end of the step.
    next_patch : Patch
        At the end of the step.
    state : State
        At the end of the step.
    candidates : int
        Active sets that were solved.
    """

    V: Array
    a1: Array
    a2: Array
    p: Array
    l: Array  # noqa: E741
    l_plane: float
    sigma: float
    p_n: float
    k: int
    residual: float
    mode: ContactMode
    next_patch: Patch
    state: State
    candidates: int


def step(
    trial: Trial,
    state: State,
    time: float,
    adhesion_force: float = 0.0,
    patch_centroid_world: Array | None = None,
) -> StepSolution:
    """Take one step.

    Parameters
    ----------
    trial : Trial
        Robot, substrate, field and the step's length.
    state : State
        At the start of the step.
    time : float
        `t` [s].
    adhesion_force : float
        `C (A + w ℓ)` of the patch found in the step before [N].
    patch_centroid_world : Array, shape (3,), optional
        Its centroid, substrate frame [m].
    """
    problem = StepProblem(trial, state, time, adhesion_force, patch_centroid_world)
    solution = solve(problem)
    z = solution.unknowns
    position, rotation = problem.pose(z.V)
    if z.p_n > 0.0:
        patch = touching_patch(trial.body, position, rotation, z.a1)
    else:
        patch = Patch(ContactMode.AIRBORNE, 0.0, 0.0, z.a1, z.a1)
    end = State(
        np.asarray(position),
        step_quaternion(state.quaternion, z.V[3:], trial.step),
        z.V[:3].copy(),
        z.V[3:].copy(),
    )
    return StepSolution(
        z.V, z.a1, z.a2, z.p, z.l, z.l_plane, z.sigma, z.p_n, z.k, solution.residual, patch.mode, patch, end,
        solution.candidates,
    )  # fmt: skip
