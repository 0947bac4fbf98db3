"""The points that are tried around a fit."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tumblers.diagnosis.fitting.fit import Fit
from tumblers.diagnosis.fitting.fitter import Fitter
from tumblers.diagnosis.fitting.hypothesis import Hypothesis
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.what import nearby
from tumblers.diagnosis.what.contender import Contender, of_fit
from tumblers.diagnosis.what.nearby import _moved_alone, _points_around, shaken
from tumblers.effects.base import Effect
from tumblers.effects.magnetization_strength import MagnetizationStrength
from tumblers.effects.size_error import SizeError
from tumblers.effects.stray_field_gradient import StrayFieldGradient

from .lab import NOTHING, coarse_lab, plan, quiet


def fit_at(kind: type[Effect], point: list[float], held: list[bool] | None = None) -> Fit:
    hypothesis = Hypothesis.of(kind, [Simulator(plan()).nominal(0)])
    if held is not None:
        hypothesis = hypothesis.held(np.array(held))
    count = len(point)
    return Fit(hypothesis, np.array(point), NOTHING, 0.0, 10.0 * np.eye(count), np.full(count, 0.01))


def test_each_parameter_is_moved_alone_either_way_within_its_range() -> None:
    fit = fit_at(SizeError, [0.1, 0.9])
    found = [point - fit.point for point in _moved_alone(fit)]
    assert sorted(move[0] for move in found if move[0]) == pytest.approx([-0.15, -0.05, 0.05, 0.15])
    # Beyond its range is at its end.
    assert sorted(move[1] for move in found if move[1]) == pytest.approx([-0.15, -0.05, 0.05, 0.1])
    assert all(np.sum(move != 0.0) == 1 for move in found)


def test_what_is_held_is_not_moved() -> None:
    fit = fit_at(SizeError, [0.1, 0.0], [False, True])
    assert [point[1] for point in _moved_alone(fit)] == [0.0] * 4
    assert all(point[1] == 0.0 for point in _points_around(fit, 1.0, np.random.default_rng(0)))


def test_what_is_tried_depends_on_the_seed_alone() -> None:
    fit = fit_at(SizeError, [0.1, 0.2])
    first, again, other = (_points_around(fit, 1.0, np.random.default_rng(seed)) for seed in (3, 3, 4))
    np.testing.assert_array_equal(first, again)
    assert not np.array_equal(first, other)


def test_a_move_that_changes_nothing_is_none() -> None:
    # An exponent rests near zero, and has no less.
    fit = fit_at(StrayFieldGradient, [0.3, 0.1, -0.2, 0.0])
    here = fit.hypothesis.values(fit.point)
    points = _moved_alone(fit)
    assert all(np.any(fit.hypothesis.values(point) != here) for point in points)
    assert sum(point[3] != 0.0 for point in points) == 1


def test_one_that_is_moved_alone_is_fitted_on_beside_the_best_of_all(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fitter = coarse_lab(SizeError(length_factor=1.05))
    hypothesis = Hypothesis.of(SizeError, [fitter.comparison.simulator.nominal(i) for i in fitter.trials])
    fitter.take_likeliest_noise(())
    fit = fitter.fit(hypothesis, np.array([0.2, 0.0]), evaluations=3)
    alone = {tuple(point) for point in _moved_alone(fit)}
    starts: list[tuple[float, ...]] = []
    descend = Fitter.descend

    def noted(self: Fitter, h: Hypothesis, start: np.ndarray, *args: object, **keys: object) -> object:
        starts.append(tuple(start))
        return descend(self, h, start, *args, **keys)

    monkeypatch.setattr(Fitter, "descend", noted)
    shaken(fitter, of_fit(fitter, fit), 0, quiet)
    first = starts[: nearby._FITS + 1]
    assert [start in alone for start in first] == [False, False, True]


def test_of_two_parameters_points_over_the_whole_range_are_tried_too(monkeypatch: pytest.MonkeyPatch) -> None:
    fitter = coarse_lab(SizeError(length_factor=1.05))
    scenarios = [fitter.comparison.simulator.nominal(i) for i in fitter.trials]
    tried: list[np.ndarray] = []

    def noted(_fitter: Fitter, hypothesis: Hypothesis, points: list[np.ndarray], count: int) -> list[tuple[float, Any]]:
        tried.append(np.array(points))
        return [(0.0, point) for point in points[:count]]

    monkeypatch.setattr(nearby, "least", noted)
    fitter.take_likeliest_noise(())
    for kind in (SizeError, MagnetizationStrength):
        hypothesis = Hypothesis.of(kind, scenarios)
        tried.clear()
        shaken(fitter, of_fit(fitter, fitter.fit(hypothesis, np.zeros(len(hypothesis.low)), evaluations=1)), 0, quiet)
        within = tried[0][nearby._POINTS :]
        if hypothesis.free == 1:
            assert len(within) == 0
            continue
        assert len(within) == nearby._WITHIN
        assert np.all((within >= hypothesis.low) & (within <= hypothesis.high))
        # In each quarter of the range of either one.
        quarters = np.floor(4.0 * (within - hypothesis.low) / (hypothesis.high - hypothesis.low))
        assert all(set(column) == {0.0, 1.0, 2.0, 3.0} for column in quarters.T)
        # The looks that follow are around what was found.
        assert all(len(points) <= nearby._POINTS for points in tried[1:])


@pytest.mark.parametrize(("margin", "looked"), [(1.25, ["a", "b"]), (12.0, ["a", "b", "d"])])
def test_the_margin_says_what_is_about_as_good(
    margin: float, looked: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    fitter = coarse_lab(SizeError(length_factor=1.05))
    ln = fitter.comparison.objective_of(1.0)
    # One that was not held against its own noise, and one too many.
    behind = {"a": 0.0, "b": 1.0, "c": 2.0, "d": 11.0, "e": 11.5, "f": 12.5}
    those = [Contender((name,), None, NOTHING, ln * by, settled=name != "c") for name, by in behind.items()]
    asked: list[str] = []

    def noted(_fitter: Fitter, contender: Contender, _seed: int, _tell: object) -> Contender:
        asked.extend(contender.names)
        return contender

    monkeypatch.setattr(nearby, "shaken", noted)
    assert nearby.all_shaken(fitter, those, 0, quiet, margin) == those
    assert asked == looked
