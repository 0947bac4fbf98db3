"""The objective of a fit, and what a descent knows of it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tumblers.dataset import Dataset, Outcome
from tumblers.diagnosis.fitting.descent import Descent
from tumblers.diagnosis.fitting.fitter import Fitter
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.loss import FAR, HUBER, huber, robust_cost
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.what.search import Search
from tumblers.effects.magnetization_strength import MagnetizationStrength
from tumblers.effects.stray_field_gradient import StrayFieldGradient

from .lab import PLANS, measure, plan, quiet, rollouts_made


def test_a_trial_that_no_model_can_follow_counts_by_its_logarithm() -> None:
    comparison = Comparison(measure(plan(), seed=2), Simulator(measure(plan(), seed=2)))
    fitter, residual = Fitter(comparison), comparison.residual(comparison.nominal_paths)
    count = comparison.sizes[0] - len(comparison.floors[0].outcome_scale)
    outcomes = comparison.alike * robust_cost(residual.trials[0][count:])
    for size, expected in ((1e-3, 1e-6 * count), (3.0, FAR * count * np.log1p(9.0 / FAR))):
        residual.trials[0][:count] = size
        assert fitter.trial_cost(residual, 0) - outcomes == pytest.approx(expected, rel=1e-5)
    assert comparison.weight(0, residual.trials[0]) == pytest.approx(1.0 / (1.0 + 9.0 / FAR))


def with_a_speed() -> Dataset:
    """Return a track with an outcome beside it."""
    dataset = measure(plan(PLANS[:1]), seed=2)
    speed = Outcome(mean_speed_m_per_s=6e-3, sigma_m_per_s=1e-3)
    return replace(dataset, trials=(replace(dataset.trials[0], outcome=speed),))


def test_an_outcome_counts_for_as_many_numbers_of_a_track_as_speak_for_one() -> None:
    comparison = Comparison(with_a_speed(), Simulator(with_a_speed()))
    fitter, residual = Fitter(comparison), comparison.residual(comparison.nominal_paths)
    assert comparison.alike > 2.0
    values = residual.trials[0]
    count = comparison.floors[0].tracked
    assert len(values) == count + 1
    before = fitter.trial_cost(residual, 0)
    values[count:] = np.sqrt(values[count:] ** 2 + 2.0)
    assert fitter.trial_cost(residual, 0) - before == pytest.approx(2.0 * comparison.alike, rel=1e-9)
    assert comparison.weighed[0] == pytest.approx(count + comparison.alike)
    assert fitter.weights(residual, [0])[-1] ** 2 == pytest.approx(comparison.alike)


def test_least_squares_see_the_loss_of_the_objective() -> None:
    comparison = Comparison(with_a_speed(), Simulator(with_a_speed()))
    fitter = Fitter(comparison)
    (hypothesis,) = Search(fitter, [MagnetizationStrength], quiet, 0).possible
    descent = Descent(fitter, hypothesis, np.array([0.05]), fitter.trials, 1.0)
    # Differences of a track and of an outcome on either side of Huber's limit, weighed as in the rows.
    count, alike = comparison.floors[0].tracked, comparison.alike
    weights = np.ones(len(descent.limits))
    weights[count] = np.sqrt(alike)
    size = np.geomspace(0.1, 30.0, len(weights))
    rows = size * weights
    value, slope, bend = descent.loss(rows**2)
    assert value == pytest.approx(huber(size) * weights**2, rel=1e-9)
    residual = comparison.residual(comparison.nominal_paths)
    for off in (1.0, 9.0):
        residual.trials[0][:] = np.append(np.zeros(count), off)
        squares = np.zeros(len(weights))
        squares[count] = alike * off**2
        assert descent.loss(squares)[0].sum() == pytest.approx(fitter.trial_cost(residual, 0), rel=1e-9)
    # Away from the limit, where the bend jumps.
    smooth = np.abs(size / HUBER - 1.0) > 2e-2
    h = 1e-5 * rows**2
    up, down = descent.loss(rows**2 + h), descent.loss(rows**2 - h)
    assert slope[smooth] == pytest.approx(((up[0] - down[0]) / (2.0 * h))[smooth], rel=1e-6)
    assert bend[smooth] == pytest.approx(((up[1] - down[1]) / (2.0 * h))[smooth], rel=1e-6, abs=1e-12)


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


def test_a_fit_from_the_truth_ends_no_worse_where_some_fields_are_at_rest() -> None:
    pull = StrayFieldGradient(gradient_T_per_m=(0.0, 0.0, 0.04))
    dataset = measure(plan(), (pull,), seed=4)
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    (hypothesis,) = Search(fitter, [StrayFieldGradient], quiet, 0).possible
    truth = (np.array(pull.to_fit(pull.vector())) - hypothesis.neutral) / hypothesis.scale
    found = fitter.fit(hypothesis, truth)
    assert found.cost <= fitter.cost(fitter.residuals(hypothesis, [truth])[0], truth)
    still = found.hypothesis.effects(found.point)[0].edit(fitter.comparison.simulator.nominal(4))
    assert still.surroundings.force_N[2] > 0.0
