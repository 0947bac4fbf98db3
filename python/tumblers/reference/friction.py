"""Friction of a step: the Fritz John form of maximum power dissipation over an ellipsoid (docs/model.md).

Equations, with `u = [W_t W_o W_r]ᵀ V⁺` (slip velocities and spin), `E = diag(e_t, e_o, e_r)`, the bound's impulse `p̄`::

    0 = μ e_i² p̄ u_i + p_i σ                          i = t, o, r
    0 ≤ σ ⊥ ξ = (μ p̄)² - |E⁻¹p|² ≥ 0

Hence sticking has `u = 0`, `σ = 0`; slipping has `E⁻¹p = -μ p̄ Eu/|Eu|`, `σ = |Eu|`.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from scipy.optimize import brentq  # type: ignore[import-untyped, unused-ignore]

from .array import Array
from .rotation import cross

AdhesionEnters = Literal["normal", "friction_only"]


def slip(velocity: Array, r: Array) -> Array:
    """`u`, shape (3,) [m/s, m/s, rad/s], of the body's point at `r` from the centre of mass.

    Parameters
    ----------
    velocity : Array, shape (6,)
        `V⁺ = [v; ω]`, substrate frame.
    r : Array, shape (3,)
        `a1 - q⁺` [m], substrate frame.
    """
    spin = cross(velocity[3:], r)
    return np.array([velocity[0] + spin[0], velocity[1] + spin[1], velocity[5]])


def bound_impulse(p_n: float, p_adhesion: float, enters: AdhesionEnters) -> float:
    """`p̄` [N s]: `p_n`, or `p_n + p_a` while `p_n > 0` where adhesion enters friction only."""
    if enters == "normal":
        return p_n
    if enters != "friction_only":
        raise ValueError(f"adhesion_enters: found {enters!r}, expected normal or friction_only")
    return p_n + p_adhesion if p_n > 0.0 else p_n


def fritz_john(mu: float, e: Array, bound: float, u: Array, p: Array, sigma: float) -> Array:
    """The three friction rows, shape (3,), zero at a solution."""
    return np.asarray(mu * bound * e**2 * u + p * sigma)


def slack(mu: float, e: Array, bound: float, p: Array) -> float:
    """`ξ` [N² s²]."""
    scaled = p / e
    return (mu * bound) ** 2 - float(scaled @ scaled)


def maximum_dissipation(delassus: Array, free: Array, bound: float) -> tuple[Array, float]:
    """`π` and `σ` of a linear contact: `υ = A π + υ0`, with `υ = 0` and `|π| ≤ b`, or `υ = -π σ/b` and `|π| = b`.

    With `A = Q Λ Qᵀ` slipping has `π = -Q (Λ + η)⁻¹ Qᵀ υ0`, where `η = σ/b` is the root of `|π(η)| = b`.

    Parameters
    ----------
    delassus : Array, shape (3, 3)
        `A`, symmetric and positive definite [1/kg].
    free : Array, shape (3,)
        `υ0`, scaled slip `E u` without friction [m/s].
    bound : float
        `b = μ p̄` [N s].
    """
    values, vectors = np.linalg.eigh(delassus)
    rotated = vectors.T @ free
    values = np.maximum(values, 1e-14 * values[-1])
    if bound <= 0.0:
        return np.zeros(3), float(np.linalg.norm(free))
    if float(np.linalg.norm(rotated / values)) <= bound:
        return np.asarray(-vectors @ (rotated / values)), 0.0
    top = float(np.linalg.norm(free)) / bound
    eta = brentq(
        lambda e: 1.0 / float(np.linalg.norm(rotated / (values + e))) - 1.0 / bound, 0.0, top, xtol=1e-14 * top
    )
    return np.asarray(-vectors @ (rotated / (values + eta))), float(eta) * bound
