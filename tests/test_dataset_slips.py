"""Numbers that are likely in another unit than their key says."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from tumblers.dataset import likely_slips, load

from .dataset_folder import DATASET, TRACK, write_dataset

EXAMPLE = Path(__file__).parents[1] / "examples" / "aluminium_30deg"


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("strength_T = 0.010", "strength_T = 10", "the field of f05 is 10 T strong, more"),
        ("strength_T = 0.020", "strength_T = 5", "the field of slope is 5 T strong, more"),
        ("mass_kg = 3.78e-8", "mass_kg = 0.0378", "kg/m³ by mass and volume: is mass_kg in its unit"),
        ("mass_kg = 3.78e-8", "density_kg_per_m3 = 1.18", "is density_kg_per_m3 in its unit"),
        ("15000", "15e6", "magnetization_A_per_m = 1.5e+07 is more than any magnet has"),
        ("15000", "15000\nmagnetic_volume_m3 = 2.9e-2", "times the robot's volume: is it in m³?"),
        ("friction_coefficient = 0.3", "friction_coefficient = 30", "friction_coefficient = 30 is more than"),
        ("position_noise_m = 3.0e-6", "position_noise_m = 3.0e-3", "position_noise_m = 0.003 is more than the robot's"),
        ("friction_coefficient = 0.3", "friction_coefficient = 0.3\nelectrostatic_force_N = 654", "is it in N?"),
        ("angle_noise_deg = 1.0", "angle_noise_deg = 0.0175", "finer than a camera tells: is it in degrees?"),
        ("incline_deg = 30.0", "incline_deg = 0.0", "is 0.03, and rolling without slip makes 0.00045"),
    ],
)
def test_a_slip_is_told_with_its_number(tmp_path: Path, old: str, new: str, words: str) -> None:
    assert old in DATASET
    (said,) = likely_slips(load(write_dataset(tmp_path / "data", DATASET.replace(old, new, 1))))
    assert words in said


def test_lengths_in_millimetres_are_told_by_the_size_and_the_density(tmp_path: Path) -> None:
    large = DATASET
    for name in ("8.0", "4.0", "1.0"):
        large = large.replace(f"{name}e-4", f"{name}e-1")
    said = likely_slips(load(write_dataset(tmp_path / "data", large)))
    assert [words.split(":")[0] for words in said] == [
        "the robot reaches 0.45 m from its centre",
        "the robot has 1.18e-06 kg/m³ by mass and volume",
    ]


def test_a_track_in_millimetres_is_told(tmp_path: Path) -> None:
    (said,) = likely_slips(load(write_dataset(tmp_path / "data", track=TRACK.replace("1e-4", "1.5"))))
    assert said == "the track of f05 reaches 1.5 m from its origin: are its positions in m?"


def test_a_field_from_a_table_is_looked_at_row_by_row(tmp_path: Path) -> None:
    field = '{ kind = "table", time_s = [0, 4], field_T = [[0, 0, 1], [0, 1.2, 0.9]] }'
    table = DATASET.replace('{ kind = "static", strength_T = 0.020, direction = [0, 0, 1] }', field)
    (said,) = likely_slips(load(write_dataset(tmp_path / "data", table)))
    assert "the field of slope is 1.5 T strong" in said


def test_what_labs_have_is_no_slip(tmp_path: Path) -> None:
    assert likely_slips(load(write_dataset(tmp_path / "data"))) == ()
    assert likely_slips(load(EXAMPLE)) == ()


def frames(columns: str, rows: list[str]) -> str:
    return "\n".join([f"time_s,{columns}", *(f"{k / 60:.6f},{row}" for k, row in enumerate(rows)), ""])


TURNS = [2.0 * math.pi * 5.0 * k / 60.0 for k in range(60)]


@pytest.mark.parametrize(
    ("track", "words"),
    [
        (frames("x_m,y_m", [f"0.024,{1e-5 * k}" for k in range(12)]), "f05 begins 0.024 m from its origin"),
        (frames("y_m", [f"{1e-9 * k}" for k in range(12)]), "differ by 1.1e-08 m at most, less than position_noise_m"),
        (frames("tilt_deg", [f"{math.asin(math.sin(t))}" for t in TURNS]), "tilt_deg of f05 is between -1.6 and 1.6"),
    ],
)
def test_a_track_in_another_unit_or_from_another_place_is_told(tmp_path: Path, track: str, words: str) -> None:
    (said,) = likely_slips(load(write_dataset(tmp_path / "data", track=track)))
    assert words in said


@pytest.mark.parametrize(
    "track",
    [
        # Within the tolerance and the robot's size, and where the first frame is later than the start.
        frames("x_m,y_m", [f"{4e-4 + 5e-6 * (k % 2)},0" for k in range(12)]),
        "time_s,y_m\n0.5,0.02\n0.6,0.02\n",
        # At rest to the pixel; and a body that spins flat, seen with a noise of half a degree.
        frames("x_m,y_m", ["0,0"] * 12),
        frames("tilt_deg", [f"{0.5 * math.sqrt(2.0) * math.erf(0.3 * (k % 13 - 6))}" for k in range(60)]),
        frames("tilt_deg", [f"{math.degrees(math.asin(math.sin(t)))}" for t in TURNS]),
    ],
)
def test_what_a_track_may_look_like_is_no_slip(tmp_path: Path, track: str) -> None:
    assert likely_slips(load(write_dataset(tmp_path / "data", track=track))) == ()
