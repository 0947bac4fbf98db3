from __future__ import annotations

from pathlib import Path

import pytest

TEXT = """\
format = "tumblers-scenario/1"

[robot]
shape = "cuboid"
length_m = 8.0e-4
width_m = 4.0e-4
height_m = 1.0e-4
mass_kg = 3.78e-8
magnetic_volume_m3 = 2.9e-11
magnetization_A_per_m = 15000
magnetization_axis = [0.0, 1.0, 0.0]

[substrate]
friction_coefficient = 0.3
friction_ellipsoid = [1.0, 1.0, 0.1]
adhesion_N_per_m2 = 1.19
electrostatic_force_N = 6.54e-7

[field]
kind = "rotating"
strength_T = 0.010
frequency_Hz = 5

[run]
duration_s = 0.25
step_s = 5.0e-4
"""


@pytest.fixture
def text() -> str:
    return TEXT


@pytest.fixture
def scenario_file(tmp_path: Path) -> Path:
    path = tmp_path / "scenario.toml"
    path.write_text(TEXT)
    return path
