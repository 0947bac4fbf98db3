"""The smooth square system of a step on a fixed active set, solved by MINPACK's hybrid method.

An active set is a cell of the body and a regime. With the multipliers in the form without `k` (`λ`, docs/model.md), the
unknowns are `V⁺`, `r = a1 - q⁺`, the `λ` of the cell's surfaces, and in contact `E⁻¹p` (slipping: its direction `d`,
`E⁻¹p = μ p̄ d`, which stays well scaled however small `p_n` is), `p_n` and, slipping, `σ`::

    momentum rows                                                    6
    r = R⁺ s                                    (a vertex s)         3
    f_i(a1) = 0,  Σ λ_i ∇f_i(a1) = -n           (any other cell)     |A| + 3
    z(a1) + δ = 0                               (contact)            1
    E u = 0                                     (stick)              3
    E u + d σ = 0,  |d|² = 1                    (slip)               4

Airborne `p = 0` and `p_n = 0`. The units are `P0`, the impulse of all loads, `U0 = P0/m`, the body's radius and `h`.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from scipy.optimize import nnls, root  # type: ignore[import-untyped, unused-ignore]

from .array import Array
from .cell import Cell
from .friction import slip
from .linearised import Guess, load_impulse, slipping_start
from .problem import NORMAL, StepProblem, Unknowns

Regime = Literal["airborne", "stick", "slip"]

# A surface this near to the closest point takes part in -n = Σ λ ∇f, as a part of the body's radius.
_ON_SURFACE = 1e-12


class ActiveSet:
    """The system of one cell and regime."""

    def __init__(self, problem: StepProblem, cell: Cell, regime: Regime) -> None:
        self.problem, self.cell, self.regime = problem, cell, regime
        self.surfaces = sorted(cell.surfaces)
        self.vertex = cell.kind == "vertex"
        self.multipliers = 0 if self.vertex else len(self.surfaces)
        self.impulse = load_impulse(problem)
        self.speed = self.impulse / problem.mass
        radius = problem.body.radius
        # Of σ and E u; e_r may be far larger than the body, and a spin then counts as a fast slip.
        self.slip_speed = self.speed
        self.unit = np.concatenate([np.full(3, self.speed), np.full(3, self.speed / radius), np.full(3, radius)])

    def pack(self, guess: Guess) -> Array:
        """Scaled unknowns of a guess."""
        problem = self.problem
        parts = [np.concatenate([guess.V, guess.r]) / self.unit]
        if self.multipliers:
            _, gradients = problem.surface_rows(guess.V, problem.pose(guess.V)[0] + guess.r)
            parts.append(np.linalg.lstsq(gradients[self.surfaces].T, -NORMAL)[0])
        if self.regime == "stick":
            scaled = guess.p / (problem.e * self.impulse)
            parts += [scaled, np.array([guess.p_n / self.impulse])]
        elif self.regime == "slip":
            p, p_n, sigma = slipping_start(problem, guess)
            scaled = p / problem.e
            size = float(np.linalg.norm(scaled))
            direction = scaled / size if size > 0.0 else np.array([1.0, 0.0, 0.0])
            self.slip_speed = max(sigma, 1e-3 * self.speed)
            parts += [direction, np.array([p_n / self.impulse, max(sigma / self.slip_speed, 1e-3)])]
        return np.concatenate(parts)

    def unpack(self, x: Array) -> tuple[Array, Array, Array, Array, float, float]:
        """`V`, `r`, `λ`, `p`, `p_n`, `σ` in SI."""
        si, n = x[:9] * self.unit, self.multipliers
        if self.regime == "airborne":
            return si[:6], si[6:], x[9 : 9 + n], np.zeros(3), 0.0, 0.0
        p_n, p = float(x[12 + n]) * self.impulse, x[9 + n : 12 + n] * self.problem.e
        if self.regime == "stick":
            return si[:6], si[6:], x[9 : 9 + n], p * self.impulse, p_n, 0.0
        bound = self.problem.mu * (p_n if self.problem.trial.adhesion_enters == "normal" else p_n + self.problem.p_a)
        return si[:6], si[6:], x[9 : 9 + n], p * bound, p_n, float(x[13 + n]) * self.slip_speed

    def rows(self, x: Array) -> Array:
        """The square system's scaled rows."""
        problem = self.problem
        V, r, multipliers, p, p_n, _ = self.unpack(x)
        radius, moved = problem.body.radius, problem.h * self.speed
        position, rotation = problem.pose(V)
        momentum = problem.momentum(V, r, problem.normal_impulse(p_n), p) / self.impulse
        momentum[3:] /= radius
        parts = [momentum]
        if self.vertex:
            parts.append((r - rotation @ self.cell.points[0]) / radius)
        else:
            local = rotation.T @ r
            on = [problem.body.surfaces[i] for i in self.surfaces]
            parts.append(np.array([surface.value(local) for surface in on]) / radius)
            push = multipliers @ np.array([surface.gradient(local) for surface in on])
            parts.append(rotation @ push + NORMAL)
        if self.regime == "airborne":
            return np.concatenate(parts)
        parts.append(np.array([(position[2] + r[2] + problem.yielded(p_n)) / moved]))
        slipping = problem.e * slip(V, r)
        if self.regime == "stick":
            parts.append(slipping / self.speed)
        else:
            n = self.multipliers
            direction = x[9 + n : 12 + n]
            parts.append(slipping / self.slip_speed + direction * x[13 + n])
            parts.append(np.array([float(direction @ direction) - 1.0]))
        return np.concatenate(parts)

    def solve(self, guess: Guess, thorough: bool = False) -> Unknowns | None:
        """Solution near `guess`, not yet checked for its inequalities; None where the iteration fails.

        `thorough` adds Levenberg and Marquardt's method where the hybrid one fails: slower, and seldom stuck.
        """
        start = self.pack(guess)
        with np.errstate(all="ignore"):
            try:
                found = root(self.rows, start, method="hybr", options={"xtol": 1e-13, "maxfev": 60 * len(start)})
                x = self._newton(np.asarray(found.x))
                if x is None and thorough:
                    found = root(self.rows, start, method="lm", options={"xtol": 1e-13, "ftol": 1e-13, "maxiter": 600})
                    x = self._newton(np.asarray(found.x))
            except (ValueError, np.linalg.LinAlgError):
                return None
        if x is None:
            return None
        V, r, _, p, p_n, sigma = self.unpack(x)
        return complete(self.problem, V, r, p, p_n, sigma, self.cell.surfaces, self.regime != "airborne")

    def _newton(self, x: Array) -> Array | None:
        """A few Newton steps with a central-difference Jacobian: MINPACK's Broyden updates stop at about 1e-9."""
        rows = self.rows(x)
        size = float(np.abs(rows).max())
        if not size < 1e-3:
            return None
        for _ in range(4):
            if size < 1e-14:
                break
            jacobian = np.empty((len(rows), len(x)))
            for j in range(len(x)):
                d = 1e-6 * max(1.0, abs(float(x[j])))
                up, down = x.copy(), x.copy()
                up[j] += d
                down[j] -= d
                jacobian[:, j] = (self.rows(up) - self.rows(down)) / (2.0 * d)
            trial = x - np.linalg.lstsq(jacobian, rows, rcond=1e-13)[0]
            trial_rows = self.rows(trial)
            trial_size = float(np.abs(trial_rows).max())
            if not trial_size < size:
                break
            x, rows, size = trial, trial_rows, trial_size
        return x if size < 1e-8 else None


