"""Maps of where the gap lies."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm

from ...plots.style import axes_or_new
from ..result import HeatMap
from .literal import shortened

__all__ = ["plot_heat_map"]

# What noise gives is 1; a scale that ends below this would show noise as if it were a gap.
_LEAST = 3.0
_COLOURS = "YlOrBr"
_NO_DATA = "0.92"
_LONGEST = 16
_SLANTED_FROM = 6


def plot_heat_map(heat_map: HeatMap, ax: Axes | None = None) -> Axes:
    """Plot differences over two axes, in units of what noise alone gives; cells without data are grey.

    Parameters
    ----------
    heat_map
        One of `Diagnosis.heat_maps`.
    ax
        Axes to draw on; those of a new figure if None.

    Returns
    -------
    matplotlib.axes.Axes
        The axes drawn on, every cell with its number.
    """
    ax = axes_or_new(ax)
    values = np.ma.masked_invalid(np.asarray(heat_map.values, dtype=float))
    highest = max(float(values.max()) if values.count() else 1.0, _LEAST)
    mesh = ax.pcolormesh(
        np.arange(values.shape[1] + 1) - 0.5,
        np.arange(values.shape[0] + 1) - 0.5,
        values.clip(1.0, highest),
        cmap=_COLOURS,
        norm=LogNorm(1.0, highest),
        edgecolors="white",
        linewidth=0.8,
    )
    ax.set_facecolor(_NO_DATA)
    _write_cells(ax, values, highest)
    columns = [shortened(label, _LONGEST) for label in heat_map.column_labels]
    slanted = len(columns) > _SLANTED_FROM or sum(map(len, columns)) > 40
    rotation: dict[str, Any] = {"rotation": 40.0, "ha": "right", "rotation_mode": "anchor"} if slanted else {}
    ax.set_xticks(range(len(columns)), columns, fontsize="small", **rotation)
    ax.set_yticks(
        range(len(heat_map.row_labels)), [shortened(r, _LONGEST) for r in heat_map.row_labels], fontsize="small"
    )
    ax.invert_yaxis()
    ax.tick_params(length=0)
    ax.spines[:].set_visible(False)
    figure = ax.get_figure()
    assert figure is not None
    ticks = [tick for tick in (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 1000.0) if tick <= highest]
    bar = figure.colorbar(mesh, ax=ax, pad=0.02, aspect=25)
    bar.set_ticks(ticks, labels=[f"{tick:g}" for tick in ticks])
    bar.ax.minorticks_off()
    bar.outline.set_visible(False)
    bar.set_label("difference, 1 is noise", fontsize="small")
    ax.set(xlabel=heat_map.columns, ylabel=heat_map.rows)
    ax.set_title(heat_map.title, loc="left")
    return ax


def _write_cells(ax: Axes, values: np.ma.MaskedArray[tuple[int, int], np.dtype[np.float64]], highest: float) -> None:
    size = "small" if values.shape[1] <= 8 else "x-small"
    for row, column in np.argwhere(~np.ma.getmaskarray(values)):
        value = float(values[row, column])
        dark = np.log(max(value, 1.0)) > 0.55 * np.log(highest)
        words = f"{value:.1f}" if value < 9.95 else f"{value:.0f}"
        colour = "white" if dark else "0.15"
        ax.text(column, row, words, ha="center", va="center", fontsize=size, color=colour)
