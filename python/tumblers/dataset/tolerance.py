"""`Tolerance`: how well a lab knows the numbers of its nominal model."""

from __future__ import annotations

from dataclasses import dataclass, fields

from ..check import number

__all__ = ["Tolerance"]

# Beyond it a number that is off by three of them has no size any more.
_MOST = 0.3


@dataclass(frozen=True, kw_only=True, slots=True)
class Tolerance:
    """One standard deviation of what each nominal number may be off by, as a share of it, the same in all trials.

    What is off by more than three of them is an effect. The defaults are what blind datasets are drawn with, but for
    adhesion and electrostatic force, of which twice as much is assumed.

    Attributes
    ----------
    mass, magnetization, length, height
        Of the robot; `magnetization` is of the magnetic moment, `length` and `height` are along the body's y and z.
    field_strength
        Of the coils.
    friction_coefficient, adhesion, electrostatic_force
        Of the substrate.

    Raises
    ------
    InputError
        A share that is not above 0, or more than 0.3.
    """

    mass: float = 0.005
    magnetization: float = 0.005
    field_strength: float = 0.005
    friction_coefficient: float = 0.005
    adhesion: float = 0.01
    electrostatic_force: float = 0.01
    length: float = 0.001
    height: float = 0.001

    def __post_init__(self) -> None:
        for each in fields(self):
            share = number(f"tolerance.{each.name}", getattr(self, each.name), above=0.0, most=_MOST)
            object.__setattr__(self, each.name, share)
