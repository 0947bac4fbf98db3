from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from tumblers import (
    InputError,
    Run,
    Scenario,
    SimulationError,
    StaticField,
    _core,
    preset_scenario,
    save_netcdf,
    simulate,
)

SHAPES = {
    "position_m": ("time", "axis"),
    "orientation": ("time", "wxyz"),
    "linear_velocity_m_per_s": ("time", "axis"),
    "angular_velocity_rad_per_s": ("time", "axis"),
    "ecp_m": ("time", "axis"),
    "contact_mode": ("time",),
    "normal_force_N": ("time",),
    "friction_force_N": ("time", "tor"),
    "adhesion_force_N": ("time",),
    "slip_speed_m_per_s": ("time",),
    "residual": ("time",),
    "newton_iterations": ("time",),
}


@pytest.fixture
def scenario(text: str) -> Scenario:
    return Scenario.from_toml(text)


def test_a_run_is_what_the_format_says(scenario: Scenario) -> None:
    run = simulate(scenario)
    assert {name: run[name].dims for name in run.data_vars} == SHAPES
    assert run.sizes == {"time": 501, "axis": 3, "wxyz": 4, "tor": 3}
    assert run["time"].attrs["units"] == "s"
    np.testing.assert_allclose(run["time"], np.arange(501) * 5e-4, rtol=1e-12, atol=1e-15)
    assert all("units" in run[name].attrs for name in run.data_vars)
    assert run["friction_force_N"].attrs["third_component"] == "moment"
    assert run["contact_mode"].attrs["flag_meanings"] == "airborne point line surface"
    assert set(np.unique(run["contact_mode"])) <= {0, 1, 2, 3}
    np.testing.assert_allclose(np.linalg.norm(run["orientation"], axis=1), 1.0, rtol=1e-12)
    assert Scenario.from_toml(run.attrs["scenario"]) == scenario
    assert run.attrs["unconverged_steps"] == 0


def test_rows_are_as_far_apart_as_asked(scenario: Scenario) -> None:
    sparse = replace(scenario, run=replace(scenario.run, output_every_s=0.01))
    run, every = simulate(sparse), simulate(scenario)
    np.testing.assert_allclose(run["time"], np.arange(26) * 0.01, rtol=1e-12, atol=1e-15)
    xr.testing.assert_identical(run.drop_attrs(), every.isel(time=slice(None, None, 20)).drop_attrs())


def test_a_run_repeats_to_the_bit(scenario: Scenario) -> None:
    xr.testing.assert_identical(simulate(scenario), simulate(scenario))


def test_a_field_without_a_cycle_has_no_twist(scenario: Scenario) -> None:
    run = simulate(replace(scenario, field=StaticField(strength_T=0.001, direction=(0, 1, 0))))
    assert np.isnan(run.attrs["twist_deg"])
    assert run.attrs["flipped"] == 0


def test_progress_reports_every_step_in_the_end(scenario: Scenario) -> None:
    seen: list[int] = []
    simulate(scenario, progress=seen.append)
    assert seen[-1] == 500
    assert seen == sorted(seen)


def test_an_exception_in_the_callback_comes_through(scenario: Scenario) -> None:
    def stop(done: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        simulate(replace(scenario, run=Run(duration_s=20.0, step_s=5e-4)), progress=stop)


def test_an_unknown_solver_is_refused(scenario: Scenario) -> None:
    with pytest.raises(InputError, match="solver: found 'magic', expected reduced or general"):
        simulate(scenario, solver="magic")  # type: ignore[arg-type]


def test_a_saved_run_loads_as_itself(tmp_path: Path) -> None:
    run = simulate(preset_scenario("spiked", duration_s=0.01))
    save_netcdf(run, tmp_path / "run.nc")
    with xr.open_dataset(tmp_path / "run.nc", engine="h5netcdf") as loaded:
        xr.testing.assert_equal(loaded, run)
        assert loaded.attrs["scenario"] == run.attrs["scenario"]
        assert loaded["friction_force_N"].attrs["third_component"] == "moment"
    assert [file.name for file in tmp_path.iterdir()] == ["run.nc"]


def test_a_save_that_fails_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run = simulate(preset_scenario("spiked", duration_s=0.01))
    path = tmp_path / "run.nc"
    path.write_bytes(b"old")

    def interrupted(self: Path, data: bytes) -> int:
        with self.open("wb") as file:
            file.write(data[: len(data) // 2])
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "write_bytes", interrupted)
    with pytest.raises(KeyboardInterrupt):
        save_netcdf(run, path)
    assert path.read_bytes() == b"old"
    assert [file.name for file in tmp_path.iterdir()] == ["run.nc"]


def test_a_motion_that_diverges_is_a_failure(scenario: Scenario, monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*arguments: object) -> None:
        raise ArithmeticError("the state is not finite any more at 0.1 s: the motion diverged")

    monkeypatch.setattr(_core, "simulate", fails)
    for progress in (False, True, lambda done: None):
        with pytest.raises(SimulationError, match=r"^the state is not finite any more at 0\.1 s"):
            simulate(scenario, progress=progress)


def test_an_error_of_the_callback_stays_its_own(scenario: Scenario) -> None:
    def stop(done: int) -> None:
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        simulate(scenario, progress=stop)


def test_more_rows_than_memory_are_refused_before_the_run(scenario: Scenario) -> None:
    long = Run(duration_s=10000.0, step_s=5e-4)
    with pytest.raises(InputError, match=r"run\.output_every_s: found 20000001 rows .* set a larger output_every_s"):
        simulate(replace(scenario, run=long))
    replace(long, output_every_s=1.0).check_rows()


@pytest.mark.parametrize(("duration_s", "every_s"), [(0.0102, None), (0.01, None), (0.0102, 2e-3), (5e-4, 5e-4)])
def test_a_run_covers_its_time_in_whole_steps(scenario: Scenario, duration_s: float, every_s: float | None) -> None:
    run = Run(duration_s=duration_s, step_s=5e-4, output_every_s=every_s)
    made = simulate(replace(scenario, run=run))
    assert made.sizes["time"] == run.rows
    assert run.steps == replace(scenario, run=run).trial().steps
    assert float(made["time"][-1]) == pytest.approx(run.steps * 5e-4, rel=1e-12)
    assert run.steps * 5e-4 >= duration_s * (1.0 - 1e-9)


def test_a_native_failure_is_of_this_packages_tree(scenario: Scenario, monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*arguments: object) -> None:
        raise ValueError("the batch\npanicked")

    monkeypatch.setattr(_core, "simulate", fails)
    with pytest.raises(SimulationError, match=r"^the batch panicked$"):
        simulate(scenario)
