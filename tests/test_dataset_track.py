from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tumblers import InputError
from tumblers.dataset import Sensor, Track
from tumblers.dataset.track_csv import read_track_csv

PIXELS = {"position_noise_m": 3e-6, "angle_noise_deg": 1.0, "micrometres_per_pixel": 10.0, "frames_per_second": 50.0}


def read(folder: Path, text: str | bytes, **sensor: object) -> Track:
    path = folder / "t.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_track_csv("track", path, "t.csv", Sensor(**PIXELS | sensor)).track  # type: ignore[arg-type]


def test_lost_frames_are_nan_and_counted(tmp_path: Path) -> None:
    track = read(tmp_path, "time_s,y_m,z_m\n0,0,1e-4\n0.1,,\n0.2,,2e-4\n0.5,3e-4,\n")
    np.testing.assert_array_equal(track.channels["y_m"], [0.0, np.nan, np.nan, 3e-4])
    assert track.frames == 3
    assert track.frame_interval_s == pytest.approx(0.1)


@pytest.mark.parametrize("text", ["time_s,y_m\n", "time_s,y_m\n0,\n", "frame,x,y\n", "frame,x,y\n0,,\n7,,\n"])
def test_a_track_without_a_frame_loads(tmp_path: Path, text: str) -> None:
    track = read(tmp_path, text)
    assert track.frames == 0
    assert np.isnan(track.frame_interval_s) == (track.time_s.size < 2)


def test_byte_order_marks_windows_lines_and_spaces_are_welcome(tmp_path: Path) -> None:
    track = read(tmp_path, b"\xef\xbb\xbftime_s, x_m \r\n0.0, 1e-6\r\n\r\n0.1, \r\n")
    np.testing.assert_array_equal(track.channels["x_m"], [1e-6, np.nan])


