"""The beginning of a trial is compared as in the whole, and what comes later says nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.testing import assert_allclose, assert_array_equal

from tumblers.dataset import Dataset, LabTrial, Track
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.floor import SHARED
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.gap.stretch import Stretch

from .lab import PLANS, measure, plan, without

SHARE = 0.5
DURATION_S = 0.4


def compared(dataset: Dataset) -> Comparison:
    return Comparison(dataset, Simulator(dataset, 1))


def seen() -> Dataset:
    """Return trials of which one has lost frames, and one an outcome beside its track."""
    dataset = without(measure(plan(PLANS[:2], duration_s=DURATION_S), heading_deg=1.0), "f02", slice(3, 6))
    trials = (dataset.trials[0], replace(dataset.trials[1], outcome=plan(PLANS[:2]).trials[1].outcome))
    return replace(dataset, trials=trials)


def carried_off(trial: LabTrial) -> LabTrial:
    """Return a trial whose robot is a centimetre off in the second half."""
    assert trial.track is not None
    columns = {name: np.array(values) for name, values in trial.track.channels.items()}
    columns["y_m"][trial.track.time_s > SHARE * DURATION_S] += 1e-2
    return replace(trial, track=Track(time_s=trial.track.time_s, channels=columns))


def test_a_beginning_is_compared_as_in_the_whole() -> None:
    comparison = compared(seen())
    local, shared = np.array([1e-3, 2e-6, -3e-6, 4e-6]), np.zeros(2 + SHARED)
    shared[:3] = 1e-3, 1e-3, 0.5
    for reader, floor, path in zip(comparison.readers, comparison.floors, comparison.nominal_paths, strict=True):
        assert path is not None
        whole = Stretch.whole(reader, floor).whitened(path, local, shared)
        stretch = Stretch.beginning(reader, floor, SHARE * DURATION_S)
        begun = stretch.whitened(path, local, shared)
        assert 0 < stretch.counts.sum() < floor.tracked
        assert_allclose(begun[stretch.counts], whole[stretch.counts], rtol=1e-9, atol=1e-12)
        assert_array_equal(begun[~stretch.counts], 0.0)
        assert not stretch.floor.outcome_scale


def test_what_comes_later_does_not_move_the_nuisances() -> None:
    dataset = seen()
    later = replace(dataset, trials=tuple(carried_off(trial) for trial in dataset.trials))
    one, other = (
        comparison.residual(comparison.nominal_paths, share=SHARE) for comparison in map(compared, (dataset, later))
    )
    assert np.any(one.camera)
    # Sums of the same numbers in another place of memory may differ by a rounding.
    assert_allclose(one.prior, other.prior, rtol=1e-9, atol=1e-12)
    assert_allclose(one.over((0, 1)), other.over((0, 1)), rtol=1e-9, atol=1e-12)


def test_before_the_first_frame_there_is_nothing_to_compare() -> None:
    comparison = compared(seen())
    residual = comparison.residual(comparison.nominal_paths, share=1e-6)
    assert not np.any(residual.over((0, 1)))
    assert not np.any(residual.prior)


def test_the_beginning_of_a_trial_without_frames_leaves_the_others_as_they_are() -> None:
    alone = seen()
    lost = replace(without(alone, "f02", slice(None)).trials[0], id="lost")
    noted = replace(plan(PLANS[2:3], duration_s=DURATION_S).trials[0], id="noted")
    beside = replace(alone, trials=(lost, *alone.trials, noted))
    one, other = (
        comparison.residual(comparison.nominal_paths, share=SHARE) for comparison in map(compared, (alone, beside))
    )
    assert len(other.trials[0]) == 0
    # An outcome is of the whole trial: of a beginning it says nothing.
    assert_array_equal(other.trials[3], [0.0])
    assert_allclose(other.over((1, 2)), one.over((0, 1)), rtol=1e-9, atol=1e-12)
