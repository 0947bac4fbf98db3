"""`Job`: one trial to simulate, and what is changed about it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from ...effects.base import Effect
from ...scenario import Scenario
from .guide import Nudge

__all__ = ["Edit", "Interlude", "Job"]

Edit = Callable[[Scenario], Scenario]


class Interlude(NamedTuple):
    """Effects that are at work in parts of a run alone, beside those that are all along.

    Attributes
    ----------
    effects
        They leave the body as it is.
    edges_s
        They begin at the first, s, end at the second, begin again at the third, and so on; increasing.
    """

    effects: tuple[Effect, ...]
    edges_s: tuple[float, ...]


@dataclass(frozen=True, eq=False)
class Job:
    """One trial to simulate.

    Attributes
    ----------
    trial
        Its place in the dataset.
    effects
        What is added to the nominal model.
    divisor
        By how much the trial's step is divided.
    edit
        A change of the scenario beside the effects.
    share
        How much of the trial's time is simulated, up to 1.
    nudge
        How the run is drawn along y to where the robot was seen. If None, or where the trial has no `Guide`, or its
        camera shows too little of y (`Guide.behind`), it is on its own.
    interlude
        What is at work in parts of the run alone.
    """

    trial: int
    effects: tuple[Effect, ...] = ()
    divisor: int = 1
    edit: Edit | None = None
    share: float = 1.0
    nudge: Nudge | None = None
    interlude: Interlude | None = None
