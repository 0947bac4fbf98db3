"""Intervals where the trials pull in different directions, or a fit stopped short of its best."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from numpy.testing import assert_allclose
from numpy.typing import NDArray

from tumblers.diagnosis import diagnose
from tumblers.diagnosis.fitting.descent import Descent
from tumblers.diagnosis.fitting.fitter import Fitter
from tumblers.diagnosis.fitting.hypothesis import PRIOR_SIGMA, Hypothesis
from tumblers.diagnosis.fitting.sandwich import MOST_FACTOR, Pulls, misfit_factors
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.what.estimate import _pressing
from tumblers.diagnosis.what.search import Search
from tumblers.effects.size_error import SizeError
from tumblers.effects.substrate_tilt import SubstrateTilt

from .lab import PLANS, measure, plan, quiet

Floats = NDArray[np.float64]
EVERY = np.zeros(2, dtype=np.bool_)


def pulls(tables: Sequence[Floats], values: Sequence[Floats], point: Floats | None = None) -> Pulls:
    """Return what trials say of `Σ|J_t u + r_t|² + |u|²` at a point, where it is least if None."""
    table, value = np.concatenate(tables), np.concatenate(values)
    information = table.T @ table + np.eye(table.shape[1])
    at = np.linalg.solve(information, -table.T @ value) if point is None else point
    by_trial = np.array([table.T @ table for table in tables])
    slopes = np.array([table.T @ (table @ at + value) for table, value in zip(tables, values, strict=True)])
    return Pulls(information, slopes.sum(axis=0) + at, by_trial, slopes)


def factor(tables: Sequence[Floats], values: Sequence[Floats], point: Floats | None = None) -> float:
    """Return the factor of the only coordinate."""
    (found,) = misfit_factors(pulls(tables, values, point), np.ones((1, 1)), EVERY[:1])
    return float(found)


@pytest.mark.parametrize(
    "shares", [(0.25, 0.25, 0.25, 0.25), (0.7, 0.1, 0.1, 0.1), (0.97, 0.01, 0.01, 0.01), (1.0, 0.0)]
)
def test_it_is_about_one_where_the_model_is_right_however_the_trials_share_what_is_known(
    shares: tuple[float, ...],
) -> None:
    tables, found, squares = [np.full((30, 1), np.sqrt(400.0 / 30.0 * share)) for share in shares], [], []
    for seed in range(1000):
        rng = np.random.default_rng(seed)
        known = pulls(tables, [rng.normal(size=30) - table[:, 0] * 0.9 for table in tables])
        found.append(misfit_factors(known, np.ones((1, 1)), EVERY[:1])[0])
        # The equation for one coordinate.
        a, rest = known.by_trial[:, 0, 0], 1.0 - known.by_trial[:, 0, 0] / known.information[0, 0]
        apart = known.slopes[:, 0] - a * known.slope[0] / known.information[0, 0]
        squares.append(float(np.sum((apart**2 / rest)[rest > 0.01]) / known.information[0, 0]))
        assert found[-1] == pytest.approx(np.clip(np.sqrt(squares[-1]), 1.0, MOST_FACTOR), rel=1e-6)
    # As it is at least one, and a sum of so few squares: of three with one on average the mean of what is more is 1.1.
    assert min(found) == 1.0
    assert np.mean(found) < 1.2
    # Of one trial that knows all nothing can be said, wherever its best is.
    informed = sum(share > 0.0 for share in shares) > 1
    assert np.mean(squares) == pytest.approx(1.0 if informed else 0.0, abs=0.1)


def test_trials_that_pull_in_different_directions_widen_it_by_what_they_differ() -> None:
    rng = np.random.default_rng(4)
    # Each of many trials has a truth of its own, twice as far from the others' as it is known by itself.
    tables = [rng.normal(size=(40, 1)) for _ in range(400)]
    values = [rng.normal(size=40) - table[:, 0] * rng.normal(scale=2.0 / np.sqrt(40.0)) for table in tables]
    assert factor(tables, values) == pytest.approx(np.sqrt(1.0 + 2.0**2), rel=0.1)


def test_a_fit_that_stopped_short_is_off_by_as_far_as_its_slope_leads() -> None:
    rng = np.random.default_rng(6)
    tables = [rng.normal(size=(30, 1)) for _ in range(200)]
    values = [rng.normal(size=30) for _ in tables]
    best = pulls(tables, values)
    deviation = 1.0 / np.sqrt(best.information[0, 0])
    at = np.linalg.solve(best.information, -np.concatenate(tables).T @ np.concatenate(values))
    for far in (0.0, 1.0, 3.0):
        # Of 200 trials the sum of squares is off by a tenth.
        assert factor(tables, values, at + far * deviation) == pytest.approx(np.sqrt(1.0 + far**2), rel=0.1)
    # No farther than that: nobody knows where it leads.
    assert factor(tables, values, at + 50.0 * deviation) == MOST_FACTOR


def test_it_does_not_depend_on_the_coordinates() -> None:
    rng = np.random.default_rng(7)
    tables = [rng.normal(size=(20, 2)) * (3.0, 1.0) for _ in range(5)]
    values = [2.0 * rng.normal(size=20) for _ in tables]
    known, gradients = pulls(tables, values, np.array([0.03, 0.1])), np.array([[1.0, 0.0], [0.5, -2.0]])
    # v = T u: slopes by T⁻ᵀ, gradients by T⁻¹.
    turn = np.array([[2.0, 0.7], [-0.4, 1.5]])
    back = np.linalg.inv(turn)
    other = Pulls(
        back.T @ known.information @ back, back.T @ known.slope, back.T @ known.by_trial @ back, known.slopes @ back
    )
    found = misfit_factors(known, gradients, EVERY)
    assert np.all((found > 1.05) & (found < MOST_FACTOR))
    assert_allclose(misfit_factors(other, gradients @ back, EVERY), found, rtol=1e-9)


def test_what_presses_on_an_end_of_its_range_says_nothing_of_the_others() -> None:
    rng = np.random.default_rng(8)
    tables = [rng.normal(size=(30, 2)) for _ in range(6)]
    values = [rng.normal(size=30) - 1.3 * table[:, 1] for table in tables]
    known = pulls(tables, values, np.array([0.0, 1.0]))
    pressing = np.array([False, True])
    first, second = misfit_factors(known, np.eye(2), pressing)
    assert 1.0 < first < MOST_FACTOR
    alone = pulls([t[:, :1] for t in tables], [v + t[:, 1] for t, v in zip(tables, values, strict=True)], np.zeros(1))
    assert first == pytest.approx(misfit_factors(alone, np.ones((1, 1)), EVERY[:1])[0])
    assert second == 1.0
    assert misfit_factors(known, np.eye(2), ~EVERY).tolist() == [1.0, 1.0]


def test_a_coordinate_presses_where_the_objective_falls_beyond_its_end() -> None:
    low, high = np.array([-1.0, -1.0, 0.0]), np.array([1.0, 1.0, 0.0])
    none = np.empty((0, 3))
    box = Hypothesis((), np.zeros(3), np.ones(3), low, high, none, none, np.column_stack([low, high]))
    hair = 1e-9
    assert _pressing(box, np.array([hair - 1.0, 1.0 - hair, 0.0]), np.array([1.0, -1.0, 0.0])).tolist() == [True] * 3
    assert _pressing(box, np.array([-1.0, 1.0, 0.0]), np.array([-1.0, 1.0, 0.0])).tolist() == [False, False, True]
    assert _pressing(box, np.array([-0.99, 0.99, 0.0]), np.array([1.0, -1.0, 0.0])).tolist() == [False, False, True]


def test_a_parameter_that_nothing_moves_is_no_wider() -> None:
    nothing = Pulls(np.eye(1), np.zeros(1), np.zeros((3, 1, 1)), np.zeros((3, 1)))
    assert misfit_factors(nothing, np.zeros((1, 1)), EVERY[:1]) == 1.0


def test_the_trials_pulls_are_those_of_the_objective() -> None:
    dataset = measure(plan(PLANS[:3]), (SubstrateTilt(slope_x_deg=2.0, slope_y_deg=1.0),), seed=5)
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    (hypothesis,) = Search(fitter, [SubstrateTilt], quiet, 0).possible
    point, step = np.array([0.12, 0.07]), 1e-3
    descent = Descent(fitter, hypothesis, point, fitter.trials, share=1.0, steps=np.full(2, step))
    fit = descent.fit(point)
    known = descent.pulls(fit, 4.0)
    assert known.slopes.shape == (3, 2)
    own = 4
    for j in range(2):
        here, there = fitter.residuals(hypothesis, [point, point + step * np.eye(2)[j]])
        for i in fitter.trials:
            local = slice(own * i, own * i + own)
            rise = fitter.trial_cost(there, i) - fitter.trial_cost(here, i)
            rise += float(np.sum(there.prior[local] ** 2) - np.sum(here.prior[local] ** 2))
            # The objective's rise has half a step's curvature more than the slope at the point.
            expected = 0.5 * rise / step - 0.5 * step * 4.0 * known.by_trial[i, j, j]
            assert 4.0 * known.slopes[i, j] == pytest.approx(expected, rel=1e-2)
        rise = fitter.cost(there, point + step * np.eye(2)[j]) - fit.cost
        expected = 0.5 * rise / step - 0.5 * step * 4.0 * known.information[j, j]
        assert 4.0 * known.slope[j] == pytest.approx(expected, rel=1e-2)
    # The trials' and what belongs to all alike are all of it.
    shared = fit.jacobian[len(fit.residual.over(fitter.trials)) + own * 3 :]
    rest = shared.T @ shared / 4.0 + np.eye(2) / PRIOR_SIGMA**2
    assert_allclose(known.by_trial.sum(axis=0) + rest, known.information, rtol=1e-9)


def test_an_interval_is_wider_by_its_factor(monkeypatch: pytest.MonkeyPatch) -> None:
    # Of a shape that is off no nominal number's tolerance decides.
    dataset = measure(plan(), (SizeError(length_factor=1.05),), seed=4)
    ends = []
    for factor in (1.0, 3.0):
        monkeypatch.setattr(
            "tumblers.diagnosis.what.estimate.misfit_factors",
            lambda _pulls, rows, _pressing, f=factor: np.full(len(rows), f),
        )
        (effect,) = diagnose(dataset, effects=["size_error"]).effects
        ends.append(effect.parameters["length_factor"])
    assert ends[0].estimate == ends[1].estimate
    narrow, wide = (end.high - end.low for end in ends)
    assert wide > 2.0 * narrow
