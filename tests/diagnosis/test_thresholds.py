"""Thresholds of one trial, from which a fit starts."""

from __future__ import annotations

import numpy as np
import pytest

from tumblers.diagnosis.fitting.fitter import Fitter
from tumblers.diagnosis.fitting.hypothesis import Hypothesis
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.what.contender import of_nominal
from tumblers.diagnosis.what.margins import CLEAR
from tumblers.diagnosis.what.search import Search
from tumblers.diagnosis.what.thresholds import beyond_thresholds
from tumblers.effects.friction_coefficient import FrictionCoefficient
from tumblers.presets import drive

from .lab import LYING, OFF, PLANS, measure, plan, quiet, sliding_factor


@pytest.mark.parametrize("slope_deg", [50.0, 60.0])
def test_a_threshold_in_a_range_is_found_far_from_neutral_and_near(slope_deg: float) -> None:
    # Friction just low enough to slide: of no use is a derivative where nothing moves, nor a start far beyond.
    lying = (("lying", OFF, slope_deg),)
    truth = FrictionCoefficient(factor=sliding_factor(slope_deg))
    dataset = measure(plan(lying), (truth,))
    comparison = Comparison(dataset, Simulator(dataset))
    fitter = Fitter(comparison)
    search = Search(fitter, [FrictionCoefficient], quiet, 0)
    nominal = of_nominal(fitter)
    best = min(search.contenders(), key=lambda c: c.cost)
    assert nominal.cost > 100.0
    assert best.names == ("friction_coefficient",)
    (found,) = best.effects
    assert isinstance(found, FrictionCoefficient)
    assert found.factor == pytest.approx(truth.factor, rel=0.01)


def test_a_threshold_of_one_trial_is_found_beside_others_whose_cameras_are_off() -> None:
    # The others' nuisances are at their ends, and what that costs is none of this trial's.
    truth = FrictionCoefficient(factor=sliding_factor())
    dataset = measure(plan([*LYING, *PLANS[:3]]), (truth,), origin_m=2e-4, clock_frames=0.6)
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    nominal = of_nominal(fitter).residual
    assert float(np.sum(nominal.prior**2)) > fitter.comparison.objective_of(CLEAR)
    hypothesis = Hypothesis.of(FrictionCoefficient, [fitter.comparison.simulator.nominal(i) for i in fitter.trials])
    first, *_ = beyond_thresholds(fitter, hypothesis, nominal)
    (found,) = hypothesis.effects(first)
    assert isinstance(found, FrictionCoefficient)
    assert found.factor == pytest.approx(truth.factor, rel=0.01)


def test_a_climb_that_was_noted_and_is_missed_is_enough_for_a_threshold() -> None:
    # Of outcomes alone each counts for itself: what is a trifle for a track of many numbers decides here.
    # All of them are planned to climb.
    dataset = plan([(f"s{slope:g}", drive(0.020, 2.0), slope) for slope in (20.0, 45.0)], duration_s=1.0)
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    assert fitter.comparison.alike == 1.0
    nominal = of_nominal(fitter)
    hypothesis = Hypothesis.of(FrictionCoefficient, [fitter.comparison.simulator.nominal(i) for i in fitter.trials])
    first, *_ = beyond_thresholds(fitter, hypothesis, nominal.residual)
    assert nominal.cost > 9.0
    assert fitter.cost(fitter.residuals(hypothesis, [first])[0], first) < 1.0
