"""Figure of `design`: the space, its front, and the candidates."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from ...plots.style import GREEN, ORANGE, PER_METRE, legend_above, titled_figure
from ...scenario import Scenario
from ..family import Family, family_of

__all__ = ["plot_design"]

_LOOKS = {"base": ("0.25", "s"), "nominal": (ORANGE, "D"), "robust": (GREEN, "*")}


def plot_design(design: xr.Dataset, figure: Figure | None = None) -> Figure:
    """Draw the design space twice, the side views of the candidates, and what they do with errors.

    Left above: drift over the errors against speed without, coloured by the slope climbed. Right above: slope climbed
    against the tipping field, coloured by the speed. Designs on the Pareto front have black edges. Left below: side
    views. Right below: drift and speed of every robot drawn, those that flip as crosses.

    Parameters
    ----------
    design
        Result of `tumblers.design`.
    figure
        Empty figure to draw on, whose size is set here; a new one of pyplot if None.

    Returns
    -------
    matplotlib.figure.Figure
        The figure drawn on.
    """
    gain, error = (design.attrs[f"robust_gain{end}_m_per_s"] * PER_METRE for end in ("", "_error"))
    more = f"\nrobust over nominal, on robots that no search has seen: {gain:+.0f} ± {error:.0f} µm/s of mean merit"
    figure = titled_figure(figure, (12.0, 9.6), "Designs", design, more)
    (speed_drift, field_slope), (views, draws) = figure.subplots(2, 2)
    speed = ("speed_m_per_s", PER_METRE, "speed without errors (µm/s)")
    drift = ("error_drift_m", PER_METRE, "mean |drift| in a cycle over the errors (µm)")
    slope = ("climb_deg", 1.0, "slope climbed (°)")
    field = ("tipping_field_T", 1e3, "tipping field (mT)")
    _space(figure, speed_drift, design, speed, drift, slope)
    _space(figure, field_slope, design, field, slope, speed)
    _views(views, design)
    _draws(draws, design)
    return figure


Quantity = tuple[str, float, str]


def _space(figure: Figure, ax: Axes, design: xr.Dataset, x: Quantity, y: Quantity, colour: Quantity) -> None:
    shown = design.isel(design=np.flatnonzero(design["turns"].values.astype(bool)))
    front = shown["front"].values.astype(bool)
    columns = [shown[name].values * factor for name, factor, _ in (x, y, colour)]
    norm = Normalize(np.nanmin(columns[2], initial=np.inf), np.nanmax(columns[2], initial=-np.inf))
    for chosen, edge, size in ((~front, "none", 22.0), (front, "black", 42.0)):
        points = ax.scatter(
            columns[0][chosen],
            columns[1][chosen],
            c=columns[2][chosen],
            cmap="cividis",
            s=size,
            edgecolors=edge,
            linewidths=0.9,
            label="on the front" if edge == "black" else None,
            norm=norm,
        )
    figure.colorbar(points, ax=ax, label=colour[2])
    for place, (name, (look, marker)) in enumerate(_LOOKS.items()):
        at = [float(design[f"candidate_{q[0]}"][place]) * q[1] for q in (x, y)]
        size = 220.0 if marker == "*" else 75.0
        ax.scatter(
            at[0], at[1], color=look, marker=marker, s=size, edgecolors="white", linewidths=1.0, zorder=4, label=name
        )
    ax.set(xlabel=x[2], ylabel=y[2])
    legend_above(ax, ncols=4)


def _views(ax: Axes, design: xr.Dataset) -> None:
    family = family_of(Scenario.from_toml(design.attrs["scenario"]).robot)
    below = 0.0
    for place, (name, (colour, _)) in enumerate(_LOOKS.items()):
        profile = _profile(design, family, place) * PER_METRE
        below -= float(np.ptp(profile[:, 1]))
        profile[:, 1] += below - profile[:, 1].min()
        ax.fill(*profile.T, facecolor=colour, edgecolor="black", linewidth=0.8, alpha=0.55)
        names = {p.name: p.name.rsplit("_", 1)[0].replace("_", " ") for p in family.parameters}
        words = [f"{plain} {_shown(design, key, place)}" for key, plain in names.items()]
        label = "\n".join([name, *words])
        ax.annotate(
            label,
            (1.03 * float(profile[:, 0].max()), float(profile[:, 1].mean())),
            va="center",
            fontsize="small",
            color="black",
        )
        below -= 0.18 * float(np.ptp(profile[:, 0]))
    ax.set_xlim(right=2.6 * float(profile[:, 0].max()))
    ax.set_aspect("equal")
    ax.set_title("Side views", loc="left")
    ax.set(xlabel="along the length (µm)", yticks=[])
    ax.spines[["left", "right", "top"]].set_visible(False)


def _shown(design: xr.Dataset, name: str, place: int) -> str:
    value = float(design[f"candidate_{name}"][place])
    attrs = design[name].attrs
    room = 0.02 * (attrs["high"] - attrs["low"])
    bound = " (at its bound)" if value <= attrs["low"] + room or value >= attrs["high"] - room else ""
    return f"{value:.1f}°{bound}" if name.endswith("_deg") else f"{value * PER_METRE:.0f} µm{bound}"


def _profile(design: xr.Dataset, family: Family, place: int) -> np.ndarray[Any, Any]:
    values = [float(design[f"candidate_{p.name}"][place]) for p in family.parameters]
    outline = family.robot(values).body().outline
    (side,) = (polygon for polygon in outline if np.ptp(polygon[:, 0]) == 0.0 and polygon[0, 0] > 0.0)
    return np.array(side[:, 1:])


def _draws(ax: Axes, design: xr.Dataset) -> None:
    for place, (name, (colour, _)) in enumerate(_LOOKS.items()):
        speed = design["draw_speed_m_per_s"].values[place] * PER_METRE
        drift = np.abs(design["draw_drift_m"].values[place]) * PER_METRE
        upright = design["draw_upright"].values[place].astype(bool)
        merit = float(design["candidate_robust_merit_m_per_s"][place]) * PER_METRE
        words = f"{name}: {100.0 * upright.mean():.0f} % upright,\nmean merit {merit:.0f} µm/s"
        ax.plot(drift[upright], speed[upright], "o", color=colour, markersize=3.5, alpha=0.65, label=words)
        ax.plot(drift[~upright], speed[~upright], "x", color=colour, markersize=4.5, alpha=0.65)
    ax.set(xlabel="|drift| in a cycle with errors (µm); crosses flip", ylabel="speed with errors (µm/s)")
    legend_above(ax, ncols=3)
