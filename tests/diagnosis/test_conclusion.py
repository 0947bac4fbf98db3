"""In what steps and against which noise the last contenders are held."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tumblers.diagnosis.comparison import Comparison
from tumblers.diagnosis.conclusion import concluded
from tumblers.diagnosis.contender import of_fit, of_nominal
from tumblers.diagnosis.fit import Fitter
from tumblers.diagnosis.own_noise import against_the_best, beside
from tumblers.diagnosis.search import Search
from tumblers.diagnosis.simulator import LONGEST_STEP_S, Simulator
from tumblers.diagnosis.thresholds import CLEAR
from tumblers.effects.friction_coefficient import FrictionCoefficient

from .lab import LYING, measure, plan, quiet, sliding_factor


def test_the_leader_is_held_in_a_step_that_is_short_enough_for_it() -> None:
    # Steps were chosen where the body still lay.
    dataset = measure(plan(LYING), (FrictionCoefficient(factor=0.5),))
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    search = Search(fitter, [FrictionCoefficient], quiet, 0)
    fitter.take_likeliest_noise(())
    nominal = of_nominal(fitter)
    (hypothesis,) = search.possible
    there = (np.array([0.5]) - hypothesis.neutral) / hypothesis.scale
    leader = of_fit(fitter, fitter.fit(hypothesis, there, evaluations=1))
    found, still = concluded(fitter, nominal, [leader], quiet)
    assert fitter.comparison.simulator.step_s[0] < LONGEST_STEP_S
    assert found.settled
    assert found.total == pytest.approx(beside(fitter, found, found).total, rel=1e-9)
    assert still.total == pytest.approx(beside(fitter, still, still).total, rel=1e-9)


def test_a_gap_is_not_hidden_by_the_noise_around_what_closes_it() -> None:
    # Where the body slides, small changes move it much: held against that noise, that it holds would look right.
    dataset = measure(plan(LYING, duration_s=0.28), (FrictionCoefficient(factor=sliding_factor()),))
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    search = Search(fitter, [FrictionCoefficient], quiet, 0)
    best, nominal = sorted(search.contenders(), key=lambda c: c.total)
    assert best.names == ("friction_coefficient",)
    assert beside(fitter, nominal, best).total < best.total + CLEAR
    assert nominal.total > best.total + 100.0
    assert nominal.total == beside(fitter, nominal, nominal).total


def test_what_says_the_same_as_the_best_is_held_against_its_noise() -> None:
    dataset = measure(plan(LYING, duration_s=0.28), (FrictionCoefficient(factor=sliding_factor()),))
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    search = Search(fitter, [FrictionCoefficient], quiet, 0)
    best = next(c for c in search.contenders() if c.names)
    wronged = replace(best, cost=best.cost + 50.0)
    _, _, held = against_the_best(fitter, of_nominal(fitter), [best, wronged])
    assert held.total == pytest.approx(best.total, abs=1.0)
