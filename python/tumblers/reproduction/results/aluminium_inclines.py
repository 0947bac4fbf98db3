"""Result 4: slopes of aluminium."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import xarray as xr
from matplotlib.figure import Figure

from ...presets import SUBSTRATES
from ...progress import OnProgress
from ..choice import Choices
from ..claim import Claim
from ..paper_result import PaperResult
from ..suspect import STANDARD
from ..tolerance import absolute
from .climbing import YES_NO, climbs, draw_table, slopes
from .sets import PARAMETERS

__all__ = ["AluminiumInclines"]

_ROBOT = "cuboid_second_generation"
_PAPER = {30.0: "Y", 45.0: "N"}
_SEVEN = absolute(0.5, "'almost seven times': what rounds to seven")


def _ratio(name: str) -> Callable[[xr.Dataset], float]:
    return lambda data: float(data[name])


class AluminiumInclines(PaperResult):
    """Which slopes of aluminium the cuboid of the second generation climbs at 20 mT and 1 Hz."""

    number = 4
    name = "aluminium_inclines"
    title = "Slopes of aluminium, 20 mT at 1 Hz"
    sets = PARAMETERS
    suspects = STANDARD
    runs = len(_PAPER)
    claims = (
        *(
            Claim(
                robot="cuboid, second generation",
                quantity=f"climbs {incline:g}°",
                paper=said,
                tolerance=YES_NO,
                measure=climbs(_ROBOT, incline),
            )
            for incline, said in _PAPER.items()
        ),
        Claim(
            robot="cuboid, second generation",
            quantity="adhesion on aluminium over that on paper",
            paper=7.0,
            tolerance=_SEVEN,
            measure=_ratio("adhesion_ratio"),
            note="A ratio of two tables, no simulation.",
        ),
        Claim(
            robot="cuboid, second generation",
            quantity="friction coefficient on aluminium over that on paper",
            paper=7.0,
            tolerance=_SEVEN,
            measure=_ratio("friction_ratio"),
            note="A ratio of two tables, no simulation; the text says 'these values' of both.",
        ),
    )

    def simulate(self, choices: Choices, threads: int, on_progress: OnProgress) -> xr.Dataset:
        """Return the speeds of `slopes`, and ``adhesion_ratio`` and ``friction_ratio`` of aluminium over paper."""
        data = slopes([_ROBOT], list(_PAPER), "aluminium", choices, threads, on_progress)
        metal, paper = (SUBSTRATES[choices.substrate(ground)].value for ground in ("aluminium", "paper"))
        return data.assign(
            adhesion_ratio=metal.adhesion_N_per_m2 / paper.adhesion_N_per_m2,
            friction_ratio=metal.friction_coefficient / paper.friction_coefficient,
        )

    def figure(self, data: Mapping[str, xr.Dataset], figure: Figure) -> None:
        """Draw the table of slopes."""
        draw_table(data, {(_ROBOT, incline): said for incline, said in _PAPER.items()}, figure)
