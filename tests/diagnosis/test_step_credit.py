"""Steps that a hypothesis asks for, and what they must not be credited with."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tumblers.diagnosis.fitting.hypothesis import Hypothesis
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.job import Job
from tumblers.diagnosis.gap.simulator import LONGEST_STEP_S, Simulator
from tumblers.diagnosis.what.contender import of_nominal
from tumblers.diagnosis.what.last_fits import in_steps_of
from tumblers.diagnosis.what.own_noise import against_itself
from tumblers.diagnosis.what.search import Search
from tumblers.diagnosis.what.step_credit import step_credit
from tumblers.effects.contact_compliance import ContactCompliance
from tumblers.effects.friction_coefficient import FrictionCoefficient
from tumblers.effects.size_error import SizeError

from .lab import LYING, coarse_lab, measure, plan, quiet


def test_an_effect_that_makes_motion_fast_is_simulated_in_a_step_that_resolves_it() -> None:
    simulator = Simulator(plan())
    assert simulator.step_s[0] == LONGEST_STEP_S
    soft = simulator.scenario(Job(0, (ContactCompliance(compliance_m_per_N=2.0),)))
    assert soft.run.step_s <= ContactCompliance.longest_step_s * (1.0 + 1e-9)
    # Neutral is the nominal model, bit for bit, so in its step too.
    neutral = simulator.scenario(Job(0, (ContactCompliance(),)))
    assert neutral == simulator.nominal(0)


def test_steps_are_halved_where_a_hypothesis_asks_for_it() -> None:
    dataset = measure(plan(LYING))
    comparison = Comparison(dataset, Simulator(dataset))
    assert comparison.simulator.step_s == [LONGEST_STEP_S], "a body that lies still is the same in any step"
    before = comparison.nominal_paths[0]
    assert comparison.halve_steps_for((FrictionCoefficient(factor=0.5),))
    assert comparison.simulator.step_s[0] < LONGEST_STEP_S, "a body that slides is not"
    after = comparison.nominal_paths[0]
    assert before is not None
    assert after is not None
    assert_allclose(before.position_m[-1], after.position_m[-1], atol=1e-9)


def test_what_asks_for_a_shorter_step_gets_no_credit_for_it() -> None:
    # So little compliance moves nothing; against the error of a longer step around the nominal model it would lead.
    fitter = coarse_lab()
    comparison = fitter.comparison
    hypothesis = Hypothesis.of(ContactCompliance, [comparison.simulator.nominal(i) for i in fitter.trials])
    little = (np.array(ContactCompliance.to_fit([1e-6])) - hypothesis.neutral) / hypothesis.scale
    fitter.take_likeliest_noise(())
    nominal, floors = of_nominal(fitter), comparison.floors
    # About 375: what so many numbers of three trials gain by a quarter of the step.
    assert step_credit(fitter, hypothesis.effects(little)) > 100.0
    assert comparison.floors is floors, "what the credit was measured in is not left behind"
    assert of_nominal(fitter).total == nominal.total
    assert set(comparison.simulator.step_s) == {LONGEST_STEP_S}
    held = against_itself(fitter, fitter.fit(hypothesis, little, evaluations=1))
    assert nominal.total - (held.cost + held.log_determinant) > 100.0
    assert abs(nominal.total - held.total) < 1.0
    # In the same step there is none to give.
    assert comparison.halve_steps_for(hypothesis.effects(little))
    again = against_itself(fitter, fitter.fit(hypothesis, little, evaluations=1))
    assert again.step_credit == 0.0
    assert abs(of_nominal(fitter).cost - again.cost) < 1.0


def test_a_model_that_is_wrong_in_any_step_gives_no_credit() -> None:
    # Shorter steps would take 81 off its objective.
    fitter = coarse_lab(SizeError(length_factor=1.03))
    little = (ContactCompliance(compliance_m_per_N=1e-6),)
    assert not fitter.comparison.simulator.resolves(little)
    assert step_credit(fitter, little) == 0.0


@pytest.mark.parametrize("compliance_m_per_N", [0.0, 0.3])
def test_a_shorter_step_is_imposed_only_for_what_leads_without_its_credit(compliance_m_per_N: float) -> None:
    fitter = coarse_lab(ContactCompliance(compliance_m_per_N=compliance_m_per_N))
    search = Search(fitter, [ContactCompliance], quiet, 0)
    contenders = search.contenders()
    simulator, best = fitter.comparison.simulator, min(contenders, key=lambda c: c.total)
    if compliance_m_per_N:
        assert best.names == ("contact_compliance",)
    else:
        assert set(simulator.step_s) == {LONGEST_STEP_S}
        # What leads by evidence all the same is held in its steps, and the nominal model with it.
        (leader,) = (c for c in contenders if c.names)
        again = in_steps_of(fitter, leader, contenders, 0, quiet)
        assert {c.step_credit for c in again} == {0.0}
        assert max(simulator.step_s) <= ContactCompliance.longest_step_s * (1.0 + 1e-9)
    assert simulator.resolves(best.effects)


def test_longer_steps_are_taken_for_a_while_and_leave_nothing_behind() -> None:
    fitter = coarse_lab()
    comparison, simulator = fitter.comparison, fitter.comparison.simulator
    simulator.step_s = [LONGEST_STEP_S, 0.5 * LONGEST_STEP_S, 0.25 * LONGEST_STEP_S]
    comparison._start()
    compliant = (ContactCompliance(compliance_m_per_N=1e-6),)

    def seen() -> tuple[float, ...]:
        fitter.take_likeliest_noise(())
        nominal, credit = of_nominal(fitter), step_credit(fitter, compliant)
        fitter.take_likeliest_noise(compliant)
        return nominal.total, credit, of_nominal(fitter).total

    before, steps, paths, floors = seen(), list(simulator.step_s), comparison.nominal_paths, comparison.floors
    assert before[1] > 10.0, "what the credit is in the longer steps must not stay"

    def interrupted() -> None:
        with comparison.in_longer_steps():
            assert simulator.step_s == [LONGEST_STEP_S, LONGEST_STEP_S, 0.5 * LONGEST_STEP_S]
            assert comparison.log_determinant == 0.0, "the nominal model's noise is that of the longer steps"
            assert comparison.floors[2].numerical_sigmas > floors[2].numerical_sigmas
            assert seen()[1] != before[1]
            # What it is not run in is too long for it; what only shows is not.
            assert not comparison.halve_steps_for((FrictionCoefficient(factor=0.5),))
            assert comparison.halve_steps_for(compliant)
            assert simulator.resolves(compliant)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert simulator.step_s == steps
    assert comparison.nominal_paths is paths
    assert comparison.floors is floors
    assert seen() == before
