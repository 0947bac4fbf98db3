"""What all figures share: units, colours, words, and axes where none are given."""

from __future__ import annotations

import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import Normal, withStroke

from ..field import RotatingField, StaticField
from ..scenario import Scenario

__all__ = [
    "BLUE",
    "GREEN",
    "ORANGE",
    "PER_METRE",
    "RED",
    "axes_or_new",
    "figure_or_new",
    "legend_above",
    "on_white",
    "scenario_words",
    "titled_figure",
]

# Okabe and Ito's colours, told apart by colour-blind readers.
BLUE, ORANGE, GREEN = "#0072B2", "#D55E00", "#009E73"
# Marks what is good on a map, on any of its colours.
RED = "#E31A1C"
PER_METRE = 1e6


def figure_or_new(figure: Figure | None, figsize: tuple[float, float]) -> Figure:
    """Return `figure`, or a new one of pyplot, its current figure from then on."""
    if figure is not None:
        figure.set_size_inches(*figsize)
        figure.set_layout_engine("constrained")
        return figure
    # pyplot is not imported with the package: a program that gives its own figures needs no backend.
    from matplotlib import pyplot as plt

    return plt.figure(figsize=figsize, layout="constrained")


def titled_figure(
    figure: Figure | None, figsize: tuple[float, float], title: str, result: xr.Dataset, more: str = ""
) -> Figure:
    """Return `figure_or_new` under a title, which the robot and the field of a result's scenario follow, and `more`."""
    figure = figure_or_new(figure, figsize)
    figure.suptitle(f"{title}: {scenario_words(result.attrs['scenario'])}{more}")
    return figure


def axes_or_new(ax: Axes | None) -> Axes:
    """Return `ax`, or the axes of a new figure of pyplot."""
    return figure_or_new(None, (7.0, 4.0)).subplots() if ax is None else ax


def legend_above(ax: Axes, **options: object) -> None:
    """Put the title to the left and the legend to the right above the axes, where it hides no data."""
    ax.set_title(ax.get_title(), loc="left")
    ax.set_title("")
    ax.legend(
        loc="lower right",
        bbox_to_anchor=(1.0, 1.0),
        fontsize="small",
        frameon=False,
        borderaxespad=0.1,
        **{"handlelength": 1.6, "columnspacing": 1.2} | options,
    )


def on_white(artist: Artist, linewidth: float) -> None:
    """Draw a line or an edge over a wider white one."""
    artist.set_path_effects([withStroke(linewidth=linewidth, foreground="white"), Normal()])


def scenario_words(scenario: str) -> str:
    """Return robot and field of a scenario's TOML in a few words."""
    read = Scenario.from_toml(scenario)
    robot, field = f"{read.robot.shape.kind.replace('_', ' ')} robot", read.field
    if isinstance(field, RotatingField):
        return f"{robot}, {field.strength_T * 1e3:g} mT at {field.frequency_Hz:g} Hz"
    return f"{robot}, static field" if isinstance(field, StaticField) else f"{robot}, field from a table"
