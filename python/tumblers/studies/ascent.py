"""`Ascent`: one try of one slope, and `limits`: the slopes at which climbing ends, for many robots at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..scenario import Scenario
from ..sweep import ideal_speed
from .native import Native, rotating

__all__ = ["LEAST_SHARE", "Ascent", "Slopes", "bisections", "limits"]

# A robot that rocks on the spot does not climb, and one that slips a little on landing does not slide back.
LEAST_SHARE = 0.01


@dataclass(frozen=True, kw_only=True, slots=True)
class Ascent:
    """One try of one slope.

    Attributes
    ----------
    incline_deg
        The slope, degrees.
    speed_m_per_s
        Mean speed up the slope after settling, m/s; NaN where the motion diverged.
    mean_share, worst_share
        Way up the slope in a cycle after settling over the perimeter of the hull, which is the way without slip: the
        mean, and the cycle that gains least.
    unconverged_steps
        Steps that did not converge.
    error
        Why the run failed, empty if it did not.
    """

    incline_deg: float
    speed_m_per_s: float
    mean_share: float
    worst_share: float
    unconverged_steps: int
    error: str

    @property
    def climbs(self) -> bool:
        """Whether the mean cycle gains 1 % of the perimeter, and none loses as much."""
        return self.mean_share >= LEAST_SHARE and self.worst_share >= -LEAST_SHARE


@dataclass(frozen=True, kw_only=True, slots=True)
class Slopes:
    """All slopes tried with one robot, in their order.

    Attributes
    ----------
    ascents
        The tries.
    scanned
        Slopes of the coarse scan, degrees; the others were tried by bisection.
    """

    ascents: tuple[Ascent, ...]
    scanned: tuple[float, ...]

    @property
    def climbed(self) -> list[bool]:
        """What was climbed, in the order of the slopes."""
        return [ascent.climbs for ascent in self.ascents]

    @property
    def limit(self) -> tuple[float, float]:
        """The greatest slope up to which all tried were climbed and the next one, which was not, degrees.

        NaN in place of the first where even the lowest was not climbed, and of the second where all were.
        """
        climbed = self.climbed
        first = climbed.index(False) if False in climbed else len(climbed)
        return self._slope(first - 1), self._slope(first)

    @property
    def greatest(self) -> tuple[float, float]:
        """The greatest slope of all that was climbed and the next one, degrees; NaN as in `limit`."""
        climbed = self.climbed
        last = len(climbed) - 1 - climbed[::-1].index(True) if True in climbed else -1
        return self._slope(last), self._slope(last + 1)

    @property
    def monotone(self) -> bool:
        """Whether no slope that was climbed is steeper than one that was not."""
        return self.climbed == sorted(self.climbed, reverse=True)

    def _slope(self, place: int) -> float:
        return self.ascents[place].incline_deg if 0 <= place < len(self.ascents) else float("nan")


def bisections(slopes_deg: Sequence[float], resolution_deg: float) -> int:
    """Return how often the widest gap between slopes is halved until it is no wider than the resolution.

    Parameters
    ----------
    slopes_deg, resolution_deg
        Slopes of the scan, and how close the limit is sought, degrees.
    """
    if len(slopes_deg) < 2:
        return 0
    return max(0, int(np.ceil(np.log2(float(np.diff(slopes_deg).max()) / resolution_deg) - 1e-9)))


def limits(
    scenarios: Sequence[Scenario],
    native: Native,
    *,
    slopes_deg: Sequence[float],
    resolution_deg: float,
    settling_cycles: int,
    cycles: int,
) -> list[Slopes]:
    """Try slopes with many robots: a scan of all as one batch, then bisection of all where climbing ends.

    Where climbing does not end once, the first and the last of its ends are bisected.

    Parameters
    ----------
    scenarios
        Robots, each with its substrate and its rotating field; slope and time of their runs are replaced.
    native
        Runs the batches.
    slopes_deg
        Increasing slopes of the scan, degrees.
    resolution_deg
        How close an end is sought, degrees.
    settling_cycles, cycles
        Cycles of the field before measuring starts, and measured ones.

    Returns
    -------
    list[Slopes]
        What was tried with each robot.
    """

    def tried(tries: Sequence[tuple[int, float]]) -> list[Ascent]:
        ways = native.ways([_on(scenarios[robot], slope, settling_cycles + cycles) for robot, slope in tries])
        ascents = []
        for (robot, slope), way in zip(tries, ways, strict=True):
            scenario = scenarios[robot]
            frequency = rotating(scenario).frequency_Hz
            perimeter = (ideal_speed(scenario) or np.nan) / frequency
            gained = np.diff(way.ends_m[settling_cycles:])
            ascents.append(
                Ascent(
                    incline_deg=slope,
                    speed_m_per_s=float(gained.mean()) * frequency,
                    mean_share=float(gained.mean()) / perimeter,
                    worst_share=float(gained.min()) / perimeter,
                    unconverged_steps=way.unconverged_steps,
                    error=way.error,
                )
            )
        return ascents

    def collected(robot: int) -> Slopes:
        return Slopes(
            ascents=tuple(sorted(found[robot], key=lambda ascent: ascent.incline_deg)), scanned=tuple(slopes_deg)
        )

    scan = [(robot, slope) for robot in range(len(scenarios)) for slope in slopes_deg]
    found: list[list[Ascent]] = [[] for _ in scenarios]
    for (robot, _), ascent in zip(scan, tried(scan), strict=True):
        found[robot].append(ascent)
    for _ in range(bisections(slopes_deg, resolution_deg)):
        middles = []
        for robot in range(len(scenarios)):
            slopes = collected(robot)
            for low, high in dict.fromkeys((slopes.limit, slopes.greatest)):
                # NaN where there is nothing to halve.
                if high - low > resolution_deg:
                    middles.append((robot, 0.5 * (low + high)))
        for (robot, _), ascent in zip(middles, tried(middles), strict=True):
            found[robot].append(ascent)
    return [collected(robot) for robot in range(len(scenarios))]


def _on(scenario: Scenario, incline_deg: float, cycles: int) -> Scenario:
    run = replace(
        scenario.run,
        incline_deg=incline_deg,
        duration_s=cycles / rotating(scenario).frequency_Hz,
        output_every_s=None,
    )
    return replace(scenario, run=run)
