from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from tumblers import Scenario, faster_cases, preferred_cases, preset_scenario, simulate, sweep
from tumblers.plots import (
    plot_contact_modes,
    plot_forces,
    plot_map,
    plot_run,
    plot_sweep,
    plot_top_view,
    plot_trajectory,
)


@pytest.fixture(scope="module")
def run() -> xr.Dataset:
    return simulate(preset_scenario("spiked", duration_s=0.5))


@pytest.fixture(scope="module")
def made() -> xr.Dataset:
    """Return a sweep with numbers of its own: one flip, one drift too far, one failure, one slow, one marked twice."""
    result = sweep(
        preset_scenario("spiked", duration_s=0.005), drafts_deg=[0.0, 1.0], magnetization=[(0, 0), (10, 10), (10, 20)]
    )
    dims = ("draft_deg", "magnetization_case")
    twist = np.array([[0.0, 80.0, -5.0], [3.0, np.nan, 2.0]])
    return result.assign(
        twist_deg=(dims, twist),
        flipped=(dims, np.abs(twist) > 45.0),
        drift_m=(dims, np.array([[0.0, 10.0, -70.0], [20.0, np.nan, -50.0]]) * 1e-6),
        speed_m_per_s=(dims, np.array([[1093.0, 1200.0, 1210.0], [1250.0, np.nan, 1000.0]]) * 1e-6),
    )


def axes() -> Axes:
    return Figure().subplots()


def marked(ax: Axes) -> set[tuple[int, int]]:
    (cells,) = [c for c in ax.collections if c.get_gid() == "marked"]
    centres = [path.get_extents().get_points().mean(axis=0) for path in cells.get_paths()]
    return {(round(y), round(x)) for x, y in centres}


def test_trajectory_shows_micrometres(run: xr.Dataset) -> None:
    ax = axes()
    assert plot_trajectory(run, ax) is ax
    x, y, z = ax.get_lines()
    np.testing.assert_allclose(y.get_ydata(), (run["position_m"][:, 1] - run["position_m"][0, 1]) * 1e6)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("time (s)", "displacement (µm)")
    assert [line.get_label()[0] for line in (x, y, z)] == ["x", "y", "z"]


def test_contact_modes_are_named(run: xr.Dataset) -> None:
    ax = plot_contact_modes(run)
    np.testing.assert_array_equal(ax.get_lines()[0].get_ydata(), run["contact_mode"])
    assert [tick.get_text() for tick in ax.get_yticklabels()] == ["airborne", "point", "line", "surface"]


def test_forces_are_in_micronewtons(run: xr.Dataset) -> None:
    ax = plot_forces(run)
    normal, friction, adhesion = ax.get_lines()
    np.testing.assert_allclose(normal.get_ydata(), run["normal_force_N"] * 1e6)
    np.testing.assert_allclose(friction.get_ydata(), np.hypot(*run["friction_force_N"].values[:, :2].T) * 1e6)
    np.testing.assert_allclose(adhesion.get_ydata(), run["adhesion_force_N"] * 1e6)
    assert ax.get_ylabel() == "force (µN)"


def test_the_view_from_above_has_the_real_outline(run: xr.Dataset) -> None:
    ax = plot_top_view(run, snapshots=3)
    shots = [c for c in ax.collections if isinstance(c, PolyCollection)]
    outline = Scenario.from_toml(run.attrs["scenario"]).robot.body().outline
    assert len(shots) == 3
    assert all(len(shot.get_paths()) == len(outline) for shot in shots)
    # At the start the body frame is the substrate frame, moved to the centre of mass.
    corners = np.concatenate([path.vertices for path in shots[0].get_paths()])
    np.testing.assert_allclose(corners[:, 0].max(), np.concatenate(outline)[:, 1].max() * 1e6, rtol=1e-9)
    np.testing.assert_allclose(corners[:, 1].max(), np.concatenate(outline)[:, 0].max() * 1e6, rtol=1e-9)
    assert ax.yaxis_inverted()
    assert "µm" in ax.get_xlabel()


@pytest.mark.parametrize("name", ["twist_deg", "drift_m"])
def test_marks_on_the_maps_of_twist_and_drift(made: xr.Dataset, name: str) -> None:
    ax = plot_map(made, name)  # type: ignore[arg-type]
    assert marked(ax) == {(0, 0), (1, 0), (1, 2)}
    assert marked(ax) == {tuple(cell) for cell in np.argwhere(preferred_cases(made).values)}
    factor = 1.0 if name == "twist_deg" else 1e6
    np.testing.assert_allclose(np.ma.filled(ax.collections[0].get_array(), np.nan), made[name] * factor)


def test_marks_on_the_map_of_speed(made: xr.Dataset) -> None:
    ax = plot_map(made, "speed_m_per_s")
    assert marked(ax) == {(1, 0)}
    assert marked(ax) == {tuple(cell) for cell in np.argwhere(faster_cases(made).values)}
    bar = ax.collections[0].colorbar
    assert bar is not None
    speeds = {line.get_label(): line.get_ydata()[0] for line in bar.ax.get_lines() if len(line.get_ydata()) == 2}
    assert speeds["ideal"] == pytest.approx(1093.4, abs=0.1)
    assert speeds["flipped"] == pytest.approx(1200.0, abs=1e-9)
    assert bar.ax.get_ylabel() == "speed (µm/s)"
    legend = ax.get_legend()
    assert legend is not None
    assert any("ideal: 1093.4 µm/s" in entry.get_text() for entry in legend.get_texts())


def test_maps_of_a_single_failed_case_are_drawn(made: xr.Dataset) -> None:
    plot_sweep(made.isel(draft_deg=[1], magnetization_case=[1]))


def test_figures_are_saved_without_a_display(run: xr.Dataset, made: xr.Dataset, tmp_path: Path) -> None:
    for name, figure in {"run": plot_run(run), "sweep": plot_sweep(made)}.items():
        figure.savefig(tmp_path / f"{name}.png")
        assert (tmp_path / f"{name}.png").read_bytes().startswith(b"\x89PNG")
    assert mpl.get_backend() is not None
