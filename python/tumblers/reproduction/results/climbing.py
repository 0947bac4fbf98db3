"""Robots on slopes: which of them climb, for the results that ask so."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from ...plots.style import BLUE, ORANGE
from ...presets import drive
from ...progress import OnProgress
from ..batch import mean_speeds
from ..choice import Choices, Ground
from ..tolerance import exact

__all__ = ["YES_NO", "climbed", "climbs", "draw_table", "slopes"]

_FREQUENCY_HZ, _DURATION_S = 1.0, 4.0
# Y is more than half of the way without slip: what holds goes 0.9 to 1.1 of it, and what slides goes back.
_SHARE = 0.5
YES_NO = exact("yes or no; a robot climbs that gets on by more than half of the way without slip in 4 s")


def slopes(
    robots: Sequence[str],
    inclines_deg: Sequence[float],
    ground: Ground,
    choices: Choices,
    threads: int,
    on_progress: OnProgress,
) -> xr.Dataset:
    """Run robots up slopes at 20 mT and 1 Hz for 4 s.

    Parameters
    ----------
    robots, inclines_deg
        Keys of `tumblers.ROBOTS`, and slopes, degrees: each robot on each slope.
    ground, choices
        What they move on, and what else the run depends on.
    threads, on_progress
        As in `tumblers.reproduction.batch.mean_speeds`.

    Returns
    -------
    xarray.Dataset
        ``speed_m_per_s`` (robot, incline_deg) and ``ideal_speed_m_per_s`` (robot), the speed without slip.
    """
    scenarios = [
        choices.scenario(robot, ground, drive(0.020, _FREQUENCY_HZ), duration_s=_DURATION_S, incline_deg=incline)
        for robot in robots
        for incline in inclines_deg
    ]
    shape = (len(robots), len(inclines_deg))
    speeds = mean_speeds(scenarios, threads, on_progress)
    ideal = [scenario.robot.body().hull_perimeter_m * _FREQUENCY_HZ for scenario in scenarios[:: len(inclines_deg)]]
    return xr.Dataset(
        {
            "speed_m_per_s": (("robot", "incline_deg"), speeds.reshape(shape), {"units": "m s-1"}),
            "ideal_speed_m_per_s": ("robot", ideal, {"units": "m s-1"}),
        },
        {"robot": list(robots), "incline_deg": ("incline_deg", list(inclines_deg), {"units": "degree"})},
    )


def climbed(data: xr.Dataset) -> xr.DataArray:
    """Return Y, N, or nothing where the run failed, over robot and slope.

    Parameters
    ----------
    data
        What `slopes` returned.
    """
    yes = data["speed_m_per_s"] > _SHARE * data["ideal_speed_m_per_s"]
    words = np.where(np.isnan(data["speed_m_per_s"]), "diverged", np.where(yes, "Y", "N"))
    return yes.copy(data=words)


def climbs(robot: str, incline_deg: float) -> Callable[[xr.Dataset], str]:
    """Return what reads whether a robot climbs a slope.

    Parameters
    ----------
    robot, incline_deg
        Which of the runs.
    """
    return lambda data: str(climbed(data).sel(robot=robot, incline_deg=incline_deg).item())


def draw_table(data: Mapping[str, xr.Dataset], paper: Mapping[tuple[str, float], str], figure: Figure) -> None:
    """Draw the way made over the way without slip of every robot and slope, with Y and N, one axes to a set.

    Parameters
    ----------
    data
        What `slopes` returned, by the names of the sets.
    paper
        The paper's Y and N by robot and slope, degrees.
    figure
        Empty figure to draw on.
    """
    first = next(iter(data.values()))
    figure.set_size_inches(9.0, 1.5 + 1.1 * first.sizes["robot"])
    axes = figure.subplots(1, len(data), squeeze=False, sharey=True)[0]
    for ax, (name, found) in zip(axes, data.items(), strict=True):
        _draw_one(ax, found, paper)
        ax.set_title(f"{name} parameters", loc="left")
    axes[0].set_yticks(range(first.sizes["robot"]), [str(robot).replace("_", " ") for robot in first["robot"].values])
    figure.suptitle("Mean speed along the slope over the speed without slip; ours / the paper's climbs (Y) or not (N)")


def _draw_one(ax: Axes, found: xr.Dataset, paper: Mapping[tuple[str, float], str]) -> None:
    words = climbed(found)
    inclines = found["incline_deg"].values
    for i, robot in enumerate(found["robot"].values):
        for j, incline in enumerate(inclines):
            ours, said = str(words.values[i, j]), paper[str(robot), float(incline)]
            share = float(found["speed_m_per_s"][i, j] / found["ideal_speed_m_per_s"][i])
            ax.add_patch(_cell(j, i, BLUE if ours == said else ORANGE))
            ax.text(j, i, f"{ours} / {said}\n{share:.3g}", ha="center", va="center", fontsize="small")
    ax.set_xticks(range(len(inclines)), [f"{incline:g}" for incline in inclines])
    ax.set(xlim=(-0.5, len(inclines) - 0.5), ylim=(found.sizes["robot"] - 0.5, -0.5), xlabel="slope (°)")
    ax.tick_params(length=0)


def _cell(column: int, row: int, colour: str) -> Rectangle:
    return Rectangle((column - 0.5, row - 0.5), 1.0, 1.0, facecolor=colour, alpha=0.3, edgecolor="white", linewidth=2.0)
