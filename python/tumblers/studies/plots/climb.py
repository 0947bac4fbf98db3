"""Figure of `climb`: speed against slope."""

from __future__ import annotations

from math import isnan

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...plots.style import BLUE, GREEN, ORANGE, PER_METRE, legend_above, titled_figure
from ...scenario import Scenario
from ...sweep import ideal_speed

__all__ = ["plot_climb"]

# What slides back does so a thousand times as fast as anything climbs: it stands at the edge of the scale.
_LOWEST = -0.35


def plot_climb(climb: xr.Dataset, figure: Figure | None = None) -> Figure:
    """Draw speed (µm/s) against slope (°), what was climbed, the limit found and the closed forms.

    Robots that slide back faster than a third of the speed without slip are drawn at the lower edge.

    Parameters
    ----------
    climb
        Result of `tumblers.climb`.
    figure
        Empty figure to draw on, whose size is set here; a new one of pyplot if None.

    Returns
    -------
    matplotlib.figure.Figure
        The figure drawn on.
    """
    figure = titled_figure(figure, (9.0, 5.4), "Climbing", climb)
    ax = figure.subplots()
    ideal = (ideal_speed(Scenario.from_toml(climb.attrs["scenario"])) or np.nan) * PER_METRE
    slopes, climbs = climb["incline_deg"].values, climb["climbs"].values.astype(bool)
    speed = climb["speed_m_per_s"].values * PER_METRE
    lowest = _LOWEST * ideal
    fast = ~climbs & ~(speed > lowest)
    ax.axhline(ideal, color="0.6", linewidth=0.9, label="without slip")
    ax.axhline(0.0, color="0.6", linewidth=0.9, linestyle=":")
    ax.plot(slopes[climbs], speed[climbs], "o", color=BLUE, markersize=5, zorder=4, label="climbs")
    slow = ~climbs & ~fast
    ax.plot(slopes[slow], speed[slow], "x", color=ORANGE, markersize=7, zorder=4, label="does not climb")
    ax.plot(
        slopes[fast],
        np.full(fast.sum(), 0.93 * lowest),
        "v",
        color=ORANGE,
        markersize=6,
        label="slides back faster",
    )
    _limits(ax, climb)
    highest = 1.15 * max(float(np.nanmax(speed[climbs], initial=0.0)), ideal)
    ax.set(xlim=(-1.0, 90.0), ylim=(lowest, highest), xlabel="slope (°)", ylabel="mean speed up the slope (µm/s)")
    ax.set_xticks(range(0, 91, 10))
    legend_above(ax, ncols=4)
    first = climb.attrs["settling_cycles"] + 1
    ax.set_title(f"Cycles {first} to {first + climb.attrs['cycles'] - 1}", loc="left")
    return figure


def _limits(ax: Axes, climb: xr.Dataset) -> None:
    attrs = climb.attrs
    lines = []
    if not isnan(attrs["limit_deg"]) and not isnan(attrs["limit_above_deg"]):
        words = "limit" if attrs["monotone"] else "first limit"
        middle = 0.5 * (attrs["limit_deg"] + attrs["limit_above_deg"])
        lines.append((middle, f"{words} {attrs['limit_deg']:.1f}° to {attrs['limit_above_deg']:.1f}°", GREEN, "-"))
    if not attrs["monotone"]:
        lines.append((attrs["greatest_deg"], f"greatest climbed {attrs['greatest_deg']:.1f}°", GREEN, "-."))
    friction, adhering = attrs["friction_limit_deg"], attrs["friction_limit_with_line_adhesion_deg"]
    lines.append((friction, f"friction limit {friction:.1f}°", "black", "--"))
    if adhering != friction:
        lines.append((adhering, f"friction limit with line adhesion {adhering:.1f}°", "black", ":"))
    for slope, words, colour, dashes in lines:
        # What was found may lie right under the closed form.
        ax.axvline(slope, color=colour, linestyle=dashes, linewidth=4.0 if colour == GREEN else 1.4, label=words)
