"""Spiked robots with manufacturing errors: their sweeps, and what is read off them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ...grid import PAPER_DRAFTS_DEG
from ...metrics import FLIP_DEG
from ...presets import DRIVES
from ...progress import OnProgress
from ...sweep import DRIFT_LIMIT_M, sweep
from ..choice import Choices
from ..claim import Claim, Measure
from ..tolerance import Tolerance, absolute, at_most, exact

__all__ = [
    "DRIFT_LIMIT_M",
    "FIFTY",
    "GRID",
    "IDEAL",
    "METRICS",
    "PER_METRE",
    "PRESETS",
    "ROBOTS",
    "YES",
    "angles",
    "claim",
    "errors",
    "flips",
    "median_of_flips",
    "robot_words",
]

ROBOTS = ("spiked", "spiked_ends")
PRESETS = {"spiked": "spiked_pdms", "spiked_ends": "spiked_ends_pdms"}
PER_METRE = 1e6
# name: (label, factor)
METRICS = {
    "twist_deg": ("twist (°)", 1.0),
    "drift_m": ("drift (µm)", PER_METRE),
    "speed_m_per_s": ("speed (µm/s)", PER_METRE),
}
_DURATION_S = 1.0
_KEPT = ("twist_deg", "drift_m", "speed_m_per_s", "flipped", "unconverged_steps", "error")

FIFTY = at_most(50.5, "the text's 50 µm, rounded to whole µm")
GRID = exact("read on the paper's own grid")
IDEAL = absolute(1.0, "the text gives whole µm/s")
YES = exact("yes or no")


def robot_words(robot: str) -> str:
    """Return a robot's name as the paper writes it."""
    return {"spiked": "spiked (SS)", "spiked_ends": "spiked ends (SES)"}[robot]


def errors(
    choices: Choices,
    threads: int,
    on_progress: OnProgress,
    *,
    magnetization: Sequence[tuple[float, float]],
    drafts_deg: Sequence[float] = PAPER_DRAFTS_DEG,
) -> xr.Dataset:
    """Run both spiked robots at 20 mT and 1 Hz for 1 s on aluminium, for every draft and magnetization error.

    Parameters
    ----------
    choices, threads, on_progress
        As in `tumblers.reproduction.paper_result.PaperResult.simulate`.
    magnetization, drafts_deg
        As in `tumblers.sweep`.

    Returns
    -------
    xarray.Dataset
        What `tumblers.sweep` returns, over ``robot`` too, with ``ideal_speed_m_per_s`` and
        ``flipped_speed_m_per_s`` (robot).
    """
    found: list[xr.Dataset] = []
    speeds: dict[str, list[float]] = {"ideal_speed_m_per_s": [], "flipped_speed_m_per_s": []}
    cases = len(magnetization) * len(drafts_deg)
    for i, robot in enumerate(ROBOTS):
        scenario = choices.scenario(PRESETS[robot], "aluminium_pdms", DRIVES["20mT_1Hz"].value, duration_s=_DURATION_S)
        result = sweep(
            scenario,
            drafts_deg=drafts_deg,
            magnetization=magnetization,
            threads=threads or None,
            progress=lambda done, before=i * cases: on_progress(before + done),  # type: ignore[misc]
        )
        for name, values in speeds.items():
            values.append(result.attrs[name])
        found.append(result[list(_KEPT)].drop_attrs(deep=False))
    data: xr.Dataset = xr.concat(found, xr.DataArray(list(ROBOTS), dims="robot", name="robot"))
    return data.assign({name: ("robot", values, {"units": "m s-1"}) for name, values in speeds.items()})


def claim(
    robot: str, quantity: str, paper: float | str, tolerance: Tolerance, measure: Measure, note: str = ""
) -> Claim:
    """Return a claim about one of the robots.

    Parameters
    ----------
    robot
        One of `ROBOTS`.
    quantity, paper, tolerance, note
        As in `tumblers.reproduction.claim.Claim`.
    measure
        Reads our value off a Dataset without the dimension ``robot``.
    """
    return Claim(
        robot=robot_words(robot),
        quantity=quantity,
        paper=paper,
        tolerance=tolerance,
        measure=lambda data: measure(data.sel(robot=robot)),
        note=note,
    )


def flips(twist_deg: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return which twists are flips; a run that failed is none, and `numpy.isfinite` tells it apart.

    Parameters
    ----------
    twist_deg
        Twists after one cycle, degrees.
    """
    return np.asarray(np.abs(twist_deg) > FLIP_DEG)


def median_of_flips(name: str, factor: float) -> Measure:
    """Return what reads the median size of a metric where the robot flips, in words where it never does.

    Parameters
    ----------
    name, factor
        Key of `METRICS`, and what its values are multiplied by.
    """

    def measure(data: xr.Dataset) -> float | str:
        values = np.abs(data[name].values)[flips(data["twist_deg"].values)] * factor
        return float(np.median(values)) if values.size else "no flip"

    return measure


def angles(values: NDArray[np.float64], step: float) -> str:
    """Return increasing angles as ranges in words, such as ``20 to 160, 200 to 340``.

    Parameters
    ----------
    values
        Angles, degrees.
    step
        What neighbours are apart.
    """
    if values.size == 0:
        return "none"
    parts = np.split(values, np.flatnonzero(np.diff(values) > step * 1.5) + 1)
    return ", ".join(f"{part[0]:g} to {part[-1]:g}" if len(part) > 1 else f"{part[0]:g}" for part in parts)
