"""The Gaussian that draws of a posterior start from."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import minimize_scalar

from tumblers.diagnosis.fitting.fit import Fit
from tumblers.diagnosis.fitting.hypothesis import Hypothesis
from tumblers.diagnosis.what_next.posterior import _needed
from tumblers.effects.friction_coefficient import FrictionCoefficient

from .lab import NOTHING, coarse_lab

DISPERSION, NUMBERS = 2.0, 350.0


def fit_at(point: list[float]) -> Fit:
    fitter = coarse_lab()
    hypothesis = Hypothesis.of(FrictionCoefficient, [fitter.comparison.simulator.nominal(i) for i in fitter.trials])
    slopes = np.array([[30.0, 12.0], [0.0, 20.0], [5.0, -4.0]])
    return Fit(hypothesis, np.array(point), NOTHING, 0.0, slopes, np.full(2, 0.01))


def test_what_nothing_asks_for_is_neutral_and_the_rest_makes_up_for_it() -> None:
    fit = fit_at([0.2, 0.03])
    hypothesis, middle, covariance = _needed(fit, DISPERSION, NUMBERS)
    assert hypothesis.free == 1
    assert middle[1] == 0.0
    information = fit.information(DISPERSION)

    def away(strength: float) -> float:
        apart = np.array([strength, 0.0]) - fit.point
        return float(apart @ information @ apart)

    assert middle[0] == pytest.approx(minimize_scalar(away).x, rel=1e-6)
    assert middle[0] != pytest.approx(0.2, abs=1e-3)
    assert_allclose(covariance, [[1.0 / information[0, 0]]], rtol=1e-12)


def test_what_the_data_ask_for_stays() -> None:
    fit = fit_at([0.2, 0.6])
    hypothesis, middle, covariance = _needed(fit, DISPERSION, NUMBERS)
    assert hypothesis.free == 2
    assert_allclose(middle, fit.point, rtol=1e-12)
    assert_allclose(covariance, fit.covariance(DISPERSION), rtol=1e-10)
