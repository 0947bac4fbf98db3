"""Figures: without Axes or Figure of the caller's, every function draws on a new figure of pyplot."""

from .animation import animation_bytes
from .cycle import plot_cycle
from .image import figure_bytes
from .run import plot_contact_modes, plot_forces, plot_run, plot_trajectory
from .snapshots import plot_snapshots
from .sweep import plot_map, plot_sweep
from .top_view import plot_top_view

__all__ = [
    "animation_bytes",
    "figure_bytes",
    "plot_contact_modes",
    "plot_cycle",
    "plot_forces",
    "plot_map",
    "plot_run",
    "plot_snapshots",
    "plot_sweep",
    "plot_top_view",
    "plot_trajectory",
]
