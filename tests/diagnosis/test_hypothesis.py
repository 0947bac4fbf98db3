"""How a hypothesis is a point: the coordinates of a fit."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, ClassVar

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tumblers.diagnosis.fitting.descent import _MOST_STEP
from tumblers.diagnosis.fitting.hypothesis import Hypothesis
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.effects.base import Effect
from tumblers.effects.catalogue import CATALOGUE
from tumblers.effects.field_rolloff import FieldRolloff
from tumblers.effects.friction_coefficient import FrictionCoefficient
from tumblers.effects.magnetization_misalignment import MagnetizationMisalignment
from tumblers.effects.size_error import SizeError
from tumblers.effects.stray_field_gradient import StrayFieldGradient
from tumblers.effects.surface_roughness import SurfaceRoughness
from tumblers.errors import EffectError, InputError
from tumblers.scenario import Scenario

from .lab import UPWARDS, plan


@pytest.mark.parametrize("name", CATALOGUE)
def test_the_coordinates_of_a_fit_are_the_parameters_again(name: str) -> None:
    kind = CATALOGUE[name]
    scenario = Simulator(plan()).nominal(0)
    for start in kind.starts(scenario):
        assert_allclose(kind.from_fit(kind.to_fit(start)), start, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("name", CATALOGUE)
def test_neutral_is_neutral_to_the_last_bit_in_the_coordinates_of_a_fit(name: str) -> None:
    hypothesis = Hypothesis.of(CATALOGUE[name], [Simulator(plan()).nominal(0)])
    (effect,) = hypothesis.effects(np.zeros(len(hypothesis.neutral)))
    assert effect.is_neutral()


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


def test_a_pull_stays_in_a_field_at_rest_until_it_grows_with_the_frequency() -> None:
    still, turning = (Simulator(plan()).nominal(i) for i in (4, 0))
    hypothesis = Hypothesis.of(StrayFieldGradient, [still, turning])

    def pull(scenario: Scenario, power: float) -> float:
        (effect,) = hypothesis.effects([0.5, 0.0, 0.0, power])
        return effect.edit(scenario).surroundings.force_N[0]

    # Least squares keep off the ends of a range by a hair, and their derivatives take steps.
    for power in (1e-10, 1e-3, _MOST_STEP):
        assert pull(still, power) == pull(still, 0.0) > 0.0
        assert pull(turning, power) == pull(turning, 0.0)
        assert hypothesis.rests(np.array([0.5, 0.0, 0.0, power])).tolist() == [False, False, False, True]
    assert not hypothesis.rests(np.array([0.5, 0.0, 0.0, 0.2])).any()
    assert not hypothesis.rests(hypothesis.high).any()
    assert pull(still, 0.2) == 0.0
    powers = [pull(turning, power) for power in np.linspace(0.1, 1.0, 50)]
    assert np.all(np.diff(powers) < 0.0)
    assert powers[-1] == pytest.approx(pull(turning, 0.0) * 0.2**3)


class _Odd(FrictionCoefficient):
    """A user's own that says of its ranges and starts what it is told to."""

    said: ClassVar[dict[str, Any]] = {}

    @classmethod
    def ranges(cls, scenario: Scenario) -> tuple[tuple[float, float], ...]:
        found = cls.said.get("ranges", super().ranges(scenario))
        if isinstance(found, Exception):
            raise found
        return found  # type: ignore[no-any-return]

    @classmethod
    def starts(cls, scenario: Scenario) -> tuple[tuple[float, ...], ...]:
        return cls.said.get("starts", super().starts(scenario))  # type: ignore[no-any-return]


@pytest.mark.parametrize(
    ("said", "message"),
    [
        ({"ranges": ZeroDivisionError("no weight")}, "ranges or starts failed with ZeroDivisionError: no weight"),
        ({"ranges": ((0.5, 1.5),)}, "ranges or starts failed with ValueError"),
        ({"starts": ((0.9, 0.0, 0.0),)}, "ranges or starts failed with ValueError"),
        ({"starts": None}, "ranges or starts failed with TypeError"),
        ({"ranges": InputError("friction", "-1", "a friction")}, "ranges or starts failed with InputError: friction"),
        ({"starts": ((0.9, 0.0),), "ranges": ((0.5,), (0.0,))}, "ranges or starts failed with ValueError"),
    ],
)
def test_ranges_and_starts_that_fail_are_said_to(
    said: dict[str, Any], message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_Odd, "said", said)
    with pytest.raises(EffectError, match=f"friction_coefficient: its {message}") as error:
        Hypothesis.of(_Odd, [Simulator(plan()).nominal(0)])
    assert "\n" not in str(error.value)


def test_what_changes_no_trial_has_no_start() -> None:
    slippery = replace(plan(), substrate=replace(plan().substrate, friction_coefficient=0.0))
    still = plan((("still", UPWARDS, 0.0),))
    for dataset, idle in ((slippery, FrictionCoefficient), (still, FieldRolloff)):
        scenarios = [Simulator(dataset).nominal(i) for i in range(len(dataset.trials))]
        assert not len(Hypothesis.of(idle, scenarios).starts)
        assert len(Hypothesis.of(SizeError, scenarios).starts)
    # One trial that it changes is enough.
    simulator = Simulator(plan())
    both = [simulator.nominal(4), simulator.nominal(0)]
    assert len(Hypothesis.of(FieldRolloff, both).starts) == len(FieldRolloff.starts(both[1]))


def test_what_is_weaker_keeps_its_wavelength_its_exponent_and_its_way() -> None:
    scenario = Simulator(plan()).nominal(0)
    rough, gradient, magnet = (
        Hypothesis.of(kind, [scenario]) for kind in (SurfaceRoughness, StrayFieldGradient, MagnetizationMisalignment)
    )
    assert_allclose(rough.weakened(np.full(7, 0.4), 0.5), [0.4, *[0.2] * 6])
    weaker = gradient.weakened(np.full(4, 0.4), 0.5)
    assert_allclose(weaker, [0.2, 0.2, 0.2, 0.4])
    # An angle about the axis is no coordinate of its own.
    full, half = (magnet.values(point) for point in (np.array([0.2, 0.1]), magnet.weakened(np.array([0.2, 0.1]), 0.5)))
    assert_allclose(half, [0.5 * full[0], full[1]], rtol=1e-9)
    joined = Hypothesis.of(SizeError, [scenario]) + rough
    assert_allclose(joined.weakened(np.full(9, 0.4), 0.5), [0.2, 0.2, 0.4, *[0.2] * 6])


def test_a_form_is_no_strength() -> None:
    scenario = Simulator(plan()).nominal(0)
    friction, gradient = (Hypothesis.of(kind, [scenario]) for kind in (FrictionCoefficient, StrayFieldGradient))
    assert (friction.free, friction.strengths) == (2, 1)
    assert (gradient.free, gradient.strengths) == (4, 4)
    assert (friction + gradient).strengths == 5
    assert friction.held(np.array([True, False])).strengths == 0
