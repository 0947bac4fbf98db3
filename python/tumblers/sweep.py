"""`sweep`: a grid of drafts and magnetization errors as an xarray Dataset."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from math import isfinite
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from . import _core
from .check import sequence, thread_count
from .effects.catalogue import sources_of
from .errors import InputError, TumblersError, show
from .field import RotatingField
from .grid import PAPER_DRAFTS_DEG, PAPER_MAGNETIZATION_DEG
from .metrics import FLIP_DEG
from .parts import Parts
from .progress import OnProgress, native_call
from .scenario import Scenario
from .shape import Cuboid, Spiked, SpikedEnds
from .step_choice import with_chosen_step
from .version import __version__

__all__ = [
    "DRIFT_LIMIT_M",
    "faster_cases",
    "ideal_speed",
    "preferred_cases",
    "sweep",
    "sweep_settings",
]

DRIFT_LIMIT_M = 50e-6
# Steps of a part at least, where there is more than one: some drafts, about half a minute of one core.
_PART_STEPS = 20_000_000

# name: (units, meaning)
_VARIABLES = {
    "twist_deg": ("degree", "twist about the long axis after one cycle"),
    "drift_m": ("m", "displacement along x after one cycle"),
    "speed_m_per_s": ("m s-1", "displacement along y over the time"),
    "flipped": ("1", f"|twist| > {FLIP_DEG:g} degrees"),
    "unconverged_steps": ("1", "steps that did not converge (0 where the case failed: see error)"),
    "newton_iterations": ("1", "Newton iterations of the whole run (0 where the case failed: see error)"),
    "max_residual": ("1", "largest scaled natural residual of a step"),
    "max_penetration_m": ("m", "largest penetration"),
    "error": ("", "why the case failed, empty if it did not"),
}


def sweep(
    scenario: Scenario,
    *,
    drafts_deg: Sequence[float] = PAPER_DRAFTS_DEG,
    magnetization: Sequence[tuple[float, float]] = PAPER_MAGNETIZATION_DEG,
    parts: str | PathLike[str] | None = None,
    threads: int | None = None,
    progress: bool | OnProgress = False,
) -> xr.Dataset:
    """Run a scenario for every draft and every magnetization error: one native call, or a few where there are many.

    A long sweep is run in parts of some drafts each, which take about half a minute of one core.

    Parameters
    ----------
    scenario
        What all cases have in common. A step that is left to be chosen is chosen once, for the scenario as it is.
    drafts_deg
        Drafts φ, degrees; the paper's 0° to 15° by default.
    magnetization
        Pairs θ1, θ2, degrees; the paper's 37 by default: θ1 = 0, and θ1 = 10° with θ2 = 10° to 360°.
    parts
        Folder for the parts of a long sweep, from which a later call with the same settings goes on; none by default.
    threads
        Number of threads, all by default. The result does not depend on it.
    progress
        True for a progress bar over the cases, or a callback that is told how many are done.

    Returns
    -------
    xarray.Dataset
        Dimensions ``draft_deg`` and ``magnetization_case`` (coordinates ``theta1_deg``, ``theta2_deg``):
        ``twist_deg``, ``drift_m``, ``speed_m_per_s``, ``flipped``, ``unconverged_steps``, ``newton_iterations``,
        ``max_residual``, ``max_penetration_m``, ``error``. A case that failed, or that could not even be built, is NaN
        and says why in ``error``. Attributes: the scenario's TOML, ``steps`` of a case, what `simulate` says of a step
        that was chosen, and the ideal and the flipped speed where the field and the shape have them.

    Raises
    ------
    InputError
        A scenario, a grid or a number of threads that is refused, or parts of other settings (key ``parts``).
    SimulationError
        The native module gave up.
    OSError
        The folder of the parts cannot be written to, or the disk is full.
    """
    drafts = sequence("drafts_deg", drafts_deg, "a list of numbers", _angle)
    cases = sequence("magnetization", magnetization, "a list of pairs of numbers", _pair)
    if not drafts or not cases:
        raise InputError("magnetization" if drafts else "drafts_deg", "an empty list", "at least one case")
    if threads is not None:
        thread_count("threads", threads)
    # The settings are those of the scenario as it is given: what the step is chosen from, and what a caller knows.
    kept = Parts(None if parts is None else Path(parts), sweep_settings(scenario, drafts, cases))
    scenario, chosen = with_chosen_step(scenario, threads, progress is True)
    rows = max(1, round(_PART_STEPS / (len(cases) * scenario.run.steps)))
    firsts = range(0, len(drafts), rows)
    if len(firsts) == 1:
        kept = Parts(None, kept.settings)
    found = []
    with native_call("cases", len(drafts) * len(cases), progress) as on_progress:
        for first in firsts:
            chunk = drafts[first : first + rows]

            def report(done: int, before: int = first * len(cases)) -> None:
                if on_progress is not None:
                    on_progress(before + done)

            found.append(
                kept.dataset(
                    f"drafts-{first:05d}",
                    partial(_rows, scenario, chunk, cases, threads or 0, None if on_progress is None else report),
                    partial(_fits, chunk, cases),
                )
            )
            report(len(chunk) * len(cases))
    result = found[0] if len(found) == 1 else xr.concat(found, "draft_deg", data_vars="all", coords="minimal")
    attrs = {
        "title": "tumblers sweep",
        "tumblers_version": __version__,
        "scenario": scenario.to_toml(),
        "steps": scenario.run.steps,
    }
    return result.assign_attrs(attrs | chosen | _speeds(scenario))


def sweep_settings(
    scenario: Scenario, drafts_deg: Sequence[float], magnetization: Sequence[tuple[float, float]]
) -> dict[str, Any]:
    """Return what the parts of a sweep depend on.

    Parameters
    ----------
    scenario, drafts_deg, magnetization
        As for `sweep`.
    """
    return {
        "tumblers_version": __version__,
        "drafts_deg": list(drafts_deg),
        "magnetization": [list(pair) for pair in magnetization],
        "scenario": scenario.to_toml(),
        "effect_files": sources_of(scenario.effects),
    }


def _fits(drafts: Sequence[float], cases: Sequence[tuple[float, float]], held: xr.Dataset) -> bool:
    if {*held.data_vars} != {*_VARIABLES} or {*held.coords} != {"draft_deg", "theta1_deg", "theta2_deg"}:
        return False
    pairs = np.column_stack([held["theta1_deg"].values, held["theta2_deg"].values])
    return np.array_equal(held["draft_deg"].values, drafts) and np.array_equal(pairs, np.array(cases))


def _rows(
    scenario: Scenario,
    drafts: Sequence[float],
    cases: Sequence[tuple[float, float]],
    threads: int,
    on_progress: OnProgress | None,
) -> xr.Dataset:
    """Run every magnetization error for some drafts: one native call."""
    trials: list[_core.Trial] = []
    errors = []
    for draft in drafts:
        for theta1, theta2 in cases:
            try:
                robot = scenario.robot.with_draft(draft).with_magnetization(theta1, theta2)
                trials.append(replace(scenario, robot=robot).trial())
                errors.append("")
            except TumblersError as reason:
                errors.append(str(reason))
    built = np.array([not error for error in errors], dtype=bool)
    results: Mapping[str, Any] = _core.sweep(trials, threads, on_progress)
    for case, error in zip(np.flatnonzero(built), results["error"], strict=True):
        errors[case] = " ".join((error or "").split())
    failed = np.array([bool(error) for error in errors], dtype=bool)
    ran = ~failed[built]

    def column(name: str, missing: float) -> np.ndarray[Any, Any]:
        values = np.full(len(errors), missing, dtype=np.float64 if np.isnan(missing) else np.int64)
        values[~failed] = np.asarray(results[name])[ran]
        return values

    twist = np.degrees(column("twist_rad", np.nan))
    columns: dict[str, np.ndarray[Any, Any]] = {
        "twist_deg": twist,
        "drift_m": column("drift_m", np.nan),
        "speed_m_per_s": column("speed_m_per_s", np.nan),
        "flipped": np.abs(twist) > FLIP_DEG,
        "unconverged_steps": column("unconverged_steps", 0),
        "newton_iterations": column("newton_iterations", 0),
        "max_residual": column("max_residual", np.nan),
        "max_penetration_m": column("max_penetration_m", np.nan),
        "error": np.array(errors, dtype=object),
    }
    dims = ("draft_deg", "magnetization_case")
    variables = {
        name: (dims, columns[name].reshape(len(drafts), len(cases)), _attributes(units, meaning))
        for name, (units, meaning) in _VARIABLES.items()
    }
    axes = np.array(cases, dtype=np.float64).T
    coordinates = {
        "draft_deg": ("draft_deg", np.array(drafts), _attributes("degree", "draft angle")),
        "theta1_deg": ("magnetization_case", axes[0], _attributes("degree", "θ1, off the long axis")),
        "theta2_deg": ("magnetization_case", axes[1], _attributes("degree", "θ2, about the long axis")),
    }
    return xr.Dataset(variables, coordinates)


def _attributes(units: str, meaning: str) -> dict[str, str]:
    return {"units": units, "long_name": meaning} if units else {"long_name": meaning}


def _angle(key: str, value: object) -> float:
    # Angles of any size pass: one that cannot be built is that case's error, not the sweep's.
    if isinstance(value, bool | np.bool_) or not isinstance(value, int | float | np.integer | np.floating):
        raise InputError(key, show(value), "a number")
    return float(value)


def _pair(key: str, value: object) -> tuple[float, float]:
    pair = sequence(key, value, "a pair θ1, θ2", _angle)
    if len(pair) != 2:
        raise InputError(key, show(value), "a pair θ1, θ2")
    return pair[0], pair[1]


def ideal_speed(scenario: Scenario) -> float | None:
    """Return the speed without slip, hull perimeter × frequency, m/s; None if the field does not rotate.

    Parameters
    ----------
    scenario
        The robot and the field, its effects at work.
    """
    scenario = scenario.effective()
    if not isinstance(scenario.field, RotatingField):
        return None
    return scenario.robot.with_draft(0.0).body().hull_perimeter_m * scenario.field.frequency_Hz


def _speeds(scenario: Scenario) -> dict[str, float]:
    ideal, scenario = ideal_speed(scenario), scenario.effective()
    if ideal is None or not isfinite(ideal) or not isinstance(scenario.field, RotatingField):
        return {}
    speeds = {"ideal_speed_m_per_s": ideal}
    shape = scenario.robot.shape
    if isinstance(shape, Cuboid | Spiked | SpikedEnds):
        speeds["flipped_speed_m_per_s"] = 2.0 * (shape.length_m + shape.width_m) * scenario.field.frequency_Hz
    return speeds


def preferred_cases(dataset: xr.Dataset) -> xr.DataArray:
    """Return which cases of a sweep the paper marks: no flip, and a drift of at most 50 µm.

    Parameters
    ----------
    dataset
        What `sweep` returned.
    """
    straight: xr.DataArray = abs(dataset["drift_m"]) <= DRIFT_LIMIT_M
    return straight & ~dataset["flipped"]


def faster_cases(dataset: xr.Dataset) -> xr.DataArray:
    """Return which of the preferred cases are also faster than the ideal robot: none where no ideal is known.

    Parameters
    ----------
    dataset
        What `sweep` returned.
    """
    ideal = dataset.attrs.get("ideal_speed_m_per_s", np.inf)
    fast: xr.DataArray = dataset["speed_m_per_s"] > ideal
    return preferred_cases(dataset) & fast
