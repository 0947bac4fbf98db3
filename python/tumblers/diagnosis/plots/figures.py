"""`Figures`: the figures of one diagnosis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...errors import InputError, show
from ...plots.style import figure_or_new
from ..diagnosis import Diagnosis
from .gap import plot_gap
from .heat_map import plot_heat_map
from .overlay import plot_overlay
from .parameters import plot_parameters
from .ranking import plot_ranking
from .wrench import By, plot_wrench

__all__ = ["Figures"]


@dataclass(frozen=True, eq=False, slots=True)
class Figures:
    """What `Diagnosis.plots` is: each method draws on the caller's Axes or Figure, or on a new figure of pyplot.

    Attributes
    ----------
    diagnosis
        What is drawn.
    """

    diagnosis: Diagnosis

    def gap(self, ax: Axes | None = None) -> Axes:
        """Plot the gap of each trial; see `plot_gap`."""
        return plot_gap(self.diagnosis.gap, ax)

    def ranking(self, ax: Axes | None = None) -> Axes:
        """Plot the hypotheses; see `plot_ranking`."""
        return plot_ranking(self.diagnosis.ranking, ax)

    def parameters(self, ax: Axes | None = None) -> Axes:
        """Plot the estimates; see `plot_parameters`."""
        return plot_parameters(self.diagnosis, ax)

    def where(self, figure: Figure | None = None) -> Figure:
        """Draw the maps of where the gap lies, two to a row; see `plot_heat_map`."""
        maps = self.diagnosis.heat_maps
        rows = max(1, -(-len(maps) // 2))
        figure = figure_or_new(figure, (11.0, 4.2 * rows))
        axes = np.ravel(figure.subplots(rows, 2, squeeze=False))
        for ax, heat_map in zip(axes, maps, strict=False):
            plot_heat_map(heat_map, ax)
        for ax in axes[len(maps) :]:
            ax.set_axis_off()
        return figure

    def wrench(self, by: By = "phase", figure: Figure | None = None) -> Figure:
        """Draw the missing force above the missing torque; see `plot_wrench`.

        Raises
        ------
        InputError
            A diagnosis without tracks, which has no missing wrench.
        """
        missing = self.diagnosis.missing_wrench
        if missing is None:
            raise InputError("missing_wrench", "none", "a diagnosis with tracks")
        figure = figure_or_new(figure, (7.0, 6.5))
        above, below = figure.subplots(2, 1)
        plot_wrench(missing, by, "force", above)
        plot_wrench(missing, by, "torque", below)
        return figure

    def overlay(self, trial: str, figure: Figure | None = None) -> Figure:
        """Draw a trial's measurement over the model's, before and after; see `plot_overlay`.

        Raises
        ------
        InputError
            No such trial.
        """
        for overlay in self.diagnosis.overlays:
            if overlay.trial == trial:
                return plot_overlay(overlay, figure)
        known = ", ".join(overlay.trial for overlay in self.diagnosis.overlays) or "none, there are no overlays"
        raise InputError("trial", show(trial), f"one of {known}")
