"""`EddyCurrentDrag`: a conducting substrate drags on the moving magnet."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

from .base import Effect
from .parameter import Parameter

if TYPE_CHECKING:
    from ..scenario import Scenario

__all__ = ["EddyCurrentDrag"]


@dataclass(frozen=True, kw_only=True, slots=True)
class EddyCurrentDrag(Effect):
    """A conducting sheet under the robot drags on the moving and turning magnet by its eddy currents.

    T = -κ [M]× G [M]×ᵀ ω, κ = μ0² S / (32π z²), G = diag(1/2, 1/2, 1)
    F = -k v, k = 3 μ0² S (M_z² + (M_x² + M_y²)/2) / (128π z⁴)

    S is the sheet's conductivity times its thickness, M the moment in the substrate frame, z its height: the limit of
    Maxwell's receding images for speeds far below 2/(μ0 S). S' = S + sheet_conductance. A millimetre of aluminium is
    3.5e4 S and does next to nothing to so small a moment: a value that a fit finds tells of some drag that grows with
    M² and falls with the height, seldom of the sheet itself. Not modelled: a sheet thick beside the height, the lift,
    and the torque due to translation.

    Source: Reitz 1970, J. Appl. Phys. 41, 2067: Maxwell's receding images in a thin sheet.

    Attributes
    ----------
    sheet_conductance_S
        S: 0 is neutral, 0 to 3e8 searched.
    """

    name: ClassVar[str] = "eddy_current_drag"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            key="sheet_conductance_S",
            neutral=0.0,
            low=0.0,
            high=3e8,
            unit="S",
            meaning="conductivity times thickness added to the sheet",
            least=0.0,
            fine=3e5,
        ),
    )
    sheet_conductance_S: float = 0.0

    @classmethod
    def starts(cls, scenario: Scenario) -> tuple[tuple[float, ...], ...]:  # noqa: ARG003
        """Return conductances that are apart by factors of ten.

        Parameters
        ----------
        scenario
            The nominal scenario.
        """
        return ((3e5,), (3e6,), (3e7,))

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with a conducting sheet under its robot.

        Parameters
        ----------
        scenario
            What the effect adds to.
        """
        surroundings = scenario.surroundings
        conductance = surroundings.sheet_conductance_S + self.sheet_conductance_S
        return replace(scenario, surroundings=replace(surroundings, sheet_conductance_S=conductance))
