from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tumblers.dataset import Dataset, LabTrial, Outcome, Sensor, Track
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.job import Job
from tumblers.diagnosis.gap.pose import body_axis, heading_of, tilt_of
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.result import HeatMap, Region
from tumblers.diagnosis.where.localise import localise
from tumblers.diagnosis.where.seen_along import seen_along
from tumblers.diagnosis.where.wrench import missing_wrench
from tumblers.effects import get
from tumblers.effects.base import Effect
from tumblers.field import Field, StaticField
from tumblers.model import Model
from tumblers.presets import ROBOTS, SUBSTRATES, drive

FRAMES_PER_SECOND = 60.0


def lab(effects: tuple[Effect, ...] = (), seed: int = 0) -> Dataset:
    """Return what a lab sees of the paper's cuboid with some effects: with noise and clocks that are off."""
    rng = np.random.default_rng(seed)
    plans: list[tuple[str, Field, float]] = [(f"f{f:g}", drive(0.010, f), 0.0) for f in (2.0, 5.0, 10.0)]
    plans += [("s30", drive(0.020, 2.0), 30.0), ("still", StaticField(strength_T=0.003, direction=(0, 0, 1)), 0.0)]
    empty = Dataset(
        title="toy",
        robot=ROBOTS["cuboid"].value,
        substrate=SUBSTRATES["paper"].value,
        model=Model(magnetic_torque="midpoint"),
        sensor=Sensor(position_noise_m=3e-6, angle_noise_deg=1.0),
        trials=tuple(
            LabTrial(id=name, field=field, duration_s=0.8, incline_deg=slope, outcome=Outcome(climbs=True))
            for name, field, slope in plans
        ),
    )
    # A world of a fine step: another step is not the matter here.
    paths = Simulator(empty, 1).run([Job(i, effects, divisor=4) for i in range(len(plans))])
    trials = []
    for path, trial in zip(paths, empty.trials, strict=True):
        assert path is not None
        time = np.arange(0.0, trial.duration_s - 0.01, 1.0 / FRAMES_PER_SECOND)
        place, turned = path.at(time + rng.uniform(-0.4, 0.4) / FRAMES_PER_SECOND)
        axis = body_axis(turned)
        seen = dict(zip(("x_m", "y_m", "z_m"), place.T + rng.normal(0.0, 3e-6, (3, len(time))), strict=True))
        seen["tilt_deg"] = np.degrees(tilt_of(axis)) + rng.normal(0.0, 1.0, len(time))
        wide = np.maximum(0.1, np.cos(tilt_of(axis)))
        seen["heading_deg"] = np.degrees(heading_of(axis)) + rng.normal(0.0, 1.0, len(time)) / wide
        trials.append(replace(trial, outcome=None, track=Track(time_s=time, channels=seen)))
    return replace(empty, trials=tuple(trials))


def where(dataset: Dataset) -> tuple[tuple[Region, ...], tuple[HeatMap, ...]]:
    comparison = Comparison(dataset, Simulator(dataset, 1))
    paths = comparison.nominal_paths
    return localise(comparison, comparison.residual(paths), paths)


def shifted(dataset: Dataset, trial: str, channel: str, by: np.ndarray) -> Dataset:  # type: ignore[type-arg]
    trials = []
    for t in dataset.trials:
        if t.id == trial:
            assert t.track is not None
            track = Track(time_s=t.track.time_s, channels={**t.track.channels, channel: t.track.channels[channel] + by})
            t = replace(t, track=track)
        trials.append(t)
    return replace(dataset, trials=tuple(trials))


def of(regions: tuple[Region, ...], axis: str) -> list[Region]:
    return [region for region in regions if region.axis == axis]


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_noise_lies_nowhere(seed: int) -> None:
    regions, maps = where(lab(seed=seed))
    assert regions == ()
    assert all(np.nanmedian(m.values) < 1.1 for m in maps)


def test_a_gap_of_one_trial_in_one_channel_from_some_time_on_is_found_there() -> None:
    dataset = lab(seed=4)
    track = dataset.trial("f2").track
    assert track is not None
    late = 20e-6 * (track.time_s > 0.4)
    regions, maps = where(shifted(dataset, "f2", "z_m", late))
    assert [r.value for r in of(regions, "trial")] == ["f2"]
    assert [r.value for r in of(regions, "channel")] == ["z"]
    (time,) = of(regions, "time_s")
    assert time.low is not None
    assert time.high is not None
    assert 0.3 < time.low < 0.45
    assert time.high > 0.5
    assert [region.share_of_gap for region in regions] == sorted((r.share_of_gap for r in regions), reverse=True)
    by_trial = next(m for m in maps if (m.rows, m.columns) == ("trial", "channel"))
    worst = np.unravel_index(np.nanargmax(by_trial.values), by_trial.values.shape)
    assert (by_trial.row_labels[worst[0]], by_trial.column_labels[worst[1]]) == ("f2", "z")


