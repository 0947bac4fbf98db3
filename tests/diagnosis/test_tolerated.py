"""Effects that say what a nominal number's being off says too."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tumblers.dataset import Tolerance
from tumblers.diagnosis import diagnose
from tumblers.diagnosis.fitting.fitter import Fitter
from tumblers.diagnosis.fitting.hypothesis import Hypothesis
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.nominal_number import NUMBERS
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.quantity import sigmas
from tumblers.diagnosis.what.attribute import _may_be_tolerated, _with_tolerated
from tumblers.diagnosis.what.contender import of_fit, of_nominal
from tumblers.diagnosis.what.tolerated import _FACTORS, is_tolerated, tolerated
from tumblers.diagnosis.wording.headline import headline
from tumblers.effects import CATALOGUE
from tumblers.effects.base import Effect
from tumblers.effects.electrostatic_force import ElectrostaticForce
from tumblers.effects.friction_coefficient import FrictionCoefficient
from tumblers.effects.magnetization_strength import MagnetizationStrength
from tumblers.effects.size_error import SizeError
from tumblers.effects.substrate_tilt import SubstrateTilt

from .lab import coarse_lab, measure, plan

# Of moment, field and weight together 0.866 %, of which three.
MOMENT = 0.02598
# Of friction 0.5 %, of which three.
FRICTION = 0.015
# A hundredth of the attraction by paper, three times.
FORCE_N = 0.03 * plan().substrate.electrostatic_force_N


def test_every_factor_of_a_nominal_number_is_one() -> None:
    for name, numbers in _FACTORS.items():
        assert {*numbers} <= {parameter.key for parameter in CATALOGUE[name].parameters}
        assert {*numbers.values()} <= {*NUMBERS}


@pytest.mark.parametrize(
    ("effects", "tolerated"),
    [
        ((), False),
        ((MagnetizationStrength(factor=1.0 - 0.99 * MOMENT),), True),
        ((MagnetizationStrength(factor=1.0 - 1.01 * MOMENT),), False),
        ((ElectrostaticForce(added_force_N=0.99 * FORCE_N),), True),
        ((ElectrostaticForce(added_force_N=1.01 * FORCE_N),), False),
        ((SizeError(length_factor=1.002, height_factor=1.002),), True),
        ((SizeError(length_factor=1.002, height_factor=1.004),), False),
        ((FrictionCoefficient(factor=1.0 + 0.99 * FRICTION),), True),
        ((FrictionCoefficient(factor=1.0 + 0.99 * FRICTION, drift_per_s=1e-3),), False),
        ((SubstrateTilt(slope_x_deg=1e-3),), False),
        ((SubstrateTilt(slope_x_deg=1e-3), MagnetizationStrength(factor=1.001)), False),
    ],
)
def test_within_three_standard_deviations_of_a_number(effects: tuple[Effect, ...], tolerated: bool) -> None:
    assert is_tolerated(effects, plan()) == tolerated


def test_what_a_lab_knows_worse_may_be_off_by_more() -> None:
    lab = replace(plan(), tolerance=Tolerance(friction_coefficient=0.1))
    assert is_tolerated((FrictionCoefficient(factor=1.29),), lab)
    assert not is_tolerated((FrictionCoefficient(factor=1.31),), lab)
    assert not is_tolerated((MagnetizationStrength(factor=1.03),), lab)
    # A moment, a field and a weight that are hardly known leave a factor of more than the range has.
    hardly = replace(plan(), tolerance=Tolerance(magnetization=0.3, field_strength=0.3, mass=0.3))
    (factor,) = MagnetizationStrength.parameters
    assert tolerated(MagnetizationStrength, hardly) == ((factor.low, factor.high),)


@pytest.mark.parametrize(
    ("factor", "known_to", "verdict"),
    [
        (0.95, Tolerance(), "explained"),
        (0.95, Tolerance(magnetization=0.05), "no_gap"),
        (0.8, Tolerance(magnetization=0.05), "explained"),
    ],
)
def test_what_a_lab_states_to_know_its_magnet_to_says_what_is_a_gap(
    factor: float, known_to: Tolerance, verdict: str
) -> None:
    lab = replace(measure(plan(), (MagnetizationStrength(factor=factor),), seed=3), tolerance=known_to)
    found = diagnose(lab, effects=["magnetization_strength"])
    assert found.verdict == verdict
    # What the tolerance takes is no gap in what is said of it either.
    assert verdict != "no_gap" or sigmas(found.gap.after) in headline(found)
    assert [effect.name for effect in found.effects] == ["magnetization_strength"] * (verdict == "explained")


# By how many tolerances a moment is off in truth and by a fit, and the deviation that Laplace's Gaussian gives that:
# past a threshold it knows nothing, and the objective does.
@pytest.mark.parametrize(
    ("truth", "found", "deviation", "tolerated"),
    [(0.0, 1.5, 0.2, False), (0.0, 1.5, 0.4, True), (3.0, 3.0, 1.0, False), (3.0, 3.0, 1.5, False)],
)
def test_what_may_be_within_a_tolerance_is_the_nominal_model(
    truth: float, found: float, deviation: float, tolerated: bool
) -> None:
    dataset = measure(plan(), (MagnetizationStrength(factor=1.0 + truth * MOMENT),), seed=3)
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    scenarios = [fitter.comparison.simulator.nominal(i) for i in fitter.trials]
    hypothesis = Hypothesis.of(MagnetizationStrength, scenarios)
    off = 1.0 + found * MOMENT
    (low,), (high,) = (
        (np.array(MagnetizationStrength.to_fit((factor,))) - hypothesis.neutral) / hypothesis.scale
        for factor in (off, off + deviation * MOMENT)
    )
    fit = fitter.fit(hypothesis, np.array([low]), evaluations=1)
    fit = replace(fit, point=np.array([low]), jacobian=np.full((1, 1), 1.0 / (high - low)))
    effect = replace(of_fit(fitter, fit), log_evidence=5.0, probability=0.9)
    nominal = replace(of_nominal(fitter), probability=0.1)
    first, second = _with_tolerated(fitter, [effect, nominal], 1.0)
    if tolerated:
        assert (first.names, first.probability, first.log_evidence) == ((), 1.0, 5.0)
        assert second.probability == 0.0
    else:
        assert (first, second.probability) == (effect, 0.1)


@pytest.mark.parametrize(("rough", "tolerated"), [(3.0, True), (0.0, False)])
def test_a_point_within_tolerance_may_be_worse_by_what_evidence_may_be_off(
    rough: float, tolerated: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    fitter = coarse_lab()
    scenarios = [fitter.comparison.simulator.nominal(i) for i in fitter.trials]
    hypothesis = Hypothesis.of(MagnetizationStrength, scenarios)
    beyond = (np.array(MagnetizationStrength.to_fit((1.0 + 1.2 * MOMENT,))) - hypothesis.neutral) / hypothesis.scale
    fit = replace(fitter.fit(hypothesis, beyond, evaluations=1), point=beyond, jacobian=np.full((1, 1), 1e-3))
    monkeypatch.setattr(Comparison, "rough", rough)
    # At the end of the tolerance the objective is 6 higher, where 90 % of a Gaussian are within 2.7.
    monkeypatch.setattr(fitter, "again", lambda fit: replace(fit, cost=0.0))
    monkeypatch.setattr(fitter, "cost", lambda *_rest: 6.0)
    assert _may_be_tolerated(fitter, fit, 1.0) == tolerated


@pytest.mark.parametrize(("deviation", "tolerated"), [(0.02, True), (2e-3, False)])
def test_a_drift_that_the_data_allow_to_be_none_is_tolerated(deviation: float, tolerated: bool) -> None:
    dataset = measure(plan(), (), seed=3)
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    hypothesis = Hypothesis.of(FrictionCoefficient, [fitter.comparison.simulator.nominal(i) for i in fitter.trials])
    point = (np.array([1.0, 0.01]) - hypothesis.neutral) / hypothesis.scale
    fit = fitter.fit(hypothesis, point, evaluations=1)
    jacobian = np.diag(hypothesis.scale / (FRICTION, deviation))
    effect = replace(of_fit(fitter, replace(fit, point=point, jacobian=jacobian)), log_evidence=5.0, probability=0.9)
    nominal = replace(of_nominal(fitter), probability=0.1)
    first, second = _with_tolerated(fitter, [effect, nominal], 1.0)
    assert (first.names == ()) == tolerated
    assert (second.probability == 0.0) == tolerated
