"""Scenarios whose step is chosen, for the tests of the choice and of who works with it."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from tumblers import Model, Scenario, drive, preset_scenario

TORQUES = ("start_of_step", "end_of_step", "midpoint")


def rolling(frequency_Hz: float, torque: str = "midpoint", **others: Any) -> Scenario:
    """The cuboid on paper at 10 mT."""
    model = Model(magnetic_torque=torque)  # type: ignore[arg-type]
    given = {"drive": drive(0.010, frequency_Hz), "step_s": "auto", "duration_s": 0.5, "model": model, **others}
    return preset_scenario("cuboid_on_paper", **given)


def same_rows(one: xr.Dataset, other: xr.Dataset) -> bool:
    return all(np.array_equal(one[name].values, other[name].values) for name in one.variables)
