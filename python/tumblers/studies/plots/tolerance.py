"""Figure of `tolerance`: the errors that a robot bears."""

from __future__ import annotations

from math import isnan
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from ...metrics import FLIP_DEG
from ...plots.style import PER_METRE, RED, legend_above, on_white, titled_figure
from ..tolerance import PAPER_DRAFT_DEG, PAPER_THETA2_DEG

__all__ = ["plot_tolerance"]

_FLIPPED = "0.72"
# The scale ends at so many times the limit: beyond it, by how much does not matter.
_SCALE = 4.0


def plot_tolerance(tolerance: xr.Dataset, figure: Figure | None = None) -> Figure:
    """Draw two maps with the region that is kept outlined in red.

    Above: drift (µm) over θ2 and draft at the last θ1, flips grey, with the paper's box φ ≤ 2°, |θ2| ≤ 10° dashed.
    Below: the share of the directions θ2 that are kept over θ1 and draft; the outline holds what is kept in any.

    Parameters
    ----------
    tolerance
        Result of `tumblers.tolerance`.
    figure
        Empty figure to draw on, whose size is set here; a new one of pyplot if None.

    Returns
    -------
    matplotlib.figure.Figure
        The figure drawn on.
    """
    more = f", drift ≤ {tolerance.attrs['drift_limit_m'] * PER_METRE:g} µm\n{_alone(tolerance)}"
    figure = titled_figure(figure, (10.0, 9.0), "Manufacturing tolerance", tolerance, more)
    above, below = figure.subplots(2, 1, height_ratios=[3, 2])
    _drift(figure, above, tolerance.isel(theta1_deg=-1))
    _share(figure, below, tolerance)
    return figure


def _alone(tolerance: xr.Dataset) -> str:
    words = []
    last = float(tolerance["theta1_deg"][-1])
    for name, key in (("φ", "draft"), (f"|θ2| at θ1 = {last:g}°", "theta2")):
        value = tolerance.attrs[f"{key}_tolerance_deg"]
        relation = ">" if tolerance.attrs[f"{key}_tolerance_open"] else "≤"
        words.append(f"{name} {relation} {value:.2f}°" if not isnan(value) else f"no {name}")
    return f"one error alone: {' or '.join(words)}"


def _drift(figure: Figure, ax: Axes, at: xr.Dataset) -> None:
    limit = at.attrs["drift_limit_m"] * PER_METRE
    theta2, drafts = at["theta2_deg"].values, at["draft_deg"].values
    drift = np.abs(at["drift_m"].transpose("draft_deg", "theta2_deg").values) * PER_METRE
    flipped = np.abs(at["twist_deg"].transpose("draft_deg", "theta2_deg").values) > FLIP_DEG
    x, y = _edges(theta2), _edges(drafts)
    shown = np.ma.masked_where(flipped | ~np.isfinite(drift), drift)
    mesh = ax.pcolormesh(x, y, shown, cmap="cividis_r", vmin=0.0, vmax=_SCALE * limit)
    ax.pcolormesh(x, y, np.ma.masked_where(~flipped, np.ones_like(drift)), cmap=ListedColormap([_FLIPPED]))
    bar = figure.colorbar(mesh, ax=ax, label="|drift| after one cycle (µm)", extend="max")
    bar.ax.axhline(limit, color=RED, linewidth=1.6)
    _outline(ax, x, y, at["kept"].transpose("draft_deg", "theta2_deg").values.astype(bool))
    ax.add_patch(
        Rectangle(
            (-PAPER_THETA2_DEG, y[0]),
            2.0 * PAPER_THETA2_DEG,
            PAPER_DRAFT_DEG - y[0],
            fill=False,
            edgecolor="black",
            linestyle="--",
            linewidth=1.3,
            zorder=4,
        )
    )
    if theta2[-1] - theta2[0] >= 180.0:
        ax.set_xticks(range(int(np.ceil(theta2[0] / 45.0)) * 45, int(theta2[-1]) + 1, 45))
    ax.set(title=f"θ1 = {float(at['theta1_deg']):g}°", xlabel="θ2 (°)", ylabel="draft φ (°)")
    legend_above(
        ax,
        handles=[
            Line2D([], [], color=RED, linewidth=1.8, label="kept"),
            Patch(facecolor=_FLIPPED, label="flips"),
            Line2D([], [], color="black", linestyle="--", label="the paper's φ ≤ 2°, |θ2| ≤ 10°"),
        ],
        ncols=3,
    )


def _share(figure: Figure, ax: Axes, tolerance: xr.Dataset) -> None:
    share = tolerance["kept_share"].transpose("draft_deg", "theta1_deg").values
    x, y = _edges(tolerance["theta1_deg"].values), _edges(tolerance["draft_deg"].values)
    mesh = ax.pcolormesh(x, y, 100.0 * share, cmap="cividis", vmin=0.0, vmax=100.0)
    figure.colorbar(mesh, ax=ax, label="directions θ2 kept (%)")
    _outline(ax, x, y, share == 1.0)
    ax.set(title="All directions", xlabel="θ1 (°)", ylabel="draft φ (°)", xticks=tolerance["theta1_deg"].values)
    legend_above(ax, handles=[Line2D([], [], color=RED, linewidth=1.8, label="kept whatever θ2")])


def _edges(values: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Return the edges of the cells around values, those at the ends as wide as their neighbours."""
    if len(values) == 1:
        return np.array([values[0] - 0.5, values[0] + 0.5])
    middles = 0.5 * (values[1:] + values[:-1])
    return np.array([2.0 * values[0] - middles[0], *middles, 2.0 * values[-1] - middles[-1]])


def _outline(ax: Axes, x: np.ndarray[Any, Any], y: np.ndarray[Any, Any], region: np.ndarray[Any, Any]) -> None:
    padded = np.pad(region, 1)
    across = np.argwhere(padded[1:, 1:-1] != padded[:-1, 1:-1])
    upright = np.argwhere(padded[1:-1, 1:] != padded[1:-1, :-1])
    lines = [[(x[j], y[i]), (x[j + 1], y[i])] for i, j in across]
    lines += [[(x[j], y[i]), (x[j], y[i + 1])] for i, j in upright]
    edges = LineCollection(lines, colors=RED, linewidths=1.8, zorder=3, capstyle="projecting", clip_on=False)
    on_white(edges, 3.2)
    edges.set_gid("kept")
    ax.add_collection(edges)
