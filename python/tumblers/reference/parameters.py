"""What one simulated run is made of. Units are SI, frames as in docs/model.md."""

from __future__ import annotations

from dataclasses import dataclass
from dataclasses import field as attribute
from typing import Literal

import numpy as np

from .adhesion import patch_at
from .array import Array
from .body import Body
from .field import Field, StaticField
from .friction import AdhesionEnters
from .magnetics import TorqueTime
from .relief import Relief
from .rotation import matrix
from .surroundings import Surroundings

AdhesionActsAt = Literal["ecp", "patch_centroid"]


@dataclass(frozen=True, eq=False)
class State:
    """Pose and velocity.

    Parameters
    ----------
    position : Array, shape (3,)
        `q` [m], substrate frame.
    quaternion : Array, shape (4,)
        `Q`, `w, x, y, z`, body to substrate.
    velocity, angular_velocity : Array, shape (3,)
        `v` [m/s] and `ω` [rad/s], substrate frame.
    """

    position: Array
    quaternion: Array
    velocity: Array = attribute(default_factory=lambda: np.zeros(3))
    angular_velocity: Array = attribute(default_factory=lambda: np.zeros(3))

    @property
    def rotation(self) -> Array:
        """`R`, shape (3, 3)."""
        return matrix(self.quaternion)


@dataclass(frozen=True, eq=False)
class Trial:
    """Robot, substrate, field and run.

    Parameters
    ----------
    body : Body
        Shape.
    mass : float
        `m` [kg].
    moment : Array, shape (3,)
        `V_m |E| u` [A m²], body frame.
    mu : float
        Friction coefficient.
    ellipsoid : Array, shape (3,)
        `e_t`, `e_o` [-], `e_r` [m], all above 0.
    adhesion_coefficient : float
        `C` [N/m²].
    electrostatic_force : float
        `F_elect` [N].
    line_width : float
        `w` [m].
    field : Field
        `B(t)`.
    incline_rad, step, duration : float
        Slope along y `φ` [rad], `h` [s], duration [s].
    torque_time, adhesion_acts_at, adhesion_enters
        The model's switches.
    gravity : float
        `g` [m/s²].
    side_incline_rad : float
        Slope along x `σ` [rad].
    compliance : float
        `c` [m/N].
    relief : Relief
        `h(y)`.
    surroundings : Surroundings
        What else acts.
    friction_drift : float
        `k` [1/s].
    """

    body: Body
    mass: float
    moment: Array = attribute(default_factory=lambda: np.zeros(3))
    mu: float = 0.3
    ellipsoid: Array = attribute(default_factory=lambda: np.array([1.0, 1.0, 1e-4]))
    adhesion_coefficient: float = 0.0
    electrostatic_force: float = 0.0
    line_width: float = 0.0
    field: Field = attribute(default_factory=lambda: StaticField(np.zeros(3)))
    incline_rad: float = 0.0
    step: float = 5e-4
    duration: float = 1.0
    torque_time: TorqueTime = "end_of_step"
    adhesion_acts_at: AdhesionActsAt = "ecp"
    adhesion_enters: AdhesionEnters = "normal"
    gravity: float = 9.8
    side_incline_rad: float = 0.0
    compliance: float = 0.0
    relief: Relief = attribute(default_factory=Relief)
    surroundings: Surroundings = attribute(default_factory=Surroundings)
    friction_drift: float = 0.0

    def friction_at(self, time: float) -> float:
        """`μ(t) = μ max(0, 1 + k t)`."""
        return self.mu * max(0.0, 1.0 + self.friction_drift * time)

    def resting_state(self) -> State:
        """At rest, body axes along the substrate's, the lowest point on the plane."""
        return State(np.array([0.0, 0.0, -self.body.lowest_height(np.eye(3))]), np.array([1.0, 0.0, 0.0, 0.0]))

    def adhesion_at(self, state: State) -> tuple[float, Array]:
        """Adhesion force [N] of the patch that `state` rests on, and its centroid, shape (3,) [m]."""
        patch = patch_at(self.body, state.position, state.rotation)
        return patch.force(self.adhesion_coefficient, self.line_width), patch.centroid(self.line_width)
