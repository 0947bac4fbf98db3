"""The body of a scene drawn on axes, seen from far away along an axis of the substrate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb

from .scene import Scene

__all__ = ["ABOVE", "PER_MM", "SIDE", "View", "draw_body"]

PER_MM = 1e3
_LINE = 0.8
# How far a face that is turned away from the light fades to black, and every face to white.
_SHADE, _TINT = 0.35, 0.45


@dataclass(frozen=True, slots=True)
class View:
    """The substrate's axes along the picture's horizontal and vertical, and the unit vector to the eye."""

    across: int
    upward: int
    towards: tuple[float, float, float]


# x to the right and y up; y to the right and z up, seen from +x.
ABOVE = View(0, 1, (0.0, 0.0, 1.0))
SIDE = View(1, 2, (1.0, 0.0, 0.0))


def draw_body(
    ax: Axes, scene: Scene, row: int, view: View, colour: str, *, alpha: float = 1.0, zorder: float = 2.0
) -> PolyCollection:
    """Draw the body at a row, mm, its hidden faces and edges left out.

    Parameters
    ----------
    ax
        Axes to draw on.
    scene, row
        The run, and which of its rows.
    view
        From where.
    colour
        Colour of the body; its edges have it in full, its faces a tint of it.
    alpha, zorder
        Opacity of the faces, and the order among the other things on the axes.

    Returns
    -------
    matplotlib.collections.PolyCollection
        What was added to the axes.
    """
    shapes, fills, lines = [], [], []
    full = np.array(to_rgb(colour))
    for face, normal, edges in scene.seen(row, view.towards):
        lit = 1.0 - _SHADE * (1.0 - float(normal @ np.asarray(view.towards)))
        tint = (*(lit * (full + _TINT * (1.0 - full))), alpha)
        shapes += [face, *edges]
        fills += [tint, *[(0.0, 0.0, 0.0, 0.0)] * len(edges)]
        # A face without a line of its own colour would leave a hair of background beside its neighbour.
        lines += [tint if alpha == 1.0 else (0.0, 0.0, 0.0, 0.0), *[(*full * 0.8, 1.0)] * len(edges)]
    drawn = PolyCollection(
        [shape[:, [view.across, view.upward]] * PER_MM for shape in shapes],
        facecolors=fills,
        edgecolors=lines,
        linewidths=_LINE,
        capstyle="round",
        zorder=zorder,
    )
    ax.add_collection(drawn)
    return drawn
