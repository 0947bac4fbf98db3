"""Maps of a sweep."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection
from matplotlib.colorbar import Colorbar
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.patheffects import Normal, withStroke

from ..sweep import DRIFT_LIMIT_M, faster_cases, preferred_cases
from .style import PER_METRE, axes_or_new

__all__ = ["plot_map", "plot_sweep"]

_MAPS = {
    "twist_deg": (1.0, "Twist after one cycle", "twist (°)", "PuOr"),
    "drift_m": (PER_METRE, "Drift after one cycle", "drift (µm)", "PuOr"),
    "speed_m_per_s": (PER_METRE, "Mean speed", "speed (µm/s)", "cividis"),
}
Dashes = Literal["-", ":"]
_SPEEDS: tuple[tuple[str, str, Dashes], ...] = (
    ("ideal_speed_m_per_s", "ideal", "-"),
    ("flipped_speed_m_per_s", "flipped", ":"),
)
_RED = "#E31A1C"
_FAILED = "0.75"
_MOST_TICKS = 14


def plot_map(sweep: xr.Dataset, name: Literal["twist_deg", "drift_m", "speed_m_per_s"], ax: Axes | None = None) -> Axes:
    """Plot one metric of a sweep as a map, magnetization cases against drafts, with the paper's marked cells.

    Cells with red edges have no flip and a drift of at most 50 µm; on the map of speed they are also faster than the
    ideal robot, whose speed and that of a flipped one are marked in the colour bar. Failed cases are grey.

    Parameters
    ----------
    sweep
        Result of `tumblers.sweep`.
    name
        ``twist_deg``, ``drift_m`` or ``speed_m_per_s``.
    ax
        Axes to draw on; those of a new figure if None.

    Returns
    -------
    matplotlib.axes.Axes
        The axes drawn on; the marked cells are the collection with the gid ``marked``.
    """
    ax = axes_or_new(ax)
    factor, title, label, colours = _MAPS[name]
    values = sweep[name].transpose("draft_deg", "magnetization_case").values * factor
    kept = np.isfinite(values) & ~sweep["flipped"].values if name == "drift_m" else np.isfinite(values)
    speeds = {
        words: (float(sweep.attrs[key]) * factor, dashes)
        for key, words, dashes in _SPEEDS
        if name == "speed_m_per_s" and key in sweep.attrs
    }
    norm = _norm(values[kept], [speed for speed, _ in speeds.values()], signed=name != "speed_m_per_s")
    rows, columns = values.shape
    mesh = ax.pcolormesh(
        np.arange(columns + 1) - 0.5,
        np.arange(rows + 1) - 0.5,
        np.ma.masked_invalid(values),
        cmap=colours,
        norm=norm,
    )
    ax.set_facecolor(_FAILED)
    marks = faster_cases(sweep) if name == "speed_m_per_s" else preferred_cases(sweep)
    _mark(ax, marks.transpose("draft_deg", "magnetization_case").values)
    _ticks(ax, sweep)
    figure = ax.get_figure()
    assert figure is not None
    bar = figure.colorbar(mesh, ax=ax, label=label, extend=_extend(values, norm))
    _legend(ax, name, speeds, bool(np.isnan(values).any()))
    _mark_speeds(bar, speeds)
    ax.set(xlabel=_case_label(sweep), ylabel="draft φ (°)")
    ax.set_title(title, loc="left")
    return ax


def plot_sweep(sweep: xr.Dataset) -> Figure:
    """Return one figure of a sweep: the maps of twist, drift and speed."""
    figure = Figure(figsize=(11.0, 13.0), layout="constrained")
    for ax, name in zip(figure.subplots(3, 1), _MAPS, strict=True):
        plot_map(sweep, name, ax)  # type: ignore[arg-type]
    return figure


def _norm(values: np.ndarray[Any, Any], speeds: list[float], signed: bool) -> Normalize:
    if signed:
        limit = float(np.abs(values).max(initial=0.0)) or 1.0
        return Normalize(-limit, limit)
    low, high = (float(edge([*values, *speeds])) if [*values, *speeds] else 0.0 for edge in (np.min, np.max))
    margin = 0.02 * (high - low) or 1.0
    return Normalize(low - margin, high + margin)


def _extend(values: np.ndarray[Any, Any], norm: Normalize) -> str:
    low = bool((values < norm.vmin).any())
    high = bool((values > norm.vmax).any())
    return {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}[low, high]


def _mark(ax: Axes, marks: np.ndarray[Any, Any]) -> None:
    cells = [Rectangle((column - 0.5, row - 0.5), 1.0, 1.0) for row, column in np.argwhere(marks)]
    edges = PatchCollection(cells, facecolor="none", edgecolor=_RED, linewidth=1.6, zorder=3)
    edges.set_path_effects([withStroke(linewidth=3.0, foreground="white"), Normal()])
    edges.set_gid("marked")
    ax.add_collection(edges)


def _ticks(ax: Axes, sweep: xr.Dataset) -> None:
    theta1, theta2 = sweep["theta1_deg"].values, sweep["theta2_deg"].values
    several = len(np.unique(theta1[theta1 != 0.0])) > 1
    names = [
        "0" if first == 0.0 else f"{first:g}, {second:g}" if several else f"{second:g}"
        for first, second in zip(theta1, theta2, strict=True)
    ]
    columns = range(0, len(names), -(-len(names) // _MOST_TICKS))
    ax.set_xticks(list(columns), [names[i] for i in columns])
    drafts = sweep["draft_deg"].values
    rows = range(0, len(drafts), -(-len(drafts) // _MOST_TICKS))
    ax.set_yticks(list(rows), [f"{drafts[i]:g}" for i in rows])


def _case_label(sweep: xr.Dataset) -> str:
    theta1 = np.unique(sweep["theta1_deg"].values)
    errors = theta1[theta1 != 0.0]
    none = "0: no magnetization error"
    if errors.size == 0:
        return none
    words = f"θ2 (°) at θ1 = {errors[0]:g}°" if errors.size == 1 else "θ1, θ2 (°)"
    return f"{words}; {none}" if 0.0 in theta1 else words


def _legend(ax: Axes, name: str, speeds: dict[str, tuple[float, Dashes]], failed: bool) -> None:
    words = f"no flip, |drift| ≤ {DRIFT_LIMIT_M * PER_METRE:g} µm"
    if name == "speed_m_per_s":
        words += ", faster than ideal"
    handles: list[Patch | Line2D] = [Patch(facecolor="none", edgecolor=_RED, linewidth=1.6, label=words)]
    if failed:
        handles.append(Patch(facecolor=_FAILED, label="no value"))
    for speed_name, (speed, dashes) in speeds.items():
        handles.append(Line2D([], [], color="black", linestyle=dashes, label=f"{speed_name}: {speed:.1f} µm/s"))
    ax.legend(
        handles=handles,
        loc="lower right",
        bbox_to_anchor=(1.0, 1.0),
        ncols=len(handles),
        fontsize="small",
        frameon=False,
    )


def _mark_speeds(bar: Colorbar, speeds: dict[str, tuple[float, Dashes]]) -> None:
    for name, (speed, dashes) in speeds.items():
        line = bar.ax.axhline(speed, color="black", linestyle=dashes, linewidth=1.6, label=name)
        line.set_path_effects([withStroke(linewidth=3.2, foreground="white"), Normal()])
