"""The scaled natural residual of a step (docs/model.md, "Scaled natural residual").

Equations::

    P = m|v| + |Iω|/ℓ + h|F_ext| + h|T|/ℓ + p_a + |N| + |p_t| + |p_o|
    U = |v⁺| + ℓ|ω⁺| + P/(m + hk)

`f_k(a1) = 0` makes `k` active. Momentum rows over `P` and `Pℓ`, `a1 - a2 + l_k C_F` over `ℓ`, `C_F + C_G` over
`l_plane`, friction row `i` over `e_i P max(U, σ)`; of the complementary pairs the lesser of `l_i` (`l_k/ℓ`) and
`-f_i/ℓ`, of `l_plane` and `-g/ℓ`, of `σ/U` and `ξ/P²`, of `p_n/P` and `max f/ℓ`.
"""

from __future__ import annotations

import numpy as np

from .array import Array
from .problem import StepProblem, Unknowns

# A body at rest with no load at all has P = U = 0.
_TINY = 1e-100


def scales(problem: StepProblem, z: Unknowns) -> tuple[float, float]:
    """`P` [N s] and `U` [m/s]."""
    length, h, mass = problem.body.radius, problem.h, problem.mass
    impulse = (
        problem.trial.mass * float(np.linalg.norm(problem.state.velocity))
        + float(np.linalg.norm(problem.spin)) / length
        + h * float(np.linalg.norm(problem.force))
        + h * float(np.linalg.norm(problem.torque(z.V[3:]))) / length
        + problem.p_a
        + abs(problem.normal_impulse(z.p_n))
        + abs(float(z.p[0]))
        + abs(float(z.p[1]))
    )
    speed = float(np.linalg.norm(z.V[:3])) + length * float(np.linalg.norm(z.V[3:])) + impulse / mass
    return max(impulse, _TINY), max(speed, _TINY)


def residual_rows(problem: StepProblem, z: Unknowns) -> Array:
    """All scaled rows, shape (19 + m,): 15 equations, `f_k`, `m` pairs of surfaces, plane, friction, contact."""
    length = problem.body.radius
    impulse, speed = scales(problem, z)
    momentum, gap, direction, friction = problem.equations(z)
    inside, below, xi, outside = problem.complements(z)
    multipliers = z.l.copy()
    multipliers[z.k] /= length
    return np.concatenate(
        [
            momentum[:3] / impulse,
            momentum[3:] / (impulse * length),
            gap / length,
            direction / z.l_plane,
            friction / (problem.e * impulse * max(speed, z.sigma)),
            np.minimum(multipliers, inside / length),
            [
                inside[z.k] / length,
                min(z.l_plane, below / length),
                min(z.sigma / speed, xi / impulse**2),
                min(z.p_n / impulse, outside / length),
            ],
        ]
    )


def residual(problem: StepProblem, z: Unknowns) -> float:
    """Greatest absolute scaled row; infinite where a row is not a number."""
    if z.l_plane <= 0.0:
        return float("inf")
    rows = np.abs(residual_rows(problem, z))
    return float(rows.max()) if np.isfinite(rows).all() else float("inf")
