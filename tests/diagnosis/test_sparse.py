"""Fits taken as far as they go: without what is not needed, and on a line."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tumblers.diagnosis.fitting.fitter import Fitter
from tumblers.diagnosis.fitting.hypothesis import Hypothesis
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.what.contender import Contender, of_fit
from tumblers.diagnosis.what.margins import CLEAR
from tumblers.diagnosis.what.occam import unneeded
from tumblers.diagnosis.what.own_noise import POLISH_POINTS, by_itself, settled_at
from tumblers.diagnosis.what.pairs import Pairs
from tumblers.diagnosis.what.sparse import as_far
from tumblers.effects.base import Effect
from tumblers.effects.contact_compliance import ContactCompliance
from tumblers.effects.magnetization_strength import MagnetizationStrength
from tumblers.effects.size_error import SizeError
from tumblers.effects.stray_field_gradient import StrayFieldGradient
from tumblers.effects.substrate_tilt import SubstrateTilt
from tumblers.effects.viscous_drag import ViscousDrag

from .lab import PLANS, measure, plan


def ready(*truth: Effect) -> Fitter:
    """Return a dataset with effects."""
    dataset = measure(plan(PLANS[:2]), truth, seed=3)
    return Fitter(Comparison(dataset, Simulator(dataset)))


def hypothesis_of(fitter: Fitter, *kinds: type[Effect]) -> Hypothesis:
    """Return the hypothesis of some effects."""
    scenarios = [fitter.comparison.simulator.nominal(i) for i in fitter.trials]
    first, *more = [Hypothesis.of(kind, scenarios) for kind in kinds]
    return sum(more, start=first)


def at(fitter: Fitter, *effects: Effect) -> Contender:
    """Return effects as they are as a contender, settled."""
    hypothesis = hypothesis_of(fitter, *(type(effect) for effect in effects))
    values = np.concatenate([effect.to_fit(effect.vector()) for effect in effects])
    return settled_at(fitter, hypothesis, (values - hypothesis.neutral) / hypothesis.scale)


def test_what_is_not_needed_is_neutral_and_the_rest_is_fitted_farther() -> None:
    truth = StrayFieldGradient(gradient_T_per_m=(0.0, 0.1, 0.0))
    fitter = ready(truth)
    stopped = at(fitter, StrayFieldGradient(gradient_T_per_m=(5e-4, 0.104, -4e-4), frequency_exponent=0.02))
    found = as_far(fitter, stopped, fitter.comparison.alike)
    assert found.total < stopped.total
    (gradient,) = found.effects
    assert isinstance(gradient, StrayFieldGradient)
    assert gradient.gradient_T_per_m[0] == gradient.gradient_T_per_m[2] == 0.0
    # Likelier than the truth itself, as a fit is; and from the truth it ends about as well.
    assert found.total < at(fitter, truth).total
    clear = fitter.comparison.objective_of(CLEAR)
    assert found.total == pytest.approx(as_far(fitter, at(fitter, truth), fitter.comparison.alike).total, abs=clear)


def test_what_is_needed_stays() -> None:
    fitter = ready(SubstrateTilt(slope_x_deg=3.0, slope_y_deg=5.0))
    fitted = by_itself(fitter, at(fitter, SubstrateTilt(slope_x_deg=2.5, slope_y_deg=5.5)), POLISH_POINTS)
    assert fitted.fit is not None
    assert not unneeded(fitted.fit, fitter.comparison.alike, fitter.comparison.independent).any()
    (tilt,) = as_far(fitter, fitted, fitter.comparison.alike).effects
    assert isinstance(tilt, SubstrateTilt)
    assert min(tilt.slope_x_deg, tilt.slope_y_deg) > 2.0


def test_one_parameter_is_looked_for_on_its_line() -> None:
    fitter = ready(MagnetizationStrength(factor=0.8))
    stopped = at(fitter, MagnetizationStrength(factor=0.75))
    # As a search leaves it that has not held it against its own noise.
    assert stopped.fit is not None
    found = as_far(fitter, replace(of_fit(fitter, stopped.fit), settled=False), fitter.comparison.alike)
    assert found.settled
    # Farther than least squares go, which do not see that the noise changes.
    assert found.total < by_itself(fitter, stopped, POLISH_POINTS).total
    assert found.fit is not None
    # Its own noise is what it is held against.
    assert found.total == pytest.approx(settled_at(fitter, found.fit.hypothesis, found.point).total)


def test_what_stands_in_anothers_place_is_exchanged_with_the_other_held() -> None:
    size, tilt = SizeError(length_factor=1.1), SubstrateTilt(slope_y_deg=6.0)
    fitter = ready(size, tilt)
    kinds: list[type[Effect]] = [SizeError, SubstrateTilt, ViscousDrag, ContactCompliance]
    possible = [hypothesis_of(fitter, kind) for kind in kinds]
    wrong = at(fitter, size, ViscousDrag(viscosity_Pa_s=2e-3))
    singles = [at(fitter, kind.from_vector(kind.starts(fitter.comparison.simulator.nominal(0))[0])) for kind in kinds]
    pairs = Pairs(fitter, possible, {}, [wrong])
    pairs.exchange(wrong, ViscousDrag, singles)
    best = pairs.likeliest_first()[0]
    assert set(best.names) == {"size_error", "substrate_tilt"}
    assert best.total < wrong.total - 500.0
    (found,) = [effect for effect in best.effects if isinstance(effect, SubstrateTilt)]
    assert found.slope_y_deg == pytest.approx(6.0, abs=1.0)