def test_trackpy_columns_with_their_index(tmp_path: Path) -> None:
    track = read(
        tmp_path,
        ",y,x,mass,size,ecc,signal,raw_mass,ep,frame,particle\n0,100,50,9,2,,1,9,,0,3\n1,98,51,9,2,0.1,1,9,0.1,5,3\n",
    )
    assert list(track.channels) == ["x_m", "y_m"]
    np.testing.assert_allclose(track.time_s, [0.0, 0.1])
    np.testing.assert_allclose(track.channels["x_m"], [0.0, 1e-5], atol=1e-18)
    np.testing.assert_allclose(track.channels["y_m"], [0.0, 2e-5], atol=1e-18)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("time_s;x_m;y_m\n0,0;1,5e-6;0,0\n", "t.csv line 1 with semicolons between columns, expected commas"),
        ("\ntime_s\tx_m\n0.0\t1e-6\n", "t.csv line 2 with tabs between columns, expected commas"),
    ],
)
def test_what_a_spreadsheet_writes_with_other_separators_is_named(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        read(tmp_path, text)


def test_frames_that_trackpy_writes_twice(tmp_path: Path) -> None:
    track = read(tmp_path, "frame,y,x,frame,particle\n0,100,50,0,3\n5,98,51,5,3\n")
    np.testing.assert_allclose(track.time_s, [0.0, 0.1])
    # As pandas writes them where a frame is missing in one of them.
    track = read(tmp_path, "frame,y,x,frame,particle\n0,100,50,0.0,3\n5,98,51,5.0,3.0\n6,,,6.0,\n")
    np.testing.assert_allclose(track.time_s, [0.0, 0.1, 0.12])
    with pytest.raises(InputError, match="two columns 'frame', expected the same frames in both"):
        read(tmp_path, "frame,y,x,frame\n0,100,50,0\n5,98,51,6\n")
    with pytest.raises(InputError, match="two columns 'x', expected each column once"):
        read(tmp_path, "frame,y,x,x\n0,100,50,50\n")


def test_an_index_without_a_name_is_passed_over(tmp_path: Path) -> None:
    track = read(tmp_path, ",time_s,x_m\n7,0.0,1e-6\n8,0.1,2e-6\n")
    assert list(track.channels) == ["x_m"]
    # As pandas names it once it has read it itself.
    assert list(read(tmp_path, "Unnamed: 0,time_s,x_m\n7,0.0,1e-6\n").channels) == ["x_m"]
    for name in ("", "Unnamed: 2"):
        with pytest.raises(InputError, match=f"with a column '{name}'"):
            read(tmp_path, f"time_s,x_m,{name}\n0.0,1e-6,7\n")


def test_empty_rows_and_columns_of_a_spreadsheet_are_passed_over(tmp_path: Path) -> None:
    track = read(tmp_path, 'time_s, "x_m",\n0.0,1e-6,\n,,\n0.1,2e-6,\n,,\n   \n')
    assert list(track.channels) == ["x_m"]
    np.testing.assert_array_equal(track.time_s, [0.0, 0.1])
    # A lost frame has its time.
    lost = read(tmp_path, "time_s,x_m\n0.0,1e-6\n0.1,\n")
    assert (len(lost.time_s), lost.frames) == (2, 1)


@pytest.mark.parametrize(
    ("y_axis", "x", "y"),
    [
        # A step of 3 px to the right and 1 px down, seen from above.
        ([0, -1], 3, -1),  # +y up, +x right
        ([1, 0], 1, 3),  # +y right, +x down
        ([0, 5], -3, 1),  # +y down, +x left
        ([-2, 0], -1, -3),  # +y left, +x up
        ([1, 1], -2 / np.sqrt(2), 4 / np.sqrt(2)),  # +y down to the right, +x down to the left
    ],
)
def test_the_image_axes(tmp_path: Path, y_axis: list[float], x: float, y: float) -> None:
    track = read(tmp_path, "time_s,x_px,y_px\n0,,\n0.1,7,7\n0.2,10,8\n", y_axis_px=y_axis)
    np.testing.assert_allclose(track.channels["x_m"], [np.nan, 0, x * 1e-5], atol=1e-15)
    np.testing.assert_allclose(track.channels["y_m"], [np.nan, 0, y * 1e-5], atol=1e-15)


def test_without_the_start_the_origin_has_to_be_stated(tmp_path: Path) -> None:
    late = "frame,x,y\n0,,\n1,,\n2,7,7\n3,10,8\n"
    with pytest.raises(InputError, match=r"^sensor\.origin_px: found no such key, expected .* at 0\.04 s, when it has"):
        read(tmp_path, late)
    assert read(tmp_path, late, origin_px=[7, 7]).channels["x_m"][3] == pytest.approx(3e-5)
    # One frame late it may be, as long as it has moved no farther than an origin may be off.
    one = "frame,x,y\n0,,\n1,7,7\n2,11,7\n"
    assert read(tmp_path, one).channels["x_m"][2] == pytest.approx(4e-5)
    with pytest.raises(InputError, match=r"^sensor\.origin_px: found no such key, expected .* at 0\.02 s, when it has"):
        read(tmp_path, one.replace("11", "13"))
    assert read(tmp_path, one.replace("11", "13"), origin_tolerance_m=1e-4).channels["x_m"][2] == pytest.approx(6e-5)
    # As of a movie that began before the field, or counts on from the last trial's.
    with pytest.raises(InputError, match=r"the first in t\.csv is at 2 s, .* since the field's start, time 0"):
        read(tmp_path, "frame,x,y\n100,7,7\n101,7,7\n")
    # A robot that is never seen has left no start.
    assert np.isnan(read(tmp_path, "frame,x,y\n0,,\n1,,\n").channels["x_m"]).all()


def test_a_stated_origin_is_kept(tmp_path: Path) -> None:
    track = read(tmp_path, "time_s,x_px,y_px\n0.1,7,7\n", origin_px=[6, 9])
    assert (track.channels["x_m"][0], track.channels["y_m"][0]) == pytest.approx((1e-5, 2e-5))


@given(st.floats(0.951, 1.049))
def test_quaternions_are_normalised(length: float) -> None:
    whole = np.array([0.5, -0.5, 0.5, 0.5]) * length
    channels = {name: [value, np.nan] for name, value in zip(("qw", "qx", "qy", "qz"), whole, strict=True)}
    track = Track(time_s=[0.0, 1.0], channels=channels)
    np.testing.assert_allclose([track.channels[n][0] for n in channels], [0.5, -0.5, 0.5, 0.5], rtol=1e-12)


# Each: the file, the words of the line.
REFUSED = [
    ("", "t.csv with the columns [], expected one column time_s, or one column frame"),
    ("x_m\n0\n", "expected one column time_s, or one column frame"),
    ("time_s,frame,x_m\n0,0,0\n", "expected one column time_s, or one column frame"),
    ("time_s\n0\n", "expected any of x_m,"),
    ("time_s,x\n0,0\n", "x_m and y_m, or x_px and y_px, beside time_s"),
    ("time_s,x_px\n0,0\n", "x and y once, both in pixels or in metres"),
    ("frame,x,y,x_m\n0,0,0,0\n", "x and y once"),
    ("frame,x,y,x_px,y_px\n0,0,0,0,0\n", "x and y once"),
    ("time_s,x_m,x_m\n0,0,0\n", "two columns 'x_m', expected each column once"),
    ("time_s,x_mm\n0,0\n", "a column 'x_mm', expected time_s and any of x_m,"),
    ("time_s,x_m,mass\n0,0,0\n", "a column 'mass'"),
    ("time_s;x_m\n0;0\n", "t.csv line 1 with semicolons between columns, expected commas"),
    ("time_s,qw,qx,qy\n0,1,0,0\n", "expected all of qw, qx, qy, qz or none"),
    ("time_s,x_m\n0,0\n0.1,fast\n", "t.csv line 3: x_m 'fast', expected a finite number, or an empty cell"),
    ("time_s,x_m\n\n0,nan\n", "t.csv line 3: x_m 'nan'"),
    ("time_s,x_m\n0,inf\n", "t.csv line 2: x_m 'inf'"),
    ("time_s,x_m\n,0\n", "t.csv line 2: time_s '', expected a finite number"),
    ("time_s,x_m\n0\n", "t.csv line 2 with 1 cells, expected 2"),
    ("time_s,x_m\n0.2,0\n0.1,0\n", "t.csv line 3: time_s '0.1' after '0.2', expected times that increase"),
    ("time_s,x_m\n0.2,0\n0.2,0\n", "t.csv line 3: time_s '0.2' a second time, expected times that increase"),
    ("frame,x,y\n5,0,0\n4,0,0\n", "t.csv line 3: frame '4' after '5', expected times that increase"),
    ("frame,x,y\n5,0,0\n5.0,0,0\n", "t.csv line 3: frame '5.0' a second time, expected times that increase"),
    ("time_s,x_m\n1e308,0\n-1e308,0\n", "t.csv line 3: time_s '-1e308' after '1e308'"),
    ("frame,x,y\n0.5,0,0\n", "t.csv line 2: frame '0.5', expected a whole number"),
    ("frame,x,y,particle\n0,0,0,1\n0,0,0,2\n", "the particles ['1', '2'], expected the rows of a single one"),
    ("frame,x,y,particle\n0,0,0,1\n1,0,0,\n", "the particles ['', '1'], expected the rows of a single one"),
    ("frame,x,y,particle\n0,0,0,nan\n1,0,0,1\n", "the particles ['1', 'nan'], expected the rows of a single one"),
    ("frame,x,y\n0,1,\n", "t.csv line 2: y an empty cell beside one of x, expected both pixels or none"),
    ("time_s,x_m\n0,1_0e-6\n", "t.csv line 2: x_m '1_0e-6', expected a finite number"),
    ("time_s,x_m\n0,１\n", "t.csv line 2: x_m '１', expected a finite number"),
    ("time_s,tilt_deg\n0,90.5\n0.1,-95\n0.2,181\n", "t.csv line 4: tilt_deg 181 degrees, expected the angle above"),
    ("time_s,x_m,y_m\n0,0,0\n1,3,410\n", "t.csv line 3: y_m 410 m, expected metres, at most 10 from the start"),
    ("time_s,qw,qx,qy,qz\n0,1,,0,0\n", "t.csv line 2: qx an empty cell beside the others, expected a whole quaternion"),
    ("time_s,qw,qx,qy,qz\n0,1,0,0,0\n1,1,1,0,0\n", "t.csv line 3: qw a quaternion of length 1.414, expected length 1"),
    ('frame,x_m,particle\n0,0,"a\nb"\n1,q,"a\nb"\n', "t.csv line 5: x_m 'q'"),
    ('time_s,x_m\n0,"1\n2"\n', "t.csv line 3: x_m '1\\n2'"),
    ('time_s,x_m\n0,"1\n', "t.csv: unexpected end of data, expected a CSV file"),
    (b"time_s,x_m\n0,\xff\n", "bytes that are no UTF-8 text: t.csv, expected a readable CSV file"),
]


@pytest.mark.parametrize(("text", "words"), REFUSED)
def test_a_file_is_refused_in_one_line(tmp_path: Path, text: str | bytes, words: str) -> None:
    with pytest.raises(InputError) as caught:
        read(tmp_path, text)
    line = str(caught.value)
    assert words in line
    assert line.startswith(("track: found t.csv", "track: found bytes"))
    assert "\n" not in line


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("rows", "scale", "words"),
    [
        ("320,410\n320,1e308", 6.5, "t.csv line 3: y '1e308', expected a pixel of an image, at most 1e+09"),
        ("320,410\n-1e9,410", 6.5, "line 3: x '-1e9' and y '410', of which 6.5 micrometres_per_pixel make x_m -65"),
        ("320,410\n320,1e9", 1e308, "line 3: x '320' and y '1e9', of which 1e+308 micrometres_per_pixel make y_m -inf"),
    ],
)
def test_pixels_that_are_too_far_out_are_named_as_in_the_file(
    tmp_path: Path, rows: str, scale: float, words: str
) -> None:
    first, second = rows.split("\n")
    with pytest.raises(InputError) as caught:
        read(tmp_path, f"frame,x,y\n0,{first}\n1,{second}\n", micrometres_per_pixel=scale)
    assert words in str(caught.value)


