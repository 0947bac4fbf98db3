"""Result 2: slopes of paper."""

from __future__ import annotations

from collections.abc import Mapping

import xarray as xr
from matplotlib.figure import Figure

from ...progress import OnProgress
from ..choice import Choices
from ..claim import Claim
from ..paper_result import PaperResult
from ..suspect import STANDARD
from ..tolerance import exact
from .climbing import YES_NO, climbed, climbs, draw_table, slopes
from .sets import PARAMETERS

__all__ = ["PaperInclines"]

_PAPER = {5.0: "Y", 10.0: "Y", 15.0: "Y", 30.0: "Y", 45.0: "Y", 60.0: "N"}


def _steepest(data: xr.Dataset) -> float:
    up = data["incline_deg"].values[climbed(data).sel(robot="cuboid").values == "Y"]
    return float(up.max(initial=0.0))


class PaperInclines(PaperResult):
    """Which slopes of paper the cuboid climbs at 20 mT and 1 Hz."""

    number = 2
    name = "paper_inclines"
    title = "Slopes of paper, 20 mT at 1 Hz"
    sets = PARAMETERS
    suspects = STANDARD
    runs = len(_PAPER)
    claims = (
        *(
            Claim(
                robot="cuboid",
                quantity=f"climbs {incline:g}°",
                paper=said,
                tolerance=YES_NO,
                measure=climbs("cuboid", incline),
            )
            for incline, said in _PAPER.items()
        ),
        Claim(
            robot="cuboid",
            quantity="steepest of these slopes that is climbed, °",
            paper=45.0,
            tolerance=exact("one of the six slopes"),
            measure=_steepest,
        ),
    )

    def simulate(self, choices: Choices, threads: int, on_progress: OnProgress) -> xr.Dataset:
        """Return the speeds of `slopes`."""
        return slopes(["cuboid"], list(_PAPER), "paper", choices, threads, on_progress)

    def figure(self, data: Mapping[str, xr.Dataset], figure: Figure) -> None:
        """Draw the table of slopes."""
        draw_table(data, {("cuboid", incline): said for incline, said in _PAPER.items()}, figure)
