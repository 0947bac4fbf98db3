"""Occam's factor: a spike at neutral and a slab beside it, against the integrals written out."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import logsumexp

from tumblers.diagnosis.fitting.fit import Fit
from tumblers.diagnosis.fitting.hypothesis import PRIOR_SIGMA, Hypothesis
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.what.occam import _shares, log_occam, neutral_sets, seldom_needed, unneeded
from tumblers.effects.catalogue import CATALOGUE

from .lab import NOTHING, plan

SCENARIO = Simulator(plan()).nominal(0)
# So many that no parameter is known better than one of them says of it: the plain integrals.
MANY = 1e12


def hypothesis_of(*names: str) -> Hypothesis:
    """Return the hypothesis of some effects."""
    first, *more = [Hypothesis.of(CATALOGUE[name], [SCENARIO]) for name in names]
    return sum(more, start=first)


@pytest.mark.parametrize(
    ("names", "sets"),
    [
        (("viscous_drag",), {()}),
        (("friction_coefficient",), {(), (0,), (1,)}),
        (("substrate_tilt",), {(), (0,), (1,)}),
        # The direction of an error has no place of its own without its angle, nor a wavelength without amplitudes.
        (("magnetization_misalignment",), {()}),
        (("viscous_drag", "substrate_tilt"), {(), (1,), (2,)}),
    ],
)
def test_an_effect_acts_whatever_is_neutral(names: tuple[str, ...], sets: set[tuple[int, ...]]) -> None:
    assert set(neutral_sets(hypothesis_of(*names))) == sets


@pytest.mark.parametrize(("name", "count"), [("stray_field_gradient", 14), ("surface_roughness", 63)])
def test_what_is_without_effect_alone_does_not_act(name: str, count: int) -> None:
    hypothesis = hypothesis_of(name)
    sets = neutral_sets(hypothesis)
    assert len(sets) == len(set(sets)) == count
    for held in sets:
        those = np.isin(np.arange(len(hypothesis.neutral)), held)
        (effect,) = hypothesis.effects(np.where(those, 0.0, 0.5 * hypothesis.high))
        assert not effect.is_neutral()


def test_what_is_held_has_no_set() -> None:
    hypothesis = hypothesis_of("substrate_tilt")
    assert list(neutral_sets(hypothesis.held(np.array([True, False])))) == [()]


@pytest.mark.parametrize(
    ("names", "asked"),
    [
        (("viscous_drag",), ()),
        (("viscous_drag",), (0,)),
        (("friction_coefficient",), (0,)),
        (("friction_coefficient",), (0, 1)),
        (("stray_field_gradient",), (1,)),
        (("surface_roughness",), (0, 1, 2)),
        (("friction_coefficient", "substrate_tilt"), (0, 3)),
    ],
)
@pytest.mark.parametrize("dispersion", [1.0, 8.0])
def test_it_is_the_mean_evidence_of_all_sets(names: tuple[str, ...], asked: tuple[int, ...], dispersion: float) -> None:
    hypothesis, rng = hypothesis_of(*names), np.random.default_rng(3)
    count = len(hypothesis.neutral)
    slopes = np.sqrt(dispersion) * rng.normal(size=(40, count)) * (20.0, 3.0, 8.0, 1.0, 5.0, 12.0, 2.0)[:count]
    seen = slopes @ np.where(np.isin(np.arange(count), asked), 0.4, 0.0) + np.sqrt(dispersion) * rng.normal(size=40)

    def evidence(free: list[int]) -> float:
        """Return ln of the integral over some parameters, the others being zero."""
        table = slopes[:, free]
        precision = table.T @ table / dispersion + np.eye(len(free)) / PRIOR_SIGMA**2
        best = np.linalg.solve(precision, table.T @ seen / dispersion)
        least = float(np.sum((seen - table @ best) ** 2)) / dispersion + float(np.sum((best / PRIOR_SIGMA) ** 2))
        return -0.5 * least - 0.5 * float(np.linalg.slogdet(precision * PRIOR_SIGMA**2)[1])

    # The fit's objective does not temper the likelihood.
    best = np.linalg.solve(slopes.T @ slopes + np.eye(count) / PRIOR_SIGMA**2, slopes.T @ seen)
    cost = float(np.sum((seen - slopes @ best) ** 2) + np.sum((best / PRIOR_SIGMA) ** 2))
    fit = Fit(hypothesis, best, NOTHING, cost, slopes, np.full(count, 0.01))
    sets = list(neutral_sets(hypothesis))
    each = np.array([evidence([j for j in range(count) if j not in held]) for held in sets])
    drifting = np.array(["friction_coefficient" in names and 1 not in held for held in sets])
    parts = np.where(drifting, 0.5 / max(drifting.sum(), 1), (0.5 if drifting.any() else 1.0) / (~drifting).sum())
    each += np.log(parts)
    expected = float(logsumexp(each))
    assert -0.5 * cost / dispersion + log_occam(fit, dispersion, MANY) == pytest.approx(expected, rel=1e-9, abs=1e-9)
    likeliest = sets[int(np.argmax(each))]
    assert np.flatnonzero(unneeded(fit, dispersion, MANY)).tolist() == sorted(likeliest)


def test_what_moves_nothing_that_was_measured_is_no_way_to_act() -> None:
    anisotropy, across = hypothesis_of("friction_anisotropy"), 0
    assert set(neutral_sets(anisotropy)) == {(), (0,), (1,)}
    assert set(neutral_sets(anisotropy, [across])) == {(), (0,)}
    # Beside another effect, which keeps its own.
    both = hypothesis_of("substrate_tilt") + anisotropy
    expected = {(*tilt, *rest) for tilt in ((), (0,), (1,)) for rest in ((), (2,))}
    assert set(neutral_sets(both, [2])) == expected
    # What moves nothing at all has all of its sets.
    assert neutral_sets(anisotropy, [0, 1]) == neutral_sets(anisotropy)


@pytest.mark.parametrize("dispersion", [1.0, 8.0])
def test_a_friction_across_a_way_that_no_trial_leaves_costs_nothing(dispersion: float) -> None:
    anisotropy = hypothesis_of("friction_anisotropy")
    slopes = np.sqrt(dispersion) * np.outer(np.ones(40), (0.0, 20.0))
    fit = Fit(anisotropy, np.array([0.0, 0.4]), NOTHING, 30.0, slopes, np.full(2, 0.01))
    along = anisotropy.held(np.array([True, False]))
    alone = Fit(along, fit.point, NOTHING, 30.0, slopes, fit.steps)
    assert log_occam(fit, dispersion, MANY) == pytest.approx(log_occam(alone, dispersion, MANY), rel=1e-9)
    # Where it moves as much as one number's noise, it is one of three ways to act, of which the data rule out one.
    least = np.sqrt(dispersion / len(slopes)) / PRIOR_SIGMA
    for moves, sets in ((0.99 * least, 2), (1.01 * least, 3)):
        some = Fit(anisotropy, fit.point, NOTHING, 30.0, slopes + np.outer(np.ones(40), (moves, 0.0)), fit.steps)
        assert len(_shares(some, dispersion, MANY)) == sets


@pytest.mark.parametrize("dispersion", [1.0, 8.0])
def test_no_parameter_costs_more_than_one_of_the_numbers_says_of_it(dispersion: float) -> None:
    drag, rng = hypothesis_of("viscous_drag"), np.random.default_rng(5)

    def cost(known: float, numbers: float) -> float:
        """Return what a parameter near neutral costs that the data know to a share of its prior's deviation."""
        slopes = rng.normal(size=(40, 1))
        slopes *= np.sqrt(dispersion * (known**-2 - 1.0) / np.sum(slopes**2)) / PRIOR_SIGMA
        return -log_occam(Fit(drag, np.array([0.0]), NOTHING, 30.0, slopes, np.full(1, 0.01)), dispersion, numbers)

    # Known to a tenth it costs ln 10, to a thousandth no more than Schwarz's half a logarithm of 350 numbers.
    assert cost(0.1, 350.0) == pytest.approx(np.log(10.0))
    assert cost(1e-3, 350.0) == pytest.approx(0.5 * np.log(350.0))
    assert cost(1e-3, 1e7) == pytest.approx(np.log(1000.0))
    # Fewer numbers than one say nothing.
    assert cost(1e-3, 0.5) == pytest.approx(0.0)


