"""Result 10: four seconds on aluminium with both errors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ...plots.style import BLUE, ORANGE
from ...presets import DRIVES
from ...progress import OnProgress
from ...simulate import simulate
from ..choice import Choices
from ..paper_result import PaperResult
from ..suspect import DRAFT, STANDARD, UNSTATED
from ..tolerance import at_least
from .errors import DRIFT_LIMIT_M, PER_METRE, PRESETS, ROBOTS, claim, robot_words
from .sets import DRAFTS

__all__ = ["FourSeconds"]

_DURATION_S, _PERIOD_S, _EVERY_S = 4.0, 1.0, 1e-2
_THETA1_DEG, _THETA2_DEG, _DRAFT_DEG = 10.0, 0.0, 4.0


def _sideways(data: xr.Dataset) -> float:
    """Return the greatest distance along x from the straight line along y, µm."""
    x = data["position_m"].sel(axis="x").values
    return float(np.abs(x - x[0]).max()) * PER_METRE


def _periodic(data: xr.Dataset) -> float:
    """Return the greatest correlation of the velocity along x with itself one or two cycles later."""
    x = data["position_m"].sel(axis="x").values
    velocity: NDArray[np.float64] = np.diff(x)
    cycle = round(_PERIOD_S / _EVERY_S)
    # A path that does not move has no correlation.
    with np.errstate(invalid="ignore", divide="ignore"):
        return max(float(np.corrcoef(velocity[:-lag], velocity[lag:])[0, 1]) for lag in (cycle, 2 * cycle))


def _greatest_twist(data: xr.Dataset) -> float:
    """Return the greatest |twist| at the end of a cycle, degrees: the turn about y in the swing-twist decomposition."""
    ends = np.arange(1, round(_DURATION_S / _PERIOD_S) + 1) * round(_PERIOD_S / _EVERY_S)
    w, _, y, _ = data["orientation"].values[ends].T
    twist = np.degrees(2.0 * np.arctan2(y, w))
    return float(np.abs((twist + 180.0) % 360.0 - 180.0).max())


class FourSeconds(PaperResult):
    """Paths of both spiked robots, θ1 = 10°, θ2 = 0°, φ = 4°, at 1 Hz for 4 s."""

    number = 10
    name = "four_seconds"
    title = "Four seconds on aluminium, θ1 = 10°, θ2 = 0°, φ = 4°, 1 Hz"
    sets = DRAFTS
    suspects = (*DRAFT, *UNSTATED, *STANDARD)
    runs = len(ROBOTS)
    claims = tuple(
        made
        for robot in ROBOTS
        for made in (
            claim(
                robot,
                "drifts along x: greatest |x| in 4 s, µm",
                "drifts",
                at_least(DRIFT_LIMIT_M * PER_METRE, "beyond the paper's own limit of a straight path"),
                _sideways,
            ),
            claim(
                robot,
                "changes periodically: correlation of the velocity along x with that one or two cycles later",
                "periodic",
                at_least(
                    0.5, "a half; the velocities of two paths that have nothing to do with each other have about none"
                ),
                _periodic,
            ),
            claim(
                robot,
                "twists or flips: greatest |twist| at the end of a cycle, °",
                "twists or flips",
                at_least(1.0, "a degree, the last digit that the text gives of a twist"),
                _greatest_twist,
            ),
        )
    )

    def simulate(self, choices: Choices, threads: int, on_progress: OnProgress) -> xr.Dataset:  # noqa: ARG002
        """Return ``position_m`` and ``orientation`` over ``robot`` and ``time``."""
        runs = []
        for done, robot in enumerate(ROBOTS, start=1):
            scenario = choices.scenario(
                PRESETS[robot],
                "aluminium_pdms",
                DRIVES["20mT_1Hz"].value,
                duration_s=_DURATION_S,
                output_every_s=_EVERY_S,
            )
            erring = scenario.robot.with_draft(_DRAFT_DEG).with_magnetization(_THETA1_DEG, _THETA2_DEG)
            run = simulate(replace(scenario, robot=erring))
            runs.append(run[["position_m", "orientation"]].drop_attrs(deep=False))
            on_progress(done)
        data: xr.Dataset = xr.concat(runs, xr.DataArray(list(ROBOTS), dims="robot", name="robot"))
        return data

    def figure(self, data: Mapping[str, xr.Dataset], figure: Figure) -> None:
        """Draw the paths of the centre of mass from above, travel to the right."""
        figure.set_size_inches(9.0, 6.5)
        axes = figure.subplots(len(ROBOTS), 1, sharex=True)
        cycle = round(_PERIOD_S / _EVERY_S)
        for ax, robot in zip(axes, ROBOTS, strict=True):
            for (name, found), colour, dashes in zip(
                data.items(), (BLUE, BLUE, ORANGE, ORANGE), ("-", "--", "-", "--"), strict=True
            ):
                path = found["position_m"].sel(robot=robot) * PER_METRE
                x, y = path.sel(axis="x"), path.sel(axis="y")
                ax.plot(y, x, dashes, color=colour, label=name)
                ax.plot(y[::cycle], x[::cycle], "o", color=colour, markersize=4)
            ax.axhline(0.0, color="0.7", linewidth=0.8)
            ax.set_title(robot_words(robot), loc="left")
            ax.set_ylabel("x (µm)")
        axes[0].legend(fontsize="small", frameon=False)
        axes[-1].set_xlabel("y (µm), direction of travel; dots: every cycle")
        figure.suptitle(self.title)
