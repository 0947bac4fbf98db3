"""`simulate`: one run as an xarray Dataset."""

from __future__ import annotations

from collections.abc import Mapping
from math import degrees
from typing import Any, Literal, get_args

import numpy as np
import xarray as xr

from . import _core
from .check import choice
from .metrics import FLIP_DEG
from .progress import OnProgress, native_call
from .scenario import Scenario
from .step_choice import with_chosen_step
from .version import __version__

__all__ = ["CONTACT_MODES", "Solver", "simulate"]

Solver = Literal["reduced", "general"]
CONTACT_MODES = ("airborne", "point", "line", "surface")

# name: (dimensions, units, meaning)
_VARIABLES: dict[str, tuple[tuple[str, ...], str, str]] = {
    "position_m": (("time", "axis"), "m", "centre of mass, substrate frame"),
    "orientation": (("time", "wxyz"), "1", "unit quaternion, body to substrate"),
    "linear_velocity_m_per_s": (("time", "axis"), "m s-1", "velocity of the centre of mass, substrate frame"),
    "angular_velocity_rad_per_s": (("time", "axis"), "rad s-1", "angular velocity, substrate frame"),
    "ecp_m": (("time", "axis"), "m", "equivalent contact point on the body, substrate frame"),
    "contact_mode": (("time",), "1", "kind of contact"),
    "normal_force_N": (("time",), "N", "normal force"),
    "friction_force_N": (("time", "tor"), "N, N, N m", "friction along t = x and o = y, and moment about the normal"),
    "adhesion_force_N": (("time",), "N", "adhesion"),
    "slip_speed_m_per_s": (("time",), "m s-1", "speed of the contact point along the substrate"),
    "residual": (("time",), "1", "scaled natural residual of the step"),
    "newton_iterations": (("time",), "1", "Newton iterations of the step"),
}
_SPECIAL: dict[str, dict[str, Any]] = {
    "contact_mode": {"flag_values": np.arange(4, dtype=np.int8), "flag_meanings": " ".join(CONTACT_MODES)},
    "friction_force_N": {"third_component": "moment", "third_component_units": "N m"},
}


def simulate(scenario: Scenario, solver: Solver = "reduced", progress: bool | OnProgress = False) -> xr.Dataset:
    """Run a scenario.

    Parameters
    ----------
    scenario
        What to run.
    solver
        ``reduced`` (fast) or ``general`` (the paper's unreduced problem).
    progress
        True for a progress bar over the steps, or a callback that is told how many are done.

    Returns
    -------
    xarray.Dataset
        A row for the start, every ``output_every_s`` and the end: dimensions ``time`` (coordinate in s), ``axis``
        (x, y, z), ``wxyz`` and ``tor`` (t, o, r), every variable with its units. Where the camera is off, or the point
        that it follows is not the centre of mass, ``seen_time_s``, ``seen_position_m`` and ``seen_orientation`` are
        what it sees.

        Attributes: the scenario's TOML; ``twist_deg`` and ``drift_m`` after one cycle of the field (NaN if there is
        none), ``flipped``, ``speed_m_per_s``, ``steps``, ``unconverged_steps``, ``max_residual``,
        ``max_penetration_m``. Where the scenario left the step to be chosen: ``step_s``, ``step_error``, its error
        estimate as a share, and ``step_met``, whether that is at most 1 %; the scenario's TOML has the step as a
        number.

    Raises
    ------
    InputError
        A scenario or a solver that is refused, or more rows than memory is meant for.
    SimulationError
        The motion diverged, or the native module gave up.
    """
    choice("solver", solver, get_args(Solver))
    scenario, chosen = with_chosen_step(scenario, progress=progress is True)
    scenario.run.check_rows()
    trial = scenario.trial()
    with native_call("steps", trial.steps, progress) as on_progress:
        run: Mapping[str, Any] = _core.simulate(trial, scenario.run.output_every, solver, on_progress)
    coordinates = {
        "time": ("time", run["time_s"], {"units": "s", "long_name": "time"}),
        "axis": ("axis", list("xyz")),
        "wxyz": ("wxyz", list("wxyz")),
        "tor": ("tor", list("tor")),
    }
    variables = {
        name: (dims, run[name], {"units": units, "long_name": meaning, **_SPECIAL.get(name, {})})
        for name, (dims, units, meaning) in _VARIABLES.items()
    }
    variables |= _seen(scenario.effective(), run)
    return xr.Dataset(variables, coordinates, attrs=_attributes(scenario, solver, run) | chosen)


def _seen(scenario: Scenario, run: Mapping[str, Any]) -> dict[str, tuple[tuple[str, ...], Any, dict[str, str]]]:
    """Return what a camera that is off, or that follows another point than the centre of mass, sees of a run."""
    camera, mass_m = scenario.camera, scenario.robot.center_of_mass_m
    if camera == camera.perfect and not camera.tracked_m(mass_m).any():
        return {}
    point = {"body_centre": "centre of the body's shape", "centre_of_mass": "centre of mass"}[camera.tracked_point]
    tracked = camera.tracked_position(run["position_m"], run["orientation"], mass_m)
    return {
        "seen_time_s": (
            ("time",),
            run["time_s"] - camera.time_offset_s,
            {"units": "s", "long_name": "what the camera's clock says"},
        ),
        "seen_position_m": (
            ("time", "axis"),
            camera.seen_position(tracked),
            {"units": "m", "long_name": f"{point} as the camera sees it"},
        ),
        "seen_orientation": (
            ("time", "wxyz"),
            camera.seen_orientation(run["orientation"]),
            {"units": "1", "long_name": "unit quaternion, body to substrate, as the camera sees it"},
        ),
    }


def _attributes(scenario: Scenario, solver: Solver, run: Mapping[str, Any]) -> dict[str, Any]:
    twist = degrees(run["twist_rad"])
    return {
        "title": "tumblers run",
        "tumblers_version": __version__,
        "solver": solver,
        "scenario": scenario.to_toml(),
        "twist_deg": twist,
        "drift_m": float(run["drift_m"]),
        "speed_m_per_s": float(run["speed_m_per_s"]),
        "flipped": int(abs(twist) > FLIP_DEG),
        "steps": scenario.run.steps,
        "unconverged_steps": int(run["unconverged_steps"]),
        "max_residual": float(run["max_residual"]),
        "max_penetration_m": float(run["max_penetration_m"]),
    }
