from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from tumblers import InputError, StaticField, preset_scenario, simulate
from tumblers.plots import plot_cycle
from tumblers.plots.contact import MODE_COLOURS
from tumblers.plots.cycle import cycle_count
from tumblers.plots.pictures import cycle_bytes


@pytest.fixture(scope="module")
def run() -> xr.Dataset:
    return simulate(preset_scenario("cuboid_up_paper", duration_s=2.5))


def bodies(ax: Axes) -> list[PolyCollection]:
    # The substrate is a collection too, below the bodies.
    return [c for c in ax.collections if isinstance(c, PolyCollection) and c.get_zorder() >= 2.0]


def numbers(ax: Axes) -> list[str]:
    return [text.get_text() for text in ax.texts if text.get_text().isdigit()]


def test_the_robot_is_coloured_by_its_contact(run: xr.Dataset) -> None:
    side, strip = plot_cycle(run, figure=Figure()).axes
    shots = bodies(side)
    assert len(shots) == 10
    assert numbers(side) == numbers(strip) == [str(k) for k in range(1, 11)]
    times = [text.get_position()[0] for text in strip.texts]
    # The second cycle of 1 Hz.
    assert (times[0], times[-1]) == (1.0, 2.0)
    modes = run["contact_mode"].sel(time=times, method="nearest").values
    for shot, mode in zip(shots, modes, strict=True):
        edge = np.array(shot.get_edgecolor()[-1][:3])
        np.testing.assert_allclose(edge, 0.8 * np.array(to_rgb(MODE_COLOURS[mode])), atol=1e-9)
    # The cuboid lies flat for 1 % of the cycle only, and is shown there.
    assert set(modes) == set(run["contact_mode"].values[2001:4001])


def test_every_instant_is_where_the_run_says(run: xr.Dataset) -> None:
    side, strip = plot_cycle(run, cycle=0, instants=8, figure=Figure()).axes
    times = [text.get_position()[0] for text in strip.texts]
    places = [text.get_position() for text in side.texts if text.get_text().isdigit()]
    rows = [int(abs(run["time"].values - t).argmin()) for t in times]
    np.testing.assert_allclose(places, run["position_m"].values[rows, 1:] * 1e3)
    (left, right), (bottom, top) = side.get_xlim(), side.get_ylim()
    corners = np.concatenate([path.vertices for shot in bodies(side) for path in shot.get_paths()])
    assert left < corners[:, 0].min()
    assert corners[:, 0].max() < right
    assert bottom < corners[:, 1].min()
    assert corners[:, 1].max() < top
    # It stands on the substrate, z = 0; the numerical penetration is far below a nanometre.
    assert corners[:, 1].min() == pytest.approx(0.0, abs=1e-6)
    assert side.get_aspect() == 1.0


def test_the_strip_is_the_contact_mode(run: xr.Dataset) -> None:
    _, strip = plot_cycle(run, cycle=1, figure=Figure()).axes
    assert [label.get_text() for label in strip.get_yticklabels()] == ["airborne", "point", "line", "surface"]
    step = 5e-4
    for kind, bars in enumerate(strip.collections):
        widths = [np.ptp(path.vertices[:, 0]) for path in bars.get_paths()]
        assert sum(widths) == pytest.approx(step * (run["contact_mode"].values[2001:4001] == kind).sum(), abs=1e-9)


def test_gravity_shows_the_slope(run: xr.Dataset) -> None:
    side, _ = plot_cycle(run, figure=Figure()).axes
    assert any(text.get_text() == "g, slope 45°" for text in side.texts)
    (arrow,) = [text for text in side.texts if text.get_text() == ""]
    across, upward = arrow.get_position()
    # Down the slope and into the substrate alike.
    assert across == pytest.approx(upward)
    assert across < 0.0


def test_a_run_without_a_cycle_is_shown_whole() -> None:
    scenario = preset_scenario("cuboid_on_paper", duration_s=0.05)
    static = simulate(replace(scenario, field=StaticField(strength_T=0.01, direction=(0.0, 0.0, 1.0))))
    for whole in (static, simulate(scenario)):
        assert cycle_count(whole) == 1
        figure = plot_cycle(whole, figure=Figure())
        assert figure.axes[1].get_xlim() == pytest.approx((0.0, 0.05))
        assert figure.get_suptitle().startswith("The run: ")


def test_what_is_not_there_is_refused(run: xr.Dataset) -> None:
    assert cycle_count(run) == 2
    for cycle, instants in ((2, 10), (-1, 10), (0, 1)):
        with pytest.raises(InputError, match="expected"):
            plot_cycle(run, cycle, instants, figure=Figure())


def test_files(run: xr.Dataset) -> None:
    assert cycle_bytes(run, "png", dpi=40).startswith(b"\x89PNG")
    assert cycle_bytes(run, "pdf").startswith(b"%PDF")
