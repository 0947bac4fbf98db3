from __future__ import annotations

import pickle
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tumblers import Cuboid, Model, Robot, RotatingField, StaticField, Substrate, TableField, dataset
from tumblers.dataset import CHANNELS, Dataset, LabTrial, Outcome, Sensor, Tolerance, Track
from tumblers.dataset.track import POSITIONS

ROBOT = Robot(shape=Cuboid(length_m=8e-4, width_m=4e-4, height_m=1e-4), mass_kg=3.78e-8, magnetization_A_per_m=15000.0)
DURATION = 1.0
POSITIVE = st.floats(1e-9, 1e3)
LEAST = st.floats(0, 0.5)
VALUE = st.floats(-1e3, 1e3)
PLACE = st.floats(-10, 10)
NOISE = st.floats(1e-9, 1.0)
PIXEL = st.tuples(VALUE, VALUE)
NAME = st.text(min_size=1, max_size=12).filter(lambda text: text.isprintable() and text.strip())
MAYBE = st.none()


@st.composite
def tracks(draw: st.DrawFn) -> Track:
    time = sorted(draw(st.sets(st.floats(0, DURATION), max_size=6)))
    names = draw(st.sets(st.sampled_from([name for name in CHANNELS if not name.startswith("q")])))

    def column(name: str) -> np.ndarray:  # type: ignore[type-arg]
        known = st.floats(-90, 90) if name == "tilt_deg" else PLACE if name in POSITIONS else VALUE
        cell = known | st.just(float("nan"))
        return np.array(draw(st.lists(cell, min_size=len(time), max_size=len(time))))

    channels = {name: column(name) for name in sorted(names)}
    if not channels or draw(st.booleans()):
        vectors = draw(
            st.lists(st.tuples(*[st.floats(0.1, 1.0)] * 4), min_size=len(time), max_size=len(time)).map(np.array)
        ).reshape(-1, 4)
        vectors = vectors / np.linalg.norm(vectors, axis=1, keepdims=True) * draw(st.floats(0.96, 1.04))
        vectors[draw(st.lists(st.booleans(), min_size=len(time), max_size=len(time)).map(np.array)).astype(bool)] = (
            np.nan
        )
        channels |= {name: vectors[:, i] for i, name in enumerate(("qw", "qx", "qy", "qz"))}
    return Track(time_s=np.array(time), channels=channels)


@st.composite
def outcomes(draw: st.DrawFn, rests: bool) -> Outcome:
    speed, tilt = draw(st.booleans()), rests and draw(st.booleans())
    return Outcome(
        climbs=draw(st.booleans() if speed or tilt else st.just(False)),
        mean_speed_m_per_s=draw(PLACE) if speed else None,
        sigma_m_per_s=draw(NOISE) if speed else None,
        tilt_deg=draw(st.floats(-90, 90)) if tilt else None,
        sigma_deg=draw(NOISE) if tilt else None,
    )


FIELD = (
    st.builds(RotatingField, strength_T=LEAST, frequency_Hz=POSITIVE)
    | st.builds(StaticField, strength_T=LEAST, direction=st.tuples(POSITIVE, VALUE, VALUE))
    | st.lists(st.tuples(VALUE, VALUE, VALUE), min_size=2, max_size=4).map(
        lambda rows: TableField(time_s=tuple(range(len(rows))), field_T=tuple(rows))
    )
)


@st.composite
def lab_trials(draw: st.DrawFn) -> LabTrial:
    track, field = draw(MAYBE | tracks()), draw(FIELD)
    seen = outcomes(not isinstance(field, RotatingField))
    return LabTrial(
        id=draw(NAME | st.sampled_from(["f05", "slope30", "../out", 'a"b\\', "é"])),
        field=field,
        duration_s=DURATION,
        incline_deg=draw(st.floats(-89, 89)),
        gravity_m_per_s2=draw(st.floats(0, 20)),
        track=track,
        outcome=draw(seen if track is None else MAYBE | seen),
    )


SENSOR = st.builds(
    Sensor,
    position_noise_m=NOISE,
    angle_noise_deg=NOISE,
    z_noise_m=MAYBE | NOISE,
    micrometres_per_pixel=MAYBE | POSITIVE,
    frames_per_second=MAYBE | POSITIVE,
    origin_px=MAYBE | PIXEL,
    y_axis_px=st.tuples(POSITIVE, VALUE),
    time_offset_s=MAYBE | LEAST,
    origin_tolerance_m=LEAST,
    z_origin_tolerance_m=MAYBE | LEAST,
    heading_tolerance_deg=LEAST,
    scale_tolerance=LEAST,
    heading_of=st.sampled_from([None, "end", "axis"]),
    tracked_point=st.sampled_from([None, "body_centre", "centre_of_mass"]),
)
# That of the mass is a default's, and one that is not written.
SHARE = st.just(0.005) | st.floats(1e-6, 0.3)
DATASET = st.builds(
    Dataset,
    robot=st.just(ROBOT),
    substrate=st.builds(Substrate, friction_coefficient=LEAST, adhesion_N_per_m2=LEAST),
    sensor=SENSOR,
    trials=st.lists(lab_trials(), min_size=1, max_size=4, unique_by=lambda trial: trial.id),
    model=st.builds(Model, magnetic_torque=st.sampled_from(["end_of_step", "midpoint"])),
    tolerance=st.builds(Tolerance, friction_coefficient=SHARE, mass=SHARE),
    title=st.just("") | NAME,
    model_given=st.sets(st.sampled_from(["magnetic_torque", "adhesion_enters"])).map(tuple),
)


