from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tumblers.blind.law import Law
from tumblers.blind.outside import AmplifierDropout, PhaseJump, StickySpot
from tumblers.blind.view import channels_of
from tumblers.blind.world import watch
from tumblers.dataset import Dataset, Track
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.result import Region
from tumblers.diagnosis.where.localise import localise
from tumblers.diagnosis.where.onset import _evidence, _shared, begins_at_phase, begins_at_place, begins_at_time
from tumblers.effects import get
from tumblers.presets import drive

from .lab import ANGLE_NOISE_DEG, FRAMES_PER_SECOND, POSITION_NOISE_M, measure, plan

PLANNED = plan([(f"f{f:g}", drive(0.010, f), 0.0) for f in (2.0, 3.0, 5.0, 8.0)], duration_s=0.8)
LONGER = plan([(f"f{f:g}", drive(0.010, f), 0.0) for f in (1.5, 2.0, 3.0, 4.0, 5.0, 8.0)], duration_s=1.1)


def filmed(planned: Dataset, law: Law, *, seed: int, frames_per_second: float = FRAMES_PER_SECOND) -> Dataset:
    """Return the tracks of a world with a law of its own, with noise and every clock late by a third of a frame."""
    rng, trials = np.random.default_rng(seed), []
    simulator = Simulator(planned, 1)
    for i, trial in enumerate(planned.trials):
        time = np.arange(0.0, trial.duration_s - 0.02, 1.0 / frames_per_second)
        late = time + 0.3 / frames_per_second
        seen = channels_of(watch(simulator.nominal(i), [law], late, trial=i, solver="reduced").poses)
        names = {"x_m": POSITION_NOISE_M, "y_m": POSITION_NOISE_M, "z_m": POSITION_NOISE_M, "tilt_deg": ANGLE_NOISE_DEG}
        channels = {name: seen[name] + rng.normal(0.0, noise, len(time)) for name, noise in names.items()}
        trials.append(replace(trial, outcome=None, track=Track(time_s=time, channels=channels)))
    return replace(planned, trials=tuple(trials))


def compared(dataset: Dataset) -> Comparison:
    return Comparison(dataset, Simulator(dataset, 1))


def where(dataset: Dataset, axis: str) -> list[Region]:
    comparison = compared(dataset)
    regions, _ = localise(comparison, comparison.residual(comparison.nominal_paths), comparison.nominal_paths)
    return [region for region in regions if region.axis == axis]


def shared(region: Region, low: float, high: float) -> float:
    """Return intersection over union."""
    assert region.low is not None
    assert region.high is not None
    both = min(region.high, high) - max(region.low, low)
    return both / (max(region.high, high) - min(region.low, low))


def test_a_field_that_jumps_is_wrong_from_the_jump_on() -> None:
    (time,) = where(filmed(PLANNED, PhaseJump(size=0.08, time_s=0.35, forwards=-1.0), seed=1), "time_s")
    assert shared(time, 0.35, 0.8) > 0.85
    assert time.share_of_gap > 0.8


def test_a_trial_that_cannot_be_run_says_nothing_of_when() -> None:
    comparison = compared(filmed(PLANNED, PhaseJump(size=0.08, time_s=0.35, forwards=-1.0), seed=1))
    paths = [path if trial != 2 else None for trial, path in enumerate(comparison.nominal_paths)]
    time = begins_at_time(comparison, comparison.residual(paths), paths)
    assert time is not None
    assert shared(time, 0.35, 0.8) > 0.85


def test_one_trial_alone_cannot_tell_a_place_from_a_time() -> None:
    one, two = np.array([[1.0, 0.0], [20.0, 0.0]]), np.array([[1.0, 0.0], [20.0, 5.0]])
    assert _shared(one) is None
    assert _shared(two) == 1
    # Each had rather a region of its own than the one that suits both; the second that shares it speaks for it too.
    assert _shared(np.array([[0.0, 30.0], [30.0, 0.0], [16.0, 16.0]])) is None
    assert _shared(np.array([[0.0, 18.0], [18.0, 0.0], [16.0, 16.0]])) == 2


@pytest.mark.parametrize("alike", [1.0, 2.0, 8.0])
def test_white_noise_shares_no_region_however_few_numbers_count_as_one(alike: float) -> None:
    rng = np.random.default_rng(5)
    trials, channels, numbers, regions = 12, 5, 60, 60
    told = 0
    for _ in range(10):
        square = rng.normal(size=(trials, channels, numbers)) ** 2
        each = np.zeros((trials, numbers, 4, channels))
        for step in range(4):
            each[:, :, step] = (np.searchsorted([1.0, 4.0, 9.0], square, side="right") == step).swapaxes(1, 2)
        up_to = np.concatenate([np.zeros((trials, 1, 4, channels)), np.cumsum(each, axis=1)], axis=1)
        evidence = np.empty((regions - 1, trials))
        for start in range(1, regions):
            before, after = up_to[:, start], up_to[:, -1] - up_to[:, start]
            evidence[start - 1] = _evidence(before, after, np.zeros_like(after)) / alike
        told += _shared(evidence) is not None
    assert told == 0


def test_a_sticky_place_is_found_where_it_is_and_not_where_the_robot_came_late_from_it() -> None:
    place = 1.2e-3, 2.4e-3
    law = StickySpot(size=0.2, place_m=place)
    (found,) = where(filmed(LONGER, law, seed=2, frames_per_second=120.0), "position_y_m")
    assert shared(found, *place) > 0.5


@pytest.mark.parametrize(("phase", "share"), [(0.3, 0.2), (0.15, 0.25)])
def test_a_field_that_falls_short_in_a_part_of_the_cycle_is_wrong_there(phase: float, share: float) -> None:
    law = AmplifierDropout(size=0.8, phase=phase, share=share)
    (found,) = where(filmed(LONGER, law, seed=6, frames_per_second=120.0), "cycle_phase_deg")
    assert shared(found, 360.0 * phase, 360.0 * (phase + share)) > 0.5


@pytest.mark.parametrize(
    ("effect", "vector"),
    [
        ("size_error", (1.03, 1.0)),
        ("field_rolloff", (0.02,)),
        ("viscous_drag", (0.03,)),
        ("magnetization_misalignment", (6.0, 20.0)),
        ("friction_coefficient", (0.4, 0.0)),
    ],
)
def test_what_acts_all_along_sets_in_nowhere(effect: str, vector: tuple[float, ...]) -> None:
    comparison = compared(measure(PLANNED, (get(effect).from_vector(vector),), seed=3, clock_frames=0.3))
    paths = comparison.nominal_paths
    residual = comparison.residual(paths)
    # There is a gap.
    assert np.mean(residual.over(range(len(paths))) ** 2) > 1.4
    for begins in (begins_at_time, begins_at_place, begins_at_phase):
        assert begins(comparison, residual, paths) is None


@pytest.mark.parametrize("seed", [4, 5])
def test_noise_sets_in_nowhere(seed: int) -> None:
    comparison = compared(measure(PLANNED, seed=seed, clock_frames=0.3))
    residual = comparison.residual(comparison.nominal_paths)
    for begins in (begins_at_time, begins_at_place, begins_at_phase):
        assert begins(comparison, residual, comparison.nominal_paths) is None
