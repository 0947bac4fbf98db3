"""The gap of every trial, before and after."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from ...plots.style import BLUE, ORANGE, axes_or_new, legend_above
from ..result import Gap
from .literal import shortened

__all__ = ["plot_gap"]

_SERIES = (("nominal", ORANGE, "s"), ("sensor refitted", "0.45", "|"), ("with the effects", BLUE, "o"))
_LONGEST = 14
# Smaller gaps are drawn here.
_LEAST = 0.2


def plot_gap(gap: Gap, ax: Axes | None = None) -> Axes:
    """Plot the gap of every trial in noise sigmas: nominal, with the sensor's nuisances refitted, with the effects.

    Parameters
    ----------
    gap
        `Diagnosis.gap`.
    ax
        Axes to draw on; those of a new figure if None.

    Returns
    -------
    matplotlib.axes.Axes
        The axes drawn on, a row for each trial.
    """
    ax = axes_or_new(ax)
    rows = np.arange(len(gap.by_trial))
    values = np.array(list(gap.by_trial.values()), dtype=float).reshape(-1, 3)
    drawn = np.maximum(values, _LEAST)
    ax.hlines(rows, drawn[:, 2], drawn[:, 0], color="0.8", linewidth=2.0, zorder=1)
    for (label, colour, marker), column in zip(_SERIES, drawn.T, strict=True):
        thick = 2.0 if marker == "|" else 0.0
        ax.scatter(
            column, rows, s=70 if thick else 26, color=colour, marker=marker, linewidth=thick, label=label, zorder=2
        )
    if gap.noise_floor > 0.0:
        ax.axvline(gap.noise_floor, color="0.3", linestyle=":", linewidth=1.0, label="noise alone")
    ax.set_xscale("log")
    finite = drawn[np.isfinite(drawn)]
    highest = float(finite.max(initial=gap.noise_floor if np.isfinite(gap.noise_floor) else 1.0))
    ax.set_xlim(0.8 * _LEAST, 1.4 * highest)
    ticks = [tick for tick in (0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 1e3, 1e4) if tick <= 1.4 * highest]
    ax.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    ax.minorticks_off()
    ax.set_yticks(rows, [shortened(trial, _LONGEST) for trial in gap.by_trial], fontsize="small")
    ax.set_ylim(len(rows) - 0.4, -0.6)
    cut = f"; below {_LEAST:g} drawn there" if np.any(values < _LEAST) else ""
    ax.set(title="Gap of each trial", xlabel=f"gap (noise sigmas{cut})")
    legend_above(ax, ncols=2)
    return ax
