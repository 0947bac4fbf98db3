"""Figures as SVG, the same bytes for the same figure."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from io import BytesIO
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure

__all__ = ["WIDTH_IN", "svg_bytes"]

# Of a figure that is still read on a phone.
WIDTH_IN = 4.4

# Coordinates of paths, in points, and the digits that no eye sees.
_COORDINATES = re.compile(rb' (?:d|x|y)="[^"]*"')
_DIGITS = re.compile(rb"(\.\d\d)\d+")
# Outlines, so that no font is needed; a salt, so that the names inside do not differ from one time to the next.
_STYLE: dict[Any, Any] = {
    "svg.fonttype": "path",
    "svg.hashsalt": "tumblers",
    "font.family": "sans-serif",
    "font.size": 9.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
}


def svg_bytes(draw: Callable[[Figure], object], width_in: float, height_in: float) -> bytes:
    """Return what is drawn on a figure as SVG; pyplot, its backends and its figures stay untouched.

    Parameters
    ----------
    draw
        Draws on the figure that it is given.
    width_in, height_in
        Size, inches, unless `draw` sets another.
    """
    buffer = BytesIO()
    with mpl.rc_context(_STYLE), warnings.catch_warnings():
        # A letter that the font does not have is drawn as a box.
        warnings.filterwarnings("ignore", message="Glyph .* missing from")
        figure = Figure(figsize=(width_in, height_in), layout="constrained")
        draw(figure)
        figure.savefig(buffer, format="svg", metadata={"Date": None})
    return _COORDINATES.sub(lambda found: _DIGITS.sub(rb"\1", found[0]), buffer.getvalue())
