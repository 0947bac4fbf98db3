from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib import colormaps
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from tumblers import Scenario, faster_cases, preferred_cases, preset_scenario, simulate, sweep
from tumblers.effects.size_error import SizeError
from tumblers.plots import (
    figure_bytes,
    plot_contact_modes,
    plot_forces,
    plot_map,
    plot_run,
    plot_sweep,
    plot_top_view,
    plot_trajectory,
)


@pytest.fixture(autouse=True)
def _no_windows() -> Iterator[None]:
    plt.switch_backend("Agg")
    yield
    plt.close("all")


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
    # The row before the first step has no contact force, and is left out.
    np.testing.assert_allclose(normal.get_xdata(), run["time"][1:])
    np.testing.assert_allclose(normal.get_ydata(), run["normal_force_N"][1:] * 1e6)
    np.testing.assert_allclose(friction.get_ydata(), np.hypot(*run["friction_force_N"].values[1:, :2].T) * 1e6)
    np.testing.assert_allclose(adhesion.get_ydata(), run["adhesion_force_N"][1:] * 1e6)
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


def test_the_view_from_above_has_the_body_with_every_effect() -> None:
    scenario = preset_scenario("cuboid_on_paper", duration_s=0.002)
    ax = plot_top_view(simulate(replace(scenario, effects=(SizeError(length_factor=2.0),))), snapshots=1)
    (shot,) = (c for c in ax.collections if isinstance(c, PolyCollection))
    corners = np.concatenate([path.vertices for path in shot.get_paths()])
    # Twice the 800 µm of the scenario's own robot.
    assert np.ptp(corners[:, 0]) == pytest.approx(1600.0)


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


def ticks(ax: Axes, minor: bool = False) -> list[str]:
    return [label.get_text() for label in ax.get_xticklabels(minor=minor)]


@pytest.mark.parametrize("peak", [1.4, 10.0])
def test_a_peak_at_the_start_leaves_the_scale_with_a_note(run: xr.Dataset, peak: float) -> None:
    normal = np.ones(run.sizes["time"]) * 1e-6
    normal[1] = peak * 1e-6
    none = {"friction_force_N": run["friction_force_N"] * 0.0, "adhesion_force_N": run["adhesion_force_N"] * 0.0}
    ax = plot_forces(run.assign(normal_force_N=("time", normal), **none))
    assert (ax.get_ylim()[1] < peak) == (peak > 1.5)
    notes = [text.get_text() for text in ax.texts]
    assert notes == (["off the scale at the start: up to 10 µN at 0.0005 s"] if peak > 1.5 else [])


def test_a_thin_path_gets_a_low_view_from_above(run: xr.Dataset) -> None:
    moved = run["position_m"].copy()
    moved[:, 1] = np.linspace(0.0, 0.05, run.sizes["time"])
    thin, figure = plot_run(run.assign(position_m=moved)), plot_run(run)
    assert thin.get_size_inches()[1] < figure.get_size_inches()[1]


def test_the_case_without_error_is_told_from_theta2_of_zero() -> None:
    short = preset_scenario("spiked", duration_s=0.001)
    result = sweep(short, drafts_deg=[0.0], magnetization=[(0, 0), (10, 0), (10, 90)])
    ax = plot_map(result, "speed_m_per_s")
    assert ticks(ax) == ["none", "0", "90"]
    assert ax.get_xlabel() == "θ2 (°) at θ1 = 10°; none: no magnetization error"
    grouped = sweep(short, drafts_deg=[0.0], magnetization=[(0, 0), (5, 0), (5, 90), (10, 0), (10, 90)])
    ax = plot_map(grouped, "speed_m_per_s")
    assert ticks(ax) == ["none", "0", "90", "0", "90"]
    assert [words.strip() for words in ticks(ax, minor=True)] == ["θ1 = 5°", "θ1 = 10°"]
    figure = plot_sweep(grouped)
    assert figure.get_suptitle() == "Manufacturing errors: spiked robot, 20 mT at 1 Hz"


@pytest.mark.parametrize(("name", "noise"), [("twist_deg", 1e-9), ("drift_m", 1e-15), ("speed_m_per_s", 1e-15)])
def test_rounding_noise_looks_neutral(made: xr.Dataset, name: str, noise: float) -> None:
    shape = made[name].shape
    values = noise * np.linspace(-1.0, 1.0, made[name].size).reshape(shape)
    made = made.assign({name: (made[name].dims, values), "flipped": (made[name].dims, np.zeros(shape, dtype=bool))})
    del made.attrs["ideal_speed_m_per_s"], made.attrs["flipped_speed_m_per_s"]
    norm = plot_map(made, name).collections[0].norm  # type: ignore[arg-type]
    assert norm.vmax - norm.vmin == pytest.approx(2.0)


def test_half_a_turn_to_either_side_is_one_colour(made: xr.Dataset) -> None:
    twist = np.array([[180.0, -179.9, 90.0], [-90.0, 0.0, 0.0]])
    mesh = plot_map(made.assign(twist_deg=(made["twist_deg"].dims, twist)), "twist_deg").collections[0]
    left, right, up, down = (np.array(mesh.cmap(mesh.norm(angle))) for angle in (180.0, -179.9, 90.0, -90.0))
    assert np.abs(left - right).max() < 0.02
    assert np.abs(up - down).max() > 0.2
    small = plot_map(made, "twist_deg").collections[0]
    assert small.cmap == colormaps["PuOr"]


def test_pyplot_saves_what_was_plotted(run: xr.Dataset, made: xr.Dataset, tmp_path: Path) -> None:
    for name, plot in {"run": lambda: plot_run(run), "sweep": lambda: plot_sweep(made)}.items():
        assert plot() is plt.gcf()
        plt.savefig(tmp_path / f"{name}.png", dpi=40)
        assert plt.imread(tmp_path / f"{name}.png").std() > 0.05
    assert plot_forces(run) is plt.gca()


@pytest.mark.parametrize(("kind", "start"), [("png", b"\x89PNG"), ("pdf", b"%PDF"), ("svg", b"<?xml")])
def test_files_leave_no_figure_behind(run: xr.Dataset, made: xr.Dataset, kind: str, start: bytes) -> None:
    assert figure_bytes(run, kind, dpi=40).startswith(start)
    assert figure_bytes(made, kind, dpi=40).startswith(start)
    assert plt.get_fignums() == []
