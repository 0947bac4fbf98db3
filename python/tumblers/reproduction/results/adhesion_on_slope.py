"""Result 3: adhesion over time on a slope of paper."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ...plots.style import BLUE, ORANGE
from ...presets import drive
from ...progress import OnProgress
from ...simulate import CONTACT_MODES, simulate
from ..choice import Choices
from ..claim import Claim
from ..paper_result import PaperResult
from ..suspect import STANDARD
from ..tolerance import absolute, exact
from .sets import PARAMETERS

__all__ = ["AdhesionOnSlope"]

_CYCLES = 4
# Shares of the greatest force: W × H is an eighth of L × W, and a line has no area.
_LARGE_FACE, _LINE = 0.5, 0.01


def _forces(data: xr.Dataset) -> NDArray[np.float64]:
    # The first row is before any step.
    return np.asarray(data["adhesion_force_N"].values[1:])


def _large(data: xr.Dataset) -> float:
    return float(_forces(data).max())


def _small(data: xr.Dataset) -> float:
    """Return the median of the forces that are above a line's and well below the large face's."""
    forces = _forces(data)
    greatest = forces.max()
    small = forces[(forces > _LINE * greatest) & (forces < _LARGE_FACE * greatest)]
    return float(np.median(small)) if small.size else float("nan")


def _line(data: xr.Dataset) -> float:
    line = data["contact_mode"].values == CONTACT_MODES.index("line")
    forces = data["adhesion_force_N"].values[line]
    return float(np.median(forces)) if forces.size else float("nan")


def _periodic(data: xr.Dataset) -> str:
    """Return Y where two successive turns after the first have the same force in 95 % of their steps."""
    force = data["adhesion_force_N"].values[1:]
    turn = len(force) // _CYCLES
    before, after = force[turn : 2 * turn], force[2 * turn : 3 * turn]
    same = np.isclose(before, after, rtol=0.0, atol=0.05 * force.max())
    return "Y" if force.max() > 0.0 and same.mean() >= 0.95 else "N"


class AdhesionOnSlope(PaperResult):
    """Adhesion over time, the cuboid up paper at 45°, 20 mT at 1 Hz."""

    number = 3
    name = "adhesion_on_slope"
    title = "Adhesion over time, paper at 45°, 20 mT at 1 Hz"
    sets = PARAMETERS
    suspects = STANDARD
    runs = 1
    claims = (
        Claim(
            robot="cuboid",
            quantity="adhesion with L × W on the slope, N",
            paper=3.8e-7,
            tolerance=absolute(0.05e-7, "half of the last digit given"),
            measure=_large,
        ),
        Claim(
            robot="cuboid",
            quantity="adhesion with W × H on the slope, N",
            paper=4.7e-8,
            tolerance=absolute(
                0.1e-8, "one of the last digit given: W × H times C is 4.76e-8, which the text cuts off"
            ),
            measure=_small,
        ),
        Claim(
            robot="cuboid",
            quantity="adhesion with a line on the slope, N",
            paper=0.0,
            tolerance=absolute(0.04e-7, "'almost zero': 1 % of the greatest"),
            measure=_line,
        ),
        Claim(
            robot="cuboid",
            quantity="the force changes periodically",
            paper="Y",
            tolerance=exact("yes or no; the second and the third turn agree in 95 % of their steps"),
            measure=_periodic,
        ),
    )

    def simulate(self, choices: Choices, threads: int, on_progress: OnProgress) -> xr.Dataset:  # noqa: ARG002
        """Return ``adhesion_force_N`` and ``contact_mode`` over ``time``."""
        scenario = choices.scenario("cuboid", "paper", drive(0.020, 1.0), duration_s=float(_CYCLES), incline_deg=45.0)
        run = simulate(scenario)
        on_progress(1)
        return run[["adhesion_force_N", "contact_mode"]].drop_attrs(deep=False)

    def figure(self, data: Mapping[str, xr.Dataset], figure: Figure) -> None:
        """Draw the force over time, with the paper's two values."""
        figure.set_size_inches(9.0, 2.4 * len(data))
        axes = figure.subplots(len(data), 1, squeeze=False, sharex=True)[:, 0]
        for ax, (name, found) in zip(axes, data.items(), strict=True):
            ax.plot(found["time"][1:], found["adhesion_force_N"][1:] * 1e7, color=BLUE, linewidth=0.9, label="ours")
            for value in (3.8, 0.47):
                ax.axhline(
                    value, color=ORANGE, linestyle="--", linewidth=0.9, label="the paper's" if value > 1 else None
                )
            ax.set_title(f"{name} parameters", loc="left")
            ax.set_ylabel("adhesion (1e-7 N)")
        axes[0].legend(loc="upper right", fontsize="small")
        axes[-1].set_xlabel("time (s)")
        figure.suptitle(self.title)
