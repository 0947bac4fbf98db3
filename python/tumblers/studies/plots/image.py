"""Figures of studies as files, without a display."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO

import xarray as xr
from matplotlib.figure import Figure

__all__ = ["study_bytes"]


def study_bytes(
    draw: Callable[[xr.Dataset, Figure], Figure], result: xr.Dataset, kind: str, dpi: float = 150.0
) -> bytes:
    """Return the figure of a study as a file's content; pyplot, its backends and its figures stay untouched.

    Parameters
    ----------
    draw
        One of the functions of this package.
    result
        What the study returned.
    kind
        ``png``, ``pdf``, ``svg`` or another format of matplotlib.
    dpi
        Dots per inch.

    Returns
    -------
    bytes
        The content of the file.
    """
    buffer = BytesIO()
    draw(result, Figure()).savefig(buffer, format=kind, dpi=dpi)
    return buffer.getvalue()
