"""The native fit of the sensor's nuisances against the plain one, on paths that are near, far and not there."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from numpy.typing import NDArray

from tests.diagnosis.lab import folded, measure, plan, thinned, without
from tumblers.dataset import Dataset, Outcome
from tumblers.diagnosis.gap import built_floors
from tumblers.diagnosis.gap.comparison import Comparison, Residual
from tumblers.diagnosis.gap.floor import SHARED
from tumblers.diagnosis.gap.job import Job
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.effects import get
from tumblers.effects.base import Effect

from .nuisances import PlainFit

Floats = NDArray[np.float64]

# Both find the one least of the same small problems within bounds, by other ways to what is held; a gain of 1e-9 in the
# objective, which is flat to second order, is what the native one leaves at most.
AGREE = 1e-9
# What a number counts, in sigmas, of a trial that could not be run.
NOT_RUN = 30.0


def off() -> Dataset:
    """Return trials of a sensor that is off in every way, with lost frames and outcomes of every kind."""
    dataset = measure(plan(), seed=8, clock_frames=0.4, origin_m=3e-5, heading_deg=1.2, scale=1.003)
    dataset = replace(dataset, sensor=replace(dataset.sensor, z_origin_tolerance_m=4e-5))
    dataset = without(dataset, "f05", slice(5, 9))
    way = Outcome(climbs=True, mean_speed_m_per_s=2e-3, sigma_m_per_s=1e-4)
    first, second, *others, still = dataset.trials
    trials = (replace(first, outcome=way), replace(second, track=None, outcome=way), *others)
    return replace(dataset, trials=(*trials, replace(still, outcome=Outcome(tilt_deg=3.0, sigma_deg=1.0))))


def turned() -> Dataset:
    """Return trials in which the camera saw whole orientations."""
    return measure(plan(), seed=9, heading_deg=-1.0, quaternions=True)


def rigid() -> Dataset:
    """Return trials of a sensor that is stated to be perfect, one of them without any frame left."""
    dataset = without(off(), "f10", slice(None))
    sure = {
        "time_offset_s": 0.0,
        "origin_tolerance_m": 0.0,
        "z_origin_tolerance_m": 0.0,
        "heading_tolerance_deg": 0.0,
        "scale_tolerance": 0.0,
    }
    return replace(dataset, sensor=replace(dataset.sensor, **sure))


def sparse() -> Dataset:
    """Return trials in which every sixth frame was kept, by a clock that may be off by half of what is between them."""
    return thinned(off(), 6)


def ellipses() -> Dataset:
    """Return trials in which the camera did not know which end is which."""
    return folded(off(), -90.0)


CASES: dict[str, tuple[Effect, ...]] = {
    "near": (),
    "far": (get("friction_coefficient").from_vector((0.3, 0.0)),),
    "camera": (get("camera_calibration").from_vector((1.1, 20.0, 3e-4, -2e-4, 0.03)),),
}


def assert_same(native: Residual, plain: tuple[list[Floats | None], Floats, Floats]) -> None:
    wrong, local, shared = plain
    assert_allclose(native.local, local, rtol=AGREE, atol=AGREE * np.abs(local).max())
    assert_allclose(native.camera, shared[:2], rtol=AGREE, atol=AGREE * np.abs(shared).max())
    assert_allclose(native.tolerance, shared[2:], rtol=AGREE, atol=AGREE)
    for found, expected in zip(native.trials, wrong, strict=True):
        if expected is None:
            assert np.all(found == NOT_RUN)
        else:
            assert_allclose(found, expected, rtol=AGREE, atol=AGREE * max(np.abs(expected).max(initial=0.0), 1.0))


@pytest.mark.parametrize("lab", [off, turned, rigid, sparse, ellipses])
@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize(("held", "share"), [(False, 1.0), (True, 1.0), (False, 0.4)])
def test_the_native_fit_of_nuisances_is_the_plain_one(
    lab: Callable[[], Dataset], case: str, held: bool, share: float
) -> None:
    comparison = Comparison(lab(), Simulator(lab(), 1))
    trials = range(len(comparison.readers))
    paths = comparison.simulator.run([Job(i, CASES[case]) for i in trials])
    tolerance = np.linspace(-0.5, 0.5, SHARED) if held else None
    stretches = comparison._stretches(share)
    for run, train in ((paths, trials), (paths, trials[:2]), ([None, *paths[1:]], trials)):
        found = comparison.residual(run, train, share=share, tolerance=tolerance)
        assert_same(found, PlainFit(comparison, run, stretches).residual(train, tolerance))


def test_with_a_perfect_sensor_nothing_is_fitted() -> None:
    comparison = Comparison(off(), Simulator(off(), 1))
    paths = comparison.nominal_paths
    plain = PlainFit(comparison, paths, comparison._stretches(1.0))
    local, shared = np.zeros((len(paths), 4)), np.zeros(2 + SHARED)
    found = comparison.residual(paths, fit_nuisances=False)
    assert_same(found, (plain.whitened(local, shared), local, shared))


def test_a_floor_that_there_is_no_room_for_is_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(built_floors, "_MOST_KEPT", 0)
    comparison = Comparison(off(), Simulator(off(), 1))
    comparison.residual(comparison.nominal_paths)
    forgotten = [weakref.ref(floor) for floor in comparison.floors]
    comparison.take_noise_of((), shares=[0.5] * len(comparison.readers))
    gc.collect()
    assert not any(floor() for floor in forgotten)


def test_what_is_no_path_is_refused() -> None:
    comparison = Comparison(off(), Simulator(off(), 1))
    (stretch, *_), path = comparison._stretches(1.0), comparison.nominal_paths[0]
    assert path is not None
    (interval, clock, poses), outcomes = stretch.seen(path)
    local, shared = [0.0] * 4, [0.0] * (2 + SHARED)
    for run, words in (
        (((interval, clock, poses[:1]), outcomes), "1 poses"),
        (((0.0, clock, poses), outcomes), "0 s apart"),
        (((interval, float("nan"), poses), outcomes), "a path's clock"),
        (((interval, clock, poses[:, :6].copy()), outcomes), "6 numbers a row, expected 7"),
        (((interval, clock, np.asfortranarray(poses)), outcomes), "row after row"),
        (((interval, clock, poses), outcomes[:, :1].copy()), "1 numbers a row, expected 2"),
        (((interval, clock, poses), outcomes[:0]), "outcomes and shared have 0 and 11 numbers"),
        ((None, outcomes), "not run"),
    ):
        with pytest.raises(ValueError, match=words):
            stretch.native.whitened(run, local, shared)


def test_a_batch_is_its_runs_one_by_one_on_any_number_of_threads() -> None:
    dataset = off()
    alone, many = (Comparison(dataset, Simulator(dataset, threads)) for threads in (1, 3))
    runs = [alone.simulator.run([Job(i, effects) for i in range(len(alone.readers))]) for effects in CASES.values()]
    for found, run in zip(many.residuals(runs), runs, strict=True):
        one = alone.residual(run)
        assert all(np.array_equal(a, b) for a, b in zip(found.trials, one.trials, strict=True))
        assert np.array_equal(found.prior, one.prior)
