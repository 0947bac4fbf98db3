"""`SubstrateTilt`: the substrate leans."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

from .base import Effect
from .parameter import Parameter

if TYPE_CHECKING:
    from ..scenario import Scenario

__all__ = ["SubstrateTilt"]


@dataclass(frozen=True, kw_only=True, slots=True)
class SubstrateTilt(Effect):
    """The substrate leans by an unmeasured slope along x and y, the same in every trial.

    σ' = σ + slope_x, φ' = φ + slope_y, in gravity g (-sin σ, -sin φ cos σ, -cos φ cos σ)

    The field's directions stay fixed to the substrate. Not modelled: a field that stays level while the substrate
    leans, or a slope that changes between trials.

    Source: arithmetic; a stage that was not levelled.

    Attributes
    ----------
    slope_x_deg, slope_y_deg
        Degrees, upwards along +x and +y: 0 is neutral, -10 to 10 plausible.
    """

    name: ClassVar[str] = "substrate_tilt"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(key="slope_x_deg", neutral=0.0, low=-10.0, high=10.0, unit="degrees", meaning="added slope along +x"),
        Parameter(key="slope_y_deg", neutral=0.0, low=-10.0, high=10.0, unit="degrees", meaning="added slope along +y"),
    )
    slope_x_deg: float = 0.0
    slope_y_deg: float = 0.0

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with its slopes changed.

        Parameters
        ----------
        scenario
            What the effect adds to.
        """
        run = scenario.run
        return replace(
            scenario,
            run=replace(
                run,
                side_incline_deg=run.side_incline_deg + self.slope_x_deg,
                incline_deg=run.incline_deg + self.slope_y_deg,
            ),
        )
