"""Figures as files, without a display."""

from __future__ import annotations

from io import BytesIO

import xarray as xr
from matplotlib.figure import Figure

from .run import plot_run
from .sweep import plot_sweep

__all__ = ["figure_bytes"]


def figure_bytes(result: xr.Dataset, kind: str, dpi: float = 150.0) -> bytes:
    """Return the figure of a run or a sweep as a file's content; pyplot, its backends and its figures stay untouched.

    Parameters
    ----------
    result
        What `tumblers.simulate` or `tumblers.sweep` returned.
    kind
        ``png``, ``pdf``, ``svg`` or another format of matplotlib.
    dpi
        Dots per inch.

    Returns
    -------
    bytes
        The content of the file.
    """
    draw = plot_sweep if "magnetization_case" in result.dims else plot_run
    buffer = BytesIO()
    draw(result, Figure()).savefig(buffer, format=kind, dpi=dpi)
    return buffer.getvalue()
