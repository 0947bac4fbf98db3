"""The native fit of the sensor's nuisances against the plain one, on paths that are near, far and not there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.diagnosis.lab import measure, plan, without
from tumblers.dataset import Dataset, Outcome
from tumblers.diagnosis.comparison import Comparison
from tumblers.diagnosis.floor import SHARED
from tumblers.diagnosis.simulator import Job, Simulator
from tumblers.effects import get
from tumblers.effects.base import Effect

from .nuisances import PlainFit

# Both solve the same small systems; what differs is the order of sums.
AGREE = 1e-9


def off() -> Dataset:
    """Return trials of a sensor that is off in every way, with lost frames and outcomes of every kind."""
    dataset = measure(plan(), seed=8, clock_frames=0.4, origin_m=3e-5, heading_deg=1.2, scale=1.003)
    dataset = without(dataset, "f05", slice(5, 9))
    way = Outcome(climbs=True, mean_speed_m_per_s=2e-3, sigma_m_per_s=1e-4)
    first, second, *others, still = dataset.trials
    trials = (replace(first, outcome=way), replace(second, track=None, outcome=way), *others)
    return replace(dataset, trials=(*trials, replace(still, outcome=Outcome(tilt_deg=3.0, sigma_deg=1.0))))


def turned() -> Dataset:
    """Return trials in which the camera saw whole orientations."""
    return measure(plan(), seed=9, heading_deg=-1.0, quaternions=True)


CASES: dict[str, tuple[Effect, ...]] = {
    "near": (),
    "far": (get("friction_coefficient").from_vector((0.3,)),),
    "camera": (get("camera_calibration").from_vector((1.1, 20.0)),),
}


@pytest.mark.parametrize("lab", [off, turned])
@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("held", [False, True])
def test_the_native_fit_of_nuisances_is_the_plain_one(lab, case: str, held: bool) -> None:
    comparison = Comparison(lab(), Simulator(lab(), 1))
    trials = range(len(comparison.readers))
    paths = comparison.simulator.run([Job(i, CASES[case]) for i in trials])
    tolerance = np.linspace(-0.5, 0.5, SHARED) if held else None
    missing = [None, *paths[1:]]
    for run, train in ((paths, trials), (paths, trials[:2]), (missing, trials)):
        found = comparison.residual(run, train, tolerance=tolerance)
        wrong, local, shared = PlainFit(comparison, run).residual(train, tolerance)
        assert_allclose(found.local, local, rtol=AGREE, atol=AGREE * np.abs(local).max())
        assert_allclose(found.camera, shared[:2], rtol=AGREE, atol=AGREE * np.abs(shared).max())
        assert_allclose(found.tolerance, shared[2:], rtol=AGREE, atol=AGREE)
        for native, plain in zip(found.trials, wrong, strict=True):
            if plain is not None:
                assert_allclose(native, plain, rtol=AGREE, atol=AGREE * max(np.abs(plain).max(initial=0.0), 1.0))
        assert (wrong[0] is None) == (run[0] is None)


def test_a_batch_is_its_runs_one_by_one_on_any_number_of_threads() -> None:
    dataset = off()
    alone, many = (Comparison(dataset, Simulator(dataset, threads)) for threads in (1, 3))
    runs = [alone.simulator.run([Job(i, effects) for i in range(len(alone.readers))]) for effects in CASES.values()]
    for found, run in zip(many.residuals(runs), runs, strict=True):
        one = alone.residual(run)
        assert all(np.array_equal(a, b) for a, b in zip(found.trials, one.trials, strict=True))
        assert np.array_equal(found.prior, one.prior)
