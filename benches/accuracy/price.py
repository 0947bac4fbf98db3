"""`Price`: what a simulated second costs in the longest step that is accurate enough; `Group`: of several cases."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from statistics import geometric_mean

from peers.case import Case
from peers.clock import alternate, microseconds
from peers.ours import Health, swept

from tumblers.model import MagneticTorque

from .ladder import TORQUES, Ladder

__all__ = ["Group", "Price", "grouped", "prices"]

# A run of few steps is timed in copies.
_LEAST_STEPS = 20_000


@dataclass(frozen=True)
class Price:
    """What a treatment of the torque costs.

    Attributes
    ----------
    step_s
        The longest step from which on all are accurate enough, s; None if not even the finest is.
    ms_per_s
        Processor time of a simulated second in it, ms: the median of the repetitions; in the finest step, which is too
        little, where none is accurate enough.
    """

    step_s: float | None
    ms_per_s: float


def prices(ladder: Ladder, repetitions: int, health: Health, tell: Callable[[], None]) -> dict[MagneticTorque, Price]:
    """Time every treatment of the torque, in turn.

    Parameters
    ----------
    ladder
        Of a case whose value is known.
    repetitions
        How many.
    health
        Told of every run.
    tell
        Called after each.
    """
    longest = {torque: ladder.longest_step_s(torque) for torque in TORQUES}
    runs = {
        torque: ladder.case.scenario.at_step(step or ladder.steps_s[-1], torque) for torque, step in longest.items()
    }
    contestants = {
        torque: swept([Case(ladder.case.robot, run)], -(-_LEAST_STEPS // run.run.steps), 1, health)
        for torque, run in runs.items()
    }
    samples = alternate(contestants, repetitions, tell)
    return {
        torque: Price(longest[torque], 1e-3 * microseconds(samples[torque]) * run.run.steps / run.run.duration_s)
        for torque, run in runs.items()
    }


@dataclass(frozen=True)
class Group:
    """Prices of several cases.

    Attributes
    ----------
    words
        Which cases.
    count
        How many of them have a value that is known.
    reached, cheapest
        By treatment of the torque: in how many a step is accurate enough, and in how many of those none costs less.
    over_cheapest
        Its price over the least of the case: the geometric mean over the cases.
    """

    words: str
    count: int
    reached: dict[MagneticTorque, int]
    cheapest: dict[MagneticTorque, int]
    over_cheapest: dict[MagneticTorque, float]

    @property
    def best(self) -> MagneticTorque:
        """The treatment of the least price."""
        return min(self.over_cheapest, key=lambda torque: self.over_cheapest[torque])


def grouped(words: str, found: Sequence[Mapping[MagneticTorque, Price]]) -> Group:
    """Return what several cases cost together.

    Parameters
    ----------
    words, found
        Which cases, and their prices.
    """
    least = [
        min((price.ms_per_s for price in case.values() if price.step_s is not None), default=float("inf"))
        for case in found
    ]
    reached = {torque: sum(case[torque].step_s is not None for case in found) for torque in TORQUES}
    cheapest = {
        torque: sum(
            case[torque].step_s is not None and case[torque].ms_per_s == best
            for case, best in zip(found, least, strict=True)
        )
        for torque in TORQUES
    }
    # Where no treatment gets there no one is compared.
    pairs = [(case, best) for case, best in zip(found, least, strict=True) if best < float("inf")]
    over = {
        torque: geometric_mean([case[torque].ms_per_s / best for case, best in pairs]) if pairs else float("nan")
        for torque in TORQUES
    }
    return Group(words, len(found), reached, cheapest, over)
