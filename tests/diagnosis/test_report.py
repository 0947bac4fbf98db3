"""The report and its figures."""

from __future__ import annotations

import json
import re
import tomllib
from dataclasses import replace
from html import unescape
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from tumblers import InputError
from tumblers.dataset import LabTrial, Outcome
from tumblers.diagnosis import plots
from tumblers.diagnosis.diagnosis import FILES, Diagnosis
from tumblers.diagnosis.report.report import report_html
from tumblers.diagnosis.result import MissingWrench, Overlay, Region, WrenchMean
from tumblers.diagnosis.wording.headline import headline
from tumblers.diagnosis.wording.phrase import title_of
from tumblers.effects import CATALOGUE
from tumblers.field import field_from_table

from .example import lab, made, no_gap, outcomes_only, small, wrench


class Reader(HTMLParser):
    """Keeps what a page shows, what it would run and what it would load, and that every tag is closed."""

    VOID = ("meta", "img", "br")

    def __init__(self, page: str) -> None:
        super().__init__()
        self.words, self.tags, self.open, self.loads, self.styles = "", [], [], [], []
        self.feed(page)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.loads += [value or "" for name, value in attrs if name in ("src", "href", "action", "data")]
        assert not any(name.startswith("on") for name, _ in attrs)
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if "style" not in self.open:
            self.words += data


@pytest.fixture(scope="module")
def page() -> str:
    return report_html(made())


def test_the_report_is_self_contained_and_has_every_part(page: str) -> None:
    read = Reader(page)
    assert "script" not in read.tags
    assert all(load.startswith(("data:image/svg+xml;base64,", "#")) for load in read.loads)
    assert re.findall(r"https?://", re.sub(r'src="data:[^"]*"', "", page)) == []
    words = " ".join(read.words.split())
    for part in (
        headline(made()),
        "How far",
        "Where",
        "The missing wrench",
        "What: the ranking",
        "Parameters",
        "Before and after",
        "Ties and the next trial",
        "The noise floor",
        "Assumptions",
        "The nominal mass, magnetization and friction are right to within 0.5 %.",
        "tumblers 0.2.0, seed 0",
        "gradient_T_per_m = [0.0004, 0.0482, 0.01]",
        "stray field gradient + substrate tilt",
        "240 ± 15 nN",
        "mean speed 31.2 ± 0.4 mm/s",
        "climbs with 97 % probability",
        "250 µs",
        "0.0441 to 0.0522 T/m",
    ):
        assert part in words
    assert "nan" not in words.lower()


def test_the_same_answer_is_the_same_report_whatever_the_time_it_took() -> None:
    assert report_html(small()) == report_html(small(seconds=1.0))


@pytest.mark.parametrize("diagnosis", [no_gap(), outcomes_only(), small(floors=(), assumptions=(), where=())])
def test_a_report_without_some_parts_is_whole(diagnosis: Diagnosis) -> None:
    read = Reader(report_html(diagnosis))
    assert " nan" not in read.words.lower()
    assert headline(diagnosis) in read.words


def test_everything_that_is_ruled_out_is_named() -> None:
    names = list(CATALOGUE)[:9]
    words = Reader(report_html(small(ruled_out=dict.fromkeys(names, "f01")))).words
    assert f"{', '.join(map(title_of, names))} by trial f01" in words
    assert "more in the report" not in words


def test_outcomes_are_in_words() -> None:
    page = report_html(small(overlays=made().overlays[-2:]))
    # Measured, nominal (it slides), with the effects.
    cells = re.search(r"<td>slope30</td><td>climbs</td>(.*?)</tr>", page)
    assert cells is not None
    assert re.findall(r">(\w+)</td>", cells.group(1)) == ["yes", "no", "yes"]
    assert "<td>tilt05</td><td>tilt</td>" in page


