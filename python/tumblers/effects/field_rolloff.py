"""`FieldRolloff`: the coils' amplitude falls with frequency."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import hypot, pi
from typing import TYPE_CHECKING, ClassVar

from ..field import RotatingField
from .base import Effect
from .parameter import Parameter

if TYPE_CHECKING:
    from ..scenario import Scenario

__all__ = ["FieldRolloff"]


@dataclass(frozen=True, kw_only=True, slots=True)
class FieldRolloff(Effect):
    """The amplitude of a rotating field falls with its frequency, as in coils that are driven by a voltage.

    B' = B / √(1 + (2π f τ)²)

    f is the frequency, τ = L/R. A static or tabulated field is left as it is. Not modelled: the lag, which only moves
    the start of the cycle, coils of different τ (see `field_ellipticity`), and the transient when the field is switched
    on.

    Source: the first-order circuit L dI/dt + R I = U.

    Attributes
    ----------
    time_constant_s
        τ, s: 0 is neutral, 0 to 0.1 plausible.
    """

    name: ClassVar[str] = "field_rolloff"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            key="time_constant_s",
            neutral=0.0,
            low=0.0,
            high=0.1,
            unit="s",
            meaning="inductance over resistance of the coils",
            least=0.0,
        ),
    )
    time_constant_s: float = 0.0

    @classmethod
    def starts(cls, scenario: Scenario) -> tuple[tuple[float, ...], ...]:  # noqa: ARG003
        """Return amplitudes that fall above 30, 8 and 3 Hz.

        Parameters
        ----------
        scenario
            The nominal scenario.
        """
        return ((0.005,), (0.02,), (0.05,))

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with the amplitude of its rotating field lowered.

        Parameters
        ----------
        scenario
            What the effect adds to.
        """
        field = scenario.field
        if not isinstance(field, RotatingField):
            return scenario
        amplitude = field.strength_T / hypot(1.0, 2.0 * pi * field.frequency_Hz * self.time_constant_s)
        return replace(scenario, field=replace(field, strength_T=amplitude))
