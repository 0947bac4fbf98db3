"""One tumbling cycle from the side."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.transforms import ScaledTranslation
from numpy.typing import NDArray

from ..errors import InputError, show
from ..simulate import CONTACT_MODES
from .body import PER_MM, SIDE, draw_body
from .contact import MODE_COLOURS, mode_patches
from .scene import Scene
from .style import figure_or_new, scenario_words

__all__ = ["cycle_count", "draw_gravity", "draw_substrate", "plot_cycle"]

_WIDE, _STRIP_INCHES = 11.0, 1.5
# Ticks and labels beside the axes, and titles, ticks and labels above and below both of them.
_LEFT_INCHES, _ROWS_INCHES = 0.95, 1.75
_LOWEST, _TALLEST = 1.6, 6.0
_GROUND = "0.35"
_OPACITY = 0.85


def cycle_count(run: xr.Dataset) -> int:
    """Return how many whole cycles of the field a run has; 1, the whole run, where there is none."""
    return _cycle_count(Scene.of(run))


def plot_cycle(run: xr.Dataset, cycle: int | None = None, instants: int = 10, figure: Figure | None = None) -> Figure:
    """Draw one cycle of the field from the side: the robot at several instants, coloured by its contact mode.

    Below it is the contact mode over the same time, with the instants marked.

    Parameters
    ----------
    run
        Result of `tumblers.simulate`; the body is that of its scenario with every effect.
    cycle
        Number of the cycle, from 0. If None the second, which has the start behind it, or the only one. Where the field
        does not rotate or the run has no whole cycle, the whole run is shown as cycle 0.
    instants
        How many instants, at least 2, at even distances; a contact mode that none of them shows takes the nearest of
        those between the first and the last.
    figure
        Empty figure to draw on, whose size is set here; a new one of pyplot if None.

    Returns
    -------
    matplotlib.figure.Figure
        The figure drawn on: y to the right and z up, mm, of equal scale; gravity is the arrow.

    Raises
    ------
    InputError
        No run, a cycle that it does not have, or too few instants.
    """
    scene = Scene.of(run)
    count = _cycle_count(scene)
    if cycle is None:
        cycle = min(1, count - 1)
    if not 0 <= cycle < count:
        raise InputError("cycle", show(cycle), f"a cycle from 0 to {count - 1}")
    if instants < 2:
        raise InputError("instants", show(instants), "at least 2")
    start, end = _span(scene, cycle)
    rows = _instants(scene, start, end, instants)
    low, high, tall = _extent(scene, rows)
    figure = figure_or_new(figure, (_WIDE, tall + _STRIP_INCHES + _ROWS_INCHES))
    side, strip = figure.subplots(2, 1, height_ratios=[tall, _STRIP_INCHES])
    side.set_xlim(low[0], high[0])
    side.set_ylim(low[1], high[1])
    side.set_aspect("equal", adjustable="box")
    _draw_side(side, scene, rows)
    _draw_strip(strip, scene, rows, start, end)
    whole = scene.period_s is None or scene.duration_s < scene.period_s * (1.0 - 1e-9)
    figure.suptitle(f"{'The run' if whole else f'Cycle {cycle + 1}'}: {scenario_words(run.attrs['scenario'])}")
    return figure


def draw_substrate(ax: Axes, scene: Scene) -> None:
    """Draw the substrate's line over the axes' width, and what is below it.

    Parameters
    ----------
    ax
        Axes with y (mm) to the right and z (mm) up, whose limits stand.
    scene
        The run.
    """
    left, right = ax.get_xlim()
    y = np.linspace(left, right, 400)
    height = scene.height(y / PER_MM) * PER_MM
    ax.fill_between(y, height, ax.get_ylim()[0], color="0.9", linewidth=0.0, zorder=0.5)
    ax.plot(y, height, color=_GROUND, linewidth=1.2, zorder=1.0)


def draw_gravity(ax: Axes, scene: Scene, at: tuple[float, float] = (0.06, 0.93), points: float = 30.0) -> None:
    """Draw gravity's direction in the plane of y and z, and the slope, in a corner of the axes.

    Parameters
    ----------
    ax
        Axes with y to the right and z up.
    scene
        The run.
    at, points
        Tail of the arrow, fractions of the axes, and its length, points.
    """
    across, upward = points * scene.down[1], points * scene.down[2]
    ax.annotate(
        "",
        at,
        xytext=(across, upward),
        xycoords="axes fraction",
        textcoords="offset points",
        arrowprops={"arrowstyle": "<|-", "color": "black", "shrinkA": 0.0, "shrinkB": 0.0, "linewidth": 1.3},
    )
    ax.annotate(
        f"g, {scene.slope}",
        at,
        xytext=(8.0, -2.0),
        xycoords="axes fraction",
        textcoords="offset points",
        va="center",
        fontsize="small",
    )


def _cycle_count(scene: Scene) -> int:
    if scene.period_s is None:
        return 1
    return max(int(scene.duration_s / scene.period_s * (1.0 + 1e-9)), 1)


def _span(scene: Scene, cycle: int) -> tuple[float, float]:
    first, last = float(scene.time_s[0]), float(scene.time_s[-1])
    if scene.period_s is None:
        return first, last
    return first + cycle * scene.period_s, min(first + (cycle + 1) * scene.period_s, last)


def _instants(scene: Scene, start: float, end: float, count: int) -> NDArray[np.int64]:
    rows = np.unique(scene.rows(np.linspace(start, end, count)))
    first, last = int(rows[0]), int(rows[-1])
    modes = scene.mode[first + 1 : last + 1]
    moved: set[int] = set()
    for kind in np.setdiff1d(modes, scene.mode[rows]):
        # The middle of the longest time in this mode, best one that is not beside the first or the last instant.
        middles = {first + 1 + (begin + end - 1) // 2: end - begin for begin, end in _stretches(modes == kind)}
        inside = [row for row in middles if min(row - first, last - row) > 0.4 * (last - first) / count]
        middle = max(inside or middles, key=lambda row: middles[row])
        # No other mode loses the only instant that shows it.
        shown = scene.mode[rows]
        free = [k for k in range(1, rows.size - 1) if rows[k] not in moved and (shown == shown[k]).sum() > 1]
        if free:
            rows[min(free, key=lambda k: abs(int(rows[k]) - middle))] = middle
            moved.add(middle)
    rows.sort()
    return rows


def _stretches(held: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return begin and end (not included) of every unbroken stretch of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], held, [False]])))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))


def _extent(scene: Scene, rows: NDArray[np.int64]) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """Return two corners, (y, z) in mm, that fill axes of the figure's width at one scale, and their height, inches."""
    seen = np.concatenate([scene.corners(row)[:, 1:] for row in rows]) * PER_MM
    size = scene.size_m * PER_MM
    # Above the robot there is room for gravity's arrow.
    low = seen.min(axis=0) - 0.2 * size
    high = seen.max(axis=0) + np.array([0.2, 0.5]) * size
    wide = _WIDE - _LEFT_INCHES
    across, upward = high - low
    tall = float(np.clip(wide * upward / across, _LOWEST, _TALLEST))
    across, upward = max(across, upward * wide / tall), max(upward, across * tall / wide)
    middle = 0.5 * (low[0] + high[0])
    return np.array([middle - 0.5 * across, low[1]]), np.array([middle + 0.5 * across, low[1] + upward]), tall


