"""How much nearer the model with the effects comes to what was measured."""

from __future__ import annotations

from dataclasses import replace
from math import log

import numpy as np
import pytest

from tumblers.diagnosis.fitting.fitter import Fitter
from tumblers.diagnosis.fitting.hypothesis import Hypothesis
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.how_far.followed import LEAST_FOLLOWED, _left, followed
from tumblers.diagnosis.what.own_noise import settled_at
from tumblers.diagnosis.wording.words import headline
from tumblers.effects.magnetization_strength import MagnetizationStrength

from .example import made
from .lab import PLANS, measure, plan


def fitter_of(factor: float) -> Fitter:
    dataset = measure(plan(PLANS[:3]), (MagnetizationStrength(factor=factor),))
    return Fitter(Comparison(dataset, Simulator(dataset)))


def hypothesis_of(fitter: Fitter) -> Hypothesis:
    return Hypothesis.of(MagnetizationStrength, [fitter.comparison.simulator.nominal(i) for i in fitter.trials])


def test_the_right_effect_is_followed_and_one_that_does_nothing_is_not() -> None:
    fitter = fitter_of(0.7)
    hypothesis = hypothesis_of(fitter)
    there = (np.array(MagnetizationStrength(factor=0.7).to_fit([0.7])) - hypothesis.neutral) / hypothesis.scale
    right, nothing = settled_at(fitter, hypothesis, there), settled_at(fitter, hypothesis, 0.0 * there)
    floors, steps = fitter.comparison.floors, list(fitter.comparison.simulator.step_s)
    assert followed(fitter, right) > 0.9
    assert followed(fitter, nothing) == pytest.approx(0.0, abs=1e-12)
    assert followed(fitter, settled_at(fitter, hypothesis, -there)) < LEAST_FOLLOWED
    assert fitter.comparison.simulator.step_s == steps
    assert len(fitter.comparison.floors) == len(floors)


def test_noise_that_is_wide_around_an_effect_is_not_followed() -> None:
    fitter = fitter_of(0.7)
    hypothesis = hypothesis_of(fitter)
    nothing = settled_at(fitter, hypothesis, np.zeros(1))
    vague = replace(nothing.residual, trials=tuple(0.01 * values for values in nothing.residual.trials))
    assert followed(fitter, replace(nothing, residual=vague)) == pytest.approx(0.0, abs=1e-12)


def test_what_is_within_the_sensor_s_noise_leaves_nothing_and_a_trial_counts_by_the_logarithm() -> None:
    dataset = measure(plan(PLANS[:2]))
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    residual = fitter.comparison.residual(fitter.comparison.nominal_paths)
    for values, size in zip(residual.trials, (0.5, 3.0), strict=True):
        values[:] = size
    assert _left(fitter, residual) == pytest.approx(fitter.comparison.sizes[1] * log(9.0))


def test_the_headline_says_that_what_would_close_the_gap_follows_nothing() -> None:
    gap = replace(made().gap, followed=0.01)
    ranking = (replace(made().ranking[0], gap=1.0), *made().ranking[1:])
    said = headline(made(verdict="unexplained", gap=gap, ranking=ranking))
    assert "the robot could do almost anything then" in said
    partial = (replace(ranking[0], gap=7.0), *ranking[1:])
    assert "follows the measured one no better" in headline(made(verdict="unexplained", gap=gap, ranking=partial))
    assert "no better" not in headline(made(verdict="unexplained", gap=replace(gap, followed=0.9), ranking=ranking))
