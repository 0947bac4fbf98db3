"""The robot from above."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection

from ..scenario import Scenario
from .style import PER_METRE, axes_or_new, legend_above

__all__ = ["plot_top_view"]


def plot_top_view(run: xr.Dataset, snapshots: int = 8, ax: Axes | None = None) -> Axes:
    """Plot the path from above, travel to the right, with snapshots of the real body's faces.

    Parameters
    ----------
    run
        Result of `tumblers.simulate`; the body is that of its scenario.
    snapshots
        Number of snapshots, spread evenly over the run's rows.
    ax
        Axes to draw on; those of a new figure if None.

    Returns
    -------
    matplotlib.axes.Axes
        The axes drawn on: y to the right and x downwards, µm, of equal scale.
    """
    ax = axes_or_new(ax)
    outline = Scenario.from_toml(run.attrs["scenario"]).robot.body().outline
    position, orientation = run["position_m"].values, run["orientation"].values
    rows = np.unique(np.linspace(0, run.sizes["time"] - 1, max(snapshots, 1)).round().astype(int))
    colours = colormaps["viridis"](np.linspace(0.0, 0.9, len(rows)))
    for row, colour in zip(rows, colours, strict=True):
        turn = _rotation(orientation[row])
        faces = sorted((face @ turn.T + position[row] for face in outline), key=lambda face: float(face[:, 2].mean()))
        ax.add_collection(
            PolyCollection(
                [face[:, [1, 0]] * PER_METRE for face in faces],
                facecolors=[(*colour[:3], 0.25)],
                edgecolors=[(*colour[:3], 0.9)],
                linewidths=0.7,
                label=f"{float(run['time'][row]):.3g} s",
            )
        )
    x, y = position[:, 0] * PER_METRE, position[:, 1] * PER_METRE
    ax.plot(y, x, color="black", linewidth=1.0, label="centre of mass")
    ax.set_aspect("equal", adjustable="datalim")
    ax.autoscale_view()
    if not ax.yaxis_inverted():
        ax.invert_yaxis()
    ax.set(title="View from above", xlabel="y (µm), direction of travel", ylabel="x (µm)")
    legend_above(ax, ncols=-(-(len(rows) + 1) // 2))
    return ax


def _rotation(quaternion: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    w, x, y, z = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
