"""The objective of a fit, and what a descent knows of it."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tumblers.diagnosis.comparison import Comparison
from tumblers.diagnosis.fit import Fitter
from tumblers.diagnosis.loss import FAR, robust_cost
from tumblers.diagnosis.search import Search
from tumblers.diagnosis.simulator import Simulator
from tumblers.effects.magnetization_strength import MagnetizationStrength

from .lab import PLANS, measure, plan, quiet, rollouts_made


def test_a_trial_that_no_model_can_follow_counts_by_its_logarithm() -> None:
    comparison = Comparison(measure(plan(), seed=2), Simulator(measure(plan(), seed=2)))
    fitter, residual = Fitter(comparison), comparison.residual(comparison.nominal_paths)
    count = comparison.sizes[0] - len(comparison.floors[0].outcome_scale)
    outcomes = robust_cost(residual.trials[0][count:])
    for size, expected in ((1e-3, 1e-6 * count), (3.0, FAR * count * np.log1p(9.0 / FAR))):
        residual.trials[0][:count] = size
        assert fitter.trial_cost(residual, 0) - outcomes == pytest.approx(expected, rel=1e-5)
    assert comparison.weight(0, residual.trials[0]) == pytest.approx(1.0 / (1.0 + 9.0 / FAR))


def test_a_descent_ends_where_the_fit_does_and_its_derivatives_serve_again(monkeypatch: pytest.MonkeyPatch) -> None:
    dataset = measure(plan(PLANS[:2]), (MagnetizationStrength(factor=0.9),))
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    (hypothesis,) = Search(fitter, [MagnetizationStrength], quiet, 0).possible
    start = np.array([0.1])
    fit = fitter.fit(hypothesis, start, evaluations=4)
    assert fitter.descend(hypothesis, start, evaluations=4) == (fit.cost, fit.point)
    # Against another noise the same paths do.
    fitter.comparison.take_noise_of(hypothesis.effects(fit.point))
    made = rollouts_made(monkeypatch)
    again = fitter.fit(hypothesis, fit.point, evaluations=1, steps=fit.steps)
    assert sum(made) == 0
    assert again.cost != fit.cost
    assert_allclose(again.steps, fit.steps)
