"""The robot from above at several times along its path, as in the paper's figures of trajectories."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from ..errors import InputError, show
from .body import ABOVE, PER_MM, draw_body
from .scene import Scene
from .style import figure_or_new, scenario_words

__all__ = ["plot_snapshots", "snapshots_size"]

_Floats = NDArray[np.float64]
_LABEL_INCHES = 0.17
# Room around the axes: the times to the right, ticks and their label to the left, title and ticks above and below.
_RIGHT_INCHES, _LEFT_INCHES, _ROWS_INCHES = 0.75, 0.75, 1.1
_TALLEST, _WIDEST, _NARROWEST, _LOWEST = 8.0, 9.0, 2.4, 2.4
_MARGIN = 0.4


def plot_snapshots(run: xr.Dataset, times_s: Sequence[float] | None = None, ax: Axes | None = None) -> Axes:
    """Plot the robot from above at several times, with the path of its centre of mass.

    Parameters
    ----------
    run
        Result of `tumblers.simulate`; the body is that of its scenario with every effect.
    times_s
        Times to show, s; the nearest rows are taken. About eight at round, even distances if None.
    ax
        Axes to draw on; those of a new figure, of the size that the path asks for, if None.

    Returns
    -------
    matplotlib.axes.Axes
        The axes drawn on: x to the right and y up, mm, of equal scale.

    Raises
    ------
    InputError
        No run, no time, or a time outside the run.
    """
    scene = Scene.of(run)
    rows = _rows(scene, times_s)
    if ax is None:
        ax = figure_or_new(None, snapshots_size(run, times_s)).subplots()
    for order, row in enumerate(rows):
        share = 0.85 * float(scene.time_s[row] - scene.time_s[0]) / scene.duration_s
        draw_body(ax, scene, row, ABOVE, to_hex(colormaps["viridis"](share)), zorder=2.0 + 0.01 * order)
    x, y = scene.position_m[:, :2].T * PER_MM
    ax.plot(x, y, color="black", linewidth=0.9, zorder=3.0, label="centre of mass")
    ax.plot(x[rows], y[rows], color="black", linestyle="none", marker="o", markersize=2.5, zorder=3.0)
    _label(ax, scene, rows, _frame(ax, scene, rows))
    ax.set(xlabel="x (mm)", ylabel="y (mm)")
    ax.set_title(f"From above\n{scenario_words(run.attrs['scenario'])}", fontsize="medium")
    return ax


def snapshots_size(run: xr.Dataset, times_s: Sequence[float] | None = None) -> tuple[float, float]:
    """Return the width and the height, inches, of a figure that `plot_snapshots` fills."""
    scene = Scene.of(run)
    wide, high = np.ptp(_extent(scene, _rows(scene, times_s)), axis=0)
    scale = min(_TALLEST / high, _WIDEST / wide)
    return (
        max(scale * wide, _NARROWEST) + _LEFT_INCHES + _RIGHT_INCHES,
        max(scale * high, _LOWEST) + _ROWS_INCHES,
    )


def _rows(scene: Scene, times_s: Sequence[float] | None) -> NDArray[np.int64]:
    if times_s is not None:
        if len(times_s) == 0:
            raise InputError("times_s", show(times_s), "at least one time")
        return np.unique(scene.rows(times_s))
    first, last = scene.time_s[0], scene.time_s[-1]
    times = MaxNLocator(nbins=9, steps=[1, 2, 2.5, 5, 10]).tick_values(first, last)
    slack = 1e-9 * scene.duration_s
    return np.unique(scene.rows(times[(times >= first - slack) & (times <= last + slack)]))


def _extent(scene: Scene, rows: NDArray[np.int64]) -> _Floats:
    """Return the lower left and the upper right corner of what is shown, with a margin, mm, shape (2, 2)."""
    seen = np.concatenate([scene.position_m[:, :2], *(scene.corners(row)[:, :2] for row in rows)]) * PER_MM
    margin = _MARGIN * scene.size_m * PER_MM
    return np.stack([seen.min(axis=0) - margin, seen.max(axis=0) + margin])


def _frame(ax: Axes, scene: Scene, rows: NDArray[np.int64]) -> float:
    """Set limits that fill the axes at one scale; return the scale, mm per inch."""
    figure = ax.get_figure(root=True)
    assert figure is not None
    whole, box = figure.get_size_inches(), ax.get_position()
    # Where the axes are alone, the layout leaves them what is not ticks, title or times.
    room = np.array([whole[0] - _LEFT_INCHES - _RIGHT_INCHES, whole[1] - _ROWS_INCHES])
    inches = room if len(figure.axes) == 1 else np.array([box.width, box.height]) * whole
    inches = np.maximum(inches, 0.5)
    low, high = _extent(scene, rows)
    scale = float(((high - low) / inches).max())
    middle, half = 0.5 * (low + high), 0.5 * scale * inches
    ax.set_xlim(middle[0] - half[0], middle[0] + half[0])
    ax.set_ylim(middle[1] - half[1], middle[1] + half[1])
    ax.set_aspect("equal", adjustable="box")
    return scale


def _label(ax: Axes, scene: Scene, rows: NDArray[np.int64], scale: float) -> None:
    """Write the times in a column to the right of the axes, in the order of their places, none over another."""
    low, high = ax.get_ylim()
    places = scene.position_m[rows, 1] * PER_MM
    gap = min(_LABEL_INCHES * scale, 0.95 * (high - low) / len(rows))
    for row, place, y in zip(rows, places, _spread(places, gap, low, high), strict=True):
        edge = float(scene.corners(row)[:, 0].max()) * PER_MM
        ax.annotate(
            f"{scene.time_s[row]:.4g} s",
            (edge, place),
            xytext=(1.06, y),
            textcoords=ax.get_yaxis_transform(),
            va="center",
            ha="left",
            fontsize="small",
            arrowprops={"arrowstyle": "-", "color": "0.6", "linewidth": 0.6, "shrinkA": 1.0, "shrinkB": 1.0},
        )


def _spread(places: _Floats, gap: float, low: float, high: float) -> _Floats:
    """Return places at least `gap` apart and between `low` and `high`, in the same order and near the given ones."""
    order = np.argsort(places, kind="stable")
    spread = places[order].astype(float)
    for i in range(1, spread.size):
        spread[i] = max(spread[i], spread[i - 1] + gap)
    spread[-1] = min(spread[-1], high - 0.5 * gap)
    for i in range(spread.size - 2, -1, -1):
        spread[i] = min(spread[i], spread[i + 1] - gap)
    shift = max(low + 0.5 * gap - spread[0], 0.0)
    back = np.empty_like(spread)
    back[order] = spread + shift
    return back
