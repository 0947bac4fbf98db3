from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tumblers import InputError, dataset

from .dataset_folder import DATASET as TEXT
from .dataset_folder import write_dataset

OUTCOME = "{ mean_speed_m_per_s = 0.03, sigma_m_per_s = 0.001 }"
FIELD = '{ kind = "rotating", strength_T = 0.010, frequency_Hz = 5.0 }'

# Each: what to replace, by what, the key that the error names, words that it holds.
REFUSED = [
    ("tumblers-dataset/1", "tumblers-scenario/1", "format", "tumblers-dataset/1"),
    ('format = "tumblers-dataset/1"\n', "", "format", "no such key"),
    ('"two trials"', "3", "title", "3"),
    ('"two trials"', '"two\\ntrials"', "title", "one line of printable characters"),
    ("[robot]", "[robots]", "robots", "did you mean robot?"),
    ("[sensor]", "[camera]", "camera", "unknown key"),
    ("mass_kg = 3.78e-8", "mass_kg = -1", "robot.mass_kg", "greater than 0"),
    ("height_m = 1.0e-4", "height_m = 1.0e-4\ndraft_deg = 89", "robot.draft_deg", "draft"),
    ("friction_coefficient = 0.3", "friction_coefficient = nan", "substrate.friction_coefficient", "nan"),
    ("[sensor]", "[model]\nsolver = 'x'\n[sensor]", "model.solver", "unknown key"),
    ("[sensor]", "model = 1\n[sensor]", "substrate.model", "unknown key"),
    ("position_noise_m = 3.0e-6", "position_noise_m = 0", "sensor.position_noise_m", "greater than 0"),
    (
        "position_noise_m = 3.0e-6\n",
        "",
        "sensor.position_noise_m",
        "no such key, expected the noise of x_m in trial[0]",
    ),
    ("angle_noise_deg = 1.0\n", "", "sensor.angle_noise_deg", "the noise of tilt_deg in trial[0].track"),
    ("angle_noise_deg = 1.0", "angle_noise_deg = true", "sensor.angle_noise_deg", "True"),
    ("[sensor]", "[tolerance]\nfriction = 0.1\n[sensor]", "tolerance.friction", "expected one of mass, magnetization"),
    ("[sensor]", "[tolerance]\nmass = 0\n[sensor]", "tolerance.mass", "greater than 0"),
    ("[sensor]", "[tolerance]\nmass = 5.0\n[sensor]", "tolerance.mass", "at most 0.3"),
    ("[sensor]", "[sensor]\nnoise = 1", "sensor.noise", "unknown key"),
    ("[sensor]", "[sensor]\nz_noise_m = 0", "sensor.z_noise_m", "greater than 0"),
    ("[sensor]", "[sensor]\nz_noise_m = 1e-200", "sensor.z_noise_m", "at least 1e-12"),
    ("position_noise_m = 3.0e-6", "position_noise_m = 1e200", "sensor.position_noise_m", "at most 1"),
    ("[sensor]", "[sensor]\nmicrometres_per_pixel = -2", "sensor.micrometres_per_pixel", "greater than 0"),
    ("[sensor]", "[sensor]\nframes_per_second = 0", "sensor.frames_per_second", "greater than 0"),
    ("[sensor]", "[sensor]\norigin_px = [1, 2, 3]", "sensor.origin_px", "a list of 2 numbers"),
    ("[sensor]", "[sensor]\norigin_px = [1, 'a']", "sensor.origin_px[1]", "'a'"),
    ("[sensor]", "[sensor]\norigin_px = [1, -2e9]", "sensor.origin_px[1]", "at least -1e+09"),
    ("[sensor]", "[sensor]\ny_axis_px = [0, 0]", "sensor.y_axis_px", "not zero"),
    ("[sensor]", "[sensor]\ny_axis_px = [1]", "sensor.y_axis_px", "a list of 2 numbers"),
    ("[sensor]", "[sensor]\ntime_offset_s = -1", "sensor.time_offset_s", "at least 0"),
    ("[sensor]", "[sensor]\norigin_tolerance_m = -1", "sensor.origin_tolerance_m", "at least 0"),
    ("[sensor]", "[sensor]\nz_origin_tolerance_m = -1", "sensor.z_origin_tolerance_m", "at least 0"),
    ("[sensor]", "[sensor]\nheading_tolerance_deg = 181", "sensor.heading_tolerance_deg", "at most 180"),
    ("[sensor]", "[sensor]\nscale_tolerance = 1", "sensor.scale_tolerance", "less than 1"),
    ("[sensor]", "[sensor]\nheading_of = 'nose'", "sensor.heading_of", "end or axis"),
    ("[sensor]", "[sensor]\ntracked_point = 'nose'", "sensor.tracked_point", "body_centre or centre_of_mass"),
    ('id = "f05"\n', "", "trial[0].id", "no such key"),
    ('id = "f05"', 'id = " "', "trial[0].id", "a name of printable characters"),
    ('id = "f05"', "id = 5", "trial[0].id", "5"),
    ('id = "slope"', 'id = "f05"', "trial[1].id", "found 'f05' again, expected another id than trial[0]"),
    ("duration_s = 4\n", "", "trial[1].duration_s", "a value for duration_s (trial 'slope')"),
    ("duration_s = 4", "duration_s = 0", "trial[1].duration_s", "greater than 0 (trial 'slope')"),
    (
        "duration_s = 2.0",
        "duration_s = 0.5",
        "trial[0].track",
        "found tracks/f05.csv line 4: time_s '1.0', expected times from 0 s to duration_s, 0.5 s, give",
    ),
    ("incline_deg = 30.0", "incline_deg = 90", "trial[1].incline_deg", "less than 90"),
    ("incline_deg = 30.0", "slope_deg = 30", "trial[1].slope_deg", "unknown key"),
    ("incline_deg = 30.0", "gravity_m_per_s2 = -1", "trial[1].gravity_m_per_s2", "at least 0"),
    (f"field = {FIELD}\n", "", "trial[0].field", "no such key"),
    (FIELD, "1", "trial[0].field", "a table"),
    ("frequency_Hz = 5.0", "frequency_Hz = 0", "trial[0].field.frequency_Hz", "greater than 0"),
    ('kind = "rotating"', 'kind = "wobbling"', "trial[0].field.kind", "'wobbling'"),
    ("direction = [0, 0, 1]", "direction = [0, 0, 0]", "trial[1].field.direction", "not zero"),
    (FIELD, '{ kind = "table", csv = "../B.csv" }', "trial[0].field.csv", "leads out of"),
    (FIELD, '{ kind = "table", csv = "B.csv" }', "trial[0].field.csv", "no such file"),
    (FIELD, '{ kind = "table", time_s = [0, 1], field_T = [[0, 0, 0], [0, 0, 1]] }', "trial[0].field.time_s", "cover"),
    ('track = "tracks/f05.csv"\n', "", "trial[0].track", "neither a track nor an outcome"),
    ('"tracks/f05.csv"', "7", "trial[0].track", "7"),
    ('"tracks/f05.csv"', '"tracks/f06.csv"', "trial[0].track", "no such file: tracks/f06.csv"),
    ('"tracks/f05.csv"', f'"{"a/" * 2000}.csv"', "trial[0].track", f"{'a/' * 38}a..., expected a readable CSV file"),
    ('"tracks/f05.csv"', '""', "trial[0].track", "found '', expected a path that starts at the dataset's folder"),
    (FIELD, '{ kind = "table", csv = "" }', "trial[0].field.csv", "found '', expected a path that starts"),
    ('"tracks/f05.csv"', '"tracks"', "trial[0].track", "a directory: tracks"),
    ('"tracks/f05.csv"', '"../outside.csv"', "trial[0].track", "'../outside.csv', which leads out of the dataset's"),
    ('"tracks/f05.csv"', '"/etc/passwd"', "trial[0].track", "a path that starts at the dataset's folder"),
    ('"tracks/f05.csv"', '"link.csv"', "trial[0].track", "'link.csv', which leads out of the dataset's folder"),
    ('"tracks/f05.csv"', '"pipe.csv"', "trial[0].track", "no regular file"),
    ('"tracks/f05.csv"', '"loop.csv"', "trial[0].track", "loop.csv"),
    ('"tracks/f05.csv"', '"a\\u0000.csv"', "trial[0].track", "a path with a NUL byte"),
    (OUTCOME, "1", "trial[1].outcome", "a table"),
    (OUTCOME, "{}", "trial[1].outcome", "no observation"),
    (OUTCOME, "{ climbs = 1 }", "trial[1].outcome.climbs", "true or false"),
    (OUTCOME, "{ speed = 1 }", "trial[1].outcome.speed", "unknown key"),
    (", sigma_m_per_s = 0.001", "", "trial[1].outcome.sigma_m_per_s", "no such key beside mean_speed_m_per_s"),
    ("mean_speed_m_per_s = 0.03, ", "", "trial[1].outcome.mean_speed_m_per_s", "no such key beside sigma_m_per_s"),
    ("sigma_m_per_s = 0.001", "sigma_m_per_s = 0", "trial[1].outcome.sigma_m_per_s", "greater than 0"),
    ("mean_speed_m_per_s = 0.03", "mean_speed_m_per_s = 30.1", "trial[1].outcome.mean_speed_m_per_s", "at most 10"),
    ("mean_speed_m_per_s = 0.03", "mean_speed_m_per_s = -1e308", "trial[1].outcome.mean_speed_m_per_s", "at least -10"),
    ("sigma_m_per_s = 0.001", "sigma_m_per_s = 1e-200", "trial[1].outcome.sigma_m_per_s", "at least 1e-12"),
    ("sigma_m_per_s = 0.001", "sigma_m_per_s = 1e200", "trial[1].outcome.sigma_m_per_s", "at most 10"),
    (OUTCOME, "{ tilt_deg = 5, sigma_deg = 1e-200 }", "trial[1].outcome.sigma_deg", "at least 1e-12"),
    (OUTCOME, "{ tilt_deg = 5 }", "trial[1].outcome.sigma_deg", "its standard deviation"),
    (OUTCOME, "{ tilt_deg = 95, sigma_deg = 1 }", "trial[1].outcome.tilt_deg", "at most 90"),
    (OUTCOME, "{ tilt_deg = -95, sigma_deg = 1 }", "trial[1].outcome.tilt_deg", "at least -90"),
    (
        'track = "tracks/f05.csv"',
        "outcome = { tilt_deg = 5, sigma_deg = 1 }",
        "trial[0].outcome.tilt_deg",
        "found 5.0 in a rotating field, expected a static field or a table",
    ),
    (TEXT[TEXT.index("[[trial]]") :], "", "trial", "no such key"),
    (TEXT[TEXT.index("[[trial]]") :], "[trial]\n", "trial", "an array of tables"),
    (
        TEXT[TEXT.index("[robot]") :],
        f"trial = []\n{TEXT[TEXT.index('[robot]') : TEXT.index('[[trial]]')]}",
        "trial",
        "no trials",
    ),
    ("[sensor]", "[sensor", None, "malformed TOML"),
]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_dataset(tmp_path / "data")


