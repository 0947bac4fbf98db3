"""Pictures of a run as files, without a display."""

from __future__ import annotations

from io import BytesIO

import xarray as xr
from matplotlib.figure import Figure

from .cycle import plot_cycle
from .snapshots import plot_snapshots, snapshots_size

__all__ = ["cycle_bytes", "snapshots_bytes"]

_DPI = 150.0


def snapshots_bytes(run: xr.Dataset, kind: str, dpi: float = _DPI) -> bytes:
    """Return what `plot_snapshots` draws as a file's content; pyplot stays untouched.

    Parameters
    ----------
    run
        Result of `tumblers.simulate`.
    kind
        ``png``, ``pdf``, ``svg`` or another format of matplotlib.
    dpi
        Dots per inch.
    """
    figure = Figure(figsize=snapshots_size(run), layout="constrained")
    plot_snapshots(run, ax=figure.subplots())
    return _bytes(figure, kind, dpi)


def cycle_bytes(run: xr.Dataset, kind: str, dpi: float = _DPI) -> bytes:
    """Return what `plot_cycle` draws as a file's content; see `snapshots_bytes`."""
    return _bytes(plot_cycle(run, figure=Figure()), kind, dpi)


def _bytes(figure: Figure, kind: str, dpi: float) -> bytes:
    buffer = BytesIO()
    figure.savefig(buffer, format=kind, dpi=dpi)
    return buffer.getvalue()
