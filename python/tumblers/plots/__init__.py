"""Figures: every function takes and returns Axes, or returns a whole Figure."""

from .run import plot_contact_modes, plot_forces, plot_run, plot_trajectory
from .sweep import plot_map, plot_sweep
from .top_view import plot_top_view

__all__ = [
    "plot_contact_modes",
    "plot_forces",
    "plot_map",
    "plot_run",
    "plot_sweep",
    "plot_top_view",
    "plot_trajectory",
]
