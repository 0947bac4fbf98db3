"""`convergence`: the headline numbers against the step, the torque's time in it, and e_r."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from typing import get_args

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ..check import choice, number, sequence
from ..errors import InputError
from ..model import MagneticTorque
from ..progress import OnProgress, native_call
from ..scenario import Scenario
from ..sweep import ideal_speed
from ..version import __version__
from .ascent import bisections, limits
from .defaults import E_R_M, STEPS_S, TORQUES
from .headline import HEADLINES, Headline
from .native import Native, rotating

__all__ = ["convergence"]

_SLOPES_DEG = (0.0, 15.0, 30.0, 45.0, 60.0)
_RESOLUTION_DEG = 0.25


def convergence(
    *,
    numbers: Sequence[str] | None = None,
    steps_s: Sequence[float] = STEPS_S,
    torques: Sequence[str] = TORQUES,
    e_r_m: Sequence[float] = E_R_M,
    threads: int | None = None,
    progress: bool | OnProgress = False,
) -> xr.Dataset:
    """Compute headline numbers for every step, every time in the step that the torque is taken at, and every e_r.

    Parameters
    ----------
    numbers
        Keys of `tumblers.studies.headline.HEADLINES`; all by default.
    steps_s
        Steps h, s.
    torques
        ``end_of_step`` (the released values' choice), ``midpoint`` (second order) and ``start_of_step`` (the paper's
        equation, unstable beyond a bound on h: no number there).
    e_r_m
        Third axis of the friction ellipsoid, m; 0.1 in the released values.
    threads
        Number of threads, all by default. The result does not depend on it.
    progress
        True for a progress bar over the runs, or a callback that is told how many are done.

    Returns
    -------
    xarray.Dataset
        Dimensions ``number``, ``magnetic_torque``, ``step_s``, ``e_r_m``: ``value`` in the unit of ``units(number)``,
        ``unconverged_steps``, and ``error``, why there is no value. ``paper(number)``, NaN where it has none, and
        ``words(number)``. ``converged(number)``: the value with the torque at the midpoint (the last of `torques` if
        that is not among them), the finest step and the last e_r. Slopes are sought to 0.25°.

    Raises
    ------
    InputError
        A name or a number that is refused.
    SimulationError
        The native module gave up.
    """
    keys = tuple(HEADLINES) if numbers is None else _distinct("numbers", numbers, tuple(HEADLINES))
    schemes = _distinct("torques", torques, get_args(MagneticTorque))
    steps = _positive("steps_s", steps_s)
    spins = _positive("e_r_m", e_r_m)
    cases = [
        (HEADLINES[key], _changed(HEADLINES[key].make(), torque, step, spin))
        for key, torque, step, spin in product(keys, schemes, steps, spins)
    ]
    climbing = np.array([headline.reading == "climb_deg" for headline, _ in cases], dtype=bool)
    tries = len(_SLOPES_DEG) + bisections(_SLOPES_DEG, _RESOLUTION_DEG)
    total = int((~climbing).sum() + climbing.sum() * tries)
    values = np.full(len(cases), np.nan)
    unconverged = np.zeros(len(cases), dtype=np.int64)
    errors = np.full(len(cases), "", dtype=object)
    with native_call("runs", total, progress) as report:
        native = Native(threads, report)
        for chosen, read in ((~climbing, _read), (climbing, _climbed)):
            places = np.flatnonzero(chosen)
            values[places], unconverged[places], errors[places] = read([cases[i] for i in places], native)
    shape = (len(keys), len(schemes), len(steps), len(spins))
    dims = ("number", "magnetic_torque", "step_s", "e_r_m")
    value = values.reshape(shape)
    reference = schemes.index("midpoint") if "midpoint" in schemes else -1
    variables = {
        "value": (dims, value, {"long_name": "the number, in its own unit"}),
        "unconverged_steps": (
            dims,
            unconverged.reshape(shape),
            {"units": "1", "long_name": "steps that did not converge"},
        ),
        "error": (dims, errors.reshape(shape), {"long_name": "why there is no number"}),
        "paper": ("number", [HEADLINES[key].paper for key in keys], {"long_name": "the paper's number"}),
        "converged": (
            "number",
            value[:, reference, int(np.argmin(steps)), -1],
            {"long_name": f"value of {schemes[reference]} at the finest step and the last e_r"},
        ),
        "units": ("number", np.array([HEADLINES[key].units for key in keys], dtype=object)),
        "words": ("number", np.array([HEADLINES[key].words for key in keys], dtype=object)),
    }
    coordinates = {
        "number": ("number", np.array(keys, dtype=object)),
        "magnetic_torque": ("magnetic_torque", np.array(schemes, dtype=object)),
        "step_s": ("step_s", np.array(steps), {"units": "s", "long_name": "step h"}),
        "e_r_m": ("e_r_m", np.array(spins), {"units": "m", "long_name": "third axis of the friction ellipsoid"}),
    }
    attrs = {"title": "tumblers convergence", "tumblers_version": __version__}
    return xr.Dataset(variables, coordinates, attrs=attrs)


Case = tuple[Headline, Scenario]
Columns = tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.object_]]


def _changed(scenario: Scenario, torque: str, step_s: float, e_r_m: float) -> Scenario:
    e_t, e_o, _ = scenario.substrate.friction_ellipsoid
    return replace(
        scenario,
        substrate=replace(scenario.substrate, friction_ellipsoid=(e_t, e_o, e_r_m)),
        run=replace(scenario.run, step_s=step_s),
        model=replace(scenario.model, magnetic_torque=torque),  # type: ignore[arg-type]
    )


def _read(cases: Sequence[Case], native: Native) -> Columns:
    """Return the numbers that one run gives."""
    values = np.full(len(cases), np.nan)
    unconverged = np.zeros(len(cases), dtype=np.int64)
    errors = np.full(len(cases), "", dtype=object)
    shares = [i for i, (headline, _) in enumerate(cases) if headline.reading == "share_without_slip"]
    for i, way in zip(shares, native.ways([cases[i][1] for i in shares]), strict=True):
        scenario = cases[i][1]
        without_slip = (ideal_speed(scenario) or np.nan) / rotating(scenario).frequency_Hz
        values[i] = np.diff(way.ends_m[1:]).mean() / without_slip
        unconverged[i], errors[i] = way.unconverged_steps, way.error
    others = [i for i, (headline, _) in enumerate(cases) if headline.reading != "share_without_slip"]
    found = native.outcomes([cases[i][1] for i in others])
    for row, i in enumerate(others):
        values[i] = getattr(found, cases[i][0].reading)[row]
    unconverged[others] = found.unconverged_steps
    errors[others] = found.errors
    return values, unconverged, errors


def _climbed(cases: Sequence[Case], native: Native) -> Columns:
    tried = limits(
        [scenario for _, scenario in cases],
        native,
        slopes_deg=_SLOPES_DEG,
        resolution_deg=_RESOLUTION_DEG,
        settling_cycles=1,
        cycles=3,
    )
    return (
        np.array([slopes.limit[0] for slopes in tried]),
        np.array([sum(ascent.unconverged_steps for ascent in slopes.ascents) for slopes in tried], dtype=np.int64),
        # A robot that slides far down leaves all bounds: that is an answer and not an error.
        np.array([slopes.ascents[0].error for slopes in tried], dtype=object),
    )


def _distinct(key: str, value: object, known: tuple[str, ...]) -> tuple[str, ...]:
    found = sequence(key, value, f"a list of {', '.join(known)}", lambda at, entry: choice(at, entry, known))
    return tuple(dict.fromkeys(_some(key, found)))


def _positive(key: str, value: object) -> tuple[float, ...]:
    found = sequence(key, value, "a list of numbers", lambda at, entry: number(at, entry, above=0.0))
    return tuple(dict.fromkeys(_some(key, found)))


def _some(key: str, found: tuple) -> tuple:  # type: ignore[type-arg]
    if not found:
        raise InputError(key, "an empty list", "at least one")
    return found
