"""The robot from above."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection

from .scene import Scene
from .style import PER_METRE, axes_or_new, legend_above

__all__ = ["plot_top_view"]


def plot_top_view(run: xr.Dataset, snapshots: int = 8, ax: Axes | None = None) -> Axes:
    """Plot the path from above, travel to the right, with snapshots of the real body's faces.

    Parameters
    ----------
    run
        Result of `tumblers.simulate`; the body is that of its scenario with every effect.
    snapshots
        Number of snapshots, spread evenly over the run's rows.
    ax
        Axes to draw on; those of a new figure if None.

    Returns
    -------
    matplotlib.axes.Axes
        The axes drawn on: y to the right and x downwards, µm, of equal scale.

    Raises
    ------
    InputError
        Something else than a run.
    """
    scene = Scene.of(run)
    ax = axes_or_new(ax)
    rows = np.unique(np.linspace(0, scene.time_s.size - 1, max(snapshots, 1)).round().astype(int))
    colours = colormaps["viridis"](np.linspace(0.0, 0.9, len(rows)))
    for row, colour in zip(rows, colours, strict=True):
        turn, at = scene.rotation[row], scene.position_m[row]
        faces = sorted((face @ turn.T + at for face in scene.faces), key=lambda face: float(face[:, 2].mean()))
        ax.add_collection(
            PolyCollection(
                [face[:, [1, 0]] * PER_METRE for face in faces],
                facecolors=[(*colour[:3], 0.25)],
                edgecolors=[(*colour[:3], 0.9)],
                linewidths=0.7,
                label=f"{scene.time_s[row]:.3g} s",
            )
        )
    x, y = scene.position_m[:, :2].T * PER_METRE
    ax.plot(y, x, color="black", linewidth=1.0, label="centre of mass")
    ax.set_aspect("equal", adjustable="datalim")
    ax.autoscale_view()
    if not ax.yaxis_inverted():
        ax.invert_yaxis()
    ax.set(title="View from above", xlabel="y (µm), direction of travel", ylabel="x (µm)")
    legend_above(ax, ncols=-(-(len(rows) + 1) // 2))
    return ax