def assert_same(one: Dataset, other: Dataset) -> None:
    def bare(data: Dataset) -> Dataset:
        without = (replace(trial, track=None, outcome=trial.outcome or Outcome(climbs=True)) for trial in data.trials)
        return replace(data, trials=tuple(without))

    assert bare(one) == bare(other)
    for a, b in zip(one.trials, other.trials, strict=True):
        assert a.outcome == b.outcome
        assert (a.track is None) == (b.track is None)
        if a.track is not None and b.track is not None:
            np.testing.assert_array_equal(a.track.time_s, b.track.time_s, strict=True)
            assert list(a.track.channels) == list(b.track.channels)
            for name, values in a.track.channels.items():
                np.testing.assert_array_equal(values, b.track.channels[name], strict=True)


@settings(deadline=None)
@given(DATASET)
def test_a_saved_dataset_loads_as_itself(data: Dataset) -> None:
    with tempfile.TemporaryDirectory() as folder:
        new = Path(folder) / "made" / "for it"
        data.save(new)
        loaded = dataset.load(new)
        assert loaded.directory == new
        assert_same(loaded, data)
        assert_same(dataset.load(new / "dataset.toml"), data)
        assert_same(pickle.loads(pickle.dumps(loaded)), data)
        tracked = sum(trial.track is not None for trial in data.trials)
        assert sum(file.is_file() for file in new.rglob("*")) == 1 + tracked


def one_trial(track: Track | None = None) -> Dataset:
    trial = LabTrial(
        id="f05",
        field=RotatingField(strength_T=0.01, frequency_Hz=5.0),
        duration_s=DURATION,
        track=track,
        outcome=Outcome(climbs=True),
    )
    sensor = Sensor(position_noise_m=3e-6, angle_noise_deg=1.0)
    return Dataset(robot=ROBOT, substrate=Substrate(friction_coefficient=0.3), sensor=sensor, trials=(trial,))


def test_tracks_are_named_by_the_trials(tmp_path: Path) -> None:
    track = Track(time_s=[0.0, 0.5], channels={"x_m": [0.0, 1e-4]})
    data = one_trial(track)
    data.save(tmp_path)
    data.save(tmp_path)
    assert sorted(file.name for file in tmp_path.rglob("*")) == ["dataset.toml", "f05.csv", "tracks"]
    assert (tmp_path / "tracks" / "f05.csv").read_text() == "time_s,x_m\n0.0,0.0\n0.5,0.0001\n"
    twins = replace(data, trials=(data.trials[0], replace(data.trials[0], id="F05")))
    twins.save(tmp_path / "twins")
    # Two ids that are one file name where letters have no case.
    assert sorted(file.name for file in (tmp_path / "twins" / "tracks").iterdir()) == ["000.csv", "001.csv"]


def test_a_folder_that_cannot_be_written_stays_as_it_was(tmp_path: Path) -> None:
    (tmp_path / "tracks").write_text("in the way")
    with pytest.raises(OSError):  # noqa: PT011
        one_trial(Track(time_s=[0.0], channels={"x_m": [0.0]})).save(tmp_path)
    assert [file.name for file in tmp_path.iterdir()] == ["tracks"]
    (tmp_path / "new" / "dataset.toml").mkdir(parents=True)
    with pytest.raises(OSError):  # noqa: PT011
        one_trial(Track(time_s=[0.0], channels={"x_m": [0.0]})).save(tmp_path / "new")
    assert (tmp_path / "new" / "dataset.toml").is_dir()


def test_a_trial_gives_its_nominal_run() -> None:
    data = one_trial()
    scenario = data.trial("f05").scenario(data, 5e-4, output_every_s=5e-3)
    assert (scenario.robot, scenario.substrate, scenario.model) == (data.robot, data.substrate, data.model)
    assert (scenario.run.duration_s, scenario.run.step_s, scenario.run.rows) == (DURATION, 5e-4, 201)
    midpoint = Model(magnetic_torque="midpoint")
    assert data.trial("f05").scenario(data, 5e-4, model=midpoint).model == midpoint
