"""The full mixed complementarity problem of one step, unreduced (docs/model.md).

Unknowns `u_z = [V⁺; a1; a2; p_t; p_o; p_r]` and `v_z = [l_1..l_m; l_plane; σ; p_n]`, with `r = a1 - q⁺`,
`C_F = ∇f_k(a1) + Σ_{i≠k} l_i ∇f_i(a1)` and `C_G = l_plane n`::

    0 = M (V⁺ - V) + h [k v⁺; D ω⁺] - W_n N - W_t p_t - W_o p_o - W_r p_r - h [F_ext; T] + h [0; ω × Iω]
        + [p_a n; (c - q)×n p_a]*
    0 = a1 - a2 + l_k C_F
    0 = C_F + C_G
    0 = μ e_i² p̄ u_i + p_i σ
    0 ≤ l_i ⊥ -f_i(a1) ≥ 0,   0 ≤ l_plane ⊥ -g(a2) ≥ 0,   0 ≤ σ ⊥ ξ ≥ 0,   0 ≤ p_n ⊥ max_i f_i(a2) ≥ 0

with `g(a2) = z(a2) + δ`, the plane having yielded by `δ = c p_n/h`.

(* where adhesion acts at the patch centroid; there and for `friction_only` `N = p_n`, otherwise `N = p_n - p_a`.)
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .array import Array
from .field import TurnedField
from .friction import bound_impulse, fritz_john, slack, slip
from .magnetics import step_torque
from .momentum import final_momentum, known_momentum
from .parameters import State, Trial
from .rotation import cayley, cross

NORMAL = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class Unknowns:
    """Everything that a step solves for, SI, substrate frame.

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
    l_plane : float
        Multiplier of the plane.
    sigma : float
        `σ` [m/s].
    p_n : float
        Normal impulse [N s].
    k : int
        Index of the active surface with the largest multiplier.
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


