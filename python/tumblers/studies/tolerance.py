"""`tolerance`: the manufacturing errors that a robot bears."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from math import nan
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ..check import number, sequence
from ..errors import InputError, show
from ..progress import OnProgress
from ..scenario import Scenario
from ..step_choice import with_chosen_step
from ..sweep import DRIFT_LIMIT_M, sweep
from ..version import __version__
from .defaults import DRAFTS_DEG, THETA1_DEG, THETA2_DEG
from .native import rotating

__all__ = ["PAPER_DRAFT_DEG", "PAPER_THETA2_DEG", "tolerance"]

# What the paper quotes for a drift of at most 50 µm.
PAPER_DRAFT_DEG, PAPER_THETA2_DEG = 2.0, 10.0

# How close the tolerances of one error alone are sought.
_RESOLUTION_DEG = 0.01
_ROUNDING_DEG = 1e-9
Bools = NDArray[np.bool_]


def tolerance(
    scenario: Scenario,
    *,
    drift_limit_m: float = DRIFT_LIMIT_M,
    drafts_deg: Sequence[float] = DRAFTS_DEG,
    theta1_deg: Sequence[float] = THETA1_DEG,
    theta2_deg: Sequence[float] = THETA2_DEG,
    threads: int | None = None,
    progress: bool | OnProgress = False,
) -> xr.Dataset:
    """Find the drafts and magnetization errors with which a robot neither flips nor drifts too far in a cycle.

    A case is kept if ``|twist| ≤ 45°`` and ``|drift| ≤ drift_limit_m`` after one cycle of the field. A tolerance is the
    greatest error up to which every smaller one of the grid is kept; those of one error alone are bisected to 0.01°.

    Parameters
    ----------
    scenario
        The robot without errors on its substrate in a rotating field; its own draft and magnetic axis are replaced.
    drift_limit_m
        Limit on the drift, m.
    drafts_deg
        Increasing drafts φ from 0, degrees.
    theta1_deg
        Increasing angles θ1 of the magnetic axis off the long axis from 0, degrees. The last is the one at which the
        tolerance of θ2 is sought.
    theta2_deg
        Increasing angles θ2 of the axis about the long one, degrees, 0 among them: 0 and ±180 lie in the plane that the
        robot tumbles in.
    threads
        Number of threads, all by default. The result does not depend on it.
    progress
        True for a progress bar over the cases, or a callback that is told how many are done.

    Returns
    -------
    xarray.Dataset
        Dimensions ``draft_deg``, ``theta1_deg``, ``theta2_deg``: ``drift_m``, ``twist_deg``, ``speed_m_per_s``,
        ``kept``, ``unconverged_steps``, ``error``; at θ1 = 0, where θ2 means nothing, one run stands for all.
        ``kept_share(draft_deg, theta1_deg)``: share of the directions θ2 in [-180°, 180°) that are kept.
        ``joint_draft_deg(theta2_bound_deg)``: greatest draft that is kept together with every smaller one at the
        last θ1 and all θ2 within ± the bound; ``joint_draft_any_theta1_deg``: the same for every θ1. NaN where not
        even no draft is kept.
        Attributes: ``draft_tolerance_deg`` (no magnetization error), ``theta2_tolerance_deg`` (last θ1, no draft), NaN
        if none is kept and, with ``draft_tolerance_open`` or ``theta2_tolerance_open`` at 1, the grid's greatest if all
        are; ``joint_theta2_deg``, greatest bound on θ2 with which all drafts of the grid up to the paper's 2°,
        ``joint_theta2_draft_deg`` the greatest of them, are kept at the last θ1; ``paper_box_kept``, share of the
        cases with φ ≤ 2° and |θ2| ≤ 10° at the last θ1 that are kept, and ``paper_box_drift_m``, the greatest drift
        among them, NaN where the grid has not the corners of that box.

    Raises
    ------
    InputError
        A scenario, a grid or a number that is refused, or a field that does not rotate.
    SimulationError
        The native module gave up.
    """
    number("drift_limit_m", drift_limit_m, above=0.0)
    drafts = _increasing("drafts_deg", drafts_deg, first=0.0)
    theta1 = _increasing("theta1_deg", theta1_deg, first=0.0)
    theta2 = _increasing("theta2_deg", theta2_deg, among=0.0)
    rotating(scenario)
    if len(theta1) < 2:
        raise InputError("theta1_deg", show(list(theta1)), "at least one angle beside 0")
    # 180° and -180° are one direction, and -0.0 is 0.0: each is run once.
    directions = np.unique(np.mod(theta2, 360.0))
    axes = [(0.0, 0.0), *((first, second) for first in theta1[1:] for second in directions)]
    scenario, chosen = with_chosen_step(scenario, threads, progress is True)
    cases = sweep(scenario, drafts_deg=drafts, magnetization=axes, threads=threads, progress=progress)
    place = np.searchsorted(directions, np.mod(theta2, 360.0))
    columns = np.array(
        [np.zeros(len(theta2), dtype=int), *(1 + first * len(directions) + place for first in range(len(theta1) - 1))]
    )
    dims = ("draft_deg", "theta1_deg", "theta2_deg")
    variables: dict[str, Any] = {
        name: (dims, cases[name].values[:, columns], cases[name].attrs)
        for name in ("drift_m", "twist_deg", "speed_m_per_s", "unconverged_steps", "error")
    }
    kept = (_kept(cases, drift_limit_m))[:, columns]
    variables["kept"] = (dims, kept, {"units": "1", "long_name": "no flip, and no more drift than the limit"})
    circle = np.array([i for i, angle in enumerate(theta2) if -180.0 <= angle < 180.0])
    variables["kept_share"] = (
        dims[:2],
        kept[:, :, circle].mean(axis=2),
        {"units": "1", "long_name": "share of the directions of the magnetization error that are kept"},
    )
    bounds = np.unique(np.abs(theta2))
    within = np.less_equal(np.abs(np.array(theta2))[None, :], bounds[:, None])
    joint = {
        "joint_draft_deg": (kept[:, -1], "greatest draft kept with the last θ1 and θ2 within the bound"),
        "joint_draft_any_theta1_deg": (
            np.asarray(kept.all(axis=1)),
            "greatest draft kept with every θ1 and θ2 within the bound",
        ),
    }
    for name, (region, meaning) in joint.items():
        greatest = [_greatest(drafts, np.asarray(region[:, inside].all(axis=1))) for inside in within]
        variables[name] = ("theta2_bound_deg", np.array(greatest), {"units": "degree", "long_name": meaning})
    coordinates = {
        "draft_deg": ("draft_deg", np.array(drafts), {"units": "degree", "long_name": "draft angle φ"}),
        "theta1_deg": ("theta1_deg", np.array(theta1), {"units": "degree", "long_name": "θ1, off the long axis"}),
        "theta2_deg": ("theta2_deg", np.array(theta2), {"units": "degree", "long_name": "θ2, about the long axis"}),
        "theta2_bound_deg": ("theta2_bound_deg", bounds, {"units": "degree", "long_name": "greatest |θ2|"}),
    }

    def keeps_draft(draft: float) -> bool:
        return _keeps(scenario, drift_limit_m, draft, [(0.0, 0.0)])

    def keeps_theta2(bound: float) -> bool:
        return _keeps(scenario, drift_limit_m, 0.0, [(theta1[-1], bound), (theta1[-1], -bound)])

    draft, draft_open = _alone(drafts, kept[:, 0, 0], keeps_draft)
    bound, bound_open = _alone(bounds, np.array([kept[0, -1, inside].all() for inside in within]), keeps_theta2)
    # A range of steps ends a rounding beside 2.
    up_to_paper = np.less_equal(drafts, PAPER_DRAFT_DEG + _ROUNDING_DEG)
    box = np.ix_(up_to_paper, np.abs(np.array(theta2)) <= PAPER_THETA2_DEG + _ROUNDING_DEG)
    corners = _has(drafts, PAPER_DRAFT_DEG) and _has(theta2, -PAPER_THETA2_DEG) and _has(theta2, PAPER_THETA2_DEG)
    attrs = {
        "title": "tumblers tolerance",
        "tumblers_version": __version__,
        "scenario": scenario.to_toml(),
        "drift_limit_m": float(drift_limit_m),
        "draft_tolerance_deg": draft,
        "draft_tolerance_open": int(draft_open),
        "theta2_tolerance_deg": bound,
        "theta2_tolerance_open": int(bound_open),
        "joint_theta2_deg": _greatest(bounds, np.array([kept[up_to_paper, -1][:, w].all() for w in within])),
        "joint_theta2_draft_deg": float(np.array(drafts)[up_to_paper][-1]),
        "paper_box_kept": float(kept[:, -1][box].mean()) if corners else nan,
        "paper_box_drift_m": float(np.abs(variables["drift_m"][1][:, -1][box]).max()) if corners else nan,
        **chosen,
    }
    return xr.Dataset(variables, coordinates, attrs=attrs)


def _increasing(key: str, value: object, first: float | None = None, among: float | None = None) -> tuple[float, ...]:
    values = sequence(key, value, "a list of numbers", number)
    if not values or any(after <= before for before, after in pairwise(values)):
        raise InputError(key, show(list(values)), "at least one number, and increasing ones")
    if first is not None and values[0] != first:
        raise InputError(key, show(list(values)), f"numbers that begin with {first:g}")
    if among is not None and among not in values:
        raise InputError(key, show(list(values)), f"{among:g} among them")
    return values


def _has(values: Sequence[float], wanted: float) -> bool:
    return bool((np.abs(np.array(values) - wanted) <= _ROUNDING_DEG).any())


def _kept(cases: xr.Dataset, drift_limit_m: float) -> Bools:
    # A failed case has no drift, and is not kept.
    return np.asarray((abs(cases["drift_m"]) <= drift_limit_m) & ~cases["flipped"])


def _keeps(scenario: Scenario, drift_limit_m: float, draft_deg: float, axes: list[tuple[float, float]]) -> bool:
    cases = sweep(scenario, drafts_deg=[draft_deg], magnetization=axes, threads=1)
    return bool(_kept(cases, drift_limit_m).all())


def _greatest(values: Sequence[float] | NDArray[np.float64], kept: Bools) -> float:
    """Return the greatest of the increasing values up to which all are kept; NaN if the first is not."""
    count = int(np.argmin(kept)) if not kept.all() else len(kept)
    return float(values[count - 1]) if count else float("nan")


def _alone(
    values: Sequence[float] | NDArray[np.float64], kept: Bools, keeps: Callable[[float], bool]
) -> tuple[float, bool]:
    """Return the greatest value up to which all are kept, bisected beyond the grid, and whether none ended it."""
    low = _greatest(values, kept)
    if kept.all() or not kept[0]:
        return low, bool(kept.all())
    high = float(values[int(np.argmin(kept))])
    while high - low > _RESOLUTION_DEG:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if keeps(middle) else (low, middle)
    return low, False
