"""The change of angular momentum in a step (docs/model.md, "The step's mixed complementarity problem").

Equations::

    start, end of step:   ΔL = I^u (ω⁺ - ω) + h ω × I^u ω
    midpoint:             ΔL = C(ω⁺) I^u ω⁺ - C(ω)ᵀ I^u ω,   C(ω)² = Cay(hω/2)
"""

from __future__ import annotations

import numpy as np

from .array import Array
from .magnetics import TorqueTime
from .rotation import cross, half_cayley


def final_momentum(when: TorqueTime, inertia: Array, omega: Array, h: float) -> Array:
    """The part of `ΔL` that depends on `ω⁺`, shape (3,) [N m s]."""
    if when == "midpoint":
        return np.asarray(half_cayley(0.5 * h * omega) @ inertia @ omega)
    return np.asarray(inertia @ omega)


def known_momentum(when: TorqueTime, inertia: Array, omega: Array, h: float) -> Array:
    """The part that `ω` gives, with the sign of a momentum before the step, shape (3,) [N m s]."""
    momentum = np.asarray(inertia @ omega)
    if when == "midpoint":
        return np.asarray(half_cayley(0.5 * h * omega).T @ momentum)
    return np.asarray(momentum - h * cross(omega, momentum))
