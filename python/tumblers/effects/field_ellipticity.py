"""`FieldEllipticity`: the two phases of the rotating field differ."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

from ..field import RotatingField
from .base import Effect
from .parameter import Parameter

if TYPE_CHECKING:
    from ..scenario import Scenario

__all__ = ["FieldEllipticity"]


@dataclass(frozen=True, kw_only=True, slots=True)
class FieldEllipticity(Effect):
    """The two phases of a rotating field differ in amplitude or are not at 90°.

    B(t)' = B [b0 cos ωt + ρ' (a × b0) sin(ωt + δ')], ρ' = amplitude_ratio ρ, δ' = δ + phase_error

    A static or tabulated field is left as it is. Not modelled: harmonics, an offset of the field, a turned axis.

    Source: arithmetic; coil pairs of different size and current have different gain and lag.

    Attributes
    ----------
    amplitude_ratio
        Second phase over first, no unit: 1 is neutral, 0.6 to 1.6 plausible.
    phase_error_deg
        Degrees by which the second phase is early: 0 is neutral, -30 to 30 plausible.
    """

    name: ClassVar[str] = "field_ellipticity"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            key="amplitude_ratio",
            neutral=1.0,
            low=0.6,
            high=1.6,
            unit="1",
            meaning="amplitude of the second phase over the first",
            least=0.0,
        ),
        Parameter(
            key="phase_error_deg",
            neutral=0.0,
            low=-30.0,
            high=30.0,
            unit="degrees",
            meaning="lead of the second phase over 90°",
        ),
    )
    amplitude_ratio: float = 1.0
    phase_error_deg: float = 0.0

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with its rotating field's second phase changed.

        Parameters
        ----------
        scenario
            What the effect adds to.
        """
        field = scenario.field
        if not isinstance(field, RotatingField):
            return scenario
        ratio = field.quadrature_ratio * self.amplitude_ratio
        phase = field.phase_error_deg + self.phase_error_deg
        return replace(scenario, field=replace(field, quadrature_ratio=ratio, phase_error_deg=phase))
