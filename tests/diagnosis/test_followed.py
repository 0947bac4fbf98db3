"""How much nearer the model with the effects comes to what was measured."""

from __future__ import annotations

import json
from dataclasses import replace
from math import log

import numpy as np
import pytest

from tumblers import diagnose
from tumblers.dataset import Outcome
from tumblers.diagnosis.conclusion import Conclusion
from tumblers.diagnosis.fitting.fitter import Fitter
from tumblers.diagnosis.fitting.hypothesis import Hypothesis
from tumblers.diagnosis.gap import built_floors
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.floor import Floor, Sensitivity
from tumblers.diagnosis.gap.reading import Reader
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.how_far.followed import LEAST_FOLLOWED, _left, followed
from tumblers.diagnosis.result import Failing
from tumblers.diagnosis.what.own_noise import settled_at
from tumblers.diagnosis.wording.headline import headline
from tumblers.diagnosis.wording.words import points
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
    assert followed(fitter, right) > 0.9
    assert followed(fitter, nothing) == pytest.approx(0.0, abs=1e-12)
    wrong = settled_at(fitter, hypothesis, -there)
    floors, steps = fitter.comparison.floors, list(fitter.comparison.simulator.step_s)
    assert followed(fitter, wrong) < LEAST_FOLLOWED
    assert fitter.comparison.simulator.step_s == steps
    assert fitter.comparison.floors is floors


def test_noise_that_is_wide_around_an_effect_is_not_followed(monkeypatch: pytest.MonkeyPatch) -> None:
    fitter = fitter_of(0.7)
    nothing = settled_at(fitter, hypothesis_of(fitter), np.array([-1e-3]))
    build = built_floors.build_floor

    def wide(reader: Reader, moved: Sensitivity, share: float) -> Floor:
        # A hundred times what the motion is uncertain by.
        return build(reader, moved, 100.0 * share)

    monkeypatch.setattr(built_floors, "build_floor", wide)
    assert followed(fitter, nothing) < 0.05


def test_what_is_within_the_sensor_s_noise_leaves_nothing_and_a_trial_counts_by_the_logarithm(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    planned = plan(PLANS[:2])
    dataset = measure(planned)
    outcomes = tuple(replace(trial, outcome=Outcome(climbs=True)) for trial in dataset.trials)
    comparison = Comparison(replace(dataset, trials=outcomes), Simulator(dataset))
    residual = comparison.residual(comparison.nominal_paths)
    counts = [floor.tracked for floor in comparison.floors]
    assert [len(values) for values in residual.trials] == [count + 1 for count in counts]
    for values, (track, outcome) in zip(residual.trials, ((0.5, 0.9), (3.0, 2.0)), strict=True):
        values[:-1], values[-1] = track, outcome
    monkeypatch.setattr(comparison, "residual", lambda _: residual)
    assert _left(comparison, (), comparison.nominal_paths) == pytest.approx(
        counts[1] * log(9.0) + comparison.alike * log(4.0)
    )


def test_the_headline_says_that_what_would_close_the_gap_follows_nothing() -> None:
    ranking = (replace(made().ranking[0], gap=1.0), *made().ranking[1:])
    for share, nearer in ((0.05, "comes only 5 % nearer to"), (-0.2, "comes no nearer to"), (0.9, "too few trials")):
        left_out = (Failing("trials left out"),)
        gap = replace(made().gap, followed=share)
        diagnosis = made(verdict="unexplained", gap=gap, ranking=ranking, failings=left_out)
        assert nearer in headline(diagnosis)
        (far,) = (text for label, text in points(diagnosis) if label == "how far")
        assert ("by the sensor's noise alone" in far) == (share < LEAST_FOLLOWED)
    # Where the gap stays there is nothing to take back.
    stays = (replace(ranking[0], gap=7.0), *ranking[1:])
    diagnosis = made(verdict="unexplained", gap=replace(made().gap, followed=0.05), ranking=stays)
    assert "nearer" not in headline(diagnosis)
    assert not any("nearer" in text for _, text in points(diagnosis))


@pytest.mark.parametrize(("share", "verdict"), [(LEAST_FOLLOWED - 0.01, "unexplained"), (LEAST_FOLLOWED, "explained")])
def test_what_is_not_followed_is_not_explained(share: float, verdict: str, monkeypatch: pytest.MonkeyPatch) -> None:
    dataset = measure(plan(PLANS[:3]), (MagnetizationStrength(factor=0.7),))
    monkeypatch.setitem(Conclusion.stands.__globals__, "followed", lambda _fitter, _contender: share)
    found = diagnose(dataset, effects=["magnetization_strength"])
    assert found.verdict == verdict
    assert [effect.name for effect in found.effects] == ["magnetization_strength"]
    assert found.gap.followed == share
    assert found.failings == ((Failing("the path"),) if verdict == "unexplained" else ())
    assert json.loads(found.to_json())["gap"]["followed"] == share


def test_what_is_not_foretold_is_told_as_that(monkeypatch: pytest.MonkeyPatch) -> None:
    dataset = measure(plan(PLANS[:3]), (MagnetizationStrength(factor=0.7),))
    monkeypatch.setattr(Conclusion, "foretold", lambda _self, _contender: False)
    found = diagnose(dataset, effects=["magnetization_strength"])
    assert found.verdict == "unexplained"
    assert found.failings == (Failing("trials left out"),)


def test_without_effects_nothing_is_followed() -> None:
    found = diagnose(measure(plan(PLANS[:3])), effects=["magnetization_strength"])
    assert found.verdict == "no_gap"
    assert found.gap.followed is None
