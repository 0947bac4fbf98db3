"""`SurfaceRoughness`: the substrate is not flat."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from itertools import zip_longest
from math import pi
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from ..check import Vector
from ..errors import InputError, show
from ..relief import Relief
from .base import Effect
from .parameter import Parameter

if TYPE_CHECKING:
    from ..scenario import Scenario

__all__ = ["SurfaceRoughness"]

# Where a relief is shallow, a fit finds its way from one to the next; where it is not, from one of the closer ones; and
# where it is steep enough to hold the robot or let it slide, from a steep one alone: from so many reliefs of all three
# waves with slopes (root mean square) between these, amplitudes beyond their ranges held at the end. With as many a fit
# came near the truth or beyond it in four datasets that have one known.
_WAVELENGTHS_M = (0.7e-3, 1.0e-3, 1.5e-3, 2.2e-3, 3.3e-3, 4.8e-3, 7.0e-3)
_CLOSE_RATIO, _CLOSE_COUNT = 1.217, 13
_RELIEFS, _SLOPES = 256, (0.01, 0.25)


@dataclass(frozen=True, kw_only=True, slots=True)
class SurfaceRoughness(Effect):
    """The substrate is not flat: its height along y is a sum of three waves that are long beside the robot.

    h(y) = Σ_k c_k (cos(2π k y/λ) - 1) + s_k sin(2π k y/λ), k = 1, 2, 3

    The robot touches the tangent plane at its place, and starts at the same place of the relief in every trial. A
    nominal relief of the same wavelength gets the amplitudes added, one of another wavelength is refused. Not
    modelled: heights that vary along x, bumps shorter than the robot or on which it stands on two points, and
    roughness that only changes friction (see `friction_coefficient`).

    Source: Fourier series of a height profile; the roughness of paper is some 10 µm over 1 mm.

    Attributes
    ----------
    wavelength_m
        λ, m: 6e-4 to 8e-3 plausible, without effect where all amplitudes are 0.
    cosine_m, sine_m
        c_k and s_k, m: 0 is neutral, -2e-5 to 2e-5 plausible (paper and milled metal).
    """

    name: ClassVar[str] = "surface_roughness"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            key="wavelength_m",
            neutral=0.002,
            low=0.0006,
            high=0.008,
            unit="m",
            meaning="longest wave of the heights",
            above=0.0,
            always=True,
        ),
        Parameter(
            key="cosine_m[0]", neutral=0.0, low=-2e-05, high=2e-05, unit="m", meaning="cosine amplitude of wave 1"
        ),
        Parameter(
            key="cosine_m[1]", neutral=0.0, low=-2e-05, high=2e-05, unit="m", meaning="cosine amplitude of wave 2"
        ),
        Parameter(
            key="cosine_m[2]", neutral=0.0, low=-2e-05, high=2e-05, unit="m", meaning="cosine amplitude of wave 3"
        ),
        Parameter(key="sine_m[0]", neutral=0.0, low=-2e-05, high=2e-05, unit="m", meaning="sine amplitude of wave 1"),
        Parameter(key="sine_m[1]", neutral=0.0, low=-2e-05, high=2e-05, unit="m", meaning="sine amplitude of wave 2"),
        Parameter(key="sine_m[2]", neutral=0.0, low=-2e-05, high=2e-05, unit="m", meaning="sine amplitude of wave 3"),
    )
    wavelength_m: float = 2.0e-3
    cosine_m: Vector = (0.0, 0.0, 0.0)
    sine_m: Vector = (0.0, 0.0, 0.0)

    def is_neutral(self) -> bool:
        """Whether all amplitudes are zero, whatever the wavelength is."""
        return not any((*self.cosine_m, *self.sine_m))

    @classmethod
    def starts(cls, scenario: Scenario) -> tuple[tuple[float, ...], ...]:  # noqa: ARG003
        """Return wavelengths over the range, each with a small first wave: none of them tells of its neighbours.

        Parameters
        ----------
        scenario
            The nominal scenario.
        """
        return tuple((wavelength, 0.0, 0.0, 0.0, 5e-6, 0.0, 0.0) for wavelength in _WAVELENGTHS_M)

    @classmethod
    def close_starts(cls, scenario: Scenario) -> tuple[tuple[float, ...], ...]:  # noqa: ARG003
        """Return more wavelengths, each with a smaller first wave, and reliefs of all three waves.

        Parameters
        ----------
        scenario
            The nominal scenario.
        """
        wavelengths = (_WAVELENGTHS_M[0] * _CLOSE_RATIO**k for k in range(_CLOSE_COUNT))
        waves = tuple((wavelength, 0.0, 0.0, 0.0, 2e-6, 0.0, 0.0) for wavelength in wavelengths)
        return waves + _reliefs(tuple((p.low, p.high) for p in cls.parameters))

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with its substrate's heights added.

        Parameters
        ----------
        scenario
            What the effect adds to.
        """
        relief = scenario.relief
        if not any((*relief.cosine_m, *relief.sine_m)):
            relief = Relief(wavelength_m=self.wavelength_m, cosine_m=self.cosine_m, sine_m=self.sine_m)
            return replace(scenario, relief=relief)
        if relief.wavelength_m != self.wavelength_m:
            expected = f"{relief.wavelength_m:g}, that of the relief that is there already"
            raise InputError(f"{self.name}.wavelength_m", show(self.wavelength_m), expected)
        relief = replace(relief, cosine_m=_sum(relief.cosine_m, self.cosine_m), sine_m=_sum(relief.sine_m, self.sine_m))
        return replace(scenario, relief=relief)


@cache
def _reliefs(ranges: tuple[tuple[float, float], ...]) -> tuple[tuple[float, ...], ...]:
    """Return reliefs over the logarithms of wavelength and slope, and over the waves' shares of it (Sobol 1967)."""
    # What only a diagnosis needs is not loaded with every simulation.
    from scipy.stats import qmc

    (shortest, longest), (gentle, steep) = ranges[0], _SLOPES
    # The same for every diagnosis, whatever its seed is: they are starts, as the wavelengths are.
    drawn = qmc.Sobol(1 + len(ranges), rng=np.random.default_rng(0)).random(_RELIEFS)
    wavelength = shortest * (longest / shortest) ** drawn[:, 0]
    slope = gentle * (steep / gentle) ** drawn[:, 1]
    # The mean square of the slope is half of the sum of the waves' squares.
    shares = 2.0 * drawn[:, 2:] - 1.0
    shares /= np.sqrt(0.5 * np.sum(shares**2, axis=1, keepdims=True))
    number = np.tile(np.arange(1, 4), 2)
    amplitudes = shares * (slope * wavelength / (2.0 * pi))[:, None] / number
    low, high = np.transpose(ranges[1:])
    points = np.column_stack([wavelength, np.clip(amplitudes, low, high)])
    return tuple(tuple(point) for point in points.tolist())


def _sum(first: tuple[float, ...], second: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(a + b for a, b in zip_longest(first, second, fillvalue=0.0))
