"""`step_credit`: what the shorter steps of a hypothesis take off the objective by themselves.

What moves fast is run in shorter steps than the nominal model. Where that is right but for its numerical error, the
smaller error of these steps would speak for the hypothesis: it is what they take off the nominal model's own objective,
each against the noise around it. Where the nominal model is wrong, its objective in one step or another says nothing of
a hypothesis that is not; then the steps are imposed on all before anything is concluded (`Search`).
"""

from __future__ import annotations

from ..effects.base import Effect
from .contender import of_nominal
from .fit import Fitter
from .predictive import is_right

__all__ = ["step_credit"]


def step_credit(fitter: Fitter, effects: tuple[Effect, ...]) -> float:
    """Return the credit of a hypothesis, at least 0; the noise of the moment stays.

    Parameters
    ----------
    fitter
        Of the dataset.
    effects
        The hypothesis.
    """
    comparison = fitter.comparison
    if comparison.simulator.resolves(effects):
        return 0.0
    key = tuple(comparison.simulator.steps_of(effects))
    if key not in comparison.step_credits:
        comparison.step_credits[key] = _measured(fitter, effects)
    return comparison.step_credits[key]


def _measured(fitter: Fitter, effects: tuple[Effect, ...]) -> float:
    comparison = fitter.comparison
    with comparison.kept():
        fitter.take_likeliest_noise(())
        before = of_nominal(fitter)
        if not is_right(comparison, before.residual):
            return 0.0
        comparison.take_steps_of(effects)
        fitter.take_likeliest_noise(())
        return max(before.total - of_nominal(fitter).total, 0.0)