@pytest.mark.parametrize(("old", "new", "key", "words"), REFUSED)
def test_a_wrong_dataset_is_refused_in_one_line(folder: Path, old: str, new: str, key: str | None, words: str) -> None:
    assert TEXT.count(old) >= 1
    (folder / "dataset.toml").write_text(TEXT.replace(old, new, 1))
    with pytest.raises(InputError) as caught:
        dataset.load(folder)
    line = str(caught.value)
    assert caught.value.key == key
    assert line.startswith(f"{folder / 'dataset.toml'}: ")
    assert "found " in line
    assert ", expected " in line
    assert words in line
    assert "\n" not in line


def test_the_sound_one_loads_also_with_windows_lines(folder: Path) -> None:
    (folder / "dataset.toml").write_bytes(b"\xef\xbb\xbf" + TEXT.replace("\n", "\r\n").encode())
    data = dataset.load(folder)
    assert [trial.id for trial in data.trials] == ["f05", "slope"]
    assert data.title == "two trials"
    assert data.trials[0].track is not None
    assert data.trials[0].track.frames == 2
    assert data.model_given == ()
    assert data.directory == folder
    with pytest.raises(InputError, match="found 'f06', expected one of f05, slope"):
        data.trial("f06")


def test_a_track_belongs_to_one_trial(folder: Path) -> None:
    second = 'track = "tracks/../tracks/f05.csv"\n'
    (folder / "dataset.toml").write_text(TEXT.replace("outcome =", f"{second}outcome ="))
    found = r"trial\[1\]\.track: found 'tracks/\.\./tracks/f05\.csv' again"
    line = rf"{found}, expected another file than trial\[0\] \(trials 'f05', 'slope'\)$"
    with pytest.raises(InputError, match=line):
        dataset.load(folder)


