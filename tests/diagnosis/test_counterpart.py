"""Where another effect does what one does, and that a search asks for it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from tumblers.diagnosis.fitting.fitter import Fitter
from tumblers.diagnosis.fitting.hypothesis import Hypothesis
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.what.contender import Contender, of_fit, of_nominal
from tumblers.diagnosis.what.counterpart import counterparts, with_counterparts
from tumblers.diagnosis.what.margins import CLEAR
from tumblers.diagnosis.what.own_noise import settled_at
from tumblers.diagnosis.what.search import Search
from tumblers.effects.base import Effect
from tumblers.effects.camera_calibration import CameraCalibration
from tumblers.effects.friction_anisotropy import FrictionAnisotropy
from tumblers.effects.friction_coefficient import FrictionCoefficient
from tumblers.effects.size_error import SizeError
from tumblers.effects.stray_field_gradient import StrayFieldGradient
from tumblers.effects.substrate_tilt import SubstrateTilt
from tumblers.field import StaticField

from .lab import PLANS, measure, plan

KINDS: list[type[Effect]] = [SubstrateTilt, StrayFieldGradient, SizeError, CameraCalibration, FrictionCoefficient]


def quiet(_phase: str, _done: int, _total: int) -> None:
    """Tell nobody."""


def _at(search: Search, *effects: Effect) -> Contender:
    """Return effects as they are as a contender."""
    first, *more = [next(h for h in search.possible if h.kinds == (type(effect),)) for effect in effects]
    hypothesis = sum(more, start=first)
    values = np.concatenate([effect.to_fit(effect.vector()) for effect in effects])
    return settled_at(search.fitter, hypothesis, (values - hypothesis.neutral) / hypothesis.scale)


def _search(*truth: Effect) -> Search:
    dataset = measure(plan(PLANS[:2]), truth, seed=3)
    return Search(Fitter(Comparison(dataset, Simulator(dataset))), KINDS, quiet, 0)


def test_a_tilt_has_its_counterpart_in_a_gradient_that_pulls_as_gravity_does() -> None:
    tilt = SubstrateTilt(slope_y_deg=6.0)
    search = _search(tilt)
    best = _at(search, tilt)
    found = counterparts(search.fitter, best, SubstrateTilt, search.possible)
    assert found[0].hypothesis.names == ("stray_field_gradient",)
    (gradient,) = found[0].hypothesis.effects(found[0].point)
    assert isinstance(gradient, StrayFieldGradient)
    robot = search.comparison.simulator.nominal(0).robot
    pull = robot.total_mass_kg * search.comparison.dataset.trials[0].gravity_m_per_s2 * np.sin(np.radians(6.0))
    # A positive slope raises +y. One linear step from neutral: of four draws of the noise all were within 4 %.
    moment = np.linalg.norm(robot.magnetic_moment_A_m2)
    assert gradient.gradient_T_per_m[1] == pytest.approx(-pull / moment, rel=0.1)
    # It takes most of what the tilt takes off the nominal model's objective.
    nominal = of_nominal(search.fitter).cost
    assert nominal - found[0].cost > 0.7 * (nominal - best.cost) > 100.0


def test_one_of_a_pair_is_exchanged_while_the_other_stays() -> None:
    truth = (SizeError(length_factor=1.1), SubstrateTilt(slope_y_deg=6.0))
    search = _search(*truth)
    best = _at(search, *truth)
    found = counterparts(search.fitter, best, SubstrateTilt, search.possible)
    assert found[0].hypothesis.names == ("size_error", "stray_field_gradient")
    assert found[0].point[0] == best.point[0]
    assert all("substrate_tilt" not in counterpart.hypothesis.names for counterpart in found)
    assert all(counterpart.hypothesis.names[0] == "size_error" for counterpart in found)
    # The first of them: the parameters of the other come before it then.
    swapped = counterparts(search.fitter, best, SizeError, search.possible)
    assert swapped
    for counterpart in swapped:
        assert counterpart.hypothesis.names[0] == "substrate_tilt"
        assert_array_equal(counterpart.point[:2], best.point[2:])


def test_a_counterpart_is_looked_for_along_each_parameter_alone_too() -> None:
    tilt = SubstrateTilt(slope_y_deg=6.0)
    search = _search(tilt)
    found = counterparts(search.fitter, _at(search, tilt), SubstrateTilt, search.possible)
    gradients = [c.point for c in found if c.hypothesis.names == ("stray_field_gradient",)]
    together, alone = sorted(gradients, key=np.count_nonzero, reverse=True)
    assert np.count_nonzero(together) > 1
    # Of its numbers the one along y does what the tilt does.
    assert np.flatnonzero(alone).tolist() == [1]


def test_what_does_the_same_as_a_weaker_effect_is_sought_in_its_own_form(monkeypatch: pytest.MonkeyPatch) -> None:
    truth = StrayFieldGradient(gradient_T_per_m=(0.0, 0.1, 0.0), frequency_exponent=1.0)
    search = _search(truth)
    best, seen = _at(search, truth), list[np.ndarray]()
    run = Fitter.residuals

    def noted(fitter: Fitter, hypothesis: Hypothesis, points: Sequence[Any], *rest: Any, **more: Any) -> Any:
        if hypothesis.names == best.names:
            seen.extend(points)
        return run(fitter, hypothesis, points, *rest, **more)

    monkeypatch.setattr(Fitter, "residuals", noted)
    counterparts(search.fitter, best, StrayFieldGradient, search.possible)
    along, exponent = 1, 3
    assert best.point[exponent] != 0.0
    weaker = [point for point in seen if 0.0 < abs(point[along]) < abs(best.point[along])]
    assert weaker
    assert all(point[exponent] == best.point[exponent] for point in weaker)


def test_a_search_keeps_what_does_the_same_better_than_the_best_does() -> None:
    truth = StrayFieldGradient(gradient_T_per_m=(0.0, 0.1, 0.0))
    search = _search(truth)
    tilt, gradient = _at(search, SubstrateTilt(slope_y_deg=-6.7)), _at(search, truth)
    assert gradient.fit is not None
    # As a search leaves it that went astray.
    idle = of_fit(search.fitter, search.fitter.again(replace(gradient.fit, point=0.02 * gradient.point)))
    made = with_counterparts(search.fitter, [tilt, idle], search.possible, quiet)
    gradient = next(contender for contender in made if contender.names == ("stray_field_gradient",))
    assert idle.total > tilt.total
    assert gradient.total < idle.total - 150.0


def test_a_search_asks_at_its_end_what_else_does_what_its_leader_does(monkeypatch: pytest.MonkeyPatch) -> None:
    search, asked = _search(SubstrateTilt(slope_y_deg=6.0)), []

    def spied(fitter: Fitter, contender: Contender, kind: type[Effect], possible: Sequence[Hypothesis]) -> Any:
        asked.append((contender.names, kind.name))
        return counterparts(fitter, contender, kind, possible)

    monkeypatch.setattr("tumblers.diagnosis.what.counterpart.counterparts", spied)
    found = {c.names: c.total for c in search.contenders()}
    # Which of the two leads is up to the noise: they do the same.
    same = ("substrate_tilt", "stray_field_gradient")
    assert any((name,) == names and name == kind for name in same for names, kind in asked)
    tilt, gradient = (found[name,] for name in same)
    assert abs(tilt - gradient) < search.comparison.objective_of(CLEAR)
    assert max(tilt, gradient) < found[()] - 100.0


def test_an_effect_of_one_strength_is_looked_for_far_away_though_another_leaves_no_gap() -> None:
    off = StaticField(strength_T=0.0, direction=(0.0, 1.0, 0.0))
    truth = FrictionCoefficient(factor=0.5)
    dataset = measure(plan((*PLANS[:2], PLANS[3], ("lying", off, 35.0))), (truth,), seed=3)
    search = Search(
        Fitter(Comparison(dataset, Simulator(dataset))), [FrictionAnisotropy, FrictionCoefficient], quiet, 0
    )
    best = _at(search, FrictionAnisotropy(e_t_factor=0.5, e_o_factor=0.5))
    hypothesis = next(h for h in search.possible if h.names == ("friction_coefficient",))
    search.fitter.take_likeliest_noise(())
    idle = of_fit(search.fitter, search.fitter.fit(hypothesis, np.zeros(2), evaluations=1))
    assert idle.effects[0].vector()[0] > 0.9
    made = search._elsewhere([best, idle], set())
    friction = next(contender for contender in made if contender.names == ("friction_coefficient",))
    (effect,) = friction.effects
    assert isinstance(effect, FrictionCoefficient)
    assert effect.factor == pytest.approx(0.5, rel=0.05)
