from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import tumblers
from tumblers import InputError
from tumblers.studies.headline import HEADLINES


@pytest.fixture(scope="module")
def found() -> xr.Dataset:
    return tumblers.convergence(numbers=["speed_10Hz", "spiked_drift"], steps_s=[1e-3, 5e-4, 1e-4], e_r_m=[1e-4, 0.1])


def test_the_step_of_the_released_values_damps_the_hops_away(found: xr.Dataset) -> None:
    """Converged 1.060 at 10 Hz, an independent implementation's; 1.001 with the released step and torque."""
    speed = found.value.sel(number="speed_10Hz", e_r_m=0.1)
    assert float(speed.sel(magnetic_torque="end_of_step", step_s=5e-4)) == pytest.approx(1.001, abs=1e-3)
    assert float(speed.sel(magnetic_torque="midpoint", step_s=1e-4)) == pytest.approx(1.060, abs=2e-3)
    assert float(found.converged.sel(number="speed_10Hz")) == float(speed.sel(magnetic_torque="midpoint", step_s=1e-4))


def test_drift_depends_on_e_r_and_speed_does_not(found: xr.Dataset) -> None:
    fine = found.value.sel(magnetic_torque="end_of_step", step_s=1e-4)
    low, high = fine.sel(number="spiked_drift").values * 1e6
    assert (low, high) == (pytest.approx(23.5, abs=1.0), pytest.approx(82.9, abs=0.5))
    speeds = fine.sel(number="speed_10Hz").values
    assert speeds[0] == pytest.approx(speeds[1], rel=1e-6)


def test_slopes_end_at_the_friction_angle() -> None:
    slopes = tumblers.convergence(numbers=["climb_aluminium"], steps_s=[2.5e-4], e_r_m=[0.1]).value
    assert slopes.shape == (1, 3, 1, 1)
    assert np.allclose(slopes, 28.37, atol=0.3)  # the resolution of 0.25°, and a little slip


def test_an_unstable_step_has_no_number_and_says_why(found: xr.Dataset) -> None:
    at = found.sel(number="spiked_drift", magnetic_torque="start_of_step", step_s=1e-3)
    assert np.isnan(at.value).all()
    assert all("stability" in error or "run.step_s" in error for error in at.error.values)
    assert not found.error.sel(magnetic_torque="end_of_step").values.astype(bool).any()


def test_every_headline_makes_a_scenario_with_a_unit() -> None:
    for headline in HEADLINES.values():
        headline.make().trial()
        assert headline.units in ("m s-1", "m", "1", "degree")


@pytest.mark.parametrize(
    ("arguments", "key"),
    [
        ({"numbers": ["speed"]}, "numbers[0]"),
        ({"numbers": []}, "numbers"),
        ({"steps_s": [0.0]}, "steps_s[0]"),
        ({"torques": ["later"]}, "torques[0]"),
        ({"e_r_m": []}, "e_r_m"),
        ({"threads": 0}, "threads"),
    ],
)
def test_bad_arguments_are_refused(arguments: dict[str, object], key: str) -> None:
    with pytest.raises(InputError) as refused:
        tumblers.convergence(**arguments)  # type: ignore[arg-type]
    assert refused.value.key == key
