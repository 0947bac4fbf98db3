"""`LineContactAdhesion`: an edge in contact holds on."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

from .base import Effect
from .parameter import Parameter

if TYPE_CHECKING:
    from ..scenario import Scenario

__all__ = ["LineContactAdhesion"]


@dataclass(frozen=True, kw_only=True, slots=True)
class LineContactAdhesion(Effect):
    """An edge in contact holds on over a strip of finite width.

    w' = w + width, in F_adh = C w l for a line of length l

    It comes from an edge that is rounded or a substrate that gives way. Not modelled: a strip that depends on the load
    or on the angle of the edge; a point in contact has no adhesion.

    Source: Johnson, Kendall, Roberts 1971, Proc. R. Soc. A 324, 301, for the strip; the paper's climb of 30° on
    aluminium.

    Attributes
    ----------
    width_m
        m: 0 is neutral, 0 to 2e-5 plausible (3 to 9 µm let the paper's cuboid climb 30° of aluminium, as it did).
    """

    name: ClassVar[str] = "line_contact_adhesion"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(
            key="width_m",
            neutral=0.0,
            low=0.0,
            high=2e-05,
            unit="m",
            meaning="width of the strip that holds on",
            least=0.0,
            fine=1e-6,
        ),
    )
    width_m: float = 0.0

    @classmethod
    def ranges(cls, scenario: Scenario) -> tuple[tuple[float, float], ...]:
        """Return the plausible range, and zero alone where the nominal substrate has no adhesion.

        Parameters
        ----------
        scenario
            The nominal scenario.
        """
        return ((0.0, 2e-5),) if scenario.substrate.adhesion_N_per_m2 > 0.0 else ((0.0, 0.0),)

    @classmethod
    def starts(cls, scenario: Scenario) -> tuple[tuple[float, ...], ...]:
        """Return the strips between which the paper's climb lies and a narrow one, and none where nothing adheres.

        Parameters
        ----------
        scenario
            The nominal scenario.
        """
        return ((1e-6,), (3e-6,), (9e-6,)) if scenario.substrate.adhesion_N_per_m2 > 0.0 else ()

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with its strip of contact widened.

        Parameters
        ----------
        scenario
            What the effect adds to.
        """
        substrate = scenario.substrate
        return replace(
            scenario, substrate=replace(substrate, line_contact_width_m=substrate.line_contact_width_m + self.width_m)
        )