class StepProblem:
    """One step's problem.

    Parameters
    ----------
    trial : Trial
        Robot, substrate, field.
    state : State
        At the start of the step.
    time : float
        `t` [s].
    adhesion_force : float
        `C (A + w ℓ)` of the patch found in the step before [N].
    patch_centroid : Array, shape (3,), optional
        Its centroid, substrate frame [m].
    """

    def __init__(
        self, trial: Trial, state: State, time: float, adhesion_force: float = 0.0, patch_centroid: Array | None = None
    ) -> None:
        self.trial, self.state, self.time, self.body = trial, state, time, trial.body
        self.h, self.mu, self.e = trial.step, trial.friction_at(time + 0.5 * trial.step), trial.ellipsoid
        self.p_a = trial.step * adhesion_force
        self.centroid = patch_centroid
        self.rotation = state.rotation
        self.inertia = trial.mass * self.rotation @ trial.body.inertia_per_mass @ self.rotation.T
        turn = trial.relief.to_tangent(float(state.position[1]))
        push, twist = trial.surroundings.wrench(time + 0.5 * trial.step)
        self.force = turn @ (_weight(trial) + push) - trial.electrostatic_force * NORMAL
        omega, field = state.angular_velocity, TurnedField(trial.field, turn)
        magnetic = step_torque(trial.torque_time, trial.moment, self.rotation, omega, field, time, trial.step)
        self.torque: Callable[[Array], Array] = lambda omega_end: magnetic(omega_end) + turn @ twist
        moment, height = self.rotation @ trial.moment, float(state.position[2])
        drag, self.rotational_drag = trial.surroundings.drag(moment, height, trial.body.radius)
        # What a change of v⁺ takes.
        self.mass = trial.mass + self.h * drag
        self.spin = self.inertia @ omega
        linear = trial.mass * state.velocity + self.h * self.force
        angular = known_momentum(trial.torque_time, self.inertia, omega, self.h)
        self.adhesion_at_ecp = trial.adhesion_enters == "normal" and trial.adhesion_acts_at == "ecp"
        if trial.adhesion_enters == "normal" and trial.adhesion_acts_at == "patch_centroid" and self.p_a > 0.0:
            if patch_centroid is None:
                raise ValueError("patch_centroid: found none, expected the centroid of the patch that adheres")
            linear = linear - self.p_a * NORMAL
            angular = angular - self.p_a * cross(patch_centroid - state.position, NORMAL)
        elif trial.adhesion_acts_at not in ("ecp", "patch_centroid"):
            raise ValueError(f"adhesion_acts_at: found {trial.adhesion_acts_at!r}, expected ecp or patch_centroid")
        # What the momentum would be after the step without contact and magnetic torque.
        self.linear, self.angular = linear, angular

    def angular_momentum(self, omega: Array) -> Array:
        """What the momentum rows count of `ω⁺` [N m s]."""
        kept = final_momentum(self.trial.torque_time, self.inertia, omega, self.h)
        return np.asarray(kept + self.h * self.rotational_drag @ omega)

    def yielded(self, p_n: float) -> float:
        """`δ` [m], how far the plane has yielded under `p_n`."""
        return self.trial.compliance * p_n / self.h

    def normal_impulse(self, p_n: float) -> float:
        """`N`, the normal impulse at `a1` [N s]."""
        return p_n - self.p_a if self.adhesion_at_ecp else p_n

    def bound(self, p_n: float) -> float:
        """`p̄`, the impulse in the friction bound [N s]."""
        return bound_impulse(p_n, self.p_a, self.trial.adhesion_enters)

    def pose(self, V: Array) -> tuple[Array, Array]:
        """`q⁺`, shape (3,), and `R⁺`, shape (3, 3)."""
        return self.state.position + self.h * V[:3], cayley(0.5 * self.h * V[3:]) @ self.rotation

    def momentum(self, V: Array, r: Array, normal: float, p: Array) -> Array:
        """The six momentum rows [N s, N m s] for `r = a1 - q⁺` and `N = normal`."""
        impulse = np.array([p[0], p[1], normal])
        moment = cross(r, impulse)
        moment[2] += p[2]
        linear = self.mass * V[:3] - self.linear - impulse
        angular = self.angular_momentum(V[3:]) - self.angular - self.h * self.torque(V[3:]) - moment
        return np.concatenate([linear, angular])

    def surface_rows(self, V: Array, point: Array) -> tuple[Array, Array]:
        """All `f_i`, shape (m,) [m], and `∇f_i`, shape (m, 3), at `point`, substrate frame, at the end of the step."""
        position, rotation = self.pose(V)
        local = rotation.T @ (point - position)
        return self.body.values(local), self.body.gradients(local) @ rotation.T

    def equations(self, z: Unknowns) -> tuple[Array, Array, Array, Array]:
        """Rows of the four equations: momentum (6,), `a1 - a2 + l_k C_F` (3,), `C_F + C_G` (3,), Fritz John (3,)."""
        r = z.a1 - self.pose(z.V)[0]
        _, gradients = self.surface_rows(z.V, z.a1)
        weights = z.l.copy()
        weights[z.k] = 1.0
        c_f = weights @ gradients
        return (
            self.momentum(z.V, r, self.normal_impulse(z.p_n), z.p),
            z.a1 - z.a2 + z.l[z.k] * c_f,
            c_f + z.l_plane * NORMAL,
            fritz_john(self.mu, self.e, self.bound(z.p_n), slip(z.V, r), z.p, z.sigma),
        )

    def complements(self, z: Unknowns) -> tuple[Array, float, float, float]:
        """What is complementary to `l` (m,), `l_plane`, `σ` and `p_n`: `-f(a1)`, `-g(a2)`, `ξ`, `max f(a2)`."""
        values, _ = self.surface_rows(z.V, z.a1)
        reach, _ = self.surface_rows(z.V, z.a2)
        return (
            -values,
            -float(z.a2[2]) - self.yielded(z.p_n),
            slack(self.mu, self.e, self.bound(z.p_n), z.p),
            float(reach.max()),
        )


def _weight(trial: Trial) -> Array:
    """`m g (-sin σ, -sin φ cos σ, -cos φ cos σ)` [N], shape (3,)."""
    phi, sigma, weight = trial.incline_rad, trial.side_incline_rad, trial.mass * trial.gravity
    down = [math.sin(sigma), math.sin(phi) * math.cos(sigma), math.cos(phi) * math.cos(sigma)]
    return np.asarray(-weight * np.array(down))
