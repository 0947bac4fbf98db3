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

from ..sweep import DRIFT_LIMIT_M, faster_cases, preferred_cases
from .style import PER_METRE, RED, axes_or_new, legend_above, on_white, titled_figure

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
_FAILED = "0.75"
_MOST_TICKS = 14
_MOST_GROUPS = 8
_NICE_DEG = (30.0, 45.0, 60.0, 90.0, 180.0)
# Twists from here on are closer to the opposite sign, by way of 180°, than to none.
_CYCLIC_FROM_DEG = 135.0
_CYCLIC = "twilight_shifted"
# Half of the scale (1°, 1 µm, 1 µm/s) that a map has at least: what is smaller is rounding, and looks like nothing.
_LEAST = 1.0


def plot_map(sweep: xr.Dataset, name: Literal["twist_deg", "drift_m", "speed_m_per_s"], ax: Axes | None = None) -> Axes:
    """Plot one metric of a sweep as a map, magnetization cases against drafts, with the paper's marked cells.

    Cells with red edges have no flip and a drift of at most 50 µm; on the map of speed they are also faster than the
    ideal robot, whose speed and that of a flipped one are marked in the colour bar. Failed cases are grey. The colours
    of twists up to ±180°, which is one angle, run in a circle; a scale is never finer than ±1°, ±1 µm or ±1 µm/s.

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
    if name == "twist_deg" and norm.vmax is not None and norm.vmax >= _CYCLIC_FROM_DEG:
        colours, norm = _CYCLIC, Normalize(-180.0, 180.0)
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
    _mark_speeds(bar, speeds)
    ax.set(title=title, xlabel=_case_label(sweep), ylabel="draft φ (°)")
    _legend(ax, name, speeds, bool(np.isnan(values).any()))
    return ax


def plot_sweep(sweep: xr.Dataset, figure: Figure | None = None) -> Figure:
    """Draw one figure of a sweep: the maps of twist, drift and speed, under the robot and the field.

    Parameters
    ----------
    sweep
        Result of `tumblers.sweep`.
    figure
        Empty figure to draw on, whose size is set here; a new one of pyplot if None.

    Returns
    -------
    matplotlib.figure.Figure
        The figure drawn on.
    """
    figure = titled_figure(figure, (11.0, 13.0), "Manufacturing errors", sweep)
    for ax, name in zip(figure.subplots(3, 1), _MAPS, strict=True):
        plot_map(sweep, name, ax)  # type: ignore[arg-type]
    return figure


def _norm(values: np.ndarray[Any, Any], speeds: list[float], signed: bool) -> Normalize:
    if signed:
        limit = max(float(np.abs(values).max(initial=0.0)), _LEAST)
        return Normalize(-limit, limit)
    low, high = (float(edge([*values, *speeds])) if [*values, *speeds] else 0.0 for edge in (np.min, np.max))
    half = max(0.52 * (high - low), _LEAST)
    return Normalize(0.5 * (low + high) - half, 0.5 * (low + high) + half)


def _extend(values: np.ndarray[Any, Any], norm: Normalize) -> str:
    low = bool((values < norm.vmin).any())
    high = bool((values > norm.vmax).any())
    return {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}[low, high]


def _mark(ax: Axes, marks: np.ndarray[Any, Any]) -> None:
    cells = [Rectangle((column - 0.5, row - 0.5), 1.0, 1.0) for row, column in np.argwhere(marks)]
    edges = PatchCollection(cells, facecolor="none", edgecolor=RED, linewidth=1.6, zorder=3)
    on_white(edges, 3.0)
    edges.set_gid("marked")
    ax.add_collection(edges)


def _ticks(ax: Axes, sweep: xr.Dataset) -> None:
    theta1, theta2 = sweep["theta1_deg"].values, sweep["theta2_deg"].values
    groups = np.split(np.arange(len(theta1)), np.flatnonzero(np.diff(theta1)) + 1)
    erring = [group for group in groups if theta1[group[0]] != 0.0]
    names = {int(column): "none" for column in np.flatnonzero(theta1 == 0.0)}
    for group in erring:
        for column in group[_labelled(theta2[group], max(_MOST_TICKS // len(erring), 1))]:
            # Narrow columns have no room for a label right beside "none".
            if len(theta1) <= _MOST_TICKS or not {int(column) - 1, int(column) + 1} & set(
                np.flatnonzero(theta1 == 0.0)
            ):
                names[int(column)] = f"{theta2[column]:g}"
    ax.set_xticks(list(names), list(names.values()))
    for group in groups[1:]:
        ax.axvline(group[0] - 0.5, color="black", linewidth=0.9)
    if len(erring) > 1:
        shown = erring[:: -(-len(erring) // _MOST_GROUPS)]
        # On a second line, under the labels of the columns.
        ax.set_xticks(
            [float(group.mean()) + 1e-3 for group in shown],
            [f"\nθ1 = {theta1[group[0]]:g}°" for group in shown],
            minor=True,
        )
        ax.tick_params(axis="x", which="minor", length=0.0)
    drafts = sweep["draft_deg"].values
    rows = range(0, len(drafts), -(-len(drafts) // _MOST_TICKS))
    ax.set_yticks(list(rows), [f"{drafts[i]:g}" for i in rows])


def _labelled(theta2: np.ndarray[Any, Any], most: int) -> np.ndarray[Any, Any]:
    if len(theta2) <= most:
        return np.arange(len(theta2))
    for step in _NICE_DEG:
        columns = np.flatnonzero(theta2 % step == 0.0)
        if 2 <= len(columns) <= most:
            return columns
    return np.arange(0, len(theta2), -(-len(theta2) // most))


def _case_label(sweep: xr.Dataset) -> str:
    theta1 = np.unique(sweep["theta1_deg"].values)
    errors = theta1[theta1 != 0.0]
    none = "none: no magnetization error"
    if errors.size == 0:
        return none
    words = f"θ2 (°) at θ1 = {errors[0]:g}°" if errors.size == 1 else "θ2 (°) in groups of θ1"
    return f"{words}; {none}" if 0.0 in theta1 else words


def _legend(ax: Axes, name: str, speeds: dict[str, tuple[float, Dashes]], failed: bool) -> None:
    words = f"no flip, |drift| ≤ {DRIFT_LIMIT_M * PER_METRE:g} µm"
    if name == "speed_m_per_s":
        words += ", faster than ideal"
    handles: list[Patch | Line2D] = [Patch(facecolor="none", edgecolor=RED, linewidth=1.6, label=words)]
    if failed:
        handles.append(Patch(facecolor=_FAILED, label="no value"))
    for speed_name, (speed, dashes) in speeds.items():
        handles.append(Line2D([], [], color="black", linestyle=dashes, label=f"{speed_name}: {speed:.1f} µm/s"))
    legend_above(ax, handles=handles, ncols=len(handles))


def _mark_speeds(bar: Colorbar, speeds: dict[str, tuple[float, Dashes]]) -> None:
    for name, (speed, dashes) in speeds.items():
        line = bar.ax.axhline(speed, color="black", linestyle=dashes, linewidth=1.6, label=name)
        on_white(line, 3.2)
