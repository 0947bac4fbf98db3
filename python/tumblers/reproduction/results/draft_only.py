"""Result 7: draft only."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ...grid import PAPER_DRAFTS_DEG
from ...plots.style import BLUE, ORANGE
from ...progress import OnProgress
from ..choice import Choices
from ..claim import Measure
from ..paper_result import PaperResult
from ..suspect import DRAFT, STANDARD, UNSTATED
from ..tolerance import absolute, exact
from .errors import (
    DRIFT_LIMIT_M,
    FIFTY,
    GRID,
    IDEAL,
    METRICS,
    PER_METRE,
    ROBOTS,
    YES,
    claim,
    errors,
    flips,
    robot_words,
)
from .sets import DRAFTS

__all__ = ["DraftOnly"]

_DEGREE = absolute(1.0, "the text gives whole degrees, read off a figure")
_FROM = absolute(1.0, "'from φ on' can mean that the greatest is there or a step of 1° before")
_RISING_M_PER_S = 2e-6
_STYLES = ((BLUE, "o-"), (BLUE, "x--"), (ORANGE, "o-"), (ORANGE, "x--"))


def _twist(data: xr.Dataset) -> NDArray[np.float64]:
    return np.asarray(data["twist_deg"].values)


def _drift(data: xr.Dataset) -> NDArray[np.float64]:
    return np.asarray(np.abs(data["drift_m"].values) * PER_METRE)


def _speed(data: xr.Dataset) -> NDArray[np.float64]:
    return np.asarray(data["speed_m_per_s"].values) * PER_METRE


def _flips(data: xr.Dataset) -> float:
    twist = _twist(data)
    return float(flips(twist).sum()) if np.isfinite(twist).all() else float("nan")


def _first_flip(data: xr.Dataset) -> float | str:
    drafts = data["draft_deg"].values[flips(_twist(data))]
    return float(drafts[0]) if drafts.size else "no flip"


def _at(read: Callable[[xr.Dataset], NDArray[np.float64]], draft_deg: float) -> Measure:
    def measure(data: xr.Dataset) -> float | str:
        here = data["draft_deg"].values == draft_deg
        (error,) = data["error"].values[here]
        # A draft that cannot be built is a finding too.
        return "refused: a face vanishes" if "vanishes" in error else float(read(data)[here][0])

    return measure


def _draft_of_greatest(read: Callable[[xr.Dataset], NDArray[np.float64]]) -> Measure:
    def measure(data: xr.Dataset) -> float:
        values = read(data)
        if np.isnan(values).all():
            return float("nan")
        return float(data["draft_deg"].values[int(np.nanargmax(values))])

    return measure


def _greatest_twist(data: xr.Dataset) -> float:
    return float(_twist(data).max())


def _least_twist(data: xr.Dataset) -> float | str:
    twist = _twist(data)
    return "no value" if np.isnan(twist).all() else float(np.nanmin(twist))


def _keeps(data: xr.Dataset) -> float | str:
    """Return the greatest draft up to which the drift stays within the paper's limit, without a flip."""
    good = (_drift(data) <= FIFTY.size) & ~flips(_twist(data))
    count = int(np.cumprod(good).sum())
    return float(data["draft_deg"].values[count - 1]) if count else "none"


def _worst_to(draft_deg: float) -> Measure:
    return lambda data: float(_drift(data)[data["draft_deg"].values <= draft_deg].max())


def _speed_rises(data: xr.Dataset) -> str:
    speed = _speed(data)
    falls = np.maximum.accumulate(speed) - speed
    return "Y" if np.isfinite(speed).all() and falls.max() <= _RISING_M_PER_S * PER_METRE else "N"


def _twist_rises_to(draft_deg: float) -> Measure:
    def measure(data: xr.Dataset) -> str:
        twist = _twist(data)[data["draft_deg"].values <= draft_deg]
        return "Y" if bool((np.diff(twist) > 0.0).all()) else "N"

    return measure


