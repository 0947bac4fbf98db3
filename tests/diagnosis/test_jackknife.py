"""Intervals of trials that pull in different directions."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from numpy.testing import assert_allclose
from numpy.typing import NDArray

from tumblers.diagnosis.comparison import Comparison
from tumblers.diagnosis.descent import Descent
from tumblers.diagnosis.fitter import Fitter
from tumblers.diagnosis.hypothesis import PRIOR_SIGMA
from tumblers.diagnosis.jackknife import widened
from tumblers.diagnosis.search import Search
from tumblers.diagnosis.simulator import Simulator
from tumblers.effects.substrate_tilt import SubstrateTilt

from .lab import PLANS, measure, plan, quiet

Floats = NDArray[np.float64]
NUMBERS = 30


def fitted(tables: Sequence[Floats], values: Sequence[Floats]) -> Floats:
    """Return where `Σ|J_t u + r_t|² + |u|²` is least."""
    table, value = np.concatenate(tables), np.concatenate(values)
    return np.linalg.solve(table.T @ table + np.eye(table.shape[1]), -table.T @ value)


def factors(tables: Sequence[Floats], values: Sequence[Floats], gradients: Floats) -> Floats:
    by_trial = np.array([table.T @ table for table in tables])
    best = fitted(tables, values)
    slopes = np.array([table.T @ (table @ best + value) for table, value in zip(tables, values, strict=True)])
    return widened(by_trial.sum(axis=0) + np.eye(len(best)), by_trial, slopes, gradients)


def test_it_is_what_fits_to_all_trials_but_one_say() -> None:
    rng = np.random.default_rng(4)
    tables = [rng.normal(size=(NUMBERS, 2)) for _ in range(6)]
    # Each trial has a truth of its own.
    values = [rng.normal(size=NUMBERS) - table @ rng.normal(scale=0.3, size=2) for table in tables]
    gradients = np.array([[1.0, 0.0], [2.0, -1.0]])
    best = fitted(tables, values)
    rest = range(len(tables))
    moves = [fitted(*([those[i] for i in rest if i != t] for those in (tables, values))) - best for t in rest]
    table = np.concatenate(tables)
    covariance = np.linalg.inv(table.T @ table + np.eye(2))
    spread = 5.0 / 6.0 * np.sum((np.array(moves) @ gradients.T) ** 2, axis=0)
    expected = np.sqrt(spread / np.diag(gradients @ covariance @ gradients.T))
    assert np.all((expected > 1.5) & (expected < 4.0))
    assert_allclose(factors(tables, values, gradients), expected, rtol=1e-9)


def test_it_is_about_one_where_the_trials_agree_and_never_less() -> None:
    found = []
    for seed in range(300):
        rng = np.random.default_rng(seed)
        tables = [rng.normal(size=(NUMBERS, 1)) for _ in range(10)]
        found.append(factors(tables, [rng.normal(size=NUMBERS) for _ in tables], np.ones((1, 1)))[0])
    assert min(found) == 1.0
    # Of ten numbers that are one on average a deviation is off by a quarter or so.
    assert 1.0 < np.mean(found) < 1.25
    assert max(found) < 2.5


@pytest.mark.parametrize("scale", [1.0, 1e6])
def test_one_trial_that_alone_speaks_of_a_parameter_widens_it_by_so_much_at_most(scale: float) -> None:
    tables = [np.full((NUMBERS, 1), 100.0), *[np.zeros((NUMBERS, 1))] * 4]
    information = np.array([table.T @ table for table in tables])
    slopes = np.zeros((5, 1))
    # Least squares stopped on the way.
    slopes[0] = scale * 50.0
    assert widened(information.sum(axis=0) + 1.0, information, slopes, np.ones((1, 1))) == 4.0
    # At its best it says nothing of how well it is known, nor does a single trial.
    assert widened(information.sum(axis=0) + 1.0, information, 0.0 * slopes, np.ones((1, 1))) == 1.0
    assert widened(information[0] + 1.0, information[:1], slopes[:1], np.ones((1, 1))) == 1.0


def test_a_parameter_that_nothing_moves_is_no_wider() -> None:
    nothing = np.zeros((3, 1, 1))
    assert widened(np.eye(1), nothing, np.zeros((3, 1)), np.zeros((1, 1))) == 1.0


def test_the_trials_slopes_are_those_of_the_objective() -> None:
    dataset = measure(plan(PLANS[:3]), (SubstrateTilt(slope_x_deg=2.0, slope_y_deg=1.0),), seed=5)
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    (hypothesis,) = Search(fitter, [SubstrateTilt], quiet, 0).possible
    point = np.array([0.12, 0.07])
    # Derivatives by steps as small as those of the check.
    descent = Descent(fitter, hypothesis, point, fitter.trials, share=1.0, steps=np.full(2, 1e-3))
    fit = descent.fit(point)
    information, slopes = descent.by_trial(fit)
    assert slopes.shape == (3, 2)
    step = 1e-3
    for j in range(2):
        moved = point + step * np.eye(2)[j]
        there = fitter.residuals(hypothesis, [point, moved])
        for i in fitter.trials:
            rise = fitter.trial_cost(there[1], i) - fitter.trial_cost(there[0], i)
            # The objective's rise has half a step's curvature more than the slope at the point.
            bend = step * information[i, j, j]
            assert 0.5 * rise / step == pytest.approx(slopes[i, j] + 0.5 * bend, rel=2e-2, abs=0.5 * bend + 1e-6)
    # The prior and the nuisances have their own.
    own = fit.information(1.0) - np.eye(2) / PRIOR_SIGMA**2 - information.sum(axis=0)
    assert np.all(np.linalg.eigvalsh(own) > -1e-6 * np.linalg.eigvalsh(information.sum(axis=0)).max())
