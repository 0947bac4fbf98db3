"""How far two solutions of one step are apart, against how far two solutions may be."""

from __future__ import annotations

import numpy as np

from tumblers.reference import StepProblem, Unknowns, residual
from tumblers.reference.array import Array
from tumblers.reference.residual import scales

# What a step has to reach in the scaled natural residual.
REQUIRED = 1e-10
# Residuals below this are rounding.
_ROUNDING = 1e-13
# A step's equations have this condition at most: ℓ² over the least squared radius of gyration is up to 40, and the
# arms of a small p_n multiply it.
_CONDITION = 1e3
_TOUCHING = 1e-9


def full_residual(problem: StepProblem, z: Unknowns) -> float:
    """Return the residual in the reference's rows, and `f_k(a1) = 0`, which they leave to the pair of `l_k`."""
    inside, *_ = problem.complements(z)
    return max(residual(problem, z), abs(float(inside[z.k])) / problem.body.radius)


def normal_cone(z: Unknowns) -> Array:
    """Return the multipliers in the form without `k`, `Σ λ_i ∇f_i = -n`."""
    weights = z.l.copy()
    weights[z.k] = 1.0
    return np.asarray(weights / z.l_plane)


def same_motion(problem: StepProblem, z: Unknowns, other: Unknowns) -> bool:
    """Return whether both have the same `V⁺`: there may be several, and everything else follows from it."""
    return all(excess <= 1.0 for excess in _motion(problem, z, other).values())


def differences(problem: StepProblem, z: Unknowns, other: Unknowns) -> dict[str, float]:
    """Return the unknowns that differ by more than two solutions of the same contact may, and how many times more."""
    excess = {**_motion(problem, z, other), **_contact(problem, z, other)}
    return {name: float(value) for name, value in excess.items() if not value <= 1.0}


def _slack(problem: StepProblem, z: Unknowns, other: Unknowns) -> tuple[float, float]:
    """Return the errors that the residuals allow, of the equations and of `E⁻¹p`, both over `P`.

    The equations are linear in their errors. Of the friction only `ξ = (μ p̄)² - |E⁻¹p|²`, over `P²`, is as small as
    the residual ε, so that `E⁻¹p` is known to `ε / 2μp̄`, and to `√ε` where `p̄ = 0`.
    """
    impulse, _ = scales(problem, other)
    error = full_residual(problem, z) + full_residual(problem, other) + _ROUNDING
    bound = problem.mu * problem.bound(min(z.p_n, other.p_n)) / impulse
    friction = min(np.sqrt(error), error / (2.0 * bound) if bound > 0.0 else np.inf)
    return _CONDITION * error, friction


def _motion(problem: StepProblem, z: Unknowns, other: Unknowns) -> dict[str, float]:
    """Return `V⁺`'s difference over what an impulse of the size of the slack does to the body."""
    error, friction = _slack(problem, z, other)
    impulse, speed = scales(problem, other)
    length = problem.body.radius
    push = 2.0 * impulse * friction * max(problem.e[:2])
    twist = push * length + 2.0 * impulse * friction * problem.e[2]
    lightest = float(np.linalg.eigvalsh(problem.inertia)[0])
    return {
        "v": float(np.abs(z.V[:3] - other.V[:3]).max() / (error * speed + push / problem.mass)),
        "ω": float(np.abs(z.V[3:] - other.V[3:]).max() / (error * speed / length + 4.0 * twist / lightest)),
    }


def _contact(problem: StepProblem, z: Unknowns, other: Unknowns) -> dict[str, float]:
    error, friction = _slack(problem, z, other)
    impulse, speed = scales(problem, other)
    length, e = problem.body.radius, problem.e
    moved = error + friction * (1.0 + e[2] / length)
    inside, *_ = problem.complements(other)
    # ECP times N is what the moments know.
    carried = abs(problem.normal_impulse(other.p_n)) / impulse if other.p_n > 0.0 else 1.0
    place = moved * length / max(carried, 1e-12)
    slip = speed * moved * max(1.0, e[2] / length)
    excess = {
        "p_t, p_o": np.abs(z.p[:2] - other.p[:2]).max() / (impulse * (error + friction)),
        "p_r": abs(z.p[2] - other.p[2]) / (impulse * (error * length + friction * e[2])),
        "p_n": abs(z.p_n - other.p_n) / (impulse * moved),
        "a1 - a2": abs((z.a1 - z.a2 - other.a1 + other.a2)[2]) / (length * moved),
    }
    bound = problem.mu * problem.bound(other.p_n) / impulse
    if bound > 0.0:
        # σ is known from p σ alone, and without a bound on the friction it is anything.
        slip += error / bound * max(speed, other.sigma)
        excess["σ"] = abs(z.sigma - other.sigma) / slip
    if not (other.p_n == 0.0 and _level(problem, other)):
        # In the air every point of a level face or edge is a closest one.
        excess["a1"] = np.abs(z.a1 - other.a1).max() / place
        excess["a2"] = np.abs(z.a2 - other.a2).max() / place
    if (np.abs(inside) <= _TOUCHING * length).sum() <= 3 and "a1" in excess:
        # Where more than three surfaces meet the multipliers are not unique.
        cones = normal_cone(z), normal_cone(other)
        turned = moved / min(max(carried, 1e-12), 1.0)
        excess["l"] = np.abs(cones[0] - cones[1]).max() / turned
        if cones[1][other.k] - cones[1][z.k] > turned:
            excess["k"] = np.inf
    return excess


def _level(problem: StepProblem, z: Unknowns) -> bool:
    """Return whether several points of the body are the lowest."""
    _, rotation = problem.pose(z.V)
    heights = np.array([rotation[2] @ anchor.point for anchor in problem.body.anchors(rotation)])
    return bool((heights <= heights.min() + _TOUCHING * problem.body.radius).sum() > 1)