def test_a_knock_is_found_where_it_was_and_not_where_it_led() -> None:
    dataset = lab(seed=5)
    track = dataset.trial("f5").track
    assert track is not None
    # The robot is thrown off its course by 60 µm at half of its way.
    half = 0.5 * track.channels["y_m"][-1]
    off = np.where(track.channels["y_m"] > half, 60e-6, 0.0)
    (place,) = of(where(shifted(dataset, "f5", "x_m", off))[0], "position_y_m")
    assert place.low is not None
    assert place.high is not None
    assert place.low - 1e-3 < half < place.high + 1e-3
    assert place.high - place.low < 0.4 * track.channels["y_m"][-1]


def test_a_robot_that_stays_has_its_gap_where_it_was_seen() -> None:
    dataset = lab(seed=5)
    track = dataset.trial("f5").track
    assert track is not None
    y = track.channels["y_m"]
    stays = 0.4 * y[-1]
    held = np.where(y > stays, stays - y, 0.0)
    stuck = shifted(dataset, "f5", "y_m", held)
    (place,) = of(where(stuck)[0], "position_y_m")
    assert place.low is not None
    assert place.high is not None
    # The model goes on to more than twice as far.
    assert place.low - 1e-3 < stays < place.high + 1e-3
    assert place.high < 0.7 * y[-1]
    # So is what is missing.
    alone = replace(stuck, trials=(stuck.trial("f5"),))
    comparison = Comparison(alone, Simulator(alone, 1))
    missing = missing_wrench(comparison, comparison.residual(comparison.nominal_paths), comparison.nominal_paths)
    assert missing is not None
    assert max(float(label.split("–")[1].removesuffix(" mm")) for label in missing.by_place) < 1e3 * stays + 0.2


def test_a_mistracked_frame_is_no_place() -> None:
    dataset = lab(seed=5)
    comparison = Comparison(dataset, Simulator(dataset, 1))
    observed, time = comparison.readers[0].observed, comparison.readers[0].observed.time_s
    right = observed.values["y"]
    wrong = right.copy()
    wrong[len(wrong) // 2] += 5e-3
    mistracked = replace(observed, values={**observed.values, "y": wrong})
    seen = seen_along(mistracked, np.zeros(4), time, np.full(len(time), np.nan))
    # A robot goes on by less than this in a frame.
    assert np.max(np.abs(seen - right)) < 5e-4
    nowhere = replace(observed, values={**observed.values, "y": np.full(len(time), np.nan)})
    np.testing.assert_array_equal(seen_along(nowhere, np.zeros(4), time, right), right)


def test_a_gap_across_is_no_place_of_itself() -> None:
    dataset = lab(seed=5)
    track = dataset.trial("f5").track
    assert track is not None
    regions = where(shifted(dataset, "f5", "x_m", 120e-6 * (track.time_s > 0.4)))[0]
    assert of(regions, "channel")[0].value == "x"
    # The model goes straight: a region in x would be the gap that was put there.
    assert all(r.high is not None and r.high < 60e-6 for r in of(regions, "position_x_m"))


def test_rolloff_lies_at_high_frequency() -> None:
    regions, maps = where(lab((get("field_rolloff").from_vector((0.02,)),), seed=6))
    (frequency,) = of(regions, "frequency_Hz")
    assert (frequency.low, frequency.high) in {(5.0, 10.0), (10.0, 10.0)}
    named = {r.value for r in of(regions, "trial")}
    assert {"f5", "f10"} <= named
    assert not named & {"still", "s30"}
    assert all(max(m.values.shape) <= 14 for m in maps)
    assert all(m.values.shape == (len(m.row_labels), len(m.column_labels)) for m in maps)


def test_outcomes_alone_name_the_trial() -> None:
    dataset = lab()
    outcomes = {"f2": True, "f5": True, "f10": True, "s30": False}
    trials = tuple(
        replace(t, track=None, outcome=Outcome(climbs=outcomes[t.id])) for t in dataset.trials if t.id in outcomes
    )
    regions, _ = where(replace(dataset, trials=trials))
    assert [r.value for r in of(regions, "trial")] == ["s30"]
    (slope,) = of(regions, "incline_deg")
    assert (slope.low, slope.high) == (30.0, 30.0)