def test_what_a_user_wrote_is_shown_and_never_run() -> None:
    evil = '<script>alert("&")</script>'
    data = lab(title=evil)
    odd = '<img src=x onerror=y> $x$ $\\frac{ "日本'
    trials = (replace(data.trials[0], id=odd), *data.trials[1:])
    known = made()
    diagnosis = made(
        dataset=replace(data, trials=trials),
        overlays=(replace(known.overlays[0], trial=odd),),
        missing_wrench=None,
        floors=(replace(known.floors[0], trial=odd), *known.floors[1:]),
        gap=replace(known.gap, by_trial={odd: (3.0, 2.0, 1.0)}),
        where=(Region("trial", 0.9, value=odd),),
        heat_maps=(replace(known.heat_maps[0], row_labels=(odd, *known.heat_maps[0].row_labels[1:])),),
        assumptions=(evil,),
        ruled_out={"substrate_tilt": odd},
    )
    read = Reader(report_html(diagnosis))
    assert "script" not in read.tags
    assert f"Diagnosis: {evil}" in read.words
    assert odd in read.words
    assert all(load.startswith(("data:", "#")) for load in read.loads)


def test_saving_writes_every_file(tmp_path: Path) -> None:
    small().save(tmp_path / "out")
    assert {file.name for file in (tmp_path / "out").iterdir()} == set(FILES)
    table = json.loads((tmp_path / "out" / "diagnosis.json").read_text())
    assert table["effects"][0]["name"] == "stray_field_gradient"


def test_figures_are_drawn_on_what_they_are_given() -> None:
    figures = plots.Figures(made())
    for draw in (figures.gap, figures.ranking, figures.parameters):
        ax = Figure().subplots()
        assert draw(ax) is ax
    assert len(figures.where(Figure()).axes) == 2 * len(made().heat_maps) + 1
    assert len(figures.wrench("mode", Figure()).axes) == 2
    # Five channels, and the difference along y.
    assert len(figures.overlay("f15", Figure()).axes) == 6
    with pytest.raises(InputError, match="f15"):
        figures.overlay("f99", Figure())
    with pytest.raises(InputError, match="missing_wrench"):
        plots.Figures(no_gap()).wrench(figure=Figure())


def test_a_wrench_of_which_the_data_say_nothing_is_hollow_and_cut_off() -> None:
    ax = plots.plot_wrench(wrench(), "frequency", "force", Figure().subplots())
    hollow = [line for line in ax.lines if line.get_markerfacecolor() == "white" and len(line.get_xdata())]
    assert len(hollow) == 1
    assert ax.get_ylim()[1] == pytest.approx(1.25 * 255.0)


def test_a_missing_wrench_beyond_the_edge_is_marked_there() -> None:
    beyond = replace(wrench(), by_frequency={**wrench().by_frequency, "20 Hz": _far(wrench())})
    ax = plots.plot_wrench(beyond, "frequency", "force", Figure().subplots())
    marked = [line for line in ax.lines if "arrow" in str(line.get_marker()) and len(line.get_xdata())]
    # Along z by -9e-7 N, of which the data say little; what lies within is not marked.
    (line,) = marked
    assert line.get_xdata().tolist() == pytest.approx([3.2])
    assert -ax.get_ylim()[1] < line.get_ydata()[0] < 0.0
    inside = plots.plot_wrench(wrench(), "frequency", "force", Figure().subplots())
    assert not any("arrow" in str(line.get_marker()) and len(line.get_xdata()) for line in inside.lines)


def _far(missing: MissingWrench) -> WrenchMean:
    mean = missing.by_frequency["10 Hz"]
    return replace(mean, wrench=np.where(np.arange(6) == 2, -9e-7, mean.wrench))


def test_what_is_unknown_is_so_by_the_field_of_its_own_trials() -> None:
    # As unsure as the others, of a field half as strong it is all that was assumed.
    mean = wrench().by_frequency["10 Hz"]
    weak = replace(mean, sigma=mean.prior_sigma * 0.5, prior_sigma=mean.prior_sigma * 0.5)
    for at, hollow in ((weak, 3), (replace(weak, prior_sigma=mean.prior_sigma), 0)):
        ax = plots.plot_wrench(
            replace(wrench(), by_frequency={"10 Hz": at}), "frequency", "torque", Figure().subplots()
        )
        assert sum(len(line.get_xdata()) for line in ax.lines if line.get_markerfacecolor() == "white") == hollow


def test_what_was_assumed_of_a_wrench_is_told_from_the_weakest_to_the_strongest_field() -> None:
    prior = wrench().prior_sigma * np.array([[1.0], [1.0], [2.0], [2.0]]) ** np.array([0, 0, 0, 1, 1, 1])
    page = report_html(made(missing_wrench=replace(wrench(), prior_sigma=prior)))
    assert "0 ± 300 nN and 0 ± 1.3 nN m to 2.6 nN m" in page


