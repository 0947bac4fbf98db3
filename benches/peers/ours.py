"""Our side: native sweeps for the clock, recorded runs for the contact."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

import tumblers
from tumblers import _core
from tumblers.simulate import CONTACT_MODES

from .case import Case, part_of
from .clock import Contestant
from .track import Track, longest_stretch

__all__ = ["Health", "line_contact", "recorded", "swept", "throughout"]


@dataclass
class Health:
    """The worst of all runs that it is told of.

    Attributes
    ----------
    max_residual
        Greatest residual of the complementarity problem in its unreduced form, scaled as docs/model.md says.
    max_penetration_m
        Greatest penetration, m.
    unconverged_steps
        Steps that did not converge.
    """

    max_residual: float = 0.0
    max_penetration_m: float = 0.0
    unconverged_steps: int = 0

    def note(self, residual: float, penetration_m: float, unconverged_steps: int) -> None:
        """Take note of one run."""
        self.max_residual = max(self.max_residual, residual)
        self.max_penetration_m = max(self.max_penetration_m, penetration_m)
        self.unconverged_steps += unconverged_steps


def swept(cases: Sequence[Case], copies: int, threads: int, health: Health) -> Contestant:
    """Return a native batch of runs that keeps their metrics, torque computed in every step.

    Parameters
    ----------
    cases, copies
        What is run, and how many times each.
    threads
        Number of threads, 0 for all.
    health
        Told of every run.
    """
    trials = [trial for case in cases for trial in [case.scenario.trial()] * copies]

    def run() -> None:
        found = _core.sweep(trials, threads)
        errors = [error for error in found["error"] if error is not None]
        if errors:
            raise RuntimeError(errors[0])
        health.note(
            float(np.max(found["max_residual"])),
            float(np.max(found["max_penetration_m"])),
            int(np.sum(found["unconverged_steps"])),
        )

    return Contestant(run, copies * sum(case.steps for case in cases))


def recorded(case: Case, health: Health) -> tuple[Track, Any]:
    """Return the poses of a run, and all its rows.

    Parameters
    ----------
    case
        What is run.
    health
        Told of the run.
    """
    rows = tumblers.simulate(case.scenario)
    health.note(*(rows.attrs[key] for key in ("max_residual", "max_penetration_m", "unconverged_steps")))
    track = Track(case.scenario.run.step_s, rows["position_m"].values, rows["orientation"].values)
    return track, rows


def line_contact(case: Case, health: Health) -> Case:
    """Return the longest stretch of a run whose every step ends in line contact."""
    _, rows = recorded(case, health)
    first, length = longest_stretch(rows["contact_mode"].values == CONTACT_MODES.index("line"))
    # The row that it starts from is already in line contact.
    return throughout(part_of(case, rows, first, length - 1, "line contact"), "line", health)


def throughout(case: Case, mode: str, health: Health) -> Case:
    """Return a case whose every step ends in one kind of contact.

    Parameters
    ----------
    case
        What is run.
    mode
        One of `CONTACT_MODES`.
    health
        Told of the run.

    Raises
    ------
    RuntimeError
        A step ends in another.
    """
    _, rows = recorded(case, health)
    if not (rows["contact_mode"].values == CONTACT_MODES.index(mode)).all():
        raise RuntimeError(f"{case.name}: found steps in another contact than {mode}")
    return case
