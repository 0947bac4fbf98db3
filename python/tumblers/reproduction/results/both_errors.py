"""Result 9: draft and magnetization error together."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from ...grid import PAPER_DRAFTS_DEG, PAPER_MAGNETIZATION_DEG
from ...metrics import FLIP_DEG
from ...plots import plot_map
from ...progress import OnProgress
from ..choice import Choices
from ..claim import Claim
from ..paper_result import PaperResult
from ..suspect import DRAFT, STANDARD, UNSTATED
from ..tolerance import absolute, at_least, exact
from .errors import FIFTY, PER_METRE, ROBOTS, YES, claim, errors, median_of_flips, robot_words
from .sets import DRAFTS

__all__ = ["BothErrors"]

_CASES = len(PAPER_DRAFTS_DEG) * len(PAPER_MAGNETIZATION_DEG)
_SMALL_DRAFT_DEG, _SMALL_THETA2_DEG = 2.0, 10.0
_COUNT = exact("a count")


def _preferred(data: xr.Dataset) -> xr.DataArray:
    # Rounded as the text rounds its limit; a run that failed is not preferred.
    good: xr.DataArray = (abs(data["twist_deg"]) <= FLIP_DEG) & (abs(data["drift_m"]) * PER_METRE <= FIFTY.size)
    return good


def _faster(data: xr.Dataset) -> xr.DataArray:
    fast: xr.DataArray = _preferred(data) & (data["speed_m_per_s"] > data["ideal_speed_m_per_s"])
    return fast


def _near_zero(data: xr.Dataset) -> np.ndarray[Any, Any]:
    theta2 = data["theta2_deg"].values
    return np.asarray(
        (data["theta1_deg"].values == 0.0) | (np.abs((theta2 + 180.0) % 360.0 - 180.0) <= _SMALL_THETA2_DEG)
    )


def _small(data: xr.Dataset) -> xr.Dataset:
    return data.isel(draft_deg=data["draft_deg"].values <= _SMALL_DRAFT_DEG, magnetization_case=_near_zero(data))


def _at_200(data: xr.Dataset, least_deg: float, most_deg: float) -> xr.Dataset:
    drafts = data["draft_deg"].values
    return data.isel(
        draft_deg=(drafts >= least_deg) & (drafts <= most_deg), magnetization_case=data["theta2_deg"].values == 200.0
    )


def _ran(data: xr.Dataset) -> float:
    return float(np.isfinite(data["twist_deg"].values).sum())


def _yes(found: xr.DataArray) -> str:
    return "Y" if bool(found.any()) else "N"


def _worst_drift(data: xr.Dataset) -> float:
    return float(abs(_small(data)["drift_m"]).max(skipna=False)) * PER_METRE


def _share_faster_upright(data: xr.Dataset) -> float:
    upright = (abs(data["twist_deg"]) <= FLIP_DEG) & (data["draft_deg"] + data["theta1_deg"] > 0.0)
    count = int(upright.sum())
    fast = upright & (data["speed_m_per_s"] > data["ideal_speed_m_per_s"])
    return int(fast.sum()) / count if count else float("nan")


def _shared(robot: str) -> tuple[Claim, ...]:
    return (
        claim(robot, "cases run", float(_CASES), _COUNT, _ran),
        claim(
            robot,
            "|twist| where it flips (median), °",
            90.0,
            absolute(10.0, "'≈ 90°', read off a colour"),
            median_of_flips("twist_deg", 1.0),
        ),
        claim(
            robot,
            "speed where it flips (median), µm/s",
            1200.0,
            absolute(20.0, "'closer to 1200 µm/s' than 2 %"),
            median_of_flips("speed_m_per_s", PER_METRE),
        ),
        claim(robot, "greatest |d_e| for |θ2| ≤ 10° and φ ≤ 2°, µm", "at most 50", FIFTY, _worst_drift),
        claim(
            robot,
            "a preferred case with errors beyond both of those tolerances",
            "Y",
            YES,
            lambda data: _yes(
                _preferred(data).isel(
                    draft_deg=data["draft_deg"].values > _SMALL_DRAFT_DEG, magnetization_case=~_near_zero(data)
                )
            ),
        ),
    )


_SPIKED = (
    *_shared("spiked"),
    claim(
        "spiked", "preferred at φ = 15°, θ2 = 200°", "Y", YES, lambda data: _yes(_preferred(_at_200(data, 15.0, 15.0)))
    ),
    claim(
        "spiked",
        "preferred and faster than 1093 µm/s at θ2 = 200°, of the 7 drafts from 8° to 14°",
        7.0,
        _COUNT,
        lambda data: float(_faster(_at_200(data, 8.0, 14.0)).sum()),
    ),
    claim(
        "spiked",
        "preferred and faster than 1093 µm/s with small errors (|θ2| ≤ 10°, φ ≤ 2°)",
        "Y",
        YES,
        lambda data: _yes(_faster(_small(data))),
    ),
)
_SPIKED_ENDS = (
    *_shared("spiked_ends"),
    claim(
        "spiked_ends",
        "share of the cases with errors and without flip that are faster than 1197 µm/s: 'often'",
        "often",
        at_least(0.5, "'often' is half of them or more"),
        _share_faster_upright,
    ),
    claim("spiked_ends", "a preferred case faster than 1197 µm/s", "Y", YES, lambda data: _yes(_faster(data))),
)


class BothErrors(PaperResult):
    """Maps of twist, drift and speed of both spiked robots over 37 magnetization errors and 16 drafts."""

    number = 9
    name = "both_errors"
    title = "Draft and magnetization error together, 592 cases a robot"
    sets = DRAFTS
    suspects = (*DRAFT, *UNSTATED, *STANDARD)
    runs = len(ROBOTS) * _CASES
    claims = (*_SPIKED, *_SPIKED_ENDS)

    def simulate(self, choices: Choices, threads: int, on_progress: OnProgress) -> xr.Dataset:
        """Return the sweep over ``robot``, ``draft_deg`` and ``magnetization_case``."""
        return errors(choices, threads, on_progress, magnetization=PAPER_MAGNETIZATION_DEG)

    def figure(self, data: Mapping[str, xr.Dataset], figure: Figure) -> None:
        """Draw the maps of twist, drift and speed, those of a set side by side for both robots."""
        figure.set_size_inches(10.5 * len(ROBOTS), 10.5 * len(data))
        grid = figure.subfigures(len(data), len(ROBOTS), squeeze=False)
        for row, (name, found) in zip(grid, data.items(), strict=True):
            for part, robot in zip(row, ROBOTS, strict=True):
                one = found.sel(robot=robot)
                one.attrs |= {key: float(one[key]) for key in ("ideal_speed_m_per_s", "flipped_speed_m_per_s")}
                for ax, metric in zip(part.subplots(3, 1), ("twist_deg", "drift_m", "speed_m_per_s"), strict=True):
                    plot_map(one, metric, ax)  # type: ignore[arg-type]
                part.suptitle(f"{robot_words(robot)}, {name}")
