"""One step linearised about a guess: its mass matrix, and the friction of one contact on it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq  # type: ignore[import-untyped, unused-ignore]

from .array import Array
from .friction import maximum_dissipation, slip
from .problem import NORMAL, StepProblem
from .rotation import cross


@dataclass(frozen=True, eq=False)
class Guess:
    """A start: `V` (6,), `r` (3,) from the centre of mass [m], `p` (3,), `p_n`, in SI."""

    V: Array
    r: Array
    p: Array
    p_n: float


def load_impulse(problem: StepProblem) -> float:
    """`P0` [N s], the sum of the magnitudes of momentum and loads."""
    trial, radius = problem.trial, problem.body.radius
    magnetic = float(np.linalg.norm(trial.moment)) * float(np.linalg.norm(trial.field.at(problem.time + problem.h)))
    return (
        problem.mass * float(np.linalg.norm(problem.state.velocity))
        + float(np.linalg.norm(problem.spin)) / radius
        + problem.h * (float(np.linalg.norm(problem.force)) + magnetic / radius)
        + problem.p_a
    ) or problem.mass * radius / problem.h


def mass_matrix(problem: StepProblem, V: Array) -> Array:
    """`M` with the magnetic torque's stiffness `-h ∂T/∂ω⁺`, symmetrised, where that is positive definite."""
    matrix = np.zeros((6, 6))
    matrix[:3, :3] = problem.mass * np.eye(3)
    matrix[3:, 3:] = problem.inertia + problem.h * problem.rotational_drag
    d = 1e-4 / problem.h
    slope = np.stack(
        [(problem.torque(V[3:] + e) - problem.torque(V[3:] - e)) / (2.0 * d) for e in d * np.eye(3)], axis=1
    )
    stiff = matrix[3:, 3:] - 0.5 * problem.h * (slope + slope.T)
    if float(np.linalg.eigvalsh(stiff)[0]) > 0.1 * float(np.linalg.eigvalsh(problem.inertia)[0]):
        matrix[3:, 3:] = stiff
    return matrix


def lift(r: Array) -> Array:
    """`[W_t W_o W_r]`, shape (6, 3)."""
    lift = np.zeros((6, 3))
    lift[0, 0] = lift[1, 1] = lift[5, 2] = 1.0
    lift[3:, 0], lift[3:, 1] = [0.0, r[2], -r[1]], [-r[2], 0.0, r[0]]
    return lift


def friction_impulse(problem: StepProblem, inverse: Array, V: Array, r: Array, p_n: float) -> tuple[Array, float]:
    """`p`, shape (3,), and `σ` at `r` for the velocity `V`, shape (6,), without friction, and for `p_n`."""
    scaled_lift = lift(r) * problem.e
    delassus = scaled_lift.T @ inverse @ scaled_lift
    scaled, sigma = maximum_dissipation(delassus, problem.e * slip(V, r), problem.mu * problem.bound(p_n))
    return np.asarray(scaled * problem.e), sigma


def slipping_start(problem: StepProblem, guess: Guess) -> tuple[Array, float, float]:
    """`p`, `p_n`, `σ` of a point contact that moves with the guess's velocity along the normal.

    The root in `p_n` of the normal velocity's change, friction being a function of `p_n`.
    """
    inverse = np.asarray(np.linalg.inv(mass_matrix(problem, guess.V)), dtype=np.float64)
    tangential = lift(guess.r)
    normal = np.concatenate([NORMAL, cross(guess.r, NORMAL)])
    compliance = float(normal @ inverse @ normal) + problem.yielded(1.0) / problem.h
    coupling = np.asarray(tangential.T @ inverse @ normal)
    without = np.asarray(guess.V - inverse @ tangential @ guess.p)

    def friction(p_n: float) -> tuple[Array, float]:
        moved = np.asarray(without + inverse @ normal * (p_n - guess.p_n))
        return friction_impulse(problem, inverse, moved, guess.r, p_n)

    def change(p_n: float) -> float:
        return (p_n - guess.p_n) * compliance + float(coupling @ (friction(p_n)[0] - guess.p))

    high = max(guess.p_n, 1e-6 * load_impulse(problem))
    for _ in range(12):
        if change(high) > 0.0:
            break
        high *= 4.0
    p_n = high
    if change(0.0) < 0.0 < change(high):
        p_n = float(brentq(change, 0.0, high, xtol=1e-12 * high))
    p, sigma = friction(p_n)
    return p, p_n, sigma
