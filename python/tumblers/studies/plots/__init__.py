"""Figures of the studies: without a Figure of the caller's, every function draws on a new one of pyplot."""

from .climb import plot_climb
from .convergence import plot_convergence
from .design import plot_design
from .tolerance import plot_tolerance

__all__ = ["plot_climb", "plot_convergence", "plot_design", "plot_tolerance"]
