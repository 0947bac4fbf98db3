from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.text import Text

from tumblers import InputError, preset_scenario, simulate
from tumblers.plots import plot_snapshots
from tumblers.plots.pictures import snapshots_bytes
from tumblers.plots.snapshots import snapshots_size


@pytest.fixture(scope="module")
def run() -> xr.Dataset:
    scenario = preset_scenario("spiked", duration_s=2.0)
    return simulate(replace(scenario, robot=scenario.robot.with_magnetization(10.0, 0.0).with_draft(4.0)))


def drawn(run: xr.Dataset, times_s: list[float] | None = None) -> Axes:
    figure = Figure(figsize=snapshots_size(run, times_s), layout="constrained")
    ax = plot_snapshots(run, times_s, figure.subplots())
    figure.draw_without_rendering()
    return ax


def test_the_robot_is_at_the_times_that_are_written(run: xr.Dataset) -> None:
    ax = drawn(run, [0.0, 0.7, 2.0])
    assert [text.get_text() for text in ax.texts] == ["0 s", "0.7 s", "2 s"]
    shots = [c for c in ax.collections if isinstance(c, PolyCollection)]
    assert len(shots) == 3
    for shot, row in zip(shots, (0, 1400, 4000), strict=True):
        corners = np.concatenate([path.vertices for path in shot.get_paths()])
        x, y = run["position_m"].values[row, :2] * 1e3
        # The centre of mass is inside the outline; x is to the right and y up.
        assert corners[:, 0].min() < x < corners[:, 0].max()
        assert corners[:, 1].min() < y < corners[:, 1].max()
    (path, marks) = ax.get_lines()
    np.testing.assert_allclose(path.get_xydata(), run["position_m"].values[:, :2] * 1e3)
    np.testing.assert_allclose(marks.get_xydata(), run["position_m"].values[[0, 1400, 4000], :2] * 1e3)


def test_everything_is_inside_and_at_one_scale(run: xr.Dataset) -> None:
    ax = drawn(run)
    assert ax.get_aspect() == 1.0
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("x (mm)", "y (mm)")
    (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    corners = np.concatenate([p.vertices for c in ax.collections for p in c.get_paths()])
    assert left < corners[:, 0].min()
    assert corners[:, 0].max() < right
    assert bottom < corners[:, 1].min()
    assert corners[:, 1].max() < top
    # The path fills the height of the figure made for it: no more than the margins, 0.4 of the robot's size, are empty.
    assert np.ptp(corners[:, 1]) > 0.8 * (top - bottom)


@pytest.mark.parametrize("times_s", [None, list(np.linspace(0.0, 0.06, 7))])
def test_no_time_is_written_over_another(run: xr.Dataset, times_s: list[float] | None) -> None:
    ax = drawn(run, times_s)
    # Those of the words, without their leaders.
    boxes = [Text.get_window_extent(text) for text in ax.texts]
    assert len(boxes) >= 5
    assert not any(a.overlaps(b) for k, a in enumerate(boxes) for b in boxes[:k])
    whole = ax.figure.bbox
    assert all(whole.x0 <= box.x0 and box.x1 <= whole.x1 and whole.y0 <= box.y0 and box.y1 <= whole.y1 for box in boxes)


def test_a_robot_that_rests_is_drawn(run: xr.Dataset) -> None:
    at_rest = run.isel(time=slice(0, 2)).assign_coords(time=[0.0, 1.0])
    assert len(drawn(at_rest).texts) > 1


def test_times_outside_the_run_are_refused(run: xr.Dataset) -> None:
    for times_s in ([], [-0.1], [2.1]):
        with pytest.raises(InputError, match="times_s"):
            plot_snapshots(run, times_s, Figure().subplots())


def test_files(run: xr.Dataset) -> None:
    assert snapshots_bytes(run, "png", dpi=40).startswith(b"\x89PNG")
    assert snapshots_bytes(run, "svg").startswith(b"<?xml")
