"""The points that are tried around a fit."""

from __future__ import annotations

import numpy as np

from tumblers.diagnosis.fit import Fit
from tumblers.diagnosis.hypothesis import Hypothesis
from tumblers.diagnosis.nearby import _points_around
from tumblers.effects.size_error import SizeError

from .lab import NOTHING, coarse_lab


def moves(fit: Fit) -> list[np.ndarray]:
    return [point - fit.point for point in _points_around(fit, 1.0, np.random.default_rng(0))]


def test_each_parameter_is_moved_alone_either_way_and_all_are_together() -> None:
    fitter = coarse_lab()
    hypothesis = Hypothesis.of(SizeError, [fitter.comparison.simulator.nominal(i) for i in fitter.trials])
    fit = Fit(hypothesis, np.array([0.1, -0.2]), NOTHING, 0.0, 10.0 * np.eye(2), np.full(2, 0.01))
    found = moves(fit)
    for j in range(2):
        alone = sorted(move[j] for move in found if move[j] != 0.0 and move[1 - j] == 0.0)
        np.testing.assert_allclose(alone, [-0.15, -0.05, 0.05, 0.15], atol=1e-12)
    assert sum(np.all(move != 0.0) for move in found) >= 10
    low, high = hypothesis.low, hypothesis.high
    assert all(np.all((low <= fit.point + move) & (fit.point + move <= high)) for move in found)


def test_what_is_held_is_not_moved() -> None:
    fitter = coarse_lab()
    hypothesis = Hypothesis.of(SizeError, [fitter.comparison.simulator.nominal(i) for i in fitter.trials])
    held = hypothesis.held(np.array([False, True]))
    fit = Fit(held, np.array([0.1, 0.0]), NOTHING, 0.0, 10.0 * np.eye(2), np.full(2, 0.01))
    assert all(move[1] == 0.0 for move in moves(fit))
