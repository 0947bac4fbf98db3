"""What a study comes to, in a few lines of text."""

from __future__ import annotations

from collections.abc import Mapping
from math import isnan

import numpy as np
import xarray as xr

from ..step_choice import chosen_warnings
from .tolerance import PAPER_DRAFT_DEG, PAPER_THETA2_DEG

__all__ = ["climb_words", "convergence_words", "design_words", "tolerance_words", "warnings"]

_PER_METRE = 1e6


def climb_words(climb: xr.Dataset) -> str:
    """Return the limit found, the closed forms, and whether climbing ends once.

    Parameters
    ----------
    climb
        Result of `tumblers.climb`.
    """
    attrs = climb.attrs
    lines = [f"greatest slope: {_between(attrs['limit_deg'], attrs['limit_above_deg'])}"]
    if not attrs["monotone"]:
        steeper = _between(attrs["greatest_deg"], attrs["greatest_above_deg"])
        lines.append(f"climbing ends more than once: steeper slopes are climbed, the greatest {steeper}")
    lines.append(f"friction limit, electrostatic force, no adhesion: {attrs['friction_limit_deg']:.2f}°")
    adhering = attrs["friction_limit_with_line_adhesion_deg"]
    none = " (no line contact width)" if adhering == attrs["friction_limit_deg"] else ""
    lines.append(f"friction limit with the adhesion of a line: {adhering:.2f}°{none}")
    return "\n".join(lines)


def _between(low: float, high: float) -> str:
    if isnan(low):
        return f"none, {high:.2f}° is not climbed"
    return f"{low:.2f}°, all that were tried" if isnan(high) else f"{low:.2f}°, but not {high:.2f}°"


def tolerance_words(tolerance: xr.Dataset) -> str:
    """Return the tolerances of one error alone and of both.

    Parameters
    ----------
    tolerance
        Result of `tumblers.tolerance`.
    """
    attrs = tolerance.attrs
    theta1 = float(tolerance["theta1_deg"][-1])
    bounds = tolerance["theta2_bound_deg"].values
    inside = int(np.flatnonzero(bounds <= PAPER_THETA2_DEG)[-1])
    joint = float(tolerance["joint_draft_deg"][inside])
    return "\n".join(
        [
            f"no flip and a drift of at most {attrs['drift_limit_m'] * _PER_METRE:g} µm:",
            f"  draft alone: {_up_to('φ', attrs['draft_tolerance_deg'], attrs['draft_tolerance_open'])}",
            f"  magnetization error alone, θ1 = {theta1:g}°: "
            f"{_up_to('|θ2|', attrs['theta2_tolerance_deg'], attrs['theta2_tolerance_open'])}",
            f"  both, θ1 = {theta1:g}°: with |θ2| ≤ {bounds[inside]:g}° {_up_to('φ', joint, False)}; "
            f"with φ ≤ {attrs['joint_theta2_draft_deg']:g}° {_up_to('|θ2|', attrs['joint_theta2_deg'], False)}",
            f"  the paper's φ ≤ {PAPER_DRAFT_DEG:g}°, |θ2| ≤ {PAPER_THETA2_DEG:g}°: {_paper_box(attrs)}",
        ]
    )


def _paper_box(attrs: Mapping[str, float]) -> str:
    if isnan(attrs["paper_box_kept"]):
        return "not judged, the grid has not its corners"
    drift = attrs["paper_box_drift_m"] * _PER_METRE
    return f"{attrs['paper_box_kept']:.0%} of the cases kept, drift up to {drift:.1f} µm"


def _up_to(name: str, value: float, open_end: bool) -> str:
    if isnan(value):
        return f"no {name} is kept"
    return f"{name} ≤ {value:.2f}°{' and more' if open_end else ''}"


