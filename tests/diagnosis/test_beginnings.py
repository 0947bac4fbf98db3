"""Fits that find their way over the beginnings of the trials."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tumblers.diagnosis.fitting.fitter import Fitter
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.what.beginnings import from_beginnings, from_its_own_beginning, promise
from tumblers.diagnosis.what.contender import of_fit
from tumblers.diagnosis.what.margins import CLEAR, NEAR
from tumblers.diagnosis.what.own_noise import settled_at
from tumblers.diagnosis.what.search import Search
from tumblers.effects.magnetization_strength import MagnetizationStrength
from tumblers.effects.surface_roughness import SurfaceRoughness

from .lab import PLANS, measure, plan, quiet


def test_the_wavelength_of_a_roughness_is_found_from_the_beginnings() -> None:
    # Heights of one wavelength tell nothing of another: no fit from the middle of the range finds its way.
    truth = SurfaceRoughness(wavelength_m=4e-3, cosine_m=(-5e-7, 1e-6, 2e-6), sine_m=(2e-7, -1e-6, -2e-6))
    dataset = measure(plan(PLANS[:2], duration_s=1.2), (truth,))
    comparison = Comparison(dataset, Simulator(dataset))
    fitter = Fitter(comparison)
    search = Search(fitter, [SurfaceRoughness], quiet, 0)
    (hypothesis,) = search.possible
    astray = of_fit(fitter, fitter.fit(hypothesis, hypothesis.starts[-1], evaluations=2))
    found = from_beginnings(fitter, astray, search.possible, 0)
    assert found.total < astray.total - 200.0
    (effect,) = found.effects
    assert isinstance(effect, SurfaceRoughness)
    assert effect.wavelength_m == pytest.approx(truth.wavelength_m, rel=0.02)
    assert_allclose(effect.sine_m, truth.sine_m, atol=5e-7)


def test_a_steep_relief_is_followed_farther_from_steep_ones_than_from_shallow_ones() -> None:
    truth = SurfaceRoughness(wavelength_m=2.91e-3, cosine_m=(2e-5, 3.9e-6, -4e-6), sine_m=(-9.7e-6, -1.15e-5, -1.21e-5))
    dataset = measure(plan(PLANS[:2], duration_s=0.8), (truth,))
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    (hypothesis,) = Search(fitter, [SurfaceRoughness], quiet, 0).possible
    astray = of_fit(fitter, fitter.fit(hypothesis, hypothesis.starts[2], evaluations=2))
    # The first amplitude of the sine is all that the shallow ones have.
    others = np.delete(hypothesis.close, 4, axis=1)[:, 1:]
    shallow = replace(hypothesis, close=hypothesis.close[~others.any(axis=1)])
    assert 10 < len(shallow.close) < 20
    left, found = (from_beginnings(fitter, astray, [h], 0).total for h in (shallow, hypothesis))
    # By far more than what a fit that is rough stops short of (`NEAR`).
    assert found < left - NEAR


def test_a_wavelength_that_is_a_little_off_finds_its_way_over_the_beginnings_and_not_over_whole_trials() -> None:
    truth = SurfaceRoughness(wavelength_m=1.5e-3, cosine_m=(0.0, 1e-6, 4e-6), sine_m=(0.0, -4e-6, -2e-6))
    off = replace(truth, wavelength_m=1.02 * truth.wavelength_m)
    dataset = measure(plan(PLANS[:2], duration_s=1.2), (truth,))
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    (hypothesis,) = Search(fitter, [SurfaceRoughness], quiet, 0).possible
    start = (off.to_fit(off.vector()) - hypothesis.neutral) / hypothesis.scale
    stuck = settled_at(fitter, hypothesis, start, evaluations=8)
    found = from_its_own_beginning(fitter, stuck)
    wavelengths = [
        effect.wavelength_m for c in (stuck, found) for effect in c.effects if hasattr(effect, "wavelength_m")
    ]
    # The fit to whole trials stays where it started; the other ends at the truth, and with half of the objective.
    assert wavelengths[0] == pytest.approx(off.wavelength_m, rel=0.005)
    assert wavelengths[1] == pytest.approx(truth.wavelength_m, rel=0.005)
    assert found.total < 0.7 * stuck.total


def test_an_effect_promises_something_where_it_is_not_yet_where_it_should_be() -> None:
    truth = MagnetizationStrength(factor=0.7)
    dataset = measure(plan(PLANS[:2]), (truth,))
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    (hypothesis,) = Search(fitter, [MagnetizationStrength], quiet, 0).possible
    (there,) = (truth.vector()[0] - hypothesis.neutral) / hypothesis.scale
    idle, right = (of_fit(fitter, fitter.fit(hypothesis, np.array([u]), evaluations=1)) for u in (0.0, there))
    assert promise(fitter, idle, 0) > CLEAR
    assert promise(fitter, right, 0) < 0.0
