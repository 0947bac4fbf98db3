"""A substrate whose height varies along y (docs/model.md, "A substrate that is not flat").

Equations::

    h(y) = Σ_k c_k (cos(2π(k+1)y/λ) - 1) + s_k sin(2π(k+1)y/λ),   β = atan h'(y)

A step is solved in the frame of the tangent plane, which `R_x(β)` turns to the substrate's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from .array import Array
from .rotation import axis_angle, product

_X = np.array([1.0, 0.0, 0.0])


@dataclass(frozen=True, eq=False)
class Relief:
    """Heights along y; flat without amplitudes.

    Parameters
    ----------
    wavelength : float
        `λ` [m].
    cosine, sine : Array, shape (n,)
        `c_k`, `s_k` [m].
    """

    wavelength: float = 1.0
    cosine: Array = field(default_factory=lambda: np.zeros(0))
    sine: Array = field(default_factory=lambda: np.zeros(0))

    def _numbers(self) -> Array:
        return np.asarray(2.0 * math.pi * np.arange(1, len(self.cosine) + 1) / self.wavelength)

    def height(self, y: float) -> float:
        """`h(y)` [m]."""
        angles = self._numbers() * y
        return float(self.cosine @ (np.cos(angles) - 1.0) + self.sine @ np.sin(angles))

    def tilt(self, y: float) -> float:
        """`β` [rad] at `y`."""
        numbers = self._numbers()
        return math.atan(
            float((numbers * self.sine) @ np.cos(numbers * y) - (numbers * self.cosine) @ np.sin(numbers * y))
        )

    def to_tangent(self, y: float) -> Array:
        """`R_x(-β)` at `y`, from the substrate's frame to that of the tangent plane, shape (3, 3)."""
        sin, cos = math.sin(self.tilt(y)), math.cos(self.tilt(y))
        return np.array([[1.0, 0.0, 0.0], [0.0, cos, sin], [0.0, -sin, cos]])

    def seen(self, position: Array, quaternion: Array) -> tuple[Array, Array]:
        """A pose in the frame of the tangent plane as it is seen from outside: turned by `R_x(β)` and raised by `h`."""
        y = float(position[1])
        turned = product(axis_angle(_X, self.tilt(y)), quaternion)
        return position + np.array([0.0, 0.0, self.height(y)]), turned