def test_outcomes_alone_need_no_sensor(folder: Path) -> None:
    start, end = TEXT.index("[sensor]"), TEXT.index('[[trial]]\nid = "slope"')
    (folder / "dataset.toml").write_text(TEXT[:start] + TEXT[end:])
    sensor = dataset.load(folder).sensor
    assert (sensor.position_noise_m, sensor.angle_noise_deg) == (5e-6, 1.0)


def test_heights_may_have_a_noise_of_their_own(folder: Path) -> None:
    (folder / "tracks" / "f05.csv").write_text("time_s,z_m\n0,1e-4\n")
    (folder / "dataset.toml").write_text(TEXT.replace("position_noise_m = 3.0e-6", "z_noise_m = 1e-6"))
    assert dataset.load(folder).sensor.z_noise_m == 1e-6


@pytest.mark.parametrize(("time", "loads"), [(-0.02, True), (-0.03, False), (2.02, True), (2.03, False)])
def test_a_row_may_be_half_a_frame_outside(folder: Path, time: float, loads: bool) -> None:
    times = sorted([0.5, 0.55, 0.6, 0.65, time])
    (folder / "tracks" / "f05.csv").write_text("time_s,x_m\n" + "".join(f"{t},0\n" for t in times))
    (folder / "dataset.toml").write_text(TEXT)
    if loads:
        assert dataset.load(folder).trials[0].track is not None
    else:
        with pytest.raises(InputError, match=rf"trial\[0\]\.track: found tracks/f05\.csv line [26]: time_s '{time}', "):
            dataset.load(folder)


