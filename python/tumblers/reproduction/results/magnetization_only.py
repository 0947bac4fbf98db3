"""Result 8: magnetization error only."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ...grid import PAPER_MAGNETIZATION_DEG
from ...plots.style import BLUE, ORANGE
from ...progress import OnProgress
from ..choice import Choices
from ..claim import Measure
from ..paper_result import PaperResult
from ..suspect import STANDARD, UNSTATED
from ..tolerance import absolute, exact
from .errors import (
    DRIFT_LIMIT_M,
    FIFTY,
    METRICS,
    PER_METRE,
    ROBOTS,
    angles,
    claim,
    errors,
    flips,
    median_of_flips,
    robot_words,
)
from .sets import PARAMETERS

__all__ = ["MagnetizationOnly"]

_STEP_DEG = 10.0
_RANGES = exact("ranges on the paper's own grid of 10°")
_ALMOST_90 = absolute(10.0, "'almost 90°' read off a figure")
_TENS = absolute(5.0, "the text gives the speed in tens")
_NEARLY_1200 = absolute(20.0, "'nearly': within 2 %, far less than the 9 % that part it from the ideal speed")


def _erring(data: xr.Dataset) -> xr.Dataset:
    """Return the 36 cases with a magnetization error."""
    return data.isel(magnetization_case=slice(1, None))


def _at(name: str, theta2_deg: float, factor: float) -> Measure:
    def measure(data: xr.Dataset) -> float:
        erring = _erring(data)
        return float(erring[name].values[erring["theta2_deg"].values == theta2_deg][0]) * factor

    return measure


def _size_at(name: str, theta2_deg: float, factor: float) -> Measure:
    read = _at(name, theta2_deg, factor)
    return lambda data: abs(float(read(data)))


def _asymmetry(data: xr.Dataset) -> float:
    # θ2 = 10° to 350°: each is the mirror image of 360° - θ2.
    speeds = data["speed_m_per_s"].values[1:36] * PER_METRE
    # To a millionth of a µm/s: what is less is rounding.
    return round(float(np.abs(speeds - speeds[::-1]).max()), 6)


def _flipping(data: xr.Dataset) -> str:
    twist = _erring(data)["twist_deg"].values
    if not np.isfinite(twist).all():
        return "no value"
    return angles(_erring(data)["theta2_deg"].values[flips(twist)], _STEP_DEG)


def _upright(data: xr.Dataset) -> str:
    """Return θ2 without flip as the text has it: the range about 0° from a negative angle."""
    erring = _erring(data)
    twist = erring["twist_deg"].values
    if not np.isfinite(twist).all():
        return "no value"
    kept = erring["theta2_deg"].values[~flips(twist)]
    # 225° to 360° of the full circle count from zero downwards only where they go on beyond it.
    signed = np.sort(kept)
    if signed.size and signed.size < len(twist) and signed[-1] == 360.0:
        last = np.flatnonzero(np.diff(signed) > _STEP_DEG * 1.5)
        start = int(last[-1]) + 1 if last.size else 0
        signed = np.concatenate([signed[start:] - 360.0, signed[:start]])
    return angles(signed, _STEP_DEG)


def _of_flipped(name: str, factor: float) -> Measure:
    read = median_of_flips(name, factor)
    return lambda data: read(_erring(data))


def _drift_near(theta2_deg: tuple[float, ...]) -> Measure:
    def measure(data: xr.Dataset) -> float:
        erring = _erring(data)
        theta2: NDArray[np.float64] = erring["theta2_deg"].values
        drift = np.abs(erring["drift_m"].values) * PER_METRE
        return float(max(drift[np.abs(theta2 - near) <= _STEP_DEG].min() for near in theta2_deg))

    return measure


_SYMMETRIC = absolute(5.0, "symmetric to the eye in a figure of some hundred µm/s")
_SPIKED = (
    claim("spiked", "greatest |v(θ2) - v(360° - θ2)|, µm/s", 0.0, _SYMMETRIC, _asymmetry),
    claim("spiked", "θ2 at which it flips, °", "20 to 160, 200 to 340", _RANGES, _flipping),
    claim("spiked", "|twist| where it flips (median), °", 90.0, _ALMOST_90, _of_flipped("twist_deg", 1.0)),
    claim(
        "spiked", "speed where it flips (median), µm/s", 1200.0, _NEARLY_1200, _of_flipped("speed_m_per_s", PER_METRE)
    ),
    claim("spiked", "θ2 without flip, °", "-10 to 10, 170 to 190", _RANGES, _upright),
    claim(
        "spiked",
        "|d_e| near θ2 = 50°, 140°, 220°, 310° (least within 10°, the greatest of the four), µm",
        "at most 50",
        FIFTY,
        _drift_near((50.0, 140.0, 220.0, 310.0)),
    ),
    claim("spiked", "speed at θ2 = 150°, µm/s", 1210.0, _TENS, _at("speed_m_per_s", 150.0, PER_METRE)),
    claim(
        "spiked", "|d_e| at θ2 = 150°, 'close to zero', µm", "at most 50", FIFTY, _size_at("drift_m", 150.0, PER_METRE)
    ),
)
_SPIKED_ENDS = (
    claim("spiked_ends", "greatest |v(θ2) - v(360° - θ2)|, µm/s", 0.0, _SYMMETRIC, _asymmetry),
    claim("spiked_ends", "θ2 without flip, °", "-20 to 20, 90 to 100, 170 to 190, 260 to 270", _RANGES, _upright),
    claim("spiked_ends", "|twist| where it flips (median), °", 90.0, _ALMOST_90, _of_flipped("twist_deg", 1.0)),
    *(
        made
        for theta2 in (100.0, 260.0)
        for made in (
            claim(
                "spiked_ends",
                f"speed at θ2 = {theta2:g}°, µm/s",
                1290.0,
                _TENS,
                _at("speed_m_per_s", theta2, PER_METRE),
            ),
            claim(
                "spiked_ends",
                f"|d_e| at θ2 = {theta2:g}°, 'close to zero', µm",
                "at most 50",
                FIFTY,
                _size_at("drift_m", theta2, PER_METRE),
            ),
            claim(
                "spiked_ends",
                f"|twist| at θ2 = {theta2:g}°, 'minimal', °",
                0.0,
                absolute(10.0, "'almost zero' read off a figure of ± 90°"),
                _size_at("twist_deg", theta2, 1.0),
            ),
        )
    ),
)


class MagnetizationOnly(PaperResult):
    """Twist, drift and speed against θ2 with θ1 = 10°, at 1 Hz for 1 s, of both spiked robots."""

    number = 8
    name = "magnetization_only"
    title = "Magnetization error only, θ1 = 10°, at 1 Hz for 1 s"
    sets = PARAMETERS
    suspects = (*UNSTATED, *STANDARD)
    runs = len(ROBOTS) * len(PAPER_MAGNETIZATION_DEG)
    claims = (*_SPIKED, *_SPIKED_ENDS)

    def simulate(self, choices: Choices, threads: int, on_progress: OnProgress) -> xr.Dataset:
        """Return the sweep over ``robot`` and ``magnetization_case``, the first without error."""
        data = errors(choices, threads, on_progress, magnetization=PAPER_MAGNETIZATION_DEG, drafts_deg=[0.0])
        return data.isel(draft_deg=0)

    def figure(self, data: Mapping[str, xr.Dataset], figure: Figure) -> None:
        """Draw twist, drift and speed over θ2, the spiked robot on the left, spiked ends on the right."""
        figure.set_size_inches(11.0, 9.0)
        axes = figure.subplots(len(METRICS), len(ROBOTS), sharex=True)
        for column, robot in enumerate(ROBOTS):
            for ax, (metric, (label, factor)) in zip(axes[:, column], METRICS.items(), strict=True):
                for (name, found), colour in zip(data.items(), (BLUE, ORANGE), strict=True):
                    one = _erring(found.sel(robot=robot))
                    flipped = flips(one["twist_deg"].values)
                    theta2, values = one["theta2_deg"].values, one[metric].values * factor
                    ax.plot(theta2, values, color=colour, linewidth=0.8, alpha=0.4)
                    ax.plot(theta2[flipped], values[flipped], "x", color=colour, label=f"{name}, flips")
                    ax.plot(
                        theta2[~flipped], values[~flipped], "o", color=colour, markersize=4, label=f"{name}, does not"
                    )
                if metric == "speed_m_per_s":
                    for key, words, dashes in (("ideal", "ideal", ":"), ("flipped", "2(L+W)f", "--")):
                        speed = float(one[f"{key}_speed_m_per_s"]) * factor
                        ax.axhline(speed, color="black", linestyle=dashes, linewidth=0.9, label=words)
                    ax.set_xlabel("θ2 (°)")
                if metric == "drift_m":
                    ax.axhspan(-DRIFT_LIMIT_M * factor, DRIFT_LIMIT_M * factor, color="0.9", label="within 50 µm")
                ax.set_ylabel(label)
            axes[0, column].set_title(robot_words(robot), loc="left")
        marks, names = axes[0, 0].get_legend_handles_labels()
        axes[0, 0].legend(marks, names, fontsize="small", frameon=False, loc="lower left")
        marks, names = axes[2, 1].get_legend_handles_labels()
        # The lines alone, where the speeds leave room; the marks are those of the first axes.
        axes[2, 1].legend(marks[-2:], names[-2:], fontsize="small", frameon=False, loc="upper center")
        axes[0, 0].set_xticks(range(0, 361, 60))
        figure.suptitle(self.title)
