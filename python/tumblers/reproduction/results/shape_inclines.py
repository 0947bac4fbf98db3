"""Result 6: four shapes on slopes of aluminium."""

from __future__ import annotations

from collections.abc import Mapping

import xarray as xr
from matplotlib.figure import Figure

from ...progress import OnProgress
from ..choice import Choices
from ..claim import Claim
from ..paper_result import PaperResult
from ..suspect import STANDARD
from .climbing import YES_NO, climbs, draw_table, slopes
from .four_shapes import SHAPES
from .sets import PARAMETERS

__all__ = ["ShapeInclines"]

# slope: what the text says of the cuboid, the spiked, the spiked ends and the curved robot
_PAPER = {20.0: "YYYY", 30.0: "YYYN", 45.0: "NNNN"}


class ShapeInclines(PaperResult):
    """Which slopes of aluminium four shapes climb at 20 mT and 1 Hz."""

    number = 6
    name = "shape_inclines"
    title = "Four shapes on slopes of aluminium, 20 mT at 1 Hz"
    sets = PARAMETERS
    suspects = STANDARD
    runs = len(_PAPER) * len(SHAPES)
    claims = tuple(
        Claim(
            robot=shape,
            quantity=f"climbs {incline:g}°",
            paper=said,
            tolerance=YES_NO,
            measure=climbs(robot, incline),
        )
        for incline, words in _PAPER.items()
        for (shape, robot), said in zip(SHAPES.items(), words, strict=True)
    )

    def simulate(self, choices: Choices, threads: int, on_progress: OnProgress) -> xr.Dataset:
        """Return the speeds of `slopes`."""
        return slopes(list(SHAPES.values()), list(_PAPER), "aluminium", choices, threads, on_progress)

    def figure(self, data: Mapping[str, xr.Dataset], figure: Figure) -> None:
        """Draw the table of shapes and slopes."""
        said = {
            (robot, incline): word
            for incline, words in _PAPER.items()
            for robot, word in zip(SHAPES.values(), words, strict=True)
        }
        draw_table(data, said, figure)
