"""Pairs of effects, and the firsts from which they are made."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tumblers.diagnosis.fitting.fitter import Fitter
from tumblers.diagnosis.fitting.hypothesis import Hypothesis
from tumblers.diagnosis.gap.comparison import Comparison, Residual
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.what.contender import of_fit, of_nominal
from tumblers.diagnosis.what.margins import CLEAR
from tumblers.diagnosis.what.own_noise import settled_at
from tumblers.diagnosis.what.pairs import Pairs, _lines, firsts, nested
from tumblers.effects.base import Effect
from tumblers.effects.friction_coefficient import FrictionCoefficient
from tumblers.effects.magnetization_strength import MagnetizationStrength
from tumblers.effects.size_error import SizeError
from tumblers.effects.surface_roughness import SurfaceRoughness
from tumblers.effects.viscous_drag import ViscousDrag

from .lab import LYING, coarse_lab, measure, plan


@pytest.mark.parametrize("log_determinant", [0.0, -900.0])
def test_the_best_is_always_a_first_and_what_is_far_behind_is_not(log_determinant: float) -> None:
    dataset = measure(plan(LYING))
    nominal = of_nominal(Fitter(Comparison(dataset, Simulator(dataset))))
    costs = (400.0, 580.0, 620.0)
    contenders = [replace(nominal, cost=cost, log_determinant=log_determinant) for cost in costs]
    assert [contender.cost for contender in firsts(contenders)] == [400.0, 580.0]


def test_a_first_of_a_pair_is_held_against_its_own_noise(monkeypatch: pytest.MonkeyPatch) -> None:
    fitter = coarse_lab(SizeError(length_factor=1.03))
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


def test_an_effect_alone_is_fitted_as_far_as_in_a_pair() -> None:
    fitter = coarse_lab(SizeError(length_factor=1.1))
    size, friction = (
        Hypothesis.of(kind, [fitter.comparison.simulator.nominal(i) for i in fitter.trials])
        for kind in (SizeError, FrictionCoefficient)
    )
    there = (np.array(SizeError(length_factor=1.1).to_fit((1.1, 1.0))) - size.neutral) / size.scale
    pair = settled_at(fitter, size + friction, np.concatenate([there, np.zeros(2)]))
    stopped = settled_at(fitter, size, 0.9 * there)
    other = settled_at(fitter, friction, np.zeros(2))
    clear = fitter.comparison.objective_of(CLEAR)
    assert pair.total < stopped.total - 2.0 * clear
    found = nested(fitter, stopped, [pair])
    assert found.settled
    assert found.total < pair.total + clear
    # What the pair has not, what it does better than by too little, and what is in no pair stays.
    assert nested(fitter, other, [replace(pair, names=("size_error", "substrate_tilt"))]) is other
    assert nested(fitter, found, [pair]) is found
    assert nested(fitter, stopped, []) is stopped


def test_two_are_joined_from_all_and_from_halves_of_what_either_is_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    fitter = coarse_lab(SizeError(length_factor=1.1))
    fitter.take_likeliest_noise(())
    size, rough = (
        Hypothesis.of(kind, [fitter.comparison.simulator.nominal(i) for i in fitter.trials])
        for kind in (SizeError, SurfaceRoughness)
    )
    relief = [0.3, 0.0, 0.0, 0.0, 0.04, 0.0, -0.02]
    singles = [
        of_fit(fitter, fitter.fit(h, point, evaluations=1))
        for h, point in ((size, np.array([0.4, 0.0])), (rough, np.array(relief)))
    ]
    tried: list[list[float]] = []
    started: list[list[float]] = []
    residuals, fit = Fitter.residuals, Fitter.fit

    def noted(self: Fitter, hypothesis: Hypothesis, points: Any, *rest: Any) -> Any:
        if len(hypothesis.names) == 2 and not started:
            tried.extend(point.tolist() for point in points)
        return residuals(self, hypothesis, points, *rest)

    def begun(self: Fitter, hypothesis: Hypothesis, start: Any, *rest: Any, **more: Any) -> Any:
        started.append(start.tolist())
        return fit(self, hypothesis, start, *rest, **more)

    monkeypatch.setattr(Fitter, "residuals", noted)
    monkeypatch.setattr(Fitter, "fit", begun)
    pairs = Pairs(fitter, [size, rough], {})
    pairs.join(singles)
    # Half of a relief has the same wavelength.
    half = [0.3, 0.0, 0.0, 0.0, 0.02, 0.0, -0.01]
    assert tried == [[0.4, 0.0, *relief], [0.4, 0.0, *half], [0.2, 0.0, *relief], [0.2, 0.0, *half]]
    # The best of them is fitted on.
    (pair,) = pairs.likeliest_first()
    joined, whole = size + rough, fitter.trials
    costs = [fitter.cost(fitter.residuals(joined, [np.array(p)])[0], np.array(p), whole) for p in tried]
    assert started == [tried[int(np.argmin(costs))]]
    assert pair.cost <= min(costs)


@pytest.mark.parametrize(
    ("kind", "ends"), [(FrictionCoefficient, 4), (MagnetizationStrength, 2), (ViscousDrag, 1), (SizeError, 0)]
)
def test_what_may_stand_in_anothers_place_is_looked_for_over_the_range_of_its_one_strength_and_its_form(
    kind: type[Effect], ends: int
) -> None:
    hypothesis = Hypothesis.of(kind, [Simulator(plan()).nominal(0)])
    points = _lines(hypothesis)
    assert len(points) == 7 * ends
    assert all(np.sum(point != 0.0) == 1 for point in points)
    assert all(np.all((hypothesis.low <= point) & (point <= hypothesis.high)) for point in points)
