"""`step_credit`: what the shorter steps of a hypothesis take off the objective by themselves.

What moves fast is run in shorter steps than the nominal model. Where the nominal model is right in these, the smaller
numerical error would speak for the hypothesis: by as much as they take off the nominal model's own objective, in either
step against the noise around it. Where it is wrong in them, its objective in one step or another says nothing of a
hypothesis that is not wrong; whichever leads then imposes its steps on all others (`resolved`, `attribute`).
"""

from __future__ import annotations

from ...effects.base import Effect
from ..fitting.fitter import Fitter
from ..gap.comparison import Residual
from ..gap.predictive import is_right

__all__ = ["step_credit"]


def step_credit(fitter: Fitter, effects: tuple[Effect, ...]) -> float:
    """Return the credit of a hypothesis, at least 0; steps and noise are as before.

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

    def nominal() -> tuple[Residual, float]:
        fitter.take_likeliest_noise(())
        residual, cost = fitter.nominal()
        return residual, cost + comparison.log_determinant

    with comparison.restored():
        _, before = nominal()
        comparison.take_steps_of(effects)
        residual, after = nominal()
        right = is_right(comparison, residual)
    return max(before - after, 0.0) if right else 0.0
