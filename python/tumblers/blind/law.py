"""`Law`: what a world does that its nominal scenario does not say."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..effects.base import Effect
from ..scenario import Scenario

__all__ = ["EffectLaw", "Law", "State"]

# What `_core.Walk.advance` returns.
State = Mapping[str, Any]


class Law:
    """A law of the world: it settles a scenario once a trial, and may exchange it on the way.

    Attributes
    ----------
    every
        Steps between two exchanges; 0 for a law that never exchanges.
    """

    every: ClassVar[int] = 0

    def settle(self, scenario: Scenario, trial: int) -> Scenario:  # noqa: ARG002
        """Return the scenario at the start of a trial.

        Parameters
        ----------
        scenario
            What the laws before this one left.
        trial
            The trial's number in its dataset.
        """
        return scenario

    def piece(self, scenario: Scenario, time_s: float, state: State) -> Scenario:  # noqa: ARG002
        """Return the scenario of the next few steps.

        Parameters
        ----------
        scenario
            The settled scenario, or what the laws before this one made of it.
        time_s
            Time, s.
        state
            The state of the walk.
        """
        return scenario

    def seen(self, position_m: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the positions that the camera makes of those it looks at, m, shape (n, 3).

        Parameters
        ----------
        position_m
            Positions, substrate frame, m, shape (n, 3).
        """
        return position_m


class EffectLaw(Law):
    """An effect of the catalogue in the catalogue's own form.

    Parameters
    ----------
    effect
        The effect.
    """

    def __init__(self, effect: Effect) -> None:
        self.effect = effect

    def settle(self, scenario: Scenario, trial: int) -> Scenario:  # noqa: ARG002
        """Return the scenario that the effect has edited."""
        return self.effect.edit(scenario)
