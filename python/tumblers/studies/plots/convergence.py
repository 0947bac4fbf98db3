"""Figure of `convergence`: every number against the step."""

from __future__ import annotations

from math import ceil, isfinite

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ...plots.style import BLUE, GREEN, ORANGE, PER_METRE, figure_or_new

__all__ = ["plot_convergence"]

# Inches that the title takes are the least width.
_COLUMNS, _NARROWEST = 3, 6.5
_COLOURS = {"end_of_step": BLUE, "midpoint": GREEN, "start_of_step": ORANGE}
_MARKERS = ("o", "s", "^", "v", "D", "x")
_UNITS = {"m s-1": (PER_METRE, "µm/s"), "m": (PER_METRE, "µm"), "1": (1.0, "share"), "degree": (1.0, "°")}
# The scale of a panel spans so much of the number at least: what is smaller is no dependence.
_LEAST = 0.02


def plot_convergence(convergence: xr.Dataset, figure: Figure | None = None) -> Figure:
    """Draw every number against the step (ms): a colour for the torque's time, a marker for e_r, grey for the paper's.

    Parameters
    ----------
    convergence
        Result of `tumblers.convergence`.
    figure
        Empty figure to draw on, whose size is set here; a new one of pyplot if None.

    Returns
    -------
    matplotlib.figure.Figure
        The figure drawn on.
    """
    keys = convergence["number"].values
    columns = min(len(keys), _COLUMNS)
    rows = ceil(len(keys) / columns)
    figure = figure_or_new(figure, (max(4.3 * columns, _NARROWEST), 1.2 + 2.9 * rows))
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    for ax, key in zip(axes, keys, strict=False):
        _panel(ax, convergence.sel(number=key))
    for ax in axes[len(keys) :]:
        ax.set_visible(False)
    handles, words = axes[0].get_legend_handles_labels()
    named = dict(zip(words, handles, strict=True))
    figure.legend(named.values(), named.keys(), loc="outside lower center", ncols=2 * columns - 1, frameon=False)
    figure.suptitle("What the numbers rest on: step, the torque's time in it, and e_r")
    return figure


def _panel(ax: Axes, at: xr.Dataset) -> None:
    factor, unit = _UNITS[str(at["units"].values)]
    spins = at["e_r_m"].values
    for torque in at["magnetic_torque"].values:
        for place, spin in enumerate(spins):
            values = at["value"].sel(magnetic_torque=torque, e_r_m=spin).values * factor
            ax.plot(
                at["step_s"].values * 1e3,
                values,
                color=_COLOURS[str(torque)],
                marker=_MARKERS[place % len(_MARKERS)],
                # Markers of the same place lie around each other, so that all are seen.
                markersize=3.5 + 2.5 * place,
                markerfacecolor="none",
                linewidth=1.1,
                label=f"{str(torque).replace('_', ' ')}, e_r = {spin:g} m",
            )
    paper = float(at["paper"]) * factor
    if isfinite(paper):
        ax.axhline(paper, color="0.55", linestyle="--", linewidth=1.2, label="the paper")
    _scale(ax, at["value"].values * factor, paper)
    ax.set_xscale("log")
    steps = at["step_s"].values * 1e3
    ax.set_xticks(steps, [f"{step:g}" for step in steps])
    ax.minorticks_off()
    ax.set_title(str(at["words"].values), loc="left", fontsize="medium")
    ax.set(xlabel="step (ms)", ylabel=unit)


def _scale(ax: Axes, values: NDArray[np.float64], paper: float) -> None:
    shown = np.append(values[np.isfinite(values)], paper if isfinite(paper) else [])
    if shown.size == 0:
        return
    low, high = float(shown.min()), float(shown.max())
    half = max(0.56 * (high - low), 0.5 * _LEAST * max(abs(low), abs(high)))
    if half > 0.0:
        ax.set_ylim(0.5 * (low + high) - half, 0.5 * (low + high) + half)
