"""Figures of a diagnosis: without Axes or Figure of the caller's, every plot is drawn on a new figure of pyplot."""

from .figures import Figures
from .gap import plot_gap
from .heat_map import plot_heat_map
from .overlay import plot_overlay, plot_overlay_channel, plot_overlay_difference
from .parameters import plot_parameters
from .ranking import plot_ranking
from .svg import svg_bytes
from .wrench import plot_wrench

__all__ = [
    "Figures",
    "plot_gap",
    "plot_heat_map",
    "plot_overlay",
    "plot_overlay_channel",
    "plot_overlay_difference",
    "plot_parameters",
    "plot_ranking",
    "plot_wrench",
    "svg_bytes",
]
