"""What all figures share: units, colours, words, and axes where none are given."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..field import RotatingField, StaticField
from ..scenario import Scenario

__all__ = ["BLUE", "GREEN", "ORANGE", "PER_METRE", "axes_or_new", "figure_or_new", "legend_above", "scenario_words"]

# Okabe and Ito's colours, told apart by colour-blind readers.
BLUE, ORANGE, GREEN = "#0072B2", "#D55E00", "#009E73"
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


def scenario_words(scenario: str) -> str:
    """Return robot and field of a scenario's TOML in a few words."""
    read = Scenario.from_toml(scenario)
    robot, field = f"{read.robot.shape.kind.replace('_', ' ')} robot", read.field
    if isinstance(field, RotatingField):
        return f"{robot}, {field.strength_T * 1e3:g} mT at {field.frequency_Hz:g} Hz"
    return f"{robot}, static field" if isinstance(field, StaticField) else f"{robot}, field from a table"
