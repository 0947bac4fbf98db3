"""What a run and a sweep come to, in a few lines of text."""

from __future__ import annotations

import numpy as np
import xarray as xr

from .simulate import CONTACT_MODES
from .sweep import faster_cases, preferred_cases

__all__ = ["run_summary", "sweep_summary"]


def run_summary(run: xr.Dataset, seconds: float) -> str:
    """Return speed, drift, twist, contact and the solver's health of a run that took `seconds`."""
    attrs = run.attrs
    modes = run["contact_mode"].values
    shares = [f"{words} {np.mean(modes == mode):.0%}" for mode, words in enumerate(CONTACT_MODES)]
    cycle = "no cycle of the field"
    if np.isfinite(attrs["twist_deg"]):
        flipped = " (flip)" if attrs["flipped"] else ""
        cycle = f"drift {attrs['drift_m'] * 1e6:.1f} µm, twist {attrs['twist_deg']:.1f}°{flipped} after one cycle"
    return "\n".join(
        [
            f"speed {attrs['speed_m_per_s'] * 1e6:.1f} µm/s; {cycle}",
            f"contact: {', '.join(shares)}",
            f"{attrs['unconverged_steps']} unconverged steps, largest residual {attrs['max_residual']:.1e}, "
            f"largest penetration {attrs['max_penetration_m']:.1e} m",
            f"time: {seconds:.2f} s",
        ]
    )


def sweep_summary(sweep: xr.Dataset, seconds: float) -> str:
    """Return flips, drift, speed and the solver's health of a sweep that took `seconds`."""
    errors = [error for error in sweep["error"].values.ravel() if error]
    cases = sweep["error"].size
    lines = [
        f"{cases - len(errors)} of {cases} cases done",
        f"flips: {int(sweep['flipped'].sum())}",
        f"drift within 50 µm and no flip: {int(preferred_cases(sweep).sum())}",
    ]
    ideal = sweep.attrs.get("ideal_speed_m_per_s")
    if ideal is not None:
        lines.append(f"of those faster than ideal ({ideal * 1e6:.1f} µm/s): {int(faster_cases(sweep).sum())}")
    residual, penetration = (float(sweep[name].max()) for name in ("max_residual", "max_penetration_m"))
    lines += [
        f"unconverged steps: {int(sweep['unconverged_steps'].sum())}",
        f"largest residual: {residual:.1e}, largest penetration: {penetration:.1e} m",
        f"time: {seconds:.2f} s",
    ]
    if errors:
        lines.append(f"failed: {len(errors)}, the first: {errors[0]}")
    return "\n".join(lines)
