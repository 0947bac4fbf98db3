"""`Relief`: the heights of a substrate that is not flat."""

from __future__ import annotations

from dataclasses import dataclass

from .check import number, sequence
from .errors import InputError

__all__ = ["Relief"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Relief:
    """Height of the substrate along y, in waves that are long beside the robot.

    h(y) = Σ_k c_k (cos(2π(k+1)y/λ) - 1) + s_k sin(2π(k+1)y/λ), so that h(0) = 0. The robot touches the tangent plane at
    its place.

    Attributes
    ----------
    wavelength_m
        λ, the longest wave, m.
    cosine_m, sine_m
        Amplitudes c_k and s_k, m, both of shape (n,).

    Raises
    ------
    InputError
        A number that is refused, or lists of different length.
    """

    wavelength_m: float = 2.0e-3
    cosine_m: tuple[float, ...] = ()
    sine_m: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "wavelength_m", number("relief.wavelength_m", self.wavelength_m, above=0.0))
        for name in ("cosine_m", "sine_m"):
            amplitudes = sequence(f"relief.{name}", getattr(self, name), "a list of numbers", number)
            object.__setattr__(self, name, amplitudes)
        if len(self.sine_m) != len(self.cosine_m):
            found, expected = f"{len(self.sine_m)} amplitudes", f"{len(self.cosine_m)}, as many as in cosine_m"
            raise InputError("relief.sine_m", found, expected)
