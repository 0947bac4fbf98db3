from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
import xarray as xr

from tumblers import drive, preset_scenario

from .kill import files_of, kill_until_done


@pytest.mark.skipif(os.name == "nt", reason="signals")
def test_a_design_that_is_killed_at_random_times_loses_no_part(tmp_path: Path) -> None:
    preset_scenario("spiked", drive=drive(0.020, 10.0), duration_s=0.1).save(tmp_path / "spiked.toml")
    arguments = ["design", "--robot", "spiked.toml", "--samples", "16", "--draws", "8", "--generations", "1", "--out"]
    command = [sys.executable, "-m", "tumblers", *arguments]
    assert subprocess.run([*command, "whole.nc"], cwd=tmp_path, capture_output=True, check=False).returncode == 0
    parts = tmp_path / "killed.nc.parts"

    def kept() -> dict[str, bytes]:
        # Those that are written whole: a name with a dot before it is not yet one.
        return {name: content for name, content in files_of(parts, "[!.]*").items() if name != "settings.json"}

    assert kill_until_done([*command, "killed.nc"], tmp_path, kept, tmp_path / "killed.nc", 2027) > 1
    assert {file.name for file in tmp_path.iterdir()} == {"killed.nc", "spiked.toml", "whole.nc"}
    with (
        xr.open_dataset(tmp_path / "killed.nc", engine="h5netcdf") as one,
        xr.open_dataset(tmp_path / "whole.nc", engine="h5netcdf") as other,
    ):
        xr.testing.assert_identical(one.load(), other.load())
