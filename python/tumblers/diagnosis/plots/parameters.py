"""Estimates with their intervals, against the ranges that were plausible."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from ...plots.style import BLUE, axes_or_new
from ..diagnosis import Diagnosis
from ..plausible import neutral_values, plausible_ranges
from ..quantity import handy_unit, rounded, with_interval
from ..wording.phrase import unit_of

__all__ = ["plot_parameters"]


def plot_parameters(diagnosis: Diagnosis, ax: Axes | None = None) -> Axes:
    """Plot every parameter's estimate and 90 % interval within its plausible range; a dash marks the neutral value.

    Hollow markers are parameters that the data hardly narrow.

    Parameters
    ----------
    diagnosis
        What `diagnose` returned.
    ax
        Axes to draw on; those of a new figure if None.

    Returns
    -------
    matplotlib.axes.Axes
        The axes drawn on, a row for each parameter of the chosen effects.
    """
    ax = axes_or_new(ax)
    names: list[str] = []
    for effect in diagnosis.effects:
        ranges, neutral = plausible_ranges(diagnosis, effect.name), neutral_values(effect.name)
        for key, interval in effect.parameters.items():
            row = len(names)
            low, high = ranges.get(key, (interval.low, interval.high))
            width = high - low
            if not np.isfinite(width) or width <= 0.0:
                low, width = interval.estimate - 0.5, 1.0
            at = [(value - low) / width for value in (interval.low, interval.estimate, interval.high)]
            ax.hlines(row, 0.0, 1.0, color="0.88", linewidth=7.0, zorder=1)
            ax.hlines(row, *np.clip([at[0], at[2]], 0.0, 1.0), color=BLUE, linewidth=2.5, zorder=2)
            face = BLUE if interval.identified else "white"
            ax.plot(at[1], row, "o", color=BLUE, markerfacecolor=face, markersize=6.0, zorder=4)
            if key in neutral:
                ax.plot((neutral[key] - low) / width, row, "|", color="0.2", markersize=13.0, zorder=3)
            unit = unit_of(effect.name, key)
            factor, written = handy_unit(max(abs(low), abs(low + width)), unit)
            for place, value, side in ((0.0, low, "left"), (1.0, low + width, "right")):
                ax.text(
                    place, row + 0.34, rounded(factor * value), ha=side, va="center", fontsize="x-small", color="0.4"
                )
            ax.text(0.5, row + 0.34, written, ha="center", va="center", fontsize="x-small", color="0.4")
            names.append(f"{key}\n{with_interval(interval, unit)}")
    ax.set_yticks(range(len(names)), names, fontsize="small")
    ax.set_ylim(len(names) - 0.35, -0.5)
    ax.set_xlim(-0.03, 1.03)
    ax.set_xticks([])
    ax.tick_params(length=0)
    ax.spines[:].set_visible(False)
    ax.set_title("Parameters in their plausible range", loc="left")
    return ax
