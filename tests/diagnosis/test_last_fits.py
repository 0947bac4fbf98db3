"""In what steps and against which noise the last contenders are held."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tumblers.diagnosis.fitting.fitter import Fitter
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.simulator import LONGEST_STEP_S, Simulator
from tumblers.diagnosis.what.contender import Contender, of_fit, of_nominal
from tumblers.diagnosis.what.last_fits import _equally_far, _from_counterparts, _near_the_first, concluded
from tumblers.diagnosis.what.margins import CLEAR, OPEN, SECOND
from tumblers.diagnosis.what.own_noise import against_the_best, beside, lead_around, settled_at
from tumblers.diagnosis.what.search import Search
from tumblers.effects.friction_coefficient import FrictionCoefficient
from tumblers.effects.size_error import SizeError
from tumblers.effects.stray_field_gradient import StrayFieldGradient
from tumblers.effects.substrate_tilt import SubstrateTilt
from tumblers.effects.viscous_drag import ViscousDrag

from .lab import LYING, PLANS, coarse_lab, measure, plan, quiet, sliding_factor


def test_the_leader_is_held_in_a_step_that_is_short_enough_for_it() -> None:
    # Steps were chosen where the body still lay.
    dataset = measure(plan(LYING), (FrictionCoefficient(factor=0.5),))
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    search = Search(fitter, [FrictionCoefficient], quiet, 0)
    fitter.take_likeliest_noise(())
    nominal = of_nominal(fitter)
    (hypothesis,) = search.possible
    there = (np.array([0.5, 0.0]) - hypothesis.neutral) / hypothesis.scale
    leader = of_fit(fitter, fitter.fit(hypothesis, there, evaluations=1))
    found, still = concluded(fitter, nominal, [leader], 0, quiet)
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
    assert beside(fitter, nominal, best).total < best.total + fitter.comparison.objective_of(CLEAR)
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


def test_what_may_be_named_is_fitted_as_far_though_pairs_fit_better(monkeypatch: pytest.MonkeyPatch) -> None:
    fitter = coarse_lab(SizeError(length_factor=1.1))
    kinds = (SizeError, FrictionCoefficient, SubstrateTilt, ViscousDrag)
    size, *others = Search(fitter, list(kinds), quiet, 0).possible
    truth = (np.array(SizeError(length_factor=1.1).to_fit((1.1, 1.0))) - size.neutral) / size.scale
    alone = settled_at(fitter, size, truth)
    # Each better than the effect alone by more than a second effect has to be.
    ahead = 2.0 * fitter.comparison.alike * SECOND + 10.0
    pairs = [
        settled_at(fitter, size + other, np.concatenate([truth, np.zeros(len(other.neutral))])) for other in others
    ]
    pairs = [replace(pair, cost=pair.cost + alone.total - pair.total - ahead) for pair in pairs]
    far_off = [settled_at(fitter, other, np.zeros(len(other.neutral))) for other in others]
    fitted: list[tuple[str, ...]] = []

    def noted(_fitter: Fitter, contender: Contender, _alike: float) -> Contender:
        fitted.append(contender.names)
        return contender

    monkeypatch.setattr("tumblers.diagnosis.what.last_fits._PAIRS_EQUALLY_FAR", 2)
    monkeypatch.setattr("tumblers.diagnosis.what.last_fits.as_far", noted)
    monkeypatch.setattr("tumblers.diagnosis.what.last_fits.nested", lambda _fitter, single, _pairs: single)
    made = _equally_far(fitter, [*pairs, *far_off, alone], 0, quiet)
    assert made[0].names == pairs[0].names
    assert ("size_error",) in fitted
    # Neutral effects explain nothing.
    assert not any(contender.names in fitted for contender in far_off)
    assert sum(len(names) > 1 for names in fitted) == 2


def _tilt_and_gradient() -> tuple[Fitter, Contender, Contender]:
    """Return what a gradient made, at its best as a tilt, and a gradient where a search may leave it."""
    truth = StrayFieldGradient(gradient_T_per_m=(0.0, 0.1, 0.0))
    dataset = measure(plan(PLANS[:3]), (truth,), seed=3)
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    tilt, gradient = Search(fitter, [SubstrateTilt, StrayFieldGradient], quiet, 0).possible
    best = settled_at(fitter, tilt, np.array([0.0, -0.67]), evaluations=6)
    return fitter, best, settled_at(fitter, gradient, np.array([0.0, 0.4, -0.3, 0.0]))


@pytest.mark.parametrize("leads", [True, False])
def test_a_pair_that_is_clearly_behind_is_fitted_from_where_the_best_pair_is(
    leads: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    fitter = coarse_lab(SizeError(length_factor=1.1))
    kinds = (SizeError, FrictionCoefficient, SubstrateTilt, ViscousDrag)
    size, *others = Search(fitter, list(kinds), quiet, 0).possible
    truth = (np.array(SizeError(length_factor=1.1).to_fit((1.1, 1.0))) - size.neutral) / size.scale
    alone = settled_at(fitter, size, truth)
    clear = fitter.comparison.objective_of(CLEAR)
    # The first pair adds what a second effect must, or next to nothing; one is about as good, and one clearly behind.
    ahead = 2.0 * fitter.comparison.alike * SECOND + 4.0 * clear if leads else 1.0
    pairs = []
    for other, behind in zip(others, (0.0, 0.5 * clear, 3.0 * clear), strict=True):
        pair = settled_at(fitter, size + other, np.concatenate([truth, np.zeros(len(other.neutral))]))
        pairs.append(replace(pair, cost=pair.cost + alone.total - ahead + behind - pair.total))
    asked = []

    def noted(_fitter: Fitter, contender: Contender, best: Contender, each: object) -> Contender:
        asked.append((contender.names, best.names))
        assert each == [alone.fit.hypothesis] if alone.fit is not None else False
        return contender

    monkeypatch.setattr("tumblers.diagnosis.what.last_fits.as_far", lambda _fitter, contender, _alike: contender)
    monkeypatch.setattr("tumblers.diagnosis.what.last_fits.nested", lambda _fitter, single, _pairs: single)
    monkeypatch.setattr("tumblers.diagnosis.what.last_fits._from_counterparts", noted)
    made = _equally_far(fitter, [*pairs, alone], 0, quiet)
    assert made[0].names == (pairs[0].names if leads else alone.names)
    assert asked == ([(pairs[2].names, pairs[0].names)] if leads else [])


def test_what_ended_beside_its_valley_is_fitted_from_where_it_does_what_the_best_does() -> None:
    fitter, best, stuck = _tilt_and_gradient()
    assert stuck.fit is not None
    found = _from_counterparts(fitter, stuck, best, [stuck.fit.hypothesis])
    assert stuck.total > best.total + 100.0
    assert found.total < best.total + fitter.comparison.objective_of(CLEAR)
    (gradient,) = found.effects
    assert isinstance(gradient, StrayFieldGradient)
    # The noise leaves it that much.
    assert gradient.gradient_T_per_m[1] == pytest.approx(0.1, rel=0.15)


def test_of_a_pair_the_second_is_fitted_from_where_it_does_what_that_of_the_best_pair_does() -> None:
    truth = (ViscousDrag(viscosity_Pa_s=2e-3), StrayFieldGradient(gradient_T_per_m=(0.0, 0.1, 0.0)))
    dataset = measure(plan(PLANS[:3]), truth, seed=3)
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    drag, tilt, gradient = each = Search(fitter, [ViscousDrag, SubstrateTilt, StrayFieldGradient], quiet, 0).possible
    (viscosity,) = (np.array(ViscousDrag.to_fit((2e-3,))) - drag.neutral) / drag.scale
    best = settled_at(fitter, drag + tilt, np.array([viscosity, 0.0, -0.67]), evaluations=6)
    # The same pair in another order, its second where a search may leave it.
    stuck = settled_at(fitter, gradient + drag, np.array([0.0, 0.4, -0.3, 0.0, viscosity]))
    clear = fitter.comparison.objective_of(CLEAR)
    assert stuck.total > best.total + 2.0 * clear
    found = _from_counterparts(fitter, stuck, best, each)
    assert found.total < best.total + clear
    assert set(found.names) == set(stuck.names)
    # What shares no effect with the best is left where it is.
    alone = settled_at(fitter, gradient, np.array([0.0, 0.4, -0.3, 0.0]))
    assert _from_counterparts(fitter, alone, best, each) is alone


def test_the_last_fits_start_from_where_the_best_of_all_is(monkeypatch: pytest.MonkeyPatch) -> None:
    fitter, tilt, stuck = _tilt_and_gradient()
    # The tilt is not at its best, and a pair leads, by less than a second effect has to add.
    assert tilt.fit is not None
    worse = settled_at(fitter, tilt.fit.hypothesis, np.array([0.0, -0.5]))
    assert stuck.fit is not None
    pair = settled_at(fitter, tilt.fit.hypothesis + stuck.fit.hypothesis, np.array([0.0, -0.5, 0.0, 0.1, 0.0, 0.0]))
    pair = replace(pair, cost=pair.cost + worse.total - pair.total - 5.0)
    asked = []

    def noted(_fitter: Fitter, contender: Contender, best: Contender, _each: object) -> Contender:
        asked.append((contender, best))
        return contender

    monkeypatch.setattr("tumblers.diagnosis.what.last_fits._from_counterparts", noted)
    made = {contender.names: contender for contender in _equally_far(fitter, [pair, worse, stuck], 0, quiet)}
    ((contender, best),) = asked
    assert {contender.names, best.names} == {tilt.names, stuck.names}
    assert best.total == min(made[names].total for names in (tilt.names, stuck.names))
    # As it is fitted by then, not as it came.
    assert best.total < min(worse.total, stuck.total) - fitter.comparison.objective_of(CLEAR)


@pytest.mark.parametrize(("short", "leads"), [(5.0, False), (-5.0, True)])
def test_a_pair_leads_where_its_second_effect_adds_what_it_must(
    monkeypatch: pytest.MonkeyPatch, short: float, leads: bool
) -> None:
    fitter, tilt, gradient = _tilt_and_gradient()
    assert tilt.fit is not None
    assert gradient.fit is not None
    pair = settled_at(fitter, tilt.fit.hypothesis + gradient.fit.hypothesis, np.concatenate([tilt.point, np.zeros(4)]))
    # Ahead by what a second effect must add, or by a little less: likelier than either effect alone all the same.
    ahead = 2.0 * fitter.comparison.alike * SECOND - short
    pair = replace(pair, cost=pair.cost + tilt.total - pair.total - ahead)
    monkeypatch.setattr("tumblers.diagnosis.what.last_fits.as_far", lambda _fitter, contender, _alike: contender)
    monkeypatch.setattr("tumblers.diagnosis.what.last_fits.nested", lambda _fitter, single, _pairs: single)
    monkeypatch.setattr(
        "tumblers.diagnosis.what.last_fits._from_counterparts", lambda _fitter, other, _best, _each: other
    )
    found = _equally_far(fitter, [pair, tilt, gradient], 0, quiet)
    assert found[0].names == (pair.names if leads else tilt.names)


def test_a_lead_around_another_is_against_one_noise_which_both_follow() -> None:
    fitter, best, stuck = _tilt_and_gradient()
    floors = fitter.comparison.floors
    lead = lead_around(fitter, best, stuck)
    assert fitter.comparison.floors is floors
    theirs, mine = beside(fitter, stuck, stuck).total, beside(fitter, best, stuck).total
    assert theirs - mine > 100.0
    # Where a search left it the other gains more by being fitted on.
    assert lead < theirs - mine - 50.0


def test_the_noise_of_the_first_does_not_hide_what_is_near_by_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    # Nothing is at work, so that all are near.
    dataset = measure(plan(PLANS[:3]), seed=3)
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    kinds = (SizeError, FrictionCoefficient, SubstrateTilt, ViscousDrag, StrayFieldGradient)
    those = [settled_at(fitter, h, np.zeros(len(h.low))) for h in Search(fitter, list(kinds), quiet, 0).possible]
    first, by_first, *others = those
    ranked = [first, by_first, *(replace(c, cost=c.cost + 0.1 * k) for k, c in enumerate(others, start=1))]
    monkeypatch.setattr("tumblers.diagnosis.what.last_fits._EQUALLY_FAR", 2)
    pairs, singles = _near_the_first(fitter, ranked)
    assert pairs == []
    assert len(singles) == 3
    assert singles[0] == 0
    # The likeliest by its own, of those that the first's noise puts behind.
    assert singles[2] == min({1, 2, 3, 4} - {singles[1]}, key=lambda k: ranked[k].total)
    flattered = [ranked[0], *(replace(c, settled=False) for c in ranked[1:])]
    assert len(_near_the_first(fitter, flattered)[1]) == 2


def test_of_one_effect_what_is_open_beside_it_is_looked_around_and_of_a_pair_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    dataset = measure(plan(PLANS[:3]), seed=3)
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    size, tilt = Search(fitter, [SizeError, SubstrateTilt], quiet, 0).possible
    singles = [settled_at(fitter, h, np.zeros(len(h.low))) for h in (size, tilt)]
    pair = settled_at(fitter, size + tilt, np.zeros(len(size.low) + len(tilt.low)))
    ahead = 2.0 * fitter.comparison.objective_of(SECOND)
    asked: list[set[tuple[str, ...]]] = []

    def noted(_fitter: Fitter, those: list[Contender], seed: int, _tell: object, margin: float) -> list[Contender]:
        assert (seed, margin) == (7, OPEN)
        assert [c.total for c in those] == sorted(c.total for c in those)
        asked.append({contender.names for contender in those})
        # The last one gains by it.
        return [replace(those[-1], cost=those[-1].cost - ahead), *those[:-1]]

    monkeypatch.setattr("tumblers.diagnosis.what.last_fits.all_shaken", noted)
    monkeypatch.setattr("tumblers.diagnosis.what.last_fits.as_far", lambda _fitter, contender, _alike: contender)
    monkeypatch.setattr(
        "tumblers.diagnosis.what.last_fits._from_counterparts", lambda _fitter, other, _best, _each: other
    )
    for gain, looked in ((2.0 * ahead, []), (0.0, [{("size_error",), ("substrate_tilt",)}])):
        asked.clear()
        made = _equally_far(fitter, [*singles, replace(pair, cost=pair.cost - gain)], 7, quiet)
        assert asked == looked
        assert sorted(len(contender.names) for contender in made) == [1, 1, 2]
    best, other = (next(c for c in made if c.names == names) for names in (made[0].names, made[1].names))
    assert len(best.names) == 1
    assert best.total < other.total - 0.5 * ahead
