"""`Ladder`: a case in ever finer steps with every treatment of the torque, and what it converges to."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import get_args

from tumblers.metrics import Metrics, Yardstick, measured
from tumblers.model import MagneticTorque
from tumblers.step_choice import ACCURACY, choose_step

from .case import AccuracyCase

__all__ = ["KNOWN_TO", "STEPS_S", "TORQUES", "Chosen", "Ladder", "ladder"]

TORQUES: tuple[MagneticTorque, ...] = get_args(MagneticTorque)
STEPS_S = tuple(2e-3 / 2**n for n in range(10))
# A value that is to be met within 1 % is known, where it is known to half of that.
KNOWN_TO = 0.5 * ACCURACY


@dataclass(frozen=True)
class Chosen:
    """What ``step_s = "auto"`` chooses.

    Attributes
    ----------
    step_s
        The step, s.
    estimate, met
        Its error estimate, as a share, and whether that is small enough.
    run
        What the step gives.
    ms
        Processor time of the choice, ms.
    """

    step_s: float
    estimate: float
    met: bool
    run: Metrics | None
    ms: float


@dataclass(frozen=True)
class Ladder:
    """What a case comes to in every step, and what it converges to.

    Attributes
    ----------
    case
        What was run.
    steps_s
        Decreasing steps, s.
    runs
        By treatment of the torque what each step gives; None where the step is refused or the run fails.
    chosen
        By treatment of the torque the step that is chosen by itself.
    yardstick
        What differences are measured by.
    """

    case: AccuracyCase
    steps_s: tuple[float, ...]
    runs: Mapping[MagneticTorque, Sequence[Metrics | None]]
    chosen: Mapping[MagneticTorque, Chosen]
    yardstick: Yardstick

    @property
    def converged(self) -> Metrics | None:
        """The value with the torque at the midpoint in the finest step."""
        return self.runs["midpoint"][-1]

    @property
    def known_to(self) -> float:
        """How far the finest runs of the schemes that do not damp are from it."""
        last = [*self.runs["midpoint"][-3:-1], *self.runs["start_of_step"][-2:]]
        return max(self.yardstick.apart(run, self.converged) for run in last)

    @property
    def is_known(self) -> bool:
        """Whether it converges to a value that is known well enough."""
        return self.known_to <= KNOWN_TO

    def errors(self, torque: MagneticTorque) -> list[float]:
        """Return how far the value of each step is from the converged one.

        Parameters
        ----------
        torque
            A treatment of the torque.
        """
        return [self.yardstick.apart(run, self.converged) for run in self.runs[torque]]

    def longest_step_s(self, torque: MagneticTorque) -> float | None:
        """Return the step from which on all are within 1 % of the converged value; None if not even the finest is.

        Parameters
        ----------
        torque
            A treatment of the torque.
        """
        longest = None
        for step, error in zip(self.steps_s[::-1], self.errors(torque)[::-1], strict=True):
            if error > ACCURACY:
                break
            longest = step
        return longest

    def hidden(self, torque: MagneticTorque) -> list[tuple[float, float, float]]:
        """Return the steps whose error halving them does not show: step, change when halved, and error.

        Parameters
        ----------
        torque
            A treatment of the torque.
        """
        changes = [self.yardstick.apart(run, finer) for run, finer in pairwise(self.runs[torque])]
        found = zip(self.steps_s, changes, self.errors(torque), strict=False)
        return [(step, change, error) for step, change, error in found if change <= ACCURACY < error]


def ladder(case: AccuracyCase, steps_s: Sequence[float] = STEPS_S) -> Ladder:
    """Run a case in every step, with every treatment of the torque.

    Parameters
    ----------
    case
        What is run.
    steps_s
        Decreasing steps, s; those that the field's period does not allow are left out.
    """
    steps = tuple(step for step in steps_s if step <= case.scenario.longest_step_s)
    runs = {torque: measured([case.scenario.at_step(step, torque) for step in steps], threads=1) for torque in TORQUES}
    chosen = {torque: _chosen(case, torque) for torque in TORQUES}
    return Ladder(case, steps, runs, chosen, Yardstick.of(case.scenario))


def _chosen(case: AccuracyCase, torque: MagneticTorque) -> Chosen:
    start = time.process_time()
    choice = choose_step(case.scenario.at_step("auto", torque), threads=1)
    seconds = time.process_time() - start
    return Chosen(choice.step_s, choice.error, choice.met, measured([choice.scenario], threads=1)[0], 1e3 * seconds)