def test_a_number_that_is_known_sharply_costs_the_same_whatever_its_range_is() -> None:
    tilt, rng = hypothesis_of("substrate_tilt"), np.random.default_rng(6)
    # Along either slope alone, known well.
    moves = 200.0 * rng.normal(size=(40, 1))
    wide = Fit(tilt, np.array([0.0, 0.2]), NOTHING, 30.0, moves * (0.0, 3.0), np.full(2, 0.01))
    narrow = Fit(tilt, np.array([0.0, 0.6]), NOTHING, 30.0, moves * (0.0, 1.0), np.full(2, 0.01))
    assert log_occam(wide, 1.0, 350.0) == pytest.approx(log_occam(narrow, 1.0, 350.0), abs=1e-3)
    assert log_occam(wide, 1.0, MANY) == pytest.approx(log_occam(narrow, 1.0, MANY) - np.log(3.0), abs=1e-3)


def test_an_effect_without_a_parameter_that_acts_has_the_empty_set() -> None:
    gradient = hypothesis_of("stray_field_gradient")
    assert list(neutral_sets(gradient.held(np.array([True, True, True, False])))) == [()]


def test_an_exponent_that_rests_at_zero_is_neutral_and_costs_its_place_among_the_sets() -> None:
    hypothesis, rng = hypothesis_of("stray_field_gradient"), np.random.default_rng(4)
    slopes = rng.normal(size=(40, 4)) * (20.0, 3.0, 8.0, 0.0)
    point = np.array([0.0, 0.4, 0.0, 0.0])
    fit = Fit(hypothesis, point, NOTHING, 30.0, slopes, np.full(4, 0.01))
    assert unneeded(fit, 1.0, MANY)[3]
    ratios = dict(_shares(fit, 1.0, MANY))
    assert all((ratio == -np.inf) == (3 not in held) for held, ratio in ratios.items())
    count = len(neutral_sets(hypothesis))
    without = hypothesis.held(np.array([False, False, False, True]))
    half = Fit(without, point, NOTHING, 30.0, slopes, np.full(4, 0.01))
    expected = log_occam(half, 1.0, MANY) + np.log(len(neutral_sets(without)) / count)
    assert log_occam(fit, 1.0, MANY) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("names", [("friction_coefficient",), ("substrate_tilt", "friction_coefficient")])