@pytest.mark.filterwarnings("error")
def test_a_rate_that_makes_no_times_of_frames_is_named(tmp_path: Path) -> None:
    line = r"t\.csv line 3: frame '1e308', which 0\.001 frames_per_second make inf, expected a finite number"
    with pytest.raises(InputError, match=line):
        read(tmp_path, "frame,x,y\n0,0,0\n1e308,0,0\n", frames_per_second=1e-3)


@pytest.mark.filterwarnings("error")
def test_times_past_the_floats_make_no_warning(tmp_path: Path) -> None:
    assert np.isinf(read(tmp_path, "time_s,x_px,y_px\n-1.7e308,0,0\n1.7e308,0,1\n").frame_interval_s)


@pytest.mark.parametrize(
    ("key", "text"),
    [("micrometres_per_pixel", "time_s,x_px,y_px\n0,0,0\n"), ("frames_per_second", "frame,x_m\n0,0\n")],
)
def test_units_have_to_be_stated(tmp_path: Path, key: str, text: str) -> None:
    with pytest.raises(InputError, match=rf"^sensor\.{key}: found no such key"):
        read(tmp_path, text, **{key: None})


@pytest.mark.parametrize(
    ("time", "channels", "words"),
    [
        ([0.0], {}, r"track\.channels: found \{\}"),
        ([0.0], {"speed": [0.0]}, r"track\.speed: found an unknown channel"),
        ([0.0], {"x_m": [0.0, 1.0]}, r"track\.x_m: found 2 values, expected 1"),
        ([0.0], {"x_m": 0.0}, r"track\.x_m: found shape \(\)"),
        (["a"], {"x_m": [0.0]}, r"track\.time_s: found \['a'\]"),
        ([np.nan], {"x_m": [0.0]}, r"track\.time_s\[0\]: found nan"),
        ([0.0, 0.0], {"x_m": [0.0, 1.0]}, r"track\.time_s\[1\]: found 0 s a second time"),
        ([0.0], {"x_m": [np.inf]}, r"track\.x_m\[0\]: found inf"),
        ([0.0], {"qw": [1.0]}, r"track\.qx: found no such channel"),
        ([0.0], {"qw": [1e200], "qx": [0.0], "qy": [0.0], "qz": [0.0]}, r"track\.qw\[0\]: found a quaternion"),
    ],
)
def test_arrays_that_are_no_track_are_refused(time: object, channels: object, words: str) -> None:
    with pytest.raises(InputError, match=words):
        Track(time_s=time, channels=channels)  # type: ignore[arg-type]
