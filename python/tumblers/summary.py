"""What a run and a sweep come to, in a few lines of text."""

from __future__ import annotations

import numpy as np
import xarray as xr

from .simulate import CONTACT_MODES
from .step_choice import chosen_warnings, chosen_words
from .sweep import faster_cases, preferred_cases

__all__ = ["run_summary", "run_warnings", "sweep_summary", "sweep_warnings"]


def run_summary(run: xr.Dataset, seconds: float) -> str:
    """Return speed, drift, twist, contact and the solver's health of a run.

    Parameters
    ----------
    run
        What `simulate` returned.
    seconds
        How long it took, s.
    """
    attrs = run.attrs
    # A row stands for the time since the row before it; the start stands for none.
    modes, times = run["contact_mode"].values[1:], np.diff(run["time"].values)
    shares = [f"{words} {times[modes == mode].sum() / times.sum():.0%}" for mode, words in enumerate(CONTACT_MODES)]
    cycle = "no cycle of the field"
    if np.isfinite(attrs["twist_deg"]):
        flipped = " (flip)" if attrs["flipped"] else ""
        cycle = f"drift {attrs['drift_m'] * 1e6:z.1f} µm, twist {attrs['twist_deg']:z.1f}°{flipped} after one cycle"
    return "\n".join(
        [
            f"speed {attrs['speed_m_per_s'] * 1e6:z.1f} µm/s; {cycle}",
            f"contact: {', '.join(shares)}",
            f"{attrs['unconverged_steps']} unconverged steps, largest residual {attrs['max_residual']:.1e}, "
            f"largest penetration {attrs['max_penetration_m']:.1e} m",
            *chosen_words(attrs),
            f"time: {seconds:.2f} s",
        ]
    )


def sweep_summary(sweep: xr.Dataset, seconds: float) -> str:
    """Return flips, drift, speed and the solver's health of a sweep.

    Parameters
    ----------
    sweep
        What `sweep` returned.
    seconds
        How long it took, s.
    """
    errors = [error for error in sweep["error"].values.ravel() if error]
    cases = sweep["error"].size
    lines = [
        f"{cases - len(errors)} of {cases} cases done",
        f"flips: {int(sweep['flipped'].sum())}",
        f"drift within 50 µm and no flip: {int(preferred_cases(sweep).sum())}",
    ]
    ideal = sweep.attrs.get("ideal_speed_m_per_s")
    if ideal is not None:
        lines.append(f"of those faster than ideal ({ideal * 1e6:z.1f} µm/s): {int(faster_cases(sweep).sum())}")
    residual, penetration = (float(sweep[name].max()) for name in ("max_residual", "max_penetration_m"))
    lines += [
        f"unconverged steps: {int(sweep['unconverged_steps'].sum())}",
        f"largest residual: {residual:.1e}, largest penetration: {penetration:.1e} m",
        *chosen_words(sweep.attrs),
        f"time: {seconds:.2f} s",
    ]
    return "\n".join(lines)


def run_warnings(run: xr.Dataset) -> list[str]:
    """Return what a reader of a run must know, a line each; none if all is well.

    Parameters
    ----------
    run
        What `simulate` returned.
    """
    attrs = run.attrs
    return [*_unconverged(attrs["unconverged_steps"], attrs["steps"], attrs["max_residual"]), *chosen_warnings(attrs)]


def sweep_warnings(sweep: xr.Dataset) -> list[str]:
    """Return what a reader of a sweep must know, a line each; none if all is well.

    Parameters
    ----------
    sweep
        What `sweep` returned.
    """
    errors = [error for error in sweep["error"].values.ravel() if error]
    cases = sweep["error"].size
    unconverged = int(sweep["unconverged_steps"].sum())
    steps = sweep.attrs["steps"] * (cases - len(errors))
    lines = [*_unconverged(unconverged, steps, float(sweep["max_residual"].max())), *chosen_warnings(sweep.attrs)]
    if errors:
        lines.append(f"{len(errors)} of {cases} cases failed, the first: {errors[0]}")
    return lines


def _unconverged(unconverged: int, steps: int, residual: float) -> list[str]:
    if unconverged == 0:
        return []
    share = f"{unconverged} of {steps} steps did not converge (largest residual {residual:.1e})"
    return [f"{share}: the results there are not solutions"]