_SPIKED = (
    claim("spiked", "speed without errors, µm/s", 1093.0, IDEAL, _at(_speed, 0.0)),
    claim("spiked", "flips among φ = 0° to 15°", 0.0, exact("a count"), _flips),
    claim(
        "spiked", "least twist, °", -20.0, absolute(1.5, "the text says -20 of the range and -21 of it"), _least_twist
    ),
    claim("spiked", "greatest twist, °", 10.0, _DEGREE, _greatest_twist),
    claim("spiked", "φ of the greatest twist, °", 13.0, GRID, _draft_of_greatest(_twist)),
    claim("spiked", "the twist rises from step to step up to φ = 13°", "Y", YES, _twist_rises_to(13.0)),
    claim("spiked", "twist at φ = 14°, °", 0.0, _DEGREE, _at(_twist, 14.0)),
    claim("spiked", "twist at φ = 15°, °", -21.0, _DEGREE, _at(_twist, 15.0)),
    claim("spiked", "φ from which the drift falls (that of the greatest), °", 13.0, _FROM, _draft_of_greatest(_drift)),
    claim(
        "spiked",
        "the speed rises with φ",
        "Y",
        exact("yes or no; a fall of up to 2 µm/s is not seen in a figure that spans 100 µm/s or more"),
        _speed_rises,
    ),
    claim("spiked", "greatest |d_e| for φ ≤ 2°, µm", "at most 50", FIFTY, _worst_to(2.0)),
    claim("spiked", "greatest φ that keeps |d_e| ≤ 50 µm, °", 2.0, GRID, _keeps),
)
_SPIKED_ENDS = (
    claim("spiked_ends", "speed without errors, µm/s", 1197.0, IDEAL, _at(_speed, 0.0)),
    claim("spiked_ends", "φ of the greatest twist, °", 9.0, GRID, _draft_of_greatest(_twist)),
    claim("spiked_ends", "the twist rises from step to step up to φ = 9°", "Y", YES, _twist_rises_to(9.0)),
    claim("spiked_ends", "least twist, °", -90.0, _DEGREE, _least_twist),
    claim(
        "spiked_ends",
        "first φ at which it flips, °",
        12.0,
        GRID,
        _first_flip,
        "The text says it of the drift, which starts again from zero with the flip.",
    ),
    claim(
        "spiked_ends",
        "|d_e| at φ = 12°, µm",
        0.0,
        absolute(10.0, "'drops to zero' in a figure of some hundred µm"),
        _at(_drift, 12.0),
    ),
    claim(
        "spiked_ends", "φ from which the speed falls (that of the greatest), °", 12.0, _FROM, _draft_of_greatest(_speed)
    ),
    claim("spiked_ends", "greatest |d_e| for φ ≤ 1°, µm", "at most 50", FIFTY, _worst_to(1.0)),
    claim("spiked_ends", "greatest φ that keeps |d_e| ≤ 50 µm, °", 1.0, GRID, _keeps),
)


class DraftOnly(PaperResult):
    """Twist, drift and speed against draft, 0° to 15°, at 1 Hz for 1 s, of both spiked robots."""

    number = 7
    name = "draft_only"
    title = "Draft only, φ = 0° to 15°, at 1 Hz for 1 s"
    sets = DRAFTS
    suspects = (*DRAFT, *UNSTATED, *STANDARD)
    runs = len(ROBOTS) * len(PAPER_DRAFTS_DEG)
    claims = (*_SPIKED, *_SPIKED_ENDS)

    def simulate(self, choices: Choices, threads: int, on_progress: OnProgress) -> xr.Dataset:
        """Return the sweep over ``robot`` and ``draft_deg``."""
        data = errors(choices, threads, on_progress, magnetization=[(0.0, 0.0)])
        return data.isel(magnetization_case=0)

    def figure(self, data: Mapping[str, xr.Dataset], figure: Figure) -> None:
        """Draw twist, drift and speed over the draft, the spiked robot on the left, spiked ends on the right."""
        figure.set_size_inches(11.0, 9.0)
        axes = figure.subplots(len(METRICS), len(ROBOTS), sharex=True)
        for column, robot in enumerate(ROBOTS):
            for ax, (metric, (label, factor)) in zip(axes[:, column], METRICS.items(), strict=True):
                for (name, found), (colour, mark) in zip(data.items(), _STYLES, strict=True):
                    one = found.sel(robot=robot)
                    ax.plot(one["draft_deg"], one[metric] * factor, mark, color=colour, label=name, markersize=4)
                if metric == "speed_m_per_s":
                    ax.axhline(float(one["ideal_speed_m_per_s"]) * factor, color="black", linestyle=":", label="ideal")
                    ax.set_xlabel("draft φ (°)")
                if metric == "drift_m":
                    ax.axhspan(-DRIFT_LIMIT_M * factor, DRIFT_LIMIT_M * factor, color="0.9", label="within 50 µm")
                ax.set_ylabel(label)
            axes[0, column].set_title(robot_words(robot), loc="left")
        for ax in axes[:, 0]:
            ax.legend(fontsize="x-small", frameon=False)
        figure.suptitle(self.title)
