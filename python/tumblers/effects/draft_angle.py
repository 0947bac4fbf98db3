"""`DraftAngle`: the sides are tapered."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

from ..errors import InputError
from ..robot import Robot
from ..shape import Ellipsoid, Hull
from .base import Effect
from .parameter import Parameter

if TYPE_CHECKING:
    from ..scenario import Scenario

__all__ = ["DraftAngle"]

_DRAFTS_DEG = tuple(0.5 * half for half in range(16, -1, -1))


@dataclass(frozen=True, kw_only=True, slots=True)
class DraftAngle(Effect):
    """The body's sides are tapered: every profile face at x = +W/2 is inset by W tan φ.

    φ' = φ + draft

    Where the density is given instead of the mass, or no magnetic volume, these follow the smaller body. Not modelled:
    a taper that differs between faces, or towards -x. A hull and an ellipsoid take no draft.

    Source: Xie, Bi, Cappelleri, Chakraborty: draft of the sides from two-photon lithography and moulding.

    Attributes
    ----------
    draft_deg
        Degrees: 0 is neutral, 0 to 8 plausible, where the sides do not vanish before (the paper sweeps 0 to 15).
    """

    name: ClassVar[str] = "draft_angle"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            key="draft_deg",
            neutral=0.0,
            low=0.0,
            high=8.0,
            unit="degrees",
            meaning="added draft of the sides",
            least=0.0,
            fine=0.1,
        ),
    )
    draft_deg: float = 0.0

    @classmethod
    def ranges(cls, scenario: Scenario) -> tuple[tuple[float, float], ...]:
        """Return the plausible range as far as the body bears it, and zero alone for a shape that takes no draft.

        Parameters
        ----------
        scenario
            The nominal scenario.
        """
        robot = scenario.robot
        if isinstance(robot.shape, Hull | Ellipsoid):
            return ((0.0, 0.0),)
        return ((0.0, next(draft for draft in _DRAFTS_DEG if draft == 0.0 or _bears(robot, robot.draft_deg + draft))),)

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with its robot's draft increased.

        Parameters
        ----------
        scenario
            What the effect adds to.
        """
        return replace(scenario, robot=scenario.robot.with_draft(scenario.robot.draft_deg + self.draft_deg))


def _bears(robot: Robot, draft_deg: float) -> bool:
    try:
        robot.with_draft(draft_deg).body()
    except InputError:
        return False
    return True