@pytest.mark.parametrize(("time", "loads"), [(-0.19, True), (-0.21, False), (2.19, True), (2.21, False)])
def test_a_row_may_be_outside_by_what_the_clock_may_be_off(folder: Path, time: float, loads: bool) -> None:
    times = sorted([0.5, 0.55, 0.6, 0.65, time])
    (folder / "tracks" / "f05.csv").write_text("time_s,x_m\n" + "".join(f"{t},0\n" for t in times))
    (folder / "dataset.toml").write_text(TEXT.replace("[sensor]", "[sensor]\ntime_offset_s = 0.2"))
    if loads:
        assert dataset.load(folder).trials[0].track is not None
    else:
        with pytest.raises(InputError, match=rf"trial\[0\]\.track: .* time_s '{time}', .* give or take 200 ms"):
            dataset.load(folder)


@pytest.mark.parametrize(("time", "loads"), [(2.009, True), (2.011, False)])
def test_a_frame_is_one_of_the_stated_rate_where_rows_leave_some_out(folder: Path, time: float, loads: bool) -> None:
    (folder / "tracks" / "f05.csv").write_text(f"time_s,x_m\n0,0\n1,0\n{time},0\n")
    (folder / "dataset.toml").write_text(TEXT.replace("[sensor]", "[sensor]\nframes_per_second = 50"))
    if loads:
        assert dataset.load(folder).trials[0].track is not None
    else:
        with pytest.raises(InputError, match=r"expected times from 0 s to duration_s, 2 s, give or take 10 ms"):
            dataset.load(folder)


