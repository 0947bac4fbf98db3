"""The hypotheses that were fitted, the best first."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from ...plots.style import BLUE, axes_or_new
from ..quantity import percent
from ..result import RankedHypothesis

__all__ = ["plot_ranking"]

_MOST = 10


def plot_ranking(ranking: Sequence[RankedHypothesis], ax: Axes | None = None, most: int = _MOST) -> Axes:
    """Plot the probabilities of the hypotheses that were fitted, the best on top.

    Parameters
    ----------
    ranking
        `Diagnosis.ranking`.
    ax
        Axes to draw on; those of a new figure if None.
    most
        How many are drawn at most.

    Returns
    -------
    matplotlib.axes.Axes
        The axes drawn on, a bar for each hypothesis with its probability and its gap on trials not fitted.
    """
    ax = axes_or_new(ax)
    shown = ranking[:most]
    places = range(len(shown))
    probabilities = [ranked.probability for ranked in shown]
    ax.barh(places, probabilities, color=BLUE, height=0.65)
    for place, ranked in zip(places, shown, strict=True):
        held_out = ranked.held_out_gap
        left = f", {held_out:.3g} σ held out" if held_out is not None and np.isfinite(held_out) else ""
        inside = ranked.probability > 0.5
        ax.text(
            ranked.probability + (-0.015 if inside else 0.015),
            place,
            f"{percent(ranked.probability)}{left}",
            va="center",
            ha="right" if inside else "left",
            color="white" if inside else "0.15",
            fontsize="small",
        )
    names = [" +\n".join(name.replace("_", " ") for name in ranked.effects) or "nominal model" for ranked in shown]
    ax.set_yticks(places, names, fontsize="small")
    ax.invert_yaxis()
    ax.set_xlim(0.0, 1.0)
    ax.set(xlabel="probability")
    ax.set_title("Hypotheses", loc="left")
    return ax
