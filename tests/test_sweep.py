from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from tumblers import (
    PAPER_DRAFTS_DEG,
    PAPER_MAGNETIZATION_DEG,
    InputError,
    Run,
    Scenario,
    faster_cases,
    ideal_speed,
    preferred_cases,
    preset_scenario,
    save_netcdf,
    simulate,
    sweep,
)
from tumblers.effects.size_error import SizeError
from tumblers.field import RotatingField
from tumblers.shape import Cuboid

DRAFTS = [0.0, 3.0]
CASES = [(0.0, 0.0), (10.0, 40.0), (10.0, 90.0)]


@pytest.fixture(scope="module")
def scenario() -> Scenario:
    return preset_scenario("spiked", duration_s=1.0)


@pytest.fixture(scope="module")
def small(scenario: Scenario) -> xr.Dataset:
    return sweep(scenario, drafts_deg=DRAFTS, magnetization=CASES)


def test_the_papers_grid_has_592_cases() -> None:
    assert tuple(range(16)) == PAPER_DRAFTS_DEG
    assert len(PAPER_MAGNETIZATION_DEG) == 37
    assert PAPER_MAGNETIZATION_DEG[0] == (0, 0)
    assert PAPER_MAGNETIZATION_DEG[1:] == tuple((10, theta2) for theta2 in range(10, 361, 10))


def test_a_sweep_is_what_the_format_says(small: xr.Dataset, scenario: Scenario) -> None:
    for name in ("twist_deg", "drift_m", "speed_m_per_s", "flipped", "unconverged_steps", "max_residual", "error"):
        assert small[name].dims == ("draft_deg", "magnetization_case")
        assert small[name].shape == (2, 3)
    np.testing.assert_array_equal(small["draft_deg"], DRAFTS)
    np.testing.assert_array_equal(small["theta1_deg"], [0.0, 10.0, 10.0])
    np.testing.assert_array_equal(small["theta2_deg"], [0.0, 40.0, 90.0])
    assert small["theta2_deg"].dims == ("magnetization_case",)
    assert small["flipped"].dtype == bool
    np.testing.assert_array_equal(small["flipped"], np.abs(small["twist_deg"]) > 45.0)
    assert int(small["unconverged_steps"].sum()) == 0
    assert (small["error"] == "").all()
    assert Scenario.from_toml(small.attrs["scenario"]) == scenario
    assert small.attrs["ideal_speed_m_per_s"] == pytest.approx(1093.4e-6, rel=1e-4)
    assert small.attrs["flipped_speed_m_per_s"] == pytest.approx(1200e-6, rel=1e-12)
    assert ideal_speed(scenario) == small.attrs["ideal_speed_m_per_s"]


def test_a_case_is_the_run_of_its_own(small: xr.Dataset, scenario: Scenario) -> None:
    robot = scenario.robot.with_draft(3.0).with_magnetization(10.0, 40.0)
    run = simulate(replace(scenario, robot=robot))
    case = small.sel(draft_deg=3.0).isel(magnetization_case=1)
    for name in ("twist_deg", "drift_m", "speed_m_per_s", "unconverged_steps", "max_residual", "max_penetration_m"):
        assert float(case[name]) == run.attrs[name], name


@pytest.mark.parametrize("threads", [1, 2, 4])
def test_the_bits_do_not_depend_on_the_threads(small: xr.Dataset, scenario: Scenario, threads: int) -> None:
    other = sweep(scenario, drafts_deg=DRAFTS, magnetization=CASES, threads=threads)
    xr.testing.assert_identical(other, small)
    for name in ("twist_deg", "drift_m", "speed_m_per_s", "max_residual"):
        assert other[name].values.tobytes() == small[name].values.tobytes()


