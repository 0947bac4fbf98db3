"""`climb`: the greatest slope that a robot climbs."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import xarray as xr

from ..check import number, sequence
from ..errors import InputError, show
from ..progress import OnProgress, native_call
from ..scenario import Scenario
from ..step_choice import with_chosen_step
from ..version import __version__
from .ascent import LEAST_SHARE, bisections, limits
from .defaults import CYCLES, RESOLUTION_DEG, SETTLING_CYCLES, SLOPES_DEG
from .friction_limit import friction_limit_deg, line_adhesion_N
from .native import Native, rotating

__all__ = ["climb", "whole_number"]

_MOST_CYCLES = 10_000

_CLIMBS = (
    f"after settling, the mean cycle of the field gains at least {LEAST_SHARE:.0%} of the hull's perimeter up the "
    "slope, and no cycle loses as much"
)


def climb(
    scenario: Scenario,
    *,
    slopes_deg: Sequence[float] = SLOPES_DEG,
    resolution_deg: float = RESOLUTION_DEG,
    settling_cycles: int = SETTLING_CYCLES,
    cycles: int = CYCLES,
    threads: int | None = None,
    progress: bool | OnProgress = False,
) -> xr.Dataset:
    """Find the greatest slope that a robot climbs, by a scan and bisection.

    A robot climbs a slope if, after it has settled, the mean cycle of the field gains at least 1 % of the perimeter of
    its hull (its way without slip) up the slope, and no cycle loses as much. The scan runs as one native batch, and the
    ends of what is climbed are bisected. Where a steeper slope is climbed than one that is not, there are two ends, and
    ``monotone`` is 0.

    Parameters
    ----------
    scenario
        Robot, substrate, rotating field, step and model; the slope and the time of its run are replaced.
    slopes_deg
        Increasing slopes of the scan, degrees, from 0 to less than 90.
    resolution_deg
        How close the limit is sought, degrees.
    settling_cycles, cycles
        Cycles of the field before measuring starts, and measured ones. The default is the paper's 4 s at 1 Hz.
    threads
        Number of threads, all by default. The result does not depend on it.
    progress
        True for a progress bar over the runs, or a callback that is told how many are done.

    Returns
    -------
    xarray.Dataset
        Dimension ``incline_deg`` (every slope tried): ``speed_m_per_s``, ``mean_share``, ``worst_share``, ``climbs``,
        ``scanned``, ``unconverged_steps``, ``error``. Attributes: ``limit_deg`` and ``limit_above_deg``, the greatest
        slope up to which all tried ones are climbed and the lowest that is not; ``greatest_deg`` and
        ``greatest_above_deg``, the same of the greatest slope climbed at all; ``monotone``; the closed forms
        ``friction_limit_deg`` (electrostatic force, no adhesion) and ``friction_limit_with_line_adhesion_deg``; the
        scenario's TOML. A limit is NaN where nothing was climbed, and what is above it where everything was.

    Raises
    ------
    InputError
        A scenario or a number that is refused, or a field that does not rotate.
    SimulationError
        The native module gave up.

    See Also
    --------
    tumblers.studies.friction_limit.friction_limit_deg : the equation of the closed form.
    """
    slopes = _increasing_slopes("slopes_deg", slopes_deg)
    number("resolution_deg", resolution_deg, least=1e-3, most=90.0)
    whole_number("settling_cycles", settling_cycles, 0)
    whole_number("cycles", cycles, 1)
    rotating(scenario)
    scenario, chosen = with_chosen_step(scenario, threads, progress is True)
    scenario.trial()
    total = len(slopes) + bisections(slopes, resolution_deg)
    with native_call("slopes", total, progress) as report:
        (found,) = limits(
            [scenario],
            Native(threads, report),
            slopes_deg=slopes,
            resolution_deg=resolution_deg,
            settling_cycles=settling_cycles,
            cycles=cycles,
        )
    ascents = found.ascents
    dims = ("incline_deg",)
    meanings = {
        "speed_m_per_s": ("m s-1", "mean speed up the slope after settling"),
        "mean_share": ("1", "way up the slope in a cycle over the hull's perimeter, mean of the measured cycles"),
        "worst_share": ("1", "the same of the cycle that gains least"),
        "climbs": ("1", _CLIMBS),
        "unconverged_steps": ("1", "steps that did not converge"),
        "error": ("1", "why the run failed, empty if it did not"),
    }
    variables = {
        name: (
            dims,
            np.array([getattr(a, name) for a in ascents], dtype=object if name == "error" else None),
            {"units": units, "long_name": meaning},
        )
        for name, (units, meaning) in meanings.items()
    }
    tried = np.array([ascent.incline_deg for ascent in ascents])
    variables["scanned"] = (
        dims,
        np.isin(tried, found.scanned),
        {"units": "1", "long_name": "whether the slope is of the scan, or of the bisection"},
    )
    coordinates = {"incline_deg": (dims, tried, {"units": "degree", "long_name": "slope of the substrate along y"})}
    attrs = {
        "title": "tumblers climb",
        "tumblers_version": __version__,
        "scenario": scenario.to_toml(),
        "climbs_means": _CLIMBS,
        "limit_deg": found.limit[0],
        "limit_above_deg": found.limit[1],
        "greatest_deg": found.greatest[0],
        "greatest_above_deg": found.greatest[1],
        "monotone": int(found.monotone),
        "friction_limit_deg": friction_limit_deg(scenario),
        "friction_limit_with_line_adhesion_deg": friction_limit_deg(scenario, line_adhesion_N(scenario)),
        "resolution_deg": float(resolution_deg),
        "settling_cycles": settling_cycles,
        "cycles": cycles,
        **chosen,
    }
    return xr.Dataset(variables, coordinates, attrs=attrs)


def _increasing_slopes(key: str, value: object) -> tuple[float, ...]:
    slopes = sequence(key, value, "a list of numbers", lambda at, entry: number(at, entry, least=0.0, below=90.0))
    if not slopes or any(after <= before for before, after in pairwise(slopes)):
        raise InputError(key, show(list(slopes)), "at least one slope, and increasing ones")
    return slopes


def whole_number(key: str, value: object, least: int, most: int = _MOST_CYCLES) -> int:
    """Return a whole number within bounds.

    Parameters
    ----------
    key, value
        Where it stands, and what was given.
    least, most
        The bounds.

    Raises
    ------
    InputError
        Something else.
    """
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or not least <= value <= most:
        raise InputError(key, show(value), f"a whole number of at least {least} and at most {most}")
    return int(value)