def test_headings_across_half_a_turn_are_drawn_near_each_other() -> None:
    nominal = np.array([178.0, 179.5, -179.0, -178.0])
    seen = np.array([-179.5, 179.0, 179.5, -178.5])
    overlay = Overlay("f15", np.arange(4.0), {"heading": seen}, {"heading": nominal}, {"heading": seen + 0.1}, {})
    ax = plots.plot_overlay_channel(overlay, "heading", Figure().subplots())
    measured, dashed, solid = (np.asarray(line.get_ydata()) for line in ax.lines)
    assert measured.tolist() == pytest.approx([180.5, 179.0, -180.5, -178.5])
    # No line goes across the panel.
    assert np.isnan(dashed).tolist() == [False, False, True, False]
    assert np.nanmax(np.abs(np.diff(solid))) < 180.0
    # Of an axis half a turn is all.
    axis = Overlay("f15", np.arange(1.0), {"heading": [-89.5]}, {"heading": [89.0]}, {"heading": [89.0]}, {}, 180.0)
    measured = plots.plot_overlay_channel(axis, "heading", Figure().subplots()).lines[0]
    assert np.asarray(measured.get_ydata()).tolist() == [90.5]


def test_the_band_of_an_overlay_is_two_deviations_to_either_side_and_does_not_stretch_the_panel() -> None:
    line, noise = np.array([0.0, 1e-6, 2e-6]), np.array([1e-6, np.nan, 1.0])
    overlay = Overlay("f15", np.arange(3.0), {"y": line}, {"y": line}, {"y": line}, {}, noise={"y": noise})
    ax = plots.plot_overlay_channel(overlay, "y", Figure().subplots())
    (band,) = ax.collections
    corners = np.concatenate([path.vertices for path in band.get_paths()])
    assert {-2.0, 2.0} <= {*np.round(corners[corners[:, 0] == 0.0, 1], 9)}
    assert not np.any(corners[:, 0] == 1.0)
    assert ax.get_ylim()[1] < 3.0
    assert not plots.plot_overlay_channel(replace(overlay, noise={}), "y", Figure().subplots()).collections


def test_under_an_overlay_stands_what_the_sensor_and_the_effects_leave_of_it(page: str) -> None:
    assert "34.2 σ with a perfect sensor, 34.0 σ with the sensor refitted, 1.2 σ with the effects" in page
    assert "1.2 σ with the effects" not in report_html(small(verdict="unexplained", effects=(), chosen=()))


def test_the_last_gap_is_named_by_what_it_is_of() -> None:
    for verdict, words in (("explained", "the effects of the verdict"), ("unexplained", "what follows the data best")):
        assert f"with {words}" in report_html(small(verdict=verdict))
    assert "the effects of the verdict" not in report_html(no_gap())


def test_a_speed_is_said_to_be_of_the_runs_that_stay_in_view_where_others_do_not() -> None:
    (proposed,) = small().next_trials
    said = {"a": {"climbs": (0.5, 0.5), "slides_away": (0.5, 0.5), "mean_speed_m_per_s": (0.03, 0.001)}}
    staying = {"a": {"climbs": (1.0, 0.0), "mean_speed_m_per_s": (0.03, 0.001)}}
    for predictions, told in ((said, True), (staying, False)):
        page = report_html(small(next_trials=(replace(proposed, predictions=predictions),)))
        assert ("mm/s where it stays in view" in page) == told


def test_gaps_are_drawn_in_the_order_of_the_trials() -> None:
    ax = plots.plot_gap(made().gap, Figure().subplots())
    assert [label.get_text() for label in ax.get_yticklabels()] == [trial.id for trial in lab().trials]
    nominal = ax.collections[1].get_offsets()
    assert nominal[6].tolist() == pytest.approx([34.2, 6.0])


def test_a_proposed_trial_is_there_to_be_copied(page: str) -> None:
    (written,) = re.findall(r"<pre>(\[\[trial\]\].*?)</pre>", page, re.DOTALL)
    (table,) = tomllib.loads(unescape(written))["trial"]
    (proposed,) = made().next_trials
    assert table == {"id": "next1", **proposed.trial}
    LabTrial(**{**table, "field": field_from_table(table["field"], Path()), "outcome": Outcome(climbs=True)})
