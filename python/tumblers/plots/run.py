"""Figures of one run."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..simulate import CONTACT_MODES
from .style import BLUE, GREEN, ORANGE, PER_METRE, axes_or_new
from .top_view import plot_top_view

__all__ = ["plot_contact_modes", "plot_forces", "plot_run", "plot_trajectory"]

_PER_NEWTON = 1e6


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
    ax.set(title="Displacement of the centre of mass", xlabel="time (s)", ylabel="displacement (µm)")
    ax.legend()
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
    """Plot the normal force, the friction along the substrate and the adhesion (µN) over time (s)."""
    ax = axes_or_new(ax)
    friction = run["friction_force_N"].sel(tor=["t", "o"])
    lines = {
        "normal": (run["normal_force_N"], BLUE, "-"),
        "friction": (np.hypot(friction.sel(tor="t"), friction.sel(tor="o")), ORANGE, "-"),
        "adhesion": (run["adhesion_force_N"], GREEN, "--"),
    }
    for label, (force, colour, dashes) in lines.items():
        ax.plot(run["time"], force * _PER_NEWTON, color=colour, linestyle=dashes, linewidth=0.9, label=label)
    ax.set(title="Contact forces", xlabel="time (s)", ylabel="force (µN)")
    ax.legend()
    return ax


def plot_run(run: xr.Dataset) -> Figure:
    """Return one figure of a run: trajectory, contact modes, forces, and the view from above."""
    figure = Figure(figsize=(11.0, 11.0), layout="constrained")
    rows: list[Any] = [["trajectory", "forces"], ["modes", "modes"], ["top", "top"]]
    axes = figure.subplot_mosaic(rows, height_ratios=[1.0, 0.6, 1.2])
    plot_trajectory(run, axes["trajectory"])
    plot_forces(run, axes["forces"])
    plot_contact_modes(run, axes["modes"])
    plot_top_view(run, ax=axes["top"])
    return figure