def test_a_row_may_be_half_a_frame_outside_whatever_floats_make_of_it(folder: Path) -> None:
    # 2.03 + 0.01 is less than 102 / 50.
    (folder / "tracks" / "f05.csv").write_text("frame,x_m\n0,0\n102,0\n")
    text = TEXT.replace("[sensor]", "[sensor]\nframes_per_second = 50").replace("duration_s = 2.0", "duration_s = 2.03")
    (folder / "dataset.toml").write_text(text)
    assert dataset.load(folder).trials[0].track is not None


def test_a_frame_outside_its_trial_is_named_as_in_the_file(folder: Path) -> None:
    (folder / "tracks" / "f05.csv").write_text("frame,x_m\n0,0\n50,0\n99.0,0\n")
    (folder / "dataset.toml").write_text(TEXT.replace("[sensor]", "[sensor]\nframes_per_second = 25"))
    with pytest.raises(
        InputError, match=r"found tracks/f05\.csv line 4: frame '99\.0', which is 3\.96 s by frames_per_second,"
    ):
        dataset.load(folder)


def test_a_row_outside_its_trial_is_refused_without_a_file_too(folder: Path) -> None:
    data = dataset.load(folder)
    with pytest.raises(
        InputError, match=r"^trial\[0\]\.track: found a row at 1 s, expected times from 0 s to duration"
    ):
        replace(data, trials=(replace(data.trials[0], duration_s=0.5),))


def test_a_track_does_not_excuse_its_own_times(folder: Path) -> None:
    (folder / "tracks" / "f05.csv").write_text("time_s,x_m\n-1e5,0\n1e5,0\n")
    for sensor in ("[sensor]", "[sensor]\nframes_per_second = 1e-9"):
        (folder / "dataset.toml").write_text(TEXT.replace("[sensor]", sensor))
        with pytest.raises(InputError, match=r"duration_s, 2 s, give or take 1e\+03 ms"):
            dataset.load(folder)


def test_a_tabulated_field_is_read_from_the_folder(folder: Path) -> None:
    (folder / "B.csv").write_text("time_s,Bx_T,By_T,Bz_T\n0,0,0,0.01\n2,0,0.01,0\n")
    (folder / "dataset.toml").write_text(TEXT.replace(FIELD, '{ kind = "table", csv = "B.csv" }'))
    data = dataset.load(folder)
    data.save(folder / "again")
    assert dataset.load(folder / "again").trials[0].field == data.trials[0].field


def test_a_tabulated_field_that_is_too_short_is_named(folder: Path) -> None:
    (folder / "B.csv").write_text("time_s,Bx_T,By_T,Bz_T\n0,0,0,0.01\n1.5,0,0.01,0\n")
    (folder / "dataset.toml").write_text(TEXT.replace(FIELD, '{ kind = "table", csv = "B.csv" }'))
    with pytest.raises(InputError, match=r"trial\[0\]\.field\.csv: found 'B\.csv' with rows from 0\.0 s to 1\.5 s"):
        dataset.load(folder)


def test_missing_files_get_one_line(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nowhere: found no such file, expected a tumblers-dataset/1 file"):
        dataset.load(tmp_path / "nowhere")
    with pytest.raises(InputError, match=r"dataset\.toml: found no such file"):
        dataset.load(tmp_path)
    (tmp_path / "dataset.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="UTF-8"):
        dataset.load(tmp_path)
    with pytest.raises(InputError, match="found a path with a NUL byte"):
        dataset.load("nul\0")
