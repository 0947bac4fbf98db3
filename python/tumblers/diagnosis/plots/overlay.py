"""A trial's measurement over what the model says of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...plots.style import BLUE, ORANGE, PER_METRE, axes_or_new, figure_or_new
from ..result import Floats, Overlay
from .literal import literal

__all__ = ["plot_overlay", "plot_overlay_channel", "plot_overlay_difference"]

_CHANNELS = {
    "x": ("x (µm)", PER_METRE),
    "y": ("y (µm)", PER_METRE),
    "z": ("z (µm)", PER_METRE),
    "tilt": ("tilt (°)", 1.0),
    "heading": ("heading (°)", 1.0),
}
# As many dots as can be told apart.
_MOST_DOTS = 150
_CHANNEL_INCHES, _FRAME_INCHES = 1.15, 1.0
# Within so many standard deviations of the noise are 95 % of what a right model is measured as.
_BAND_SIGMAS = 2.0


def plot_overlay_channel(overlay: Overlay, channel: str, ax: Axes | None = None) -> Axes:
    """Plot one channel of a trial over time (s): measured, nominal, and with the effects of a fit that has not seen it.

    The band about the last is what counts as noise, two standard deviations to either side.

    Parameters
    ----------
    overlay
        One of `Diagnosis.overlays`.
    channel
        ``x``, ``y``, ``z``, ``tilt`` or ``heading``.
    ax
        Axes to draw on; those of a new figure if None.

    Returns
    -------
    matplotlib.axes.Axes
        The axes drawn on.
    """
    ax = axes_or_new(ax)
    label, factor = _CHANNELS.get(channel, (channel, 1.0))
    every = max(1, -(-len(overlay.time_s) // _MOST_DOTS))
    if channel == "heading":
        overlay = _turned(overlay)
    measured = np.asarray(overlay.measured[channel], dtype=float)
    dots, values = overlay.time_s[::every], factor * measured[::every]
    ax.plot(dots, values, ".", color="0.35", markersize=3.0, label="measured", zorder=3)
    lines = ((overlay.nominal, ORANGE, "--", "nominal"), (overlay.explained, BLUE, "-", "with the effects"))
    for paths, colour, dashes, name in lines:
        if channel in paths:
            values = factor * np.asarray(paths[channel], dtype=float)
            if channel == "heading":
                # A line across the whole panel is no motion.
                values = np.where(
                    np.abs(np.diff(values, prepend=values[:1])) > 0.5 * overlay.heading_turn_deg, np.nan, values
                )
            ax.plot(overlay.time_s, values, color=colour, linestyle=dashes, linewidth=1.3, label=name)
            if name == "with the effects" and channel in overlay.noise:
                _band(ax, overlay, channel, values)
    ax.set_ylabel(label)
    return ax


def _band(ax: Axes, overlay: Overlay, channel: str, values: Floats) -> None:
    """Shade what noise makes of a line; where nothing was measured it has a gap, and it does not stretch the panel."""
    wide = _BAND_SIGMAS * _CHANNELS.get(channel, ("", 1.0))[1] * np.asarray(overlay.noise[channel], dtype=float)
    limits = ax.get_ylim()
    ax.fill_between(
        overlay.time_s,
        values - wide,
        values + wide,
        color=BLUE,
        alpha=0.2,
        linewidth=0.0,
        label="noise, 2 sigma",
    )
    ax.set_ylim(limits)


def _turned(overlay: Overlay) -> Overlay:
    """Return an overlay whose headings are those nearest to the nominal ones: 179° and -179° are near."""
    if "heading" not in overlay.nominal:
        return overlay
    nominal, turn = np.asarray(overlay.nominal["heading"], dtype=float), overlay.heading_turn_deg

    def near(paths: Mapping[str, Floats]) -> Mapping[str, Floats]:
        if "heading" not in paths:
            return paths
        away = np.asarray(paths["heading"], dtype=float) - nominal
        return {**paths, "heading": nominal + away - turn * np.round(away / turn)}

    return replace(overlay, measured=near(overlay.measured), explained=near(overlay.explained))


def plot_overlay_difference(overlay: Overlay, channel: str, ax: Axes | None = None) -> Axes:
    """Plot one channel of a trial less the nominal model's over time (s); see `plot_overlay_channel`.

    Parameters
    ----------
    overlay
        One of `Diagnosis.overlays`.
    channel
        One that has a nominal path.
    ax
        Axes to draw on; those of a new figure if None.

    Returns
    -------
    matplotlib.axes.Axes
        The axes drawn on.
    """
    nominal = np.asarray(overlay.nominal[channel], dtype=float)

    def less(paths: Mapping[str, Floats]) -> dict[str, Floats]:
        return {channel: np.asarray(paths[channel], dtype=float) - nominal} if channel in paths else {}

    differences = replace(
        overlay, measured=less(overlay.measured), nominal=less(overlay.nominal), explained=less(overlay.explained)
    )
    ax = plot_overlay_channel(differences, channel, ax)
    ax.set_ylabel(f"{channel} - nominal\n{_CHANNELS[channel][0].partition(' ')[2]}")
    return ax


def plot_overlay(overlay: Overlay, figure: Figure | None = None) -> Figure:
    """Draw what a trial is off along y, and all its channels, one above the other; see `plot_overlay_channel`.

    Parameters
    ----------
    overlay
        One of `Diagnosis.overlays`.
    figure
        Empty figure to draw on, whose size is set here; a new one of pyplot if None.

    Returns
    -------
    matplotlib.figure.Figure
        The figure drawn on.
    """
    channels = [name for name in _CHANNELS if name in overlay.measured]
    figure = figure_or_new(figure, (4.4, _FRAME_INCHES + _CHANNEL_INCHES * max(len(channels), 1)))
    figure.suptitle(literal(overlay.trial), x=0.01, ha="left", fontsize="medium", fontweight="bold")
    if not channels:
        figure.text(0.5, 0.5, "no track", ha="center", va="center", color="0.4")
        return figure
    # Beside the way that a robot goes in a trial, what it is off can hardly be seen.
    difference = "y" in channels and "y" in overlay.nominal
    rows = len(channels) + difference
    figure.set_size_inches(4.4, _FRAME_INCHES + _CHANNEL_INCHES * rows)
    axes = figure.subplots(rows, 1, sharex=True, squeeze=False)[:, 0]
    for ax, channel in zip(axes[difference:], channels, strict=True):
        plot_overlay_channel(overlay, channel, ax)
    if difference:
        plot_overlay_difference(overlay, "y", axes[0])
    figure.align_ylabels(axes)
    axes[-1].set_xlabel("time (s)")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="outside lower center", ncols=4, fontsize="small", frameon=False, columnspacing=1.0
    )
    return figure