def test_a_bad_case_does_not_kill_the_others(small: xr.Dataset, scenario: Scenario) -> None:
    drafts = [0.0, 60.0, -1.0, float("nan"), 3.0]
    result = sweep(scenario, drafts_deg=drafts, magnetization=[*CASES, (float("inf"), 0.0)])
    good = result.isel(draft_deg=[0, 4], magnetization_case=[0, 1, 2])
    xr.testing.assert_identical(good, small)
    failed = result["error"] != ""
    assert int(failed.sum()) == 14
    for name in ("twist_deg", "drift_m", "speed_m_per_s", "max_residual", "max_penetration_m"):
        np.testing.assert_array_equal(np.isnan(result[name]), failed)
    assert not result["flipped"].where(failed, False).any()
    assert result["error"].values[2, 0].startswith("robot.draft_deg: found -1.0, expected")
    assert "draft" in result["error"].values[1, 0]
    assert not (preferred_cases(result) & failed).any()


def test_a_sweep_of_bad_cases_alone_still_answers(scenario: Scenario) -> None:
    result = sweep(scenario, drafts_deg=[-1.0], magnetization=CASES)
    assert (result["error"] != "").all()
    assert np.isnan(result["speed_m_per_s"]).all()


@pytest.mark.parametrize(
    ("grid", "words"),
    [
        ({"drafts_deg": []}, "drafts_deg: found an empty list"),
        ({"magnetization": []}, "magnetization: found an empty list"),
        ({"drafts_deg": ["a"]}, r"drafts_deg\[0\]: found 'a'"),
        ({"drafts_deg": 3}, "drafts_deg: found 3"),
        ({"magnetization": [(1.0,)]}, r"magnetization\[0\]: found \(1.0,\)"),
        ({"threads": 0}, "threads: found 0"),
        ({"threads": True}, "threads: found True"),
    ],
)
def test_bad_grids_get_one_line(scenario: Scenario, grid: dict[str, object], words: str) -> None:
    with pytest.raises(InputError, match=words):
        sweep(scenario, **grid)  # type: ignore[arg-type]


def test_marked_cases_follow_the_papers_definition(small: xr.Dataset) -> None:
    made = small.isel(draft_deg=[0]).assign(
        drift_m=(("draft_deg", "magnetization_case"), [[50e-6, -60e-6, 0.0]]),
        flipped=(("draft_deg", "magnetization_case"), [[False, False, True]]),
        speed_m_per_s=(("draft_deg", "magnetization_case"), [[1094e-6, 1300e-6, 1300e-6]]),
    )
    np.testing.assert_array_equal(preferred_cases(made), [[True, False, False]])
    np.testing.assert_array_equal(faster_cases(made), [[True, False, False]])
    slower = made.assign(speed_m_per_s=made["speed_m_per_s"] - 2e-6)
    np.testing.assert_array_equal(faster_cases(slower), [[False, False, False]])


def test_a_saved_sweep_loads_as_itself(small: xr.Dataset, tmp_path: Path) -> None:
    save_netcdf(small, tmp_path / "sweep.nc")
    with xr.open_dataset(tmp_path / "sweep.nc", engine="h5netcdf") as loaded:
        xr.testing.assert_equal(loaded, small)
        assert loaded["flipped"].dtype == bool


def test_a_callback_can_stop_a_sweep(scenario: Scenario) -> None:
    def stop(done: int) -> None:
        raise KeyboardInterrupt

    long = replace(scenario, run=Run(duration_s=1000.0, step_s=5e-4))
    with pytest.raises(KeyboardInterrupt):
        sweep(long, drafts_deg=DRAFTS, magnetization=CASES, progress=stop)


def test_the_speed_without_slip_is_that_of_the_robot_that_runs() -> None:
    scenario = preset_scenario("cuboid_on_paper", duration_s=0.1)
    longer = replace(scenario, effects=(SizeError(length_factor=1.5),))
    shape = scenario.robot.shape
    assert isinstance(shape, Cuboid)
    assert isinstance(scenario.field, RotatingField)
    assert ideal_speed(longer) == pytest.approx(
        2.0 * (1.5 * shape.length_m + shape.height_m) * scenario.field.frequency_Hz
    )
