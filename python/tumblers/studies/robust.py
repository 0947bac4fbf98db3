"""`Errors`: the distribution of manufacturing errors, and the merit of a design under it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from ..check import number
from ..scenario import Scenario
from .defaults import AXIS_SIGMA_DEG, DRAFT_MOST_DEG, DRAWS
from .native import Native, Outcomes, rotating

__all__ = ["NO_ERROR", "Errors", "merits", "with_errors"]

Floats = NDArray[np.float64]

NO_ERROR: Floats = np.zeros((1, 3))


@dataclass(frozen=True, kw_only=True, slots=True)
class Errors:
    """How robots of one design differ.

    The draft is uniform from 0 to `draft_most_deg`. The tip of the magnetic axis is off in every direction alike, by a
    normal distribution of `axis_sigma_deg` along each of two: θ1 is Rayleigh's, θ2 uniform.

    Attributes
    ----------
    draft_most_deg, axis_sigma_deg
        The distribution, degrees.
    draws
        Number of robots drawn, a power of two.
    seed
        What they are drawn from.
    """

    draft_most_deg: float = DRAFT_MOST_DEG
    axis_sigma_deg: float = AXIS_SIGMA_DEG
    draws: int = DRAWS
    seed: int = 0

    def __post_init__(self) -> None:
        number("draft_most_deg", self.draft_most_deg, least=0.0, most=30.0)
        number("axis_sigma_deg", self.axis_sigma_deg, least=0.0, most=30.0)

    def drawn(self) -> Floats:
        """Return φ, θ1 and θ2 of every robot drawn, degrees, shape (draws, 3): a scrambled Sobol sequence."""
        u = qmc.Sobol(3, scramble=True, seed=self.seed).random(self.draws)
        theta1 = self.axis_sigma_deg * np.sqrt(-2.0 * np.log1p(-u[:, 1]))
        return np.column_stack([self.draft_most_deg * u[:, 0], theta1, 360.0 * u[:, 2]])


def with_errors(scenario: Scenario, errors: Floats) -> list[Scenario]:
    """Return a scenario with every one of some errors.

    Parameters
    ----------
    scenario
        The design without errors.
    errors
        φ, θ1 and θ2, degrees, shape (draws, 3).
    """
    return [
        replace(scenario, robot=scenario.robot.with_draft(float(draft)).with_magnetization(float(first), float(second)))
        for draft, first, second in errors
    ]


def merits(scenario: Scenario, outcomes: Outcomes, drift_cost: float) -> Floats:
    """Return the merit of every robot drawn, m/s, shape (draws,).

    ``v - c f |d|`` for a robot that does not flip, with the speed v along y, the drift d in a cycle, the frequency f
    and the cost c of a metre of drift in metres of way; 0 for one that flips or fails.

    Parameters
    ----------
    scenario
        The design.
    outcomes
        What its runs came to.
    drift_cost
        c.
    """
    net = outcomes.speed_m_per_s - drift_cost * rotating(scenario).frequency_Hz * np.abs(outcomes.drift_m)
    return np.where(outcomes.upright, net, 0.0)


def mean_merits(scenarios: Sequence[Scenario], errors: Floats, native: Native, drift_cost: float) -> Floats:
    """Return the mean merit of designs over the same errors, m/s, shape (designs,), from one native batch.

    Parameters
    ----------
    scenarios
        The designs without errors.
    errors
        φ, θ1 and θ2, degrees, shape (draws, 3).
    native
        Runs the batch.
    drift_cost
        See `merits`.
    """
    outcomes = native.outcomes([case for scenario in scenarios for case in with_errors(scenario, errors)])
    each = merits(scenarios[0], outcomes, drift_cost).reshape(len(scenarios), -1)
    return np.asarray(each.mean(axis=1))
