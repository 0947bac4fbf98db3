"""`DesignSpace`: a family of shapes on a substrate in a field, and what its designs come to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..check import number
from ..errors import InputError, show
from ..scenario import Scenario
from .ascent import bisections, limits
from .family import Family, family_of
from .native import Native, rotating
from .robust import mean_merits, merits, with_errors
from .tipping import tipping_or_nan

__all__ = ["QUANTITIES", "DesignSpace"]

Floats = NDArray[np.float64]

_SLOPES_DEG = tuple(10.0 * n for n in range(9))
_RESOLUTION_DEG = 1.0

# name: (units, meaning)
QUANTITIES = {
    "speed_m_per_s": ("m s-1", "speed without errors"),
    "drift_m": ("m", "drift in a cycle without errors"),
    "climb_deg": ("degree", "greatest slope climbed without errors"),
    "tipping_torque_N_m": ("N m", "greatest static torque of a turn: weight, electrostatic force, adhesion of faces"),
    "tipping_field_T": ("T", "weakest field that gives the tipping torque"),
    "nominal_merit_m_per_s": ("m s-1", "merit without errors"),
    "error_speed_m_per_s": ("m s-1", "mean speed over the errors"),
    "error_drift_m": ("m", "mean |drift| in a cycle over the errors"),
    "upright_share": ("1", "share of the robots drawn that do not flip"),
    "robust_merit_m_per_s": ("m s-1", "mean merit over the errors"),
    "unconverged_steps": ("1", "steps that did not converge"),
}


class DesignSpace:
    """A family of shapes on a substrate in a field, and what its designs come to.

    Parameters
    ----------
    scenario
        The base robot on its substrate in a rotating field, for at least one of its cycles.
    drift_cost
        Cost of drift in the merit, see `tumblers.studies.robust.merits`.

    Raises
    ------
    InputError
        A shape without a family, a field that does not rotate, or a run of less than a cycle.
    """

    def __init__(self, scenario: Scenario, drift_cost: float) -> None:
        cycle = 1.0 / rotating(scenario).frequency_Hz
        if scenario.run.duration_s < cycle * (1.0 - 1e-9):
            raise InputError(
                "run.duration_s", show(scenario.run.duration_s), f"a cycle of the field, {cycle:g} s, or more"
            )
        self.family: Family = family_of(scenario.robot)
        self.base = replace(scenario, robot=self.family.base)
        self.base.trial()
        self.drift_cost = number("drift_cost", drift_cost, least=0.0)

    def scenario(self, values: Sequence[float]) -> Scenario:
        """Return the scenario of a design without errors.

        Parameters
        ----------
        values
            Its parameters.
        """
        return replace(self.base, robot=self.family.robot(values))

    def turns(self, tipping_field_T: Floats) -> NDArray[np.bool_]:
        """Return whether the field is strong enough to tip designs over.

        Parameters
        ----------
        tipping_field_T
            What each needs, T.
        """
        return np.asarray(tipping_field_T <= rotating(self.base.effective()).strength_T)

    def runs(self, draws: int) -> int:
        """Return how many runs it takes at most to describe one design.

        Parameters
        ----------
        draws
            Number of robots drawn.
        """
        return 1 + draws + len(_SLOPES_DEG) + bisections(_SLOPES_DEG, _RESOLUTION_DEG)

    def described(self, designs: Sequence[Sequence[float]], errors: Floats, native: Native) -> dict[str, list[float]]:
        """Return every quantity of some designs.

        Parameters
        ----------
        designs
            Their parameters.
        errors
            φ, θ1 and θ2 of the robots drawn, degrees, shape (draws, 3).
        native
            Runs the batches.
        """
        scenarios = [self.scenario(values) for values in designs]
        tipping = np.array([tipping_or_nan(scenario) for scenario in scenarios])
        ideal = native.outcomes(scenarios)
        slopes = limits(
            scenarios, native, slopes_deg=_SLOPES_DEG, resolution_deg=_RESOLUTION_DEG, settling_cycles=1, cycles=2
        )
        erring = native.outcomes([case for scenario in scenarios for case in with_errors(scenario, errors)])
        shape = (len(designs), len(errors))
        turns = self.turns(tipping[:, 1])
        climbing = [sum(ascent.unconverged_steps for ascent in tried.ascents) for tried in slopes]
        quantities = {
            "speed_m_per_s": ideal.speed_m_per_s,
            "drift_m": ideal.drift_m,
            "climb_deg": np.array([tried.limit[0] for tried in slopes]),
            "tipping_torque_N_m": tipping[:, 0],
            "tipping_field_T": tipping[:, 1],
            "nominal_merit_m_per_s": np.where(turns, merits(self.base, ideal, self.drift_cost), 0.0),
            "error_speed_m_per_s": erring.speed_m_per_s.reshape(shape).mean(axis=1),
            "error_drift_m": np.abs(erring.drift_m).reshape(shape).mean(axis=1),
            "upright_share": erring.upright.reshape(shape).mean(axis=1),
            "robust_merit_m_per_s": np.where(
                turns, merits(self.base, erring, self.drift_cost).reshape(shape).mean(axis=1), 0.0
            ),
            "unconverged_steps": ideal.unconverged_steps
            + erring.unconverged_steps.reshape(shape).sum(axis=1)
            + np.array(climbing),
        }
        return {name: np.asarray(quantities[name], dtype=np.float64).tolist() for name in QUANTITIES}

    def merit(self, unit: Floats, errors: Floats, native: Native) -> Floats:
        """Return the mean merit of designs over errors, m/s, 0 for those that the field cannot tip, shape (designs,).

        Parameters
        ----------
        unit
            Designs in the unit cube, shape (designs, parameters).
        errors
            φ, θ1 and θ2, degrees, shape (draws, 3).
        native
            Runs the batch.
        """
        scenarios = [self.scenario(self.family.values(place)) for place in unit]
        turns = self.turns(np.array([tipping_or_nan(scenario)[1] for scenario in scenarios]))
        return np.asarray(np.where(turns, mean_merits(scenarios, errors, native, self.drift_cost), 0.0))
