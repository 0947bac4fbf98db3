"""Guesses of what touches at the end of a step.

The body's anchors (corners, lowest points of arcs and ellipsoids) are taken as frictionless point contacts of a step
linearised about the current guess; friction is lagged. Each pass is a least-distance problem::

    min ½ ΔVᵀ M ΔV + ½ δ²h/c   with   z_j + h [n; y_j × n] · ΔV + δ ≥ 0

solved by non-negative least squares (Lawson and Hanson, Solving Least Squares Problems, chapter 23).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls, root  # type: ignore[import-untyped, unused-ignore]

from .array import Array
from .linearised import Guess, friction_impulse, lift, load_impulse, mass_matrix
from .problem import NORMAL, StepProblem
from .rotation import cross


@dataclass(frozen=True, eq=False)
class Prediction:
    """A guess and the surfaces common to all points that carry load; no surface where none is common."""

    surfaces: frozenset[int]
    loaded: bool
    guess: Guess


def free_motion(problem: StepProblem) -> Array:
    """`V⁺`, shape (6,), with neither contact nor adhesion at the closest point.

    A torque at the end of the step that turns the body by more than a radian defeats a single start, and has several
    solutions; the first found from the state, from rest and from growing parts of the first torque's kick counts.
    """
    linear = problem.linear / problem.mass
    unit = load_impulse(problem) / (problem.mass * problem.body.radius)
    scale = problem.mass * problem.body.radius**2 * unit

    def rows(x: Array) -> Array:
        omega = x * unit
        return np.asarray(
            (problem.angular_momentum(omega) - problem.angular - problem.h * problem.torque(omega)) / scale
        )

    first = problem.state.angular_velocity / unit
    kick = np.linalg.solve(problem.inertia, problem.h * problem.torque(problem.state.angular_velocity)) / unit
    best, best_size = first, float("inf")
    for start in [first, 0.0 * first] + [first + part * kick for part in (0.1, 0.25, 0.5, 1.0, -0.25, -1.0, 3.0)]:
        x = np.asarray(root(rows, start, method="hybr", options={"xtol": 1e-14}).x)
        for _ in range(2):
            jacobian = np.stack([(rows(x + d) - rows(x - d)) / 2e-6 for d in 1e-6 * np.eye(3)], axis=1)
            if abs(float(np.linalg.det(jacobian))) > 0.0:
                x = x - np.linalg.solve(jacobian, rows(x))
        size = float(np.abs(rows(x)).max())
        if size < best_size:
            best, best_size = x, size
        if size < 1e-12:
            break
    return np.concatenate([linear, best * unit])


def predictions(problem: StepProblem, free: Array, passes: int = 8) -> list[Prediction]:
    """One prediction a pass, the last first."""
    h, body = problem.h, problem.body
    V, p, ecp = free.copy(), np.zeros(3), np.zeros(3)
    found: list[Prediction] = []
    normal = 0.0
    for _ in range(passes):
        position, rotation = problem.pose(V)
        anchors = list(body.anchors(rotation))
        y = np.array([rotation @ anchor.point for anchor in anchors])
        inverse = np.asarray(np.linalg.inv(mass_matrix(problem, V)), dtype=np.float64)
        factor = np.linalg.cholesky(0.5 * (inverse + inverse.T))
        r = y[int(np.argmin(y[:, 2]))] if normal <= 0.0 else ecp
        adhesion = problem.p_a if problem.adhesion_at_ecp else 0.0
        missing = -problem.momentum(V, r, -adhesion, p)
        V_free = V + inverse @ missing
        jacobian = np.array([np.concatenate([NORMAL, cross(point, NORMAL)]) for point in y])
        lack = -(position[2] + y[:, 2] + h * jacobian @ (V_free - V)) / h
        soft = np.full((len(y), 1), np.sqrt(problem.yielded(1.0) / h))
        impulses, change = _least_distance(np.hstack([jacobian @ factor, soft]), lack - problem.yielded(adhesion) / h)
        V = V_free + factor @ change[:6]
        normal = float(impulses.sum())
        loaded = impulses > 1e-9 * max(normal, 1e-300)
        if normal <= 0.0:
            low = anchors[int(np.argmin(y[:, 2]))]
            found.append(Prediction(low.surfaces, False, Guess(V, y[int(np.argmin(y[:, 2]))], np.zeros(3), 0.0)))
            p = np.zeros(3)
            continue
        ecp = np.asarray(impulses @ y / normal)
        common = frozenset.intersection(*(a.surfaces for a, on in zip(anchors, loaded, strict=True) if on))
        without = np.asarray(V - inverse @ lift(r) @ p)
        p, _ = friction_impulse(problem, inverse, without, ecp, normal + adhesion)
        found.append(Prediction(common, True, Guess(V, ecp, p, normal)))
    return found[::-1]


def _least_distance(rows: Array, bound: Array) -> tuple[Array, Array]:
    """Multipliers, shape (k,), and `x` of `min |x|` with `rows x ≥ bound`; rows (k, n), bound (k,)."""
    if (bound <= 0.0).all():
        return np.zeros(len(bound)), np.zeros(rows.shape[1])
    size_rows, size_bound = float(np.abs(rows).max()), float(np.abs(bound).max())
    matrix = np.vstack([rows.T / size_rows, bound / size_bound])
    target = np.zeros(len(matrix))
    target[-1] = 1.0
    try:
        u, _ = nnls(matrix, target)
    except RuntimeError:
        return np.zeros(len(bound)), np.zeros(rows.shape[1])
    rest = matrix @ u - target
    if abs(float(rest[-1])) < 1e-12:
        return np.zeros(len(bound)), np.zeros(rows.shape[1])
    x = -rest[:-1] / rest[-1] * size_bound / size_rows
    return np.asarray(u / -rest[-1] * size_bound / size_rows**2), x
