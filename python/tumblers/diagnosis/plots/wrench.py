"""The missing wrench over phase, contact mode, place or frequency."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from ...plots.style import BLUE, GREEN, ORANGE, axes_or_new, legend_above
from ..quantity import handy_unit
from ..result import Floats, MissingWrench, WrenchMean
from .literal import shortened

__all__ = ["By", "Part", "averages", "plot_wrench"]

By = Literal["phase", "mode", "place", "frequency"]
Part = Literal["force", "torque"]

_WORDS: dict[By, str] = {
    "phase": "phase",
    "mode": "contact",
    "place": "place",
    "frequency": "frequency",
}
_PARTS: dict[Part, tuple[int, str, str]] = {"force": (0, "N", "F"), "torque": (3, "N m", "T")}
_COLOURS = (ORANGE, BLUE, GREEN)
# Between the components of a label, of the way to the next label.
_APART = 0.2
_LONGEST = 14
# An estimate as uncertain as this share of what was assumed beforehand says nothing.
_UNKNOWN = 0.7
# One that is this certain sets the scale.
_CLEAR = 0.2


def averages(missing: MissingWrench, by: By) -> Mapping[str, WrenchMean]:
    """Return the averages of a missing wrench by label."""
    return {"phase": missing.by_phase, "mode": missing.by_mode, "place": missing.by_place}.get(by, missing.by_frequency)


def plot_wrench(missing: MissingWrench, by: By = "phase", part: Part = "force", ax: Axes | None = None) -> Axes:
    """Plot the force or the torque that the model lacks, with one standard deviation.

    Hollow markers are averages of which the data say next to nothing; an arrow at the edge is one that lies beyond.

    Parameters
    ----------
    missing
        `Diagnosis.missing_wrench`.
    by
        ``phase``, ``mode``, ``place`` or ``frequency``.
    part
        ``force`` or ``torque``.
    ax
        Axes to draw on; those of a new figure if None.

    Returns
    -------
    matplotlib.axes.Axes
        The axes drawn on, three series labelled by their direction.
    """
    ax = axes_or_new(ax)
    first, unit, letter = _PARTS[part]
    groups = averages(missing, by)
    mine = slice(first, first + 3)
    values = np.array([mean.wrench[mine] for mean in groups.values()]).reshape(-1, 3)
    sigmas = np.array([mean.sigma[mine] for mean in groups.values()]).reshape(-1, 3)
    unsure = sigmas / np.array([mean.prior_sigma[mine] for mean in groups.values()]).reshape(-1, 3)
    sizes = np.abs(np.concatenate([values, sigmas]))
    factor, written = handy_unit(float(sizes[np.isfinite(sizes)].max(initial=0.0)), unit)
    places = np.arange(len(groups))
    for axis, (colour, marker) in enumerate(zip(_COLOURS, "sov", strict=True)):
        sure = unsure[:, axis] < _UNKNOWN
        for chosen, face in ((sure, colour), (~sure, "white")):
            # One of the two carries the name, though it may have nothing to draw.
            ax.errorbar(
                places[chosen] + _APART * (axis - 1),
                factor * values[chosen, axis],
                factor * sigmas[chosen, axis],
                color=colour,
                marker=marker,
                markersize=4.5,
                markerfacecolor=face,
                linestyle="none",
                elinewidth=1.0 if face != "white" else 0.6,
                capsize=2.0,
                label=f"{letter}{'xyz'[axis]}" if face != "white" else None,
            )
    reach = np.abs(values) + sigmas
    for share in (_CLEAR, _UNKNOWN):
        clear = (unsure < share) & np.isfinite(reach)
        if clear.any():
            # The bars of which the data say less are cut off, so that the others can be read.
            highest = 1.25 * factor * float(reach[clear].max())
            ax.set_ylim(-highest, highest)
            _mark_beyond(ax, places, factor * values, highest)
            break
    ax.axhline(0.0, color="0.5", linewidth=0.8, zorder=0)
    labels = [shortened(label, _LONGEST) for label in groups]
    slanted = len(labels) > 5 or sum(map(len, labels)) > 40
    rotation: dict[str, Any] = {"rotation": 40.0, "ha": "right", "rotation_mode": "anchor"} if slanted else {}
    ax.set_xticks(places, labels, fontsize="small", **rotation)
    ax.set_xlim(-0.6, max(len(labels), 1) - 0.4)
    ax.set(title=f"Missing {part} by {_WORDS[by]}", ylabel=f"{part} ({written})")
    legend_above(ax, ncols=3)
    ax.set_title(ax.get_title(loc="left"), loc="left", fontsize="medium")
    return ax


def _mark_beyond(ax: Axes, places: NDArray[np.int_], values: Floats, highest: float) -> None:
    """Mark values that lie beyond the edges by arrows there, of which nothing else would be seen."""
    for axis, colour in enumerate(_COLOURS):
        for sign, arrow in ((1.0, "$\\uparrow$"), (-1.0, "$\\downarrow$")):
            beyond = sign * values[:, axis] > highest
            at = places[beyond] + _APART * (axis - 1)
            ax.plot(at, np.full(at.shape, 0.93 * sign * highest), color=colour, marker=arrow, linestyle="none")