def test_a_form_is_expected_in_its_share_of_the_cases(names: tuple[str, ...], monkeypatch: pytest.MonkeyPatch) -> None:
    # A half is the same whichever side is counted.
    monkeypatch.setattr("tumblers.diagnosis.what.occam.FORM_SHARE", 0.2)
    hypothesis = hypothesis_of(*names)
    expected = neutral_sets(hypothesis)
    drift = hypothesis.keys.index(("friction_coefficient", "drift_per_s"))
    assert sum(np.exp(share) for share in expected.values()) == pytest.approx(1.0)
    assert sum(np.exp(share) for held, share in expected.items() if drift not in held) == pytest.approx(0.2)
    held = hypothesis.held(np.arange(len(hypothesis.neutral)) == drift)
    assert sum(np.exp(share) for share in neutral_sets(held).values()) == pytest.approx(1.0)


def test_what_is_rather_neutral_than_not_is_by_all_sets_and_leaves_an_effect_at_work() -> None:
    hypothesis = hypothesis_of("stray_field_gradient")
    slopes = 20.0 * np.eye(4)

    def asked(*point: float) -> list[int]:
        fit = Fit(hypothesis, np.array(point), NOTHING, 30.0, slopes, np.full(4, 0.01))
        return np.flatnonzero(seldom_needed(fit, 1.0, MANY)).tolist()

    assert asked(0.5, 0.5, 0.5, 0.2) == []
    assert asked(0.0, 0.5, 0.0, 0.2) == [0, 2]
    # Nothing asks for any of them, and one has to act: the likeliest set says which.
    fit = Fit(hypothesis, np.array([1e-4, 2e-4, 1e-4, 0.2]), NOTHING, 30.0, slopes, np.full(4, 0.01))
    assert seldom_needed(fit, 1.0, MANY).tolist() == unneeded(fit, 1.0, MANY).tolist()
    assert not seldom_needed(fit, 1.0, MANY)[:3].all()
