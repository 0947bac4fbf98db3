from __future__ import annotations

import pytest
import xarray as xr

from tumblers import preset_scenario, simulate


@pytest.fixture(scope="session")
def run() -> xr.Dataset:
    return simulate(preset_scenario("spiked"))
