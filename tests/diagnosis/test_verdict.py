"""What is concluded from the evidence and from what is left."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from tumblers.diagnosis.fitting.fitter import Fitter
from tumblers.diagnosis.fitting.hypothesis import Hypothesis
from tumblers.diagnosis.gap.comparison import Comparison, Residual
from tumblers.diagnosis.gap.predictive import failings, is_explained, is_right
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.what.attribute import LAPSE, REFUSED, Attribution, _ranked
from tumblers.diagnosis.what.contender import Contender, of_fit, of_nominal
from tumblers.diagnosis.what.margins import OPEN
from tumblers.diagnosis.what.verdict import judge, refused, ties
from tumblers.effects import get

from .lab import PLANS, measure, plan

COUNT = 400
NO_NUISANCES = np.zeros(0)


def compared(*tracked: int, alike: float = 1.0) -> SimpleNamespace:
    """Return a comparison of trials, of whose numbers so many are of a track and the others outcomes."""
    floors = tuple(
        SimpleNamespace(tracked=count, size=COUNT, outcome_scale={f"speed{k}": 1.0 for k in range(COUNT - count)})
        for count in tracked
    )
    made = SimpleNamespace(
        readers=floors,
        sizes=(COUNT,) * len(floors),
        count=COUNT * len(floors),
        floors=floors,
        alike=alike,
        dataset=SimpleNamespace(trials=tuple(SimpleNamespace(id=f"up{k}") for k in range(len(floors)))),
    )
    made.rough = Comparison.rough.fget(made)  # type: ignore[attr-defined]
    return made


def contender(name: str, left: float, probability: float) -> Contender:
    """Return a hypothesis that leaves so many sigmas everywhere in its one trial."""
    residual = Residual((np.full(COUNT, left),), NO_NUISANCES, NO_NUISANCES, NO_NUISANCES, NO_NUISANCES)
    return Contender((name,) if name else (), None, residual, 0.0, probability=probability)


@pytest.mark.parametrize(
    ("nominal_is_right", "left", "probability", "foretold", "verdict"),
    [
        # Nothing speaks against the nominal model, and it is not much less probable.
        (True, 1.0, 0.2, True, "no_gap"),
        # It is far less probable.
        (True, 1.0, 0.01, True, "explained"),
        # Its own wide noise hides what it leaves against the noise around a likelier one.
        (True, 1.7, 0.2, True, "explained"),
        (False, 1.0, 0.2, True, "explained"),
        (False, 1.0, 0.2, False, "unexplained"),
        # Of two hypotheses each has half of what is shared by all: that alone is no doubt.
        (True, 1.0, 0.5 * LAPSE, True, "explained"),
    ],
)
def test_a_likelier_effect_is_named_where_the_nominal_model_leaves_a_gap_against_either_noise(
    nominal_is_right: bool, left: float, probability: float, foretold: bool, verdict: str
) -> None:
    best, nominal = contender("viscous_drag", 1.0, 0.8), contender("", left, probability)
    comparison = compared(COUNT)
    attribution = Attribution((best, nominal), 1.0, nominal_is_right)
    found, chosen = judge(comparison, attribution, foretold)  # type: ignore[arg-type]
    assert (found, chosen) == (verdict, nominal if verdict == "no_gap" else best)


# Their squares are a mean square: right ones leave less than 1.18, and a nominal model may leave 1.25.
@pytest.mark.parametrize(("left", "verdict"), [(1.08, "explained"), (1.09, "unexplained")])
def test_what_is_to_explain_a_gap_leaves_no_more_than_right_effects_do(left: float, verdict: str) -> None:
    best, nominal = contender("viscous_drag", left, 0.8), contender("", 2.0, 0.1)
    found, chosen = judge(compared(COUNT), Attribution((best, nominal), 1.0, False), True)  # type: ignore[arg-type]
    assert (found, chosen) == (verdict, best)
    assert is_right(compared(COUNT), best.residual)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("left", "fitted", "failing"),
    [(1.08, True, []), (1.09, True, ["all trials"]), (1.09, False, []), (1.7, False, ["all trials", "a trial"])],
)
def test_what_fails_is_told_where_the_test_is_failed(left: float, fitted: bool, failing: list[str]) -> None:
    comparison, residual = compared(COUNT), contender("viscous_drag", left, 0.8).residual
    found = failings(comparison, residual, fitted)  # type: ignore[arg-type]
    assert [one.test for one in found] == failing
    passes = is_explained if fitted else is_right
    assert passes(comparison, residual) == (not found)  # type: ignore[arg-type]
    for one in found:
        assert one.left == pytest.approx(left**2)
        assert one.allowed is not None
        assert one.allowed < left**2


def test_an_outcome_that_is_contradicted_is_told() -> None:
    comparison, residual = compared(COUNT - 1), contender("viscous_drag", 1.0, 0.8).residual
    residual.trials[0][-1] = 9.0
    found = failings(comparison, residual, True)  # type: ignore[arg-type]
    assert [(one.test, one.trials) for one in found] == [("an outcome", ("up0",))]


def test_no_effect_is_farther_behind_for_its_place_in_the_catalogue() -> None:
    order = ("friction_coefficient", "viscous_drag", "size_error")
    made = [replace(contender(name, 1.0, 0.1), log_evidence=-4.0 - 0.005 * k) for k, name in enumerate(order)]
    best = replace(made[0], log_evidence=0.0)
    pair = replace(made[1], names=("friction_coefficient", "size_error"), log_evidence=-1.01)
    attribution = Attribution((best, made[1], made[2]), 1.0, False, order=order)
    assert attribution.log_odds(best, "viscous_drag") == pytest.approx(4.0)
    assert attribution.log_odds(best, "size_error") == pytest.approx(4.0)
    # What is likely beside another is not ruled out because it is unlikely alone.
    paired = replace(attribution, contenders=(best, pair, made[1], made[2]))
    assert paired.log_odds(best, "size_error") == pytest.approx(-np.log(np.exp(-4.0) + np.exp(-1.0)))


# The nominal model has 5 % of 88 % where another has e^2.81 = 16.6 times as much.
@pytest.mark.parametrize(
    ("ahead", "tracked", "foretold", "verdict"),
    [
        # Odds of e^5 are too few where the evidence of tracks is known to e^3 alone; that of outcomes is known.
        (5.7, (COUNT,), True, "no_gap"),
        (5.9, (COUNT,), True, "explained"),
        (2.7, (0,), True, "no_gap"),
        (2.9, (0,), True, "explained"),
        # One track among outcomes is enough.
        (5.7, (0, COUNT), True, "no_gap"),
        # What failed on trials left out is no more than what noise may be either.
        (5.7, (COUNT,), False, "no_gap"),
        (5.9, (COUNT,), False, "unexplained"),
    ],
)
def test_where_noise_may_explain_all_an_effect_is_named_by_more_than_its_evidence_may_be_off(
    ahead: float, tracked: tuple[int, ...], foretold: bool, verdict: str
) -> None:
    share, odds = LAPSE / 2, np.exp(ahead)

    def everywhere(name: str, left: float, probability: float) -> Contender:
        made = contender(name, left, probability)
        return replace(made, residual=replace(made.residual, trials=made.residual.trials * len(tracked)))

    best = everywhere("size_error", 0.9, share + (1.0 - LAPSE) * odds / (1.0 + odds))
    nominal = everywhere("", 1.0, share + (1.0 - LAPSE) / (1.0 + odds))
    attribution = Attribution((best, nominal), 1.0, True)
    found, _ = judge(compared(*tracked), attribution, foretold)  # type: ignore[arg-type]
    assert found == verdict


@pytest.mark.parametrize(("of_the_nominal_model", "verdict"), [(0.44, "no_gap"), (0.40, "explained")])
def test_what_is_less_probable_than_that_nothing_is_wrong_is_not_named(
    of_the_nominal_model: float, verdict: str
) -> None:
    # Three of six count as the nominal model, which has their probability and their shares of what all have alike.
    share = LAPSE / 6
    nominal = contender("", 1.7, of_the_nominal_model + 3 * share)
    merged = [replace(contender(name, 1.7, 0.0), merged=True) for name in ("magnetization_strength", "size_error")]
    best, other = contender("viscous_drag", 1.0, 0.42 + share), contender("field_rolloff", 1.5, share)
    comparison = compared(COUNT)
    attribution = Attribution((best, nominal, *merged, other, contender("draft_angle", 1.7, share)), 1.0, True)
    found, chosen = judge(comparison, attribution, foretold=True)  # type: ignore[arg-type]
    assert (found, chosen) == (verdict, nominal if verdict == "no_gap" else best)


@pytest.mark.parametrize(("nominal_is_right", "verdict"), [(True, "no_gap"), (False, "unexplained")])
def test_where_nothing_is_likelier_than_the_nominal_model_it_is_right_or_nothing_is(
    nominal_is_right: bool, verdict: str
) -> None:
    nominal, other = contender("", 1.7, 0.8), contender("viscous_drag", 1.7, 0.1)
    attribution = Attribution((nominal, other), 1.0, nominal_is_right)
    comparison = compared(COUNT)
    found, chosen = judge(comparison, attribution, True)  # type: ignore[arg-type]
    assert (found, chosen) == (verdict, nominal)


@pytest.mark.parametrize(
    ("evidence", "left", "standing", "first"),
    [
        # What stands where evidence ranks it first stays there.
        ((0.0, -1.0, -2.0), (1.0, 1.0, 1.0), {"viscous_drag", "field_rolloff"}, "viscous_drag"),
        # The first that stands of those that are tied leads.
        ((0.0, -1.0, -2.0), (1.0, 1.0, 1.0), {"field_rolloff", "size_error"}, "field_rolloff"),
        # Not where it leaves a gap in the trials that it was fitted to.
        ((0.0, -1.0, -2.0), (1.0, 1.7, 1.0), {"field_rolloff", "size_error"}, "size_error"),
        # Nor where it leaves more there than what explains the data may, though less than a nominal model may.
        ((0.0, -1.0, -2.0), (1.09, 1.0, 1.0), {"viscous_drag", "field_rolloff"}, "field_rolloff"),
        # Evidence of twenty to one is not overruled, nor is anything where none stands.
        ((0.0, -4.0, -5.0), (1.0, 1.0, 1.0), {"field_rolloff"}, "viscous_drag"),
        ((0.0, -1.0, -2.0), (1.0, 1.0, 1.0), set(), "viscous_drag"),
    ],
)
def test_between_what_evidence_ties_trials_left_out_decide(
    evidence: tuple[float, ...], left: tuple[float, ...], standing: set[str], first: str
) -> None:
    names = ("viscous_drag", "field_rolloff", "size_error")
    # One more counts as the nominal model, which is improbable, and has left it its share of the lapse.
    share = LAPSE / 5
    shares = share + (1.0 - LAPSE) * np.exp(evidence) / np.exp(evidence).sum()
    each = zip(names, left, shares, evidence, strict=True)
    made = [replace(contender(name, sigmas, float(p)), log_evidence=e) for name, sigmas, p, e in each]
    rest = contender("", 2.0, 2.0 * share), replace(contender("adhesion_coefficient", 2.0, 0.0), merged=True)
    attribution = Attribution((*made, *(replace(c, log_evidence=-90.0) for c in rest)), 1.0, False)
    comparison = compared(COUNT)
    found = attribution.refusing(refused(comparison, made, lambda c: c.names[0] in standing))  # type: ignore[arg-type]
    assert found.contenders[0].names == (first,)
    assert sum(c.probability for c in found.contenders) == pytest.approx(1.0)
    assert found.contenders[0].probability == max(c.probability for c in found.contenders)
    # What the nominal model has of the lapse alone is no doubt, however much was refused beside it.
    assert found.doubt == pytest.approx(0.0, abs=1e-12)
    assert {c.names for c in found.contenders if not c.probability} == {("adhesion_coefficient",)}
    if first == names[0]:
        assert [c.names for c in found.contenders] == [c.names for c in attribution.contenders]
        assert [c.probability for c in found.contenders] == pytest.approx(
            [c.probability for c in attribution.contenders]
        )


def parted(_other: Contender) -> float:
    """Say that against the noise around another the best leads by much, too."""
    return 1e3


@pytest.mark.parametrize("alike", [1.0, 8.0])
def test_an_outcome_parts_as_much_as_it_counts(alike: float) -> None:
    best = contender("substrate_tilt", 0.8, 0.8)
    other = replace(contender("stray_field_gradient", 0.8, 0.1), log_likelihood=-20.0, log_evidence=-20.0)
    # Of all numbers one outcome differs, by five standard deviations: 12.5 of likelihood, as it counts for itself.
    other.residual.trials[0][-1] += 5.0
    found = ties(compared(COUNT - 1, alike=alike), Attribution((best, other), 8.0, False), best, parted)  # type: ignore[arg-type]
    assert found == {"substrate_tilt": () if alike == 8.0 else ("stray_field_gradient",)}


@pytest.mark.parametrize(
    ("evidence", "behind", "sigmas", "tracked", "tied"),
    [
        # About as likely; the best is preferred for having fewer parameters.
        (-8.0, 2.0, 1.8, 0, True),
        (-2.0, 20.0, 1.8, 0, True),
        (-8.0, 20.0, 1.8, 0, False),
        # The evidence of tracks is known less well.
        (-5.0, 20.0, 1.8, 0, False),
        (-5.0, 20.0, 1.8, COUNT, True),
        (-8.0, 20.0, 1.8, COUNT, False),
        # The differences are 0.1 apart: what fits better does so by where its fit stopped.
        (-8.0, 20.0, 0.9, 0, True),
    ],
)
def test_what_is_about_as_likely_or_says_the_same_is_tied_however_parsimonious_the_best_is(
    evidence: float, behind: float, sigmas: float, tracked: int, tied: bool
) -> None:
    best = contender("substrate_tilt", 0.8, 0.8)
    other = replace(contender("stray_field_gradient", sigmas, 0.1), log_likelihood=-behind, log_evidence=evidence)
    attribution = Attribution((best, other), 8.0, False)
    comparison = compared(tracked)
    found = ties(comparison, attribution, best, parted)  # type: ignore[arg-type]
    assert found == {"substrate_tilt": ("stray_field_gradient",) if tied else ()}


@pytest.mark.parametrize(
    ("behind", "evidence", "around_the_other", "tied"),
    [
        # Against the noise around itself the best leads by 10, against that around the other by 5, and by 7.
        (10.0, 10.0, 5.0, True),
        (10.0, 10.0, 7.0, False),
        # There the other has fewer parameters, by 3; parsimony that speaks for the best parts nothing.
        (10.0, 7.0, 7.0, True),
        (10.0, 13.0, 5.0, True),
        (10.0, 13.0, 7.0, False),
        # It is too far behind to be asked.
        (12.5, 13.0, 5.0, False),
    ],
)
def test_what_leads_against_its_own_noise_alone_is_tied(
    behind: float, evidence: float, around_the_other: float, tied: bool
) -> None:
    best = contender("substrate_tilt", 0.8, 0.8)
    other = replace(contender("stray_field_gradient", 1.8, 0.1), log_likelihood=-behind, log_evidence=-evidence)
    asked = []

    def lead(against: Contender) -> float:
        asked.append(against)
        return 2.0 * 8.0 * around_the_other

    found = ties(compared(COUNT), Attribution((best, other), 8.0, False), best, lead)  # type: ignore[arg-type]
    assert found == {"substrate_tilt": ("stray_field_gradient",) if tied else ()}
    assert asked == ([other] if behind < OPEN else [])


@pytest.mark.parametrize(
    ("likelihoods", "tied"),
    [
        # All of it is within the limit, but the one does little of what the best does.
        ((4.0, 0.8, 3.0, 0.0), ("viscous_drag",)),
        # The best itself does nothing, or less: nothing does the same.
        ((0.0, 0.0, 0.0, 0.0), ()),
        ((0.0, 1.0, 1.0, 1.0), ()),
    ],
)
def test_what_does_little_of_what_a_weak_effect_does_is_not_tied_with_it(
    likelihoods: tuple[float, ...], tied: tuple[str, ...]
) -> None:
    left = [2.0 - 0.1 * likelihood for likelihood in likelihoods]
    names = ("substrate_tilt", "draft_angle", "viscous_drag", "")
    best, *others = (
        replace(contender(name, sigmas, 0.1), log_likelihood=likelihood, log_evidence=likelihood)
        for name, sigmas, likelihood in zip(names, left, likelihoods, strict=True)
    )
    comparison = compared(COUNT)
    found = ties(comparison, Attribution((best, *others), 8.0, False), best, parted)  # type: ignore[arg-type]
    assert found == {"substrate_tilt": tied}


def test_either_of_a_pair_is_tied_with_what_does_the_same_beside_the_other() -> None:
    likelihoods = {
        ("substrate_tilt", "size_error"): 0.0,
        # Within the limit, but hardly better than the tilt alone; the next does much beside the size.
        ("substrate_tilt", "viscous_drag"): -2.5,
        ("size_error", "draft_angle"): -4.0,
        # Much of it too, and beyond the limit.
        ("size_error", "field_rolloff"): -20.0,
        ("substrate_tilt",): -3.0,
        ("size_error",): -50.0,
    }
    made = [
        replace(
            contender("", 0.8 - 0.1 * likelihood, 0.1), names=names, log_likelihood=likelihood, log_evidence=likelihood
        )
        for names, likelihood in likelihoods.items()
    ]
    comparison = compared(COUNT)
    found = ties(comparison, Attribution(tuple(made), 8.0, False), made[0], parted)  # type: ignore[arg-type]
    assert found == {"substrate_tilt": ("draft_angle",), "size_error": ()}


def test_a_nominal_model_that_fails_its_test_counts_for_less_where_another_is_likelier() -> None:
    truth = (get("viscous_drag").from_vector((0.02,)),)
    data = measure(plan(PLANS[:2]), truth, seed=1)
    fitter = Fitter(Comparison(data, Simulator(data, 1)))
    fitter.take_likeliest_noise(truth)
    scenarios = [fitter.comparison.simulator.nominal(i) for i in fitter.trials]
    drag, idle = (Hypothesis.of(get(name), scenarios) for name in ("viscous_drag", "draft_angle"))
    nominal = of_nominal(fitter)
    better = of_fit(fitter, fitter.fit(drag, drag.starts[0], evaluations=8))
    nothing = of_fit(fitter, fitter.fit(idle, np.zeros(1), evaluations=1))
    assert better.total < nominal.total - 500.0
    assert nothing.total == pytest.approx(nominal.total, abs=1.0)

    def evidence(contenders: list[Contender], passed: bool) -> dict[tuple[str, ...], float]:
        ranked, _ = _ranked(contenders, fitter.comparison, ["viscous_drag", "draft_angle"], passed)
        return {contender.names: contender.log_evidence for contender in ranked}

    before, after = (evidence([nominal, better, nothing], passed) for passed in (True, False))
    assert after[()] == pytest.approx(before[()] + np.log(REFUSED))
    assert after["viscous_drag",] == before["viscous_drag",]
    # What does nothing must not lead because the nominal model is wrong.
    before, after = (evidence([nominal, nothing], passed) for passed in (True, False))
    assert after == before
    assert after[()] > after["draft_angle",]


def test_one_effect_alone_does_not_lead_by_doing_nothing() -> None:
    data = measure(plan(PLANS[:2]), seed=1)
    fitter = Fitter(Comparison(data, Simulator(data, 1)))
    fitter.take_likeliest_noise(())
    idle = Hypothesis.of(get("draft_angle"), [fitter.comparison.simulator.nominal(i) for i in fitter.trials])
    nothing = of_fit(fitter, fitter.fit(idle, np.zeros(1), evaluations=1))
    ranked, _ = _ranked([nothing, of_nominal(fitter)], fitter.comparison, ["draft_angle"], nominal_is_right=True)
    assert [contender.names for contender in ranked] == [(), ("draft_angle",)]


def test_all_is_widened_by_what_the_likeliest_leaves_and_not_by_what_is_vague() -> None:
    data = measure(plan(PLANS[:1], duration_s=0.3))
    comparison = Comparison(data, Simulator(data, 1))
    fitter = Fitter(comparison)
    nominal = of_nominal(fitter)
    wrong = replace(nominal, cost=3.0 * comparison.alike * comparison.independent, log_determinant=0.0)
    # It leaves little of anything against a noise that explains everything.
    vague = replace(wrong, names=("draft_angle",), cost=0.1, log_determinant=2.0 * wrong.cost)
    _, dispersion = _ranked([wrong, vague], comparison, ["draft_angle"], nominal_is_right=False)
    assert dispersion == pytest.approx(3.0 * comparison.alike)
