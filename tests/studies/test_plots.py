from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

import tumblers
from tumblers import preset_scenario
from tumblers.plots.image import figure_bytes
from tumblers.studies.plots import plot_climb, plot_convergence, plot_design, plot_tolerance
from tumblers.studies.robust import Errors


def legend(figure: Figure, place: int = 0) -> list[str]:
    shown = figure.axes[place].get_legend()
    assert shown is not None
    return [text.get_text() for text in shown.get_texts()]


def test_climb_shows_what_was_climbed_and_both_limits() -> None:
    scenario = preset_scenario("cuboid_up_aluminium")
    scenario = replace(scenario, substrate=replace(scenario.substrate, line_contact_width_m=6e-6))
    result = tumblers.climb(scenario, slopes_deg=[0.0, 20.0, 40.0, 60.0])
    figure = plot_climb(result, Figure())
    (ax,) = figure.axes
    lines = {line.get_label(): line for line in ax.get_lines()}
    assert len(lines["climbs"].get_xdata()) == int(result.climbs.sum())
    shown = sum(len(lines[label].get_xdata()) for label in ("climbs", "does not climb", "slides back faster"))
    assert shown == result.sizes["incline_deg"]
    words = " ".join(legend(figure))
    for expected in ("limit 32.", "friction limit 28.4°", "friction limit with line adhesion 32.3°"):
        assert expected in words


def test_tolerance_outlines_what_is_kept() -> None:
    result = tumblers.tolerance(
        preset_scenario("spiked"), drafts_deg=[0.0, 1.0, 2.0], theta1_deg=[0.0, 10.0], theta2_deg=[-10.0, 0.0, 10.0]
    )
    # One cell in the middle: four edges, half a cell around it.
    kept = np.zeros(result.kept.shape, dtype=bool)
    kept[1, :, 1] = True
    figure = plot_tolerance(result.assign(kept=(result.kept.dims, kept)), Figure())
    (outline,) = (c for c in figure.axes[0].collections if isinstance(c, LineCollection) and c.get_gid() == "kept")
    edges = {tuple(map(tuple, segment)) for segment in np.array(outline.get_segments())}
    corners = {point for edge in edges for point in edge}
    assert len(edges) == 4
    assert corners == {(-5.0, 0.5), (5.0, 0.5), (-5.0, 1.5), (5.0, 1.5)}


@pytest.mark.parametrize("robot", ["cuboid_second_generation", "curved_su8"])
def test_design_draws_every_family(robot: str) -> None:
    scenario = preset_scenario(robot=robot, substrate="aluminium", drive=tumblers.drive(0.020, 10.0), duration_s=0.1)
    result = tumblers.design(scenario, samples=8, generations=0, errors=Errors(draws=8))
    figure = plot_design(result, Figure())
    assert legend(figure)[-3:] == ["base", "nominal", "robust"]
    assert figure_bytes(result, "png", 40.0, draw=plot_design).startswith(b"\x89PNG")


def test_convergence_has_a_panel_for_each_number() -> None:
    result = tumblers.convergence(numbers=["spiked_speed", "spiked_drift"], steps_s=[5e-4, 2.5e-4], e_r_m=[0.1])
    figure = plot_convergence(result, Figure())
    shown = [ax for ax in figure.axes if ax.get_visible()]
    assert [ax.get_title(loc="left") for ax in shown] == result.words.values.tolist()
    curves = [line for line in shown[1].get_lines() if line.get_label() != "the paper"]
    assert len(curves) == 3
    assert curves[0].get_ydata() == pytest.approx(result.value.values[1, 0, :, 0] * 1e6)


@pytest.mark.parametrize(("count", "columns"), [(1, 1), (2, 2), (4, 3)])
def test_convergence_leaves_no_empty_columns(count: int, columns: int) -> None:
    numbers = ["spiked_speed", "spiked_ends_speed", "spiked_drift", "spiked_twist"][:count]
    result = tumblers.convergence(numbers=numbers, steps_s=[5e-4], torques=["end_of_step"], e_r_m=[0.1])
    figure = plot_convergence(result, Figure())
    shown = [ax.get_subplotspec() for ax in figure.axes if ax.get_visible()]
    assert {spec.get_gridspec().ncols for spec in shown if spec is not None} == {columns}
    assert len(shown) == count
