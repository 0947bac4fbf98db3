"""Figures of one run."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..simulate import CONTACT_MODES
from .style import BLUE, GREEN, ORANGE, PER_METRE, axes_or_new, legend_above, titled_figure
from .top_view import plot_top_view

__all__ = ["plot_contact_modes", "plot_forces", "plot_run", "plot_trajectory"]

_PER_NEWTON = 1e6
# The robot is set down at rest in a field that already turns; this part of the time does not rule the scale.
_START_SHARE = 0.05
_SPIKE = 1.5
_INCHES_WIDE = 10.0


def plot_trajectory(run: xr.Dataset, ax: Axes | None = None) -> Axes:
    """Plot where the centre of mass goes, displacement (µm) over time (s) along x, y and z.

    Parameters
    ----------
    run
        Result of `tumblers.simulate`.
    ax
        Axes to draw on; those of a new figure if None.

    Returns
    -------
    matplotlib.axes.Axes
        The axes drawn on, three lines labelled by their direction.
    """
    ax = axes_or_new(ax)
    moved = (run["position_m"] - run["position_m"].isel(time=0)) * PER_METRE
    words = {"x": "x (drift)", "y": "y (travel)", "z": "z (height)"}
    for (axis, label), colour, dashes in zip(words.items(), (ORANGE, BLUE, GREEN), ("--", "-", ":"), strict=True):
        ax.plot(run["time"], moved.sel(axis=axis), color=colour, linestyle=dashes, label=label)
    ax.set(title="Centre of mass", xlabel="time (s)", ylabel="displacement (µm)")
    legend_above(ax, ncols=3)
    return ax


def plot_contact_modes(run: xr.Dataset, ax: Axes | None = None) -> Axes:
    """Plot the kind of contact over time (s): airborne, point, line or surface; see `plot_trajectory`."""
    ax = axes_or_new(ax)
    ax.step(run["time"], run["contact_mode"], where="pre", color=BLUE, linewidth=0.8)
    ax.set_yticks(range(len(CONTACT_MODES)), CONTACT_MODES)
    ax.set_ylim(-0.4, len(CONTACT_MODES) - 0.6)
    ax.set(title="Contact with the substrate", xlabel="time (s)", ylabel="contact")
    return ax


def plot_forces(run: xr.Dataset, ax: Axes | None = None) -> Axes:
    """Plot the normal force, the friction along the substrate and the adhesion (µN) over time (s).

    The first row is left out: it is the state before the first step, which has adhesion but no contact force yet. A
    peak at the start (the first 5 % of the time) more than 1.5 times as high as everything later leaves the scale, and
    a note says how high it is.

    Parameters
    ----------
    run
        Result of `tumblers.simulate`.
    ax
        Axes to draw on; those of a new figure if None.

    Returns
    -------
    matplotlib.axes.Axes
        The axes drawn on, three lines labelled by their force.
    """
    ax = axes_or_new(ax)
    steps = run.isel(time=slice(1, None))
    friction = steps["friction_force_N"].sel(tor=["t", "o"])
    lines = {
        "normal": (steps["normal_force_N"].values, BLUE, "-"),
        "friction": (np.hypot(*friction.transpose("tor", "time").values), ORANGE, "-"),
        "adhesion": (steps["adhesion_force_N"].values, GREEN, "--"),
    }
    for label, (force, colour, dashes) in lines.items():
        ax.plot(steps["time"], force * _PER_NEWTON, color=colour, linestyle=dashes, linewidth=0.9, label=label)
    ax.set(title="Contact forces", xlabel="time (s)", ylabel="force (µN)")
    _limit(ax, steps["time"].values, np.array([force for force, _, _ in lines.values()]) * _PER_NEWTON)
    legend_above(ax, ncols=3)
    return ax


def _limit(ax: Axes, time: np.ndarray[Any, Any], forces: np.ndarray[Any, Any]) -> None:
    early = time <= time[0] + _START_SHARE * (time[-1] - time[0])
    start, later = (float(forces[:, rows].max(initial=0.0)) for rows in (early, ~early))
    if start <= _SPIKE * later or later == 0.0:
        return
    lowest = min(float(forces.min(initial=0.0)), 0.0)
    ax.set_ylim(lowest - 0.05 * (later - lowest), later + 0.15 * (later - lowest))
    when = time[early][int(forces[:, early].max(axis=0).argmax())]
    ax.annotate(
        f"off the scale at the start: up to {start:.3g} µN at {when:.2g} s",
        (0.02, 0.985),
        xycoords="axes fraction",
        va="top",
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 1.5},
        fontsize="small",
    )


def plot_run(run: xr.Dataset, figure: Figure | None = None) -> Figure:
    """Draw one figure of a run: trajectory, contact modes, forces, and the view from above.

    Parameters
    ----------
    run
        Result of `tumblers.simulate`.
    figure
        Empty figure to draw on, whose size is set here; a new one of pyplot if None.

    Returns
    -------
    matplotlib.figure.Figure
        The figure drawn on.
    """
    figure = titled_figure(figure, (11.0, 11.0), "Run", run)
    rows: list[Any] = [["trajectory", "forces"], ["modes", "modes"], ["top", "top"]]
    axes = figure.subplot_mosaic(rows)
    plot_trajectory(run, axes["trajectory"])
    plot_forces(run, axes["forces"])
    plot_contact_modes(run, axes["modes"])
    top = plot_top_view(run, ax=axes["top"])
    seen = top.dataLim
    # As high as the path from above needs at equal scale; titles and labels take an inch more.
    inches = [3.9, 2.2, 1.1 + float(np.clip(_INCHES_WIDE * 1.1 * seen.height / seen.width, 0.9, 6.0))]
    grid = top.get_gridspec()
    assert grid is not None
    grid.set_height_ratios(inches)
    figure.set_size_inches(11.0, 0.4 + sum(inches))
    return figure
