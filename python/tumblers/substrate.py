"""`Substrate`: friction, adhesion, electrostatic attraction and compliance."""

from __future__ import annotations

from dataclasses import dataclass

from .check import Vector, number, vector

__all__ = ["Substrate"]

_NOT_NEGATIVE = (
    "friction_coefficient",
    "adhesion_N_per_m2",
    "electrostatic_force_N",
    "line_contact_width_m",
    "compliance_m_per_N",
)


@dataclass(frozen=True, kw_only=True, slots=True)
class Substrate:
    """What the robot stands on.

    Attributes
    ----------
    friction_coefficient
        μ of the paper; where it drifts, at the start.
    friction_ellipsoid
        e_t, e_o (no unit) and e_r (m). The default e_r of 0.1 m is that of the authors' released code.
    adhesion_N_per_m2
        C of the paper, N per m² of area that really touches.
    electrostatic_force_N
        F_elect of the paper, N, towards the substrate.
    line_contact_width_m
        Width of the strip that counts as area where a line touches, m; 0 is the paper's model.
    compliance_m_per_N
        How far the plane yields per normal force, m/N; 0 is the paper's rigid plane.
    friction_drift_per_s
        k of μ(t) = μ max(0, 1 + k t), 1/s, with t from the start of the trial; 0 is the paper's constant friction.

    Raises
    ------
    InputError
        A number that is refused.
    """

    friction_coefficient: float
    friction_ellipsoid: Vector = (1.0, 1.0, 0.1)
    adhesion_N_per_m2: float = 0.0
    electrostatic_force_N: float = 0.0
    line_contact_width_m: float = 0.0
    compliance_m_per_N: float = 0.0
    friction_drift_per_s: float = 0.0

    def __post_init__(self) -> None:
        for name in _NOT_NEGATIVE:
            object.__setattr__(self, name, number(f"substrate.{name}", getattr(self, name), least=0.0))
        drift = number("substrate.friction_drift_per_s", self.friction_drift_per_s)
        object.__setattr__(self, "friction_drift_per_s", drift)
        ellipsoid = vector("substrate.friction_ellipsoid", self.friction_ellipsoid)
        for i, axis in enumerate(ellipsoid):
            number(f"substrate.friction_ellipsoid[{i}]", axis, above=0.0)
        object.__setattr__(self, "friction_ellipsoid", ellipsoid)
