"""What all figures share: units, colours, and axes where none are given."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure

__all__ = ["BLUE", "GREEN", "ORANGE", "PER_METRE", "axes_or_new"]

# Okabe and Ito's colours, told apart by colour-blind readers.
BLUE, ORANGE, GREEN = "#0072B2", "#D55E00", "#009E73"
PER_METRE = 1e6


def axes_or_new(ax: Axes | None) -> Axes:
    """Return `ax`, or the axes of a new figure."""
    return Figure(figsize=(7.0, 4.0), layout="constrained").subplots() if ax is None else ax
