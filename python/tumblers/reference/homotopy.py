"""The full problem by smoothing: a Fischer-Burmeister homotopy in a trust-region least-squares solver.

Equations: every pair `0 ≤ a ⊥ b ≥ 0` becomes `φ_ε(a, b) = a + b - sqrt(a² + b² + 2ε²) = 0`, whose solutions with
`ε > 0` have `a, b > 0` and `a b = ε²`; `max_i f_i` becomes `ε ln Σ exp(f_i/(ε ℓ))`. `ε` falls to 0 by decades, each
solution starting the next. Nothing is known beforehand of what touches or slips.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from scipy.optimize import least_squares  # type: ignore[import-untyped, unused-ignore]
from scipy.special import logsumexp  # type: ignore[import-untyped, unused-ignore]

from .active_set import complete
from .array import Array
from .linearised import Guess, load_impulse
from .problem import StepProblem, Unknowns

_SMOOTHING = (1e-1, 1e-2, 1e-3, 1e-4, 1e-6)


class Smoothed:
    """The full problem in scaled unknowns for a fixed index `k`."""

    def __init__(self, problem: StepProblem, k: int) -> None:
        self.problem, self.k = problem, k
        self.impulse = load_impulse(problem)
        self.speed = self.impulse / problem.mass
        radius, m = problem.body.radius, len(problem.body.surfaces)
        self.m = m
        multipliers = np.ones(m)
        multipliers[k] = radius
        self.unit = np.concatenate(
            [
                np.full(3, self.speed),
                np.full(3, self.speed / radius),
                np.full(6, radius),
                problem.e * self.impulse,
                multipliers,
                [1.0, self.speed, self.impulse],
            ]
        )
        self.origin = np.zeros(len(self.unit))
        self.origin[6:12] = np.tile(problem.state.position, 2)

    def pack(self, z: Unknowns) -> Array:
        """Scaled unknowns."""
        flat = np.concatenate([z.V, z.a1, z.a2, z.p, z.l, [z.l_plane, z.sigma, z.p_n]])
        return np.asarray((flat - self.origin) / self.unit)

    def unpack(self, x: Array) -> Unknowns:
        """Unknowns in SI."""
        y, m = x * self.unit + self.origin, self.m
        tail = (float(y[15 + m]), float(y[16 + m]), float(y[17 + m]))
        return Unknowns(y[:6], y[6:9], y[9:12], y[12:15], y[15 : 15 + m], *tail, self.k)

    def rows(self, x: Array, smoothing: float) -> Array:
        """Scaled rows, shape (18 + m,), of the smoothed problem."""
        problem, radius, z = self.problem, self.problem.body.radius, self.unpack(x)
        momentum, gap, direction, friction = problem.equations(z)
        inside, below, xi, _ = problem.complements(z)
        reach, _ = problem.surface_rows(z.V, z.a2)
        outside = smoothing * float(logsumexp(reach / (radius * smoothing)))
        multipliers = x[15 : 15 + self.m]
        return np.concatenate(
            [
                momentum[:3] / self.impulse,
                momentum[3:] / (self.impulse * radius),
                gap / radius,
                direction,
                friction / (problem.e * self.impulse * self.speed),
                _fischer(multipliers, inside / radius, smoothing),
                _fischer(
                    np.array([z.l_plane, x[16 + self.m], x[17 + self.m]]),
                    np.array([below / radius, xi / self.impulse**2, outside]),
                    smoothing,
                ),
            ]
        )

    def track(self, start: Unknowns, smoothing: Sequence[float] = _SMOOTHING) -> Unknowns:
        """Follow the smoothed problem's solution from `start`."""
        x = self.pack(start)
        for value in smoothing:
            x = least_squares(self.rows, x, method="trf", x_scale="jac", max_nfev=60, args=(value,)).x
        return self.unpack(x)


def _fischer(a: Array, b: Array, smoothing: float) -> Array:
    return np.asarray(a + b - np.sqrt(a * a + b * b + 2.0 * smoothing**2))


def approximations(problem: StepProblem, guesses: Sequence[Guess]) -> Iterator[Unknowns]:
    """An approximate solution from every guess, the index `k` that of the multiplier that is largest there."""
    for guess in guesses:
        _, rotation = problem.pose(guess.V)
        low = min(problem.body.anchors(rotation), key=lambda anchor: float(rotation[2] @ anchor.point))
        start = complete(problem, guess.V, rotation @ low.point, guess.p, guess.p_n, 0.0, low.surfaces, False)
        # Inner points of the orthant: a zero pair is where the smoothed function bends most.
        start = replace(start, l=np.maximum(start.l, 0.01 * Smoothed(problem, start.k).unit[15 : 15 + len(start.l)]))
        found = Smoothed(problem, start.k).track(start)
        yield found
        weights = found.l.copy()
        weights[found.k] = 1.0
        k = int(np.argmax(weights))
        if k != found.k:
            moved = found.l / weights[k]
            moved[found.k], moved[k] = 1.0 / weights[k], found.l[found.k] * weights[k]
            start = replace(found, l=moved, l_plane=found.l_plane / float(weights[k]), k=k)
            yield Smoothed(problem, k).track(start, _SMOOTHING[2:])
