"""`Initial`: where and how a run starts."""

from __future__ import annotations

from dataclasses import dataclass

from .check import Vector, unit_quaternion, vector

__all__ = ["Initial"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Initial:
    """State at the start of a run, substrate frame.

    Attributes
    ----------
    position_m
        Centre of mass, m; if None the body rests on the substrate above the origin.
    orientation
        Unit quaternion w, x, y, z, body to substrate; the identity (long axis along +y) if None.
    linear_velocity_m_per_s, angular_velocity_rad_per_s
        Velocity of the centre of mass, m/s, and angular velocity, rad/s.

    Raises
    ------
    InputError
        A number that is refused, or a quaternion that is not of length one.
    """

    position_m: Vector | None = None
    orientation: tuple[float, float, float, float] | None = None
    linear_velocity_m_per_s: Vector = (0.0, 0.0, 0.0)
    angular_velocity_rad_per_s: Vector = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if self.position_m is not None:
            object.__setattr__(self, "position_m", vector("initial.position_m", self.position_m))
        if self.orientation is not None:
            object.__setattr__(self, "orientation", unit_quaternion("initial.orientation", self.orientation))
        for name in ("linear_velocity_m_per_s", "angular_velocity_rad_per_s"):
            object.__setattr__(self, name, vector(f"initial.{name}", getattr(self, name)))