def _draw_side(ax: Axes, scene: Scene, rows: NDArray[np.int64]) -> None:
    draw_substrate(ax, scene)
    halo = [withStroke(linewidth=2.5, foreground="white")]
    path = scene.position_m[rows[0] : rows[-1] + 1, 1:] * PER_MM
    ax.plot(*path.T, color="black", linewidth=0.8, linestyle=":", zorder=3.0)
    for number, row in enumerate(rows, start=1):
        colour = MODE_COLOURS[scene.mode[row]]
        draw_body(ax, scene, row, SIDE, colour, alpha=_OPACITY, zorder=2.0 + 0.01 * number)
        y, z = scene.position_m[row, 1:] * PER_MM
        ax.text(y, z, str(number), ha="center", va="center", fontsize="small", zorder=4.0, path_effects=halo)
    draw_gravity(ax, scene)
    ax.set(xlabel="y (mm), direction of travel", ylabel="z (mm)")
    ax.legend(
        handles=mode_patches(),
        loc="lower right",
        bbox_to_anchor=(1.0, 1.0),
        ncols=len(CONTACT_MODES),
        frameon=False,
        fontsize="small",
        borderaxespad=0.1,
    )
    ax.set_title("From the side", loc="left")


def _draw_strip(ax: Axes, scene: Scene, rows: NDArray[np.int64], start: float, end: float) -> None:
    first, last = scene.rows([start, end])
    # A row's mode is that of the step that ends in it.
    time, mode = scene.time_s[first : last + 1], scene.mode[first + 1 : last + 1]
    for kind, colour in enumerate(MODE_COLOURS):
        bars = [(time[begin], time[stop] - time[begin]) for begin, stop in _stretches(mode == kind)]
        ax.broken_barh(bars, (kind - 0.4, 0.8), color=colour)
    ax.set_yticks(range(len(CONTACT_MODES)), CONTACT_MODES)
    ax.set_ylim(-0.6, len(CONTACT_MODES) + 0.4)
    ax.set_xlim(start, end)
    root = ax.get_figure(root=True)
    assert root is not None
    for number, row in enumerate(rows, start=1):
        ax.axvline(scene.time_s[row], color="0.5", linewidth=0.6, linestyle=":")
        # The first and the last stay inside the axes.
        side, points = {1: ("left", 3.0), len(rows): ("right", -3.0)}.get(number, ("center", 0.0))
        ax.text(
            scene.time_s[row],
            len(CONTACT_MODES) - 0.05,
            str(number),
            transform=ax.transData + ScaledTranslation(points / 72.0, 0.0, root.dpi_scale_trans),
            ha=side,
            va="center",
            fontsize="small",
            path_effects=[withStroke(linewidth=2.5, foreground="white")],
        )
    ax.set(xlabel="time (s)")
    ax.set_title("Contact with the substrate, and the instants above", loc="left")
