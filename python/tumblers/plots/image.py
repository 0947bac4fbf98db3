"""Figures as files, without a display."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO

import xarray as xr
from matplotlib.figure import Figure

from .run import plot_run
from .sweep import plot_sweep

__all__ = ["figure_bytes"]


def figure_bytes(
    result: xr.Dataset, kind: str, dpi: float = 150.0, draw: Callable[[xr.Dataset, Figure], Figure] | None = None
) -> bytes:
    """Return the figure of a result as a file's content; pyplot, its backends and its figures stay untouched.

    Parameters
    ----------
    result
        What is drawn.
    kind
        ``png``, ``pdf``, ``svg`` or another format of matplotlib.
    dpi
        Dots per inch.
    draw
        Draws it; `plot_run` or `plot_sweep`, for what `tumblers.simulate` or `tumblers.sweep` returned, if None.

    Returns
    -------
    bytes
        The content of the file.
    """
    if draw is None:
        draw = plot_sweep if "magnetization_case" in result.dims else plot_run
    buffer = BytesIO()
    draw(result, Figure()).savefig(buffer, format=kind, dpi=dpi)
    return buffer.getvalue()