def complete(
    problem: StepProblem,
    V: Array,
    r: Array,
    p: Array,
    p_n: float,
    sigma: float,
    cell_surfaces: frozenset[int],
    contact: bool,
) -> Unknowns:
    """All unknowns of a solution: `λ` by non-negative least squares, `l_i = λ_i/λ_k`, `l_k = d λ_k`, `l_plane = 1/λ_k`.

    Where more surfaces than three meet in a vertex the multipliers are not unique; these are a basic solution.
    """
    a1 = problem.pose(V)[0] + r
    values, gradients = problem.surface_rows(V, a1)
    near = np.abs(values) <= _ON_SURFACE * problem.body.radius
    near[sorted(cell_surfaces)] = True
    multipliers = np.zeros(len(values))
    multipliers[near] = nnls(gradients[near].T, -NORMAL)[0]
    k = int(np.argmax(multipliers))
    if multipliers[k] <= 0.0:
        multipliers[k] = 1.0
    gap = float(a1[2]) + problem.yielded(p_n)
    a2 = a1 - gap * NORMAL
    ratio = multipliers / multipliers[k]
    ratio[k] = 0.0 if contact and abs(gap) < _ON_SURFACE * problem.body.radius else gap * multipliers[k]
    return Unknowns(V, a1, a2, p, ratio, 1.0 / float(multipliers[k]), sigma, p_n, k)
