"""`Native`: many scenarios as one native batch, and a progress that runs on over several batches."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..check import thread_count
from ..errors import InputError, TumblersError, show
from ..field import RotatingField
from ..metrics import FLIP_DEG
from ..progress import OnProgress
from ..scenario import Scenario

__all__ = ["Native", "Outcomes", "Way", "rotating", "threads_of"]

Floats = NDArray[np.float64]
T = TypeVar("T")

# Rows of a path in a cycle of the field; between them the way is taken as straight.
_ROWS_PER_CYCLE = 50


@dataclass(frozen=True, eq=False, kw_only=True)
class Outcomes:
    """What n runs came to; NaN where a run failed.

    Attributes
    ----------
    speed_m_per_s
        Displacement along y over the time, m/s, shape (n,).
    drift_m, twist_deg
        After one cycle of the field, m and degrees, shape (n,).
    unconverged_steps
        Shape (n,), 0 where a run failed.
    errors
        Why a run failed, empty where it did not, n of them.
    """

    speed_m_per_s: Floats
    drift_m: Floats
    twist_deg: Floats
    unconverged_steps: NDArray[np.int64]
    errors: tuple[str, ...]

    @property
    def upright(self) -> NDArray[np.bool_]:
        """Which runs neither failed nor flipped, shape (n,)."""
        return np.abs(self.twist_deg) <= FLIP_DEG


@dataclass(frozen=True, eq=False, kw_only=True)
class Way:
    """How far a robot got.

    Attributes
    ----------
    ends_m
        y of the centre of mass at the ends of the field's cycles, m, shape (cycles + 1,), the start first; NaN from
        where the motion diverged.
    unconverged_steps
        Steps that did not converge.
    error
        Why the run failed, empty if it did not.
    """

    ends_m: Floats
    unconverged_steps: int
    error: str


class Native:
    """Runs scenarios in native batches.

    Parameters
    ----------
    threads
        Threads of a batch, all if None. The results do not depend on it.
    report
        Is told how many runs are done, over all batches.
    """

    def __init__(self, threads: int | None = None, report: OnProgress | None = None) -> None:
        self.threads = threads_of(threads)
        self.done = 0
        self._report = report

    def outcomes(self, scenarios: Sequence[Scenario]) -> Outcomes:
        """Return what every scenario comes to; one that cannot be built is NaN and says why.

        Parameters
        ----------
        scenarios
            What to run.
        """
        trials, built, errors = _trials(scenarios)
        found: Mapping[str, Any] = self._batch(
            lambda report: _core.sweep(trials, self.threads, report), len(scenarios) - len(trials), len(trials)
        )
        for case, error in zip(built, found["error"], strict=True):
            errors[case] = " ".join((error or "").split())
        good = [row for row, case in enumerate(built) if not errors[case]]

        def column(name: str) -> Floats:
            values = np.full(len(scenarios), np.nan)
            values[[built[row] for row in good]] = np.asarray(found[name], dtype=np.float64)[good]
            return values

        return Outcomes(
            speed_m_per_s=column("speed_m_per_s"),
            drift_m=column("drift_m"),
            twist_deg=np.degrees(column("twist_rad")),
            unconverged_steps=np.nan_to_num(column("unconverged_steps")).astype(np.int64),
            errors=tuple(errors),
        )

    def ways(self, scenarios: Sequence[Scenario]) -> list[Way]:
        """Return how far the robot of every scenario gets in each whole cycle of its rotating field.

        Parameters
        ----------
        scenarios
            What to run, each in a rotating field.
        """
        trials, built, errors = _trials(scenarios)
        runs = [scenarios[case] for case in built]
        periods = [1.0 / rotating(scenario).frequency_Hz for scenario in scenarios]
        every = [
            max(1, int(periods[case] / run.run.fixed_step_s / _ROWS_PER_CYCLE))
            for case, run in zip(built, runs, strict=True)
        ]
        found = self._batch(
            lambda report: _core.rollouts(trials, every, self.threads, report),
            len(scenarios) - len(trials),
            len(trials),
        )
        ways = [
            Way(ends_m=np.full(round(s.run.duration_s / period) + 1, np.nan), unconverged_steps=0, error=error)
            for s, period, error in zip(scenarios, periods, errors, strict=True)
        ]
        for case, rollout in zip(built, found, strict=True):
            times = periods[case] * np.arange(len(ways[case].ends_m))
            # The last cycle may end a rounding after the last row.
            last = rollout["time_s"][-1] * (1.0 + 1e-9)
            ends = np.interp(times, rollout["time_s"], rollout["position_m"][:, 1])
            ways[case] = Way(
                ends_m=np.where(times <= last, ends, np.nan),
                unconverged_steps=rollout["unconverged_steps"],
                error=" ".join((rollout["error"] or "").split()),
            )
        return ways

    def _batch(self, call: Callable[[OnProgress | None], T], refused: int, count: int) -> T:
        report, before = self._report, self.done + refused
        found = call(None if report is None else lambda done: report(before + done))
        self.done = before + count
        return found


def _trials(scenarios: Sequence[Scenario]) -> tuple[list[_core.Trial], list[int], list[str]]:
    """Return the trials that can be built, which scenarios they are of, and every scenario's error or none."""
    trials: list[_core.Trial] = []
    built: list[int] = []
    errors: list[str] = []
    for case, scenario in enumerate(scenarios):
        try:
            trials.append(scenario.trial())
            built.append(case)
            errors.append("")
        except TumblersError as reason:
            errors.append(str(reason))
    return trials, built, errors


def rotating(scenario: Scenario) -> RotatingField:
    """Return the rotating field of a scenario.

    Parameters
    ----------
    scenario
        What is studied.

    Raises
    ------
    InputError
        A field that does not rotate: it has no cycle.
    """
    if not isinstance(scenario.field, RotatingField):
        raise InputError("field.kind", show(scenario.field.kind), "'rotating': the study counts cycles of the field")
    return scenario.field


def threads_of(threads: int | None) -> int:
    """Return the number of threads as the native module takes it, 0 for all.

    Parameters
    ----------
    threads
        A number of threads, or None for all.

    Raises
    ------
    InputError
        Another number.
    """
    return 0 if threads is None else thread_count("threads", threads)
