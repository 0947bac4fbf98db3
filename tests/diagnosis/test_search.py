"""What a search rests on: coordinates of a fit, the objective, steps that a hypothesis asks for, thresholds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tumblers.diagnosis.beginnings import MANY, from_beginnings, from_its_own_beginning, promise
from tumblers.diagnosis.comparison import Comparison, Residual
from tumblers.diagnosis.conclusion import concluded, in_steps_of
from tumblers.diagnosis.contender import Contender, of_fit, of_nominal
from tumblers.diagnosis.fit import Fitter
from tumblers.diagnosis.hypothesis import Hypothesis
from tumblers.diagnosis.loss import FAR, robust_cost
from tumblers.diagnosis.own_noise import NEAR, against_itself, against_the_best, beside, settled_at
from tumblers.diagnosis.pairs import Pairs, firsts
from tumblers.diagnosis.search import Search, _kept
from tumblers.diagnosis.simulator import LONGEST_STEP_S, Job, Simulator
from tumblers.diagnosis.step_credit import step_credit
from tumblers.diagnosis.thresholds import CLEAR, beyond_thresholds
from tumblers.effects.base import Effect
from tumblers.effects.catalogue import CATALOGUE
from tumblers.effects.contact_compliance import ContactCompliance
from tumblers.effects.friction_coefficient import FrictionCoefficient
from tumblers.effects.magnetization_misalignment import MagnetizationMisalignment
from tumblers.effects.magnetization_strength import MagnetizationStrength
from tumblers.effects.size_error import SizeError
from tumblers.effects.surface_roughness import SurfaceRoughness
from tumblers.field import StaticField

from .lab import PLANS, measure, plan, rollouts_made

OFF = StaticField(strength_T=0.0, direction=(0.0, 1.0, 0.0))
# A robot that lies on a slope: it slides where friction is a quarter below the nominal one.
LYING = (("lying", OFF, 50.0),)

MANY_KINDS = (
    "size_error",
    "magnetization_misalignment",
    "magnetization_strength",
    "friction_coefficient",
    "substrate_tilt",
    "viscous_drag",
)


def quiet(_phase: str, _done: int, _total: int) -> None:
    """Tell nobody."""


@pytest.mark.parametrize("name", CATALOGUE)
def test_the_coordinates_of_a_fit_are_the_parameters_again(name: str) -> None:
    kind = CATALOGUE[name]
    scenario = Simulator(plan()).nominal(0)
    for start in kind.starts(scenario):
        assert_allclose(kind.from_fit(kind.to_fit(start)), start, rtol=1e-12, atol=1e-12)


def test_a_misalignment_is_smooth_around_neutral_and_has_no_end_at_half_a_turn() -> None:
    hypothesis = Hypothesis.of(MagnetizationMisalignment, [Simulator(plan()).nominal(0)])
    assert_allclose(hypothesis.values([0.0, 0.0])[0], 0.0)
    before, after = hypothesis.values([-0.2, 1e-6]), hypothesis.values([-0.2, -1e-6])
    assert_allclose(before[0], after[0], rtol=1e-6)
    assert_allclose(before[1] - after[1], 360.0, rtol=1e-4)
    axes = [effect.edit(Simulator(plan()).nominal(0)).robot.magnetic_axis for effect in _both(hypothesis)]
    assert_allclose(axes[0], axes[1], atol=1e-6)


def _both(hypothesis: Hypothesis) -> list[Effect]:
    return [hypothesis.effects(point)[0] for point in ([-0.2, 1e-6], [-0.2, -1e-6])]


def test_a_trial_that_no_model_can_follow_counts_by_its_logarithm() -> None:
    comparison = Comparison(measure(plan(), seed=2), Simulator(measure(plan(), seed=2)))
    fitter, residual = Fitter(comparison), comparison.residual(comparison.nominal_paths)
    count = comparison.sizes[0] - len(comparison.floors[0].outcome_scale)
    outcomes = robust_cost(residual.trials[0][count:])
    for size, expected in ((1e-3, 1e-6 * count), (3.0, FAR * count * np.log1p(9.0 / FAR))):
        residual.trials[0][:count] = size
        assert fitter.trial_cost(residual, 0) - outcomes == pytest.approx(expected, rel=1e-5)
    assert comparison.weight(0, residual.trials[0]) == pytest.approx(1.0 / (1.0 + 9.0 / FAR))


@pytest.mark.parametrize("log_determinant", [0.0, -900.0])
def test_the_best_is_always_a_first_and_what_is_far_behind_is_not(log_determinant: float) -> None:
    dataset = measure(plan(LYING))
    nominal = of_nominal(Fitter(Comparison(dataset, Simulator(dataset))))
    costs = (400.0, 580.0, 620.0)
    contenders = [replace(nominal, cost=cost, log_determinant=log_determinant) for cost in costs]
    assert [contender.cost for contender in firsts(contenders)] == [400.0, 580.0]


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


def _coarse_lab(*truth: Effect) -> Fitter:
    """Return what was measured in a fine step, before a nominal model in a step that nothing asked to be shorter."""
    dataset = measure(plan(PLANS[:3]), truth, divisor=16)
    comparison = Comparison(dataset, Simulator(dataset))
    comparison.simulator.step_s = [LONGEST_STEP_S] * len(dataset.trials)
    comparison._start()
    return Fitter(comparison)


def test_what_asks_for_a_shorter_step_gets_no_credit_for_it() -> None:
    # So little compliance moves nothing; against the error of a longer step around the nominal model it would lead.
    fitter = _coarse_lab()
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


@pytest.mark.parametrize("compliance_m_per_N", [0.0, 0.3])
def test_a_shorter_step_is_imposed_only_for_what_leads_without_its_credit(compliance_m_per_N: float) -> None:
    fitter = _coarse_lab(ContactCompliance(compliance_m_per_N=compliance_m_per_N))
    search = Search(fitter, [ContactCompliance], quiet, 0)
    contenders = search.contenders()
    simulator, best = fitter.comparison.simulator, min(contenders, key=lambda c: c.total)
    if compliance_m_per_N:
        assert best.names == ("contact_compliance",)
    else:
        assert set(simulator.step_s) == {LONGEST_STEP_S}
        # What leads by evidence all the same is held in its steps, and the nominal model with it.
        (leader,) = (c for c in contenders if c.names)
        again = in_steps_of(fitter, leader, contenders, quiet)
        assert {c.step_credit for c in again} == {0.0}
        assert max(simulator.step_s) <= ContactCompliance.longest_step_s * (1.0 + 1e-9)
    assert simulator.resolves(best.effects)


def test_longer_steps_are_taken_for_a_while_and_leave_nothing_behind() -> None:
    fitter = _coarse_lab()
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


def test_what_longer_steps_found_counts_by_what_it_is_in_the_right_ones(monkeypatch: pytest.MonkeyPatch) -> None:
    fitter = _coarse_lab(SizeError(length_factor=1.1))
    comparison = fitter.comparison
    comparison.simulator.step_s = [0.5 * LONGEST_STEP_S] * 3
    comparison._start()
    search = Search(fitter, [CATALOGUE[name] for name in MANY_KINDS], quiet, 0)
    flattered: list[Contender] = []

    def found(nominal: Contender) -> list[Contender]:
        assert comparison.simulator.step_s == [LONGEST_STEP_S] * 3
        first, *others = search._singles(nominal)
        assert first.names == ("size_error",)
        # The last one's objective is what no error of a step could make it.
        flattered.append(replace(others[-1], cost=-1e9))
        return [*flattered, first, *others[:-1]]

    monkeypatch.setattr(search, "_far_and_wide", found)
    made = search.contenders()
    assert max(comparison.simulator.step_s) <= 0.5 * LONGEST_STEP_S
    assert len(made) == 1 + len(search.possible)
    best = min(made, key=lambda contender: contender.total)
    assert best.names == ("size_error",)
    assert best.settled
    assert best.total == pytest.approx(beside(fitter, best, best).total, rel=1e-9)
    (again,) = (contender for contender in made if contender.names == flattered[0].names)
    assert again.total > best.total + NEAR


def test_what_was_settled_does_not_give_way_to_what_was_not() -> None:
    fitter = _coarse_lab(SizeError(length_factor=1.1))
    fitter.take_likeliest_noise(())
    made = of_nominal(fitter)
    old, new, better = replace(made, settled=True), replace(made, cost=-9.0), replace(made, cost=-9.0, settled=True)
    for contender, kept in ((new, old), (better, better)):
        assert _kept([contender], [old]) == [kept]
    assert _kept([new], [replace(old, settled=False)]) == [new]


def test_a_model_that_is_wrong_in_any_step_gives_no_credit() -> None:
    # Shorter steps would take 81 off its objective.
    fitter = _coarse_lab(SizeError(length_factor=1.03))
    little = (ContactCompliance(compliance_m_per_N=1e-6),)
    assert not fitter.comparison.simulator.resolves(little)
    assert step_credit(fitter, little) == 0.0


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


@pytest.mark.parametrize("slope_deg", [50.0, 60.0])
def test_a_threshold_in_a_range_is_found_far_from_neutral_and_near(slope_deg: float) -> None:
    # Friction just low enough to slide: of no use is a derivative where nothing moves, nor a start far beyond.
    lying = (("lying", OFF, slope_deg),)
    truth = FrictionCoefficient(factor=_sliding_factor(slope_deg))
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
    truth = FrictionCoefficient(factor=_sliding_factor())
    dataset = measure(plan([*LYING, *PLANS[:3]]), (truth,), origin_m=2e-4, clock_frames=0.6)
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    nominal = of_nominal(fitter).residual
    assert float(np.sum(nominal.prior**2)) > CLEAR
    hypothesis = Hypothesis.of(FrictionCoefficient, [fitter.comparison.simulator.nominal(i) for i in fitter.trials])
    first, *_ = beyond_thresholds(fitter, hypothesis, nominal)
    (found,) = hypothesis.effects(first)
    assert isinstance(found, FrictionCoefficient)
    assert found.factor == pytest.approx(truth.factor, rel=0.01)


def test_a_first_of_a_pair_is_held_against_its_own_noise(monkeypatch: pytest.MonkeyPatch) -> None:
    fitter = _coarse_lab(SizeError(length_factor=1.03))
    fitter.take_likeliest_noise(())
    possible = [
        Hypothesis.of(kind, [fitter.comparison.simulator.nominal(i) for i in fitter.trials])
        for kind in (SizeError, FrictionCoefficient)
    ]
    singles = [
        of_fit(fitter, fitter.fit(h, np.full(len(h.neutral), 0.01 * k), evaluations=1))
        for k, h in enumerate(possible, 1)
    ]
    seen: list[Any] = []
    scan = Fitter.scan

    def noted(self: Fitter, hypotheses: Any, base: Any, still: Residual, slopes: Any) -> Any:
        seen.append((still, self.again(replace(singles[0].fit, point=base[0][: len(possible[0].neutral)])).residual))
        return scan(self, hypotheses, base, still, slopes)

    monkeypatch.setattr(Fitter, "scan", noted)
    Pairs(fitter, possible, {}).add(singles[0], singles)
    ((still, own),) = seen
    for found, expected in zip(still.trials, own.trials, strict=True):
        assert_allclose(found, expected, rtol=1e-9, atol=1e-9)
    assert not np.allclose(still.over(fitter.trials), singles[0].residual.over(fitter.trials), rtol=1e-6)


def _sliding_factor(slope_deg: float = 50.0) -> float:
    """Return a factor of friction with which the body slides by about half its length."""
    simulator = Simulator(plan((("lying", OFF, slope_deg),)))
    low, high = 0.3, 1.0
    for _ in range(20):
        middle = 0.5 * (low + high)
        path = simulator.run([Job(0, (FrictionCoefficient(factor=middle),))])[0]
        assert path is not None
        low, high = (middle, high) if path.position_m[-1, 1] < -4e-4 else (low, middle)
    return low


def test_a_gap_is_not_hidden_by_the_noise_around_what_closes_it() -> None:
    # Where the body slides, small changes move it much: held against that noise, that it holds would look right.
    dataset = measure(plan(LYING, duration_s=0.28), (FrictionCoefficient(factor=_sliding_factor()),))
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    search = Search(fitter, [FrictionCoefficient], quiet, 0)
    best, nominal = sorted(search.contenders(), key=lambda c: c.total)
    assert best.names == ("friction_coefficient",)
    assert beside(fitter, nominal, best).total < best.total + CLEAR
    assert nominal.total > best.total + 100.0
    assert nominal.total == beside(fitter, nominal, nominal).total


def test_what_says_the_same_as_the_best_is_held_against_its_noise() -> None:
    dataset = measure(plan(LYING, duration_s=0.28), (FrictionCoefficient(factor=_sliding_factor()),))
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    search = Search(fitter, [FrictionCoefficient], quiet, 0)
    best = next(c for c in search.contenders() if c.names)
    wronged = replace(best, cost=best.cost + 50.0)
    _, _, held = against_the_best(fitter, of_nominal(fitter), [best, wronged])
    assert held.total == pytest.approx(best.total, abs=1.0)


def test_the_wavelength_of_a_roughness_is_found_from_the_beginnings() -> None:
    # Heights of one wavelength tell nothing of another: no fit from the middle of the range finds its way.
    truth = SurfaceRoughness(wavelength_m=4e-3, cosine_m=(-5e-7, 1e-6, 2e-6), sine_m=(2e-7, -1e-6, -2e-6))
    dataset = measure(plan(PLANS[:2], duration_s=1.2), (truth,))
    comparison = Comparison(dataset, Simulator(dataset))
    fitter = Fitter(comparison)
    search = Search(fitter, [SurfaceRoughness], quiet, 0)
    (hypothesis,) = search.possible
    astray = of_fit(fitter, fitter.fit(hypothesis, hypothesis.starts[-1], evaluations=2))
    found = from_beginnings(fitter, astray, search.possible, 0)
    assert found.total < astray.total - 200.0
    (effect,) = found.effects
    assert isinstance(effect, SurfaceRoughness)
    assert effect.wavelength_m == pytest.approx(truth.wavelength_m, rel=0.02)
    assert_allclose(effect.sine_m, truth.sine_m, atol=5e-7)


def test_a_wavelength_that_is_a_little_off_finds_its_way_over_the_beginnings_and_not_over_whole_trials() -> None:
    truth = SurfaceRoughness(wavelength_m=1.5e-3, cosine_m=(0.0, 1e-6, 4e-6), sine_m=(0.0, -4e-6, -2e-6))
    off = replace(truth, wavelength_m=1.02 * truth.wavelength_m)
    dataset = measure(plan(PLANS[:2], duration_s=1.2), (truth,))
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    (hypothesis,) = Search(fitter, [SurfaceRoughness], quiet, 0).possible
    start = (off.to_fit(off.vector()) - hypothesis.neutral) / hypothesis.scale
    stuck = settled_at(fitter, hypothesis, start, evaluations=8)
    found = from_its_own_beginning(fitter, stuck)
    wavelengths = [
        effect.wavelength_m for c in (stuck, found) for effect in c.effects if hasattr(effect, "wavelength_m")
    ]
    # The fit to whole trials stays where it started; the other ends at the truth, and with half of the objective.
    assert wavelengths[0] == pytest.approx(off.wavelength_m, rel=0.005)
    assert wavelengths[1] == pytest.approx(truth.wavelength_m, rel=0.005)
    assert found.total < 0.7 * stuck.total


@pytest.mark.parametrize("enough", [False, True])
def test_more_firsts_are_tried_where_every_pair_leaves_a_gap(enough: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    truth = (SizeError(length_factor=1.2), MagnetizationStrength(factor=0.7))
    dataset = measure(plan(PLANS[:1]), truth)
    search = Search(Fitter(Comparison(dataset, Simulator(dataset))), [CATALOGUE[name] for name in MANY_KINDS], quiet, 0)
    search.fitter.take_likeliest_noise(())
    nominal = of_nominal(search.fitter)
    # All as near to the best as a first has to be.
    singles = [replace(single, cost=nominal.cost) for single in search._singles(nominal)]
    tried: list[Contender] = []
    add = Pairs.add

    def spied(pairs: Pairs, first: Contender, others: Sequence[Contender]) -> None:
        tried.append(first)
        # One pair is enough to go on with.
        if len(tried) == 1:
            add(pairs, first, others)

    monkeypatch.setattr(Pairs, "add", spied)
    monkeypatch.setattr(search, "_is_enough", lambda _: enough)
    monkeypatch.setattr("tumblers.diagnosis.search.is_wanting", lambda *_: True)
    assert search._pairs(singles, strong=True)
    # What is exchanged later is another contender of the same name.
    assert [any(first is single for first in tried) for single in singles] == [True, True, *(3 * [not enough]), False]


def test_of_many_parameters_the_best_is_searched_over_its_range_and_another_pair_from_where_it_is(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fitter = _coarse_lab()
    search = Search(fitter, [SizeError, SurfaceRoughness], quiet, 0)
    size, rough = sorted(search.possible, key=lambda hypothesis: hypothesis.free)
    assert size.free <= MANY < rough.free
    few, many, pair = (
        of_fit(fitter, fitter.fit(h, np.zeros(len(h.neutral)), evaluations=1)) for h in (size, rough, size + rough)
    )
    sought: list[tuple[str, Contender]] = []

    def over_the_range(_fitter: Fitter, contender: Contender, *_: object) -> Contender:
        sought.append(("range", contender))
        return contender

    def from_where_it_is(_fitter: Fitter, contender: Contender) -> Contender:
        sought.append(("here", contender))
        return contender

    monkeypatch.setattr("tumblers.diagnosis.search.from_beginnings", over_the_range)
    monkeypatch.setattr("tumblers.diagnosis.search.from_its_own_beginning", from_where_it_is)
    for contenders, expected in (
        ([pair, few], [("range", pair), ("range", few)]),
        ([few, pair], [("range", few), ("here", pair)]),
        ([few, many, pair], [("range", few)]),
    ):
        sought.clear()
        search._refined(contenders, 2)
        assert sought == expected


def test_an_effect_promises_something_where_it_is_not_yet_where_it_should_be() -> None:
    truth = MagnetizationStrength(factor=0.7)
    dataset = measure(plan(PLANS[:2]), (truth,))
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    (hypothesis,) = Search(fitter, [MagnetizationStrength], quiet, 0).possible
    (there,) = (truth.vector()[0] - hypothesis.neutral) / hypothesis.scale
    idle, right = (of_fit(fitter, fitter.fit(hypothesis, np.array([u]), evaluations=1)) for u in (0.0, there))
    assert promise(fitter, idle, 0) > CLEAR
    assert promise(fitter, right, 0) < 0.0


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


@pytest.mark.parametrize("name", CATALOGUE)
def test_neutral_is_neutral_to_the_last_bit_in_the_coordinates_of_a_fit(name: str) -> None:
    hypothesis = Hypothesis.of(CATALOGUE[name], [Simulator(plan()).nominal(0)])
    (effect,) = hypothesis.effects(np.zeros(len(hypothesis.neutral)))
    assert effect.is_neutral()