def design_words(design: xr.Dataset) -> str:
    """Return the candidates side by side.

    Parameters
    ----------
    design
        Result of `tumblers.design`.
    """
    names = design["candidate"].values.tolist()
    free = [name for name in design.data_vars if "low" in design[name].attrs and design[name].dims == ("design",)]
    rows: list[tuple[str, float, str]] = [
        *((str(name), *((1.0, "°") if str(name).endswith("_deg") else (_PER_METRE, " µm"))) for name in free),
        ("speed_m_per_s", _PER_METRE, " µm/s"),
        ("climb_deg", 1.0, "°"),
        ("tipping_field_T", 1e3, " mT"),
        ("upright_share", 100.0, " %"),
        ("error_speed_m_per_s", _PER_METRE, " µm/s"),
        ("error_drift_m", _PER_METRE, " µm"),
        ("robust_merit_m_per_s", _PER_METRE, " µm/s"),
    ]
    lines = [f"{'':24}{''.join(f'{name:>14}' for name in names)}"]
    for name, factor, unit in rows:
        values = [f"{value:.4g}{unit}" for value in design[f"candidate_{name}"].values * factor]
        lines.append(f"{_plain(name):24}{''.join(f'{value:>14}' for value in values)}")
    gain, error = (design.attrs[f"robust_gain{end}_m_per_s"] * _PER_METRE for end in ("", "_error"))
    return "\n".join(
        [
            f"{int(design['front'].sum())} of {design.sizes['design']} designs on the front, "
            f"{int((~design['turns'].astype(bool)).sum())} that the field cannot tip over",
            *lines,
            f"robust over nominal: {gain:+.1f} ± {error:.1f} µm/s of mean merit on robots that no search has seen",
        ]
    )


def _plain(name: str) -> str:
    for ending in ("_m_per_s", "_deg", "_share", "_m", "_T"):
        name = name.removesuffix(ending)
    return {
        "error_speed": "speed with errors",
        "error_drift": "|drift| with errors",
        "robust_merit": "merit with errors",
        "climb": "slope climbed",
    }.get(name, name.replace("_", " "))


def convergence_words(convergence: xr.Dataset) -> str:
    """Return every number: the paper's, the converged one, and its range over all choices.

    Parameters
    ----------
    convergence
        Result of `tumblers.convergence`.
    """
    lines = [f"{'':42}{'paper':>10}{'converged':>12}{'lowest':>10}{'highest':>10}"]
    for key in convergence["number"].values:
        at = convergence.sel(number=key)
        unit = {"m s-1": "µm/s", "m": "µm", "1": "", "degree": "°"}[str(at["units"].values)]
        factor = _PER_METRE if unit.startswith("µ") else 1.0
        paper = float(at["paper"]) * factor
        found = [float(at["converged"]) * factor, *(float(edge(at["value"])) * factor for edge in (np.min, np.max))]
        columns = ["-" if isnan(value) else f"{value:.4g}" for value in (paper, *found)]
        words = str(at["words"].values)
        lines.append(f"{words:42}{columns[0]:>10}{columns[1]:>12}{columns[2]:>10}{columns[3]:>10} {unit}".rstrip())
    return "\n".join(lines)


def warnings(result: xr.Dataset) -> list[str]:
    """Return what a reader of a study must know, a line each; none if all is well.

    Parameters
    ----------
    result
        What a study returned.
    """
    lines = chosen_warnings(result.attrs)
    steps = int(result["unconverged_steps"].sum())
    if steps:
        runs = int((result["unconverged_steps"] > 0).sum())
        lines.append(f"{steps} steps did not converge, in {runs} of {result['unconverged_steps'].size} results")
    if "error_speed_m_per_s" in result:
        means = ("speed_m_per_s", "error_speed_m_per_s")
        lost = np.any([~np.isfinite(result[name].values) for name in means], axis=0)
        if lost.any():
            lines.append(f"{int(lost.sum())} of {lost.size} designs have runs that failed, and no speed for it")
    gain = result.attrs.get("robust_gain_m_per_s")
    if gain is not None and gain <= result.attrs["robust_gain_error_m_per_s"]:
        lines.append("the robust design is no better than the nominal one on fresh robots: draw more (--draws)")
    errors = [str(error) for error in result["error"].values.ravel() if error] if "error" in result else []
    if errors:
        lines.append(f"{len(errors)} of {result['error'].size} cases failed, the first: {errors[0]}")
    return lines
