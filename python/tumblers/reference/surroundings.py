"""What acts on the body beside its weight, the field and the substrate (docs/model.md, "Surroundings").

Equations, with the moment `M` in the substrate frame and the centre of mass at the height `z`::

    F = F_0 + F_i,   T = T_0 + T_i          i: the last row of the table that has begun in the middle of the step
    D = D_r 1 + κ [M]ₓ G [M]ₓᵀ,   κ = μ0² S/(32π z²),   G = diag(1/2, 1/2, 1)
    k = k_0 + 3 μ0² S (M_z² + (M_x² + M_y²)/2)/(128π z⁴)
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from .array import Array
from .rotation import cross

_VACUUM_PERMEABILITY = 4e-7 * math.pi
# Over ℓ: the eddy currents' drag stops growing below this height.
_LOWEST = 0.01


@dataclass(frozen=True, eq=False)
class Surroundings:
    """Forces and drags, substrate frame.

    Parameters
    ----------
    force, torque : Array, shape (3,)
        `F_0` [N], `T_0` [N m].
    translational_drag, rotational_drag : float
        `k_0` [N s/m], `D_r` [N m s].
    sheet_conductance : float
        `S` [S] of a thin sheet at z = 0.
    times : Array, shape (n,)
        When the rows of `wrenches` begin [s].
    wrenches : Array, shape (n, 6)
        `[F_i, T_i]` [N, N m].
    """

    force: Array = field(default_factory=lambda: np.zeros(3))
    torque: Array = field(default_factory=lambda: np.zeros(3))
    translational_drag: float = 0.0
    rotational_drag: float = 0.0
    sheet_conductance: float = 0.0
    times: Array = field(default_factory=lambda: np.zeros(0))
    wrenches: Array = field(default_factory=lambda: np.zeros((0, 6)))

    def wrench(self, time: float) -> tuple[Array, Array]:
        """`F` [N] and `T` [N m], shape (3,) each, at `time` [s]."""
        begun = np.flatnonzero(self.times <= time)
        row = self.wrenches[begun[-1]] if len(begun) else np.zeros(6)
        return self.force + row[:3], self.torque + row[3:]

    def drag(self, moment: Array, height: float, size: float) -> tuple[float, Array]:
        """`k` [N s/m] and `D`, shape (3, 3) [N m s].

        Parameters
        ----------
        moment : Array, shape (3,)
            `M` [A m²], substrate frame.
        height, size : float
            `z` and `ℓ` [m].
        """
        z = max(height, _LOWEST * size)
        images = np.diag([0.5, 0.5, 1.0])
        # The columns of [M]ₓ.
        turned = np.stack([cross(moment, axis) for axis in np.eye(3)], axis=1)
        kappa = _VACUUM_PERMEABILITY**2 * self.sheet_conductance / (32.0 * math.pi * z**2)
        square = float(moment @ images @ moment)
        linear = 3.0 * _VACUUM_PERMEABILITY**2 * self.sheet_conductance * square / (128.0 * math.pi * z**4)
        angular = self.rotational_drag * np.eye(3) + kappa * turned @ images @ turned.T
        return self.translational_drag + linear, np.asarray(angular)
