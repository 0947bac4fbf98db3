from __future__ import annotations

import json
import re
import subprocess
import sys
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

import tumblers
from tumblers import Cuboid, InputError, Model, Robot, RotatingField, StaticField, Substrate
from tumblers.commands import run
from tumblers.dataset import Dataset, LabTrial, Outcome, Sensor, Track
from tumblers.diagnosis import plots
from tumblers.diagnosis.diagnosis import Diagnosis
from tumblers.diagnosis.phrase import phrase_of
from tumblers.diagnosis.quantity import percent, rounded, with_interval
from tumblers.diagnosis.report import report_html
from tumblers.diagnosis.result import (
    EffectEstimate,
    Gap,
    HeatMap,
    Interval,
    MissingWrench,
    NextTrial,
    Overlay,
    RankedHypothesis,
    Region,
    TrialFloor,
)
from tumblers.diagnosis.words import headline, points, summary
from tumblers.effects.catalogue import CATALOGUE

FREQUENCIES = (1.0, 3.0, 5.0, 8.0, 10.0, 12.0, 15.0)
NAN = float("nan")


def rolled(frequency: float) -> tuple[np.ndarray, dict[str, np.ndarray], dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Return times, and a tumbling robot as measured, nominal and explained, in the units of an overlay."""
    noise = np.random.default_rng(int(frequency))
    time = np.arange(0.0, 1.0, 1.0 / 60.0)
    phase = 2.0 * np.pi * frequency * time
    push = 4e-3 * max(frequency - 8.0, 0.0) / 7.0
    nominal = {
        "x": np.zeros_like(time),
        "y": 1.8e-3 * (frequency * time - np.sin(2.0 * phase) / (4.0 * np.pi)),
        "z": 2.2e-4 - 1.7e-4 * np.cos(2.0 * phase),
        "tilt": 45.0 * np.sin(2.0 * phase),
        "heading": np.zeros_like(time),
    }
    explained = {**nominal, "y": nominal["y"] + push * time}
    measured = {
        name: values + noise.normal(0.0, 1.0 if name in ("tilt", "heading") else 8e-6, time.size)
        for name, values in explained.items()
    }
    for values in measured.values():
        values[20:26] = NAN
    return time, measured, nominal, explained


def lab(title: str = "cuboid on paper, spring batch", tracks: bool = True) -> Dataset:
    trials = []
    for frequency in FREQUENCIES:
        time, measured, _, _ = rolled(frequency)
        channels = {"x_m": measured["x"], "y_m": measured["y"], "z_m": measured["z"]}
        channels |= {"tilt_deg": measured["tilt"], "heading_deg": measured["heading"]}
        trials.append(
            LabTrial(
                id=f"f{frequency:02.0f}",
                field=RotatingField(strength_T=0.010, frequency_Hz=frequency),
                duration_s=1.0,
                track=Track(time_s=time, channels=channels) if tracks else None,
                outcome=None if tracks else Outcome(climbs=True),
            )
        )
    trials.append(
        LabTrial(
            id="slope30",
            field=RotatingField(strength_T=0.020, frequency_Hz=1.0),
            duration_s=4.0,
            incline_deg=30.0,
            outcome=Outcome(climbs=True),
        )
    )
    trials.append(
        LabTrial(
            id="tilt05",
            field=StaticField(strength_T=0.005, direction=(0.0, 0.0, 1.0)),
            duration_s=1.0,
            outcome=Outcome(tilt_deg=38.5, sigma_deg=1.0),
        )
    )
    return Dataset(
        robot=Robot(
            shape=Cuboid(length_m=8e-4, width_m=4e-4, height_m=1e-4),
            mass_kg=3.78e-8,
            magnetic_volume_m3=2.9e-11,
            magnetization_A_per_m=15000.0,
            magnetization_axis=(0.0, 1.0, 0.0),
        ),
        substrate=Substrate(friction_coefficient=0.3, adhesion_N_per_m2=1.19, electrostatic_force_N=6.54e-7),
        sensor=Sensor(position_noise_m=8e-6, angle_noise_deg=1.0),
        trials=tuple(trials),
        title=title,
    )


def wrench() -> MissingWrench:
    prior = np.array([3e-7, 3e-7, 3e-7, 1.3e-9, 1.3e-9, 1.3e-9])

    def averages(labels: list[str], push: list[float]) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        found = {}
        for i, (label, f) in enumerate(zip(labels, push, strict=True)):
            sigma = prior * np.array([0.15, 0.05, 0.9, 0.2, 0.95, 0.2])
            value = np.array([1e-9 * (i - 2), f, -2e-9, 2e-11 * (3 - i), 0.0, 1e-11 * i])
            found[label] = (value, sigma)
        return found

    eighths = [f"{45 * i} to {45 * i + 45}°" for i in range(8)]
    n = 4
    return MissingWrench(
        trials=("f12", "f12", "f15", "f15"),
        start_s=np.array([0.0, 0.5] * 2),
        end_s=np.array([0.5, 1.0] * 2),
        wrench=np.tile([0.0, 1.2e-7, 0.0, 0.0, 0.0, 0.0], (n, 1)),
        sigma=np.tile(0.2 * prior, (n, 1)),
        prior_sigma=prior,
        by_phase=averages(eighths, [1e-7, 1.1e-7, 0.9e-7, 1.2e-7, 1e-7, 1.05e-7, 0.95e-7, 1e-7]),
        by_mode=averages(["airborne", "line", "surface"], [1.3e-7, 0.8e-7, 0.1e-7]),
        by_place=averages(["0 to 8 mm", "8 to 16 mm", "16 to 24 mm"], [1e-7, 1.1e-7, 1.0e-7]),
        by_frequency=averages(["10 Hz", "12 Hz", "15 Hz"], [3e-8, 1.2e-7, 2.4e-7]),
    )


def made(**changes: Any) -> Diagnosis:
    """Return a diagnosis as of a robot that a stray gradient pulls along +y above 12 Hz."""
    data = lab()
    ids = [trial.id for trial in data.trials]
    gradient = CATALOGUE["stray_field_gradient"]
    estimates = {
        "gradient_T_per_m[0]": Interval(0.0004, -0.003, 0.004),
        "gradient_T_per_m[1]": Interval(0.0482, 0.0441, 0.0522),
        "gradient_T_per_m[2]": Interval(0.01, -0.09, 0.11, identified=False),
        "frequency_exponent": Interval(2.1, 1.7, 2.6),
    }
    overlays = []
    for trial, frequency in zip(data.trials, FREQUENCIES, strict=False):
        time, measured, nominal, explained = rolled(frequency)
        overlays.append(Overlay(trial.id, time, measured, nominal, explained, {}))
    nothing = np.empty(0)
    overlays.append(Overlay("slope30", nothing, {}, {}, {}, {"climbs": (1.0, 0.04, 0.97)}))
    overlays.append(Overlay("tilt05", nothing, {}, {}, {}, {"tilt_deg": (38.5, 38.1, 38.2)}))
    before = [1.1, 0.9, 1.0, 1.3, 9.0, 18.0, 34.0, 4.0, 0.5]
    by_trial = {trial: (gap + 0.2, gap, min(gap, 1.2)) for trial, gap in zip(ids, before, strict=True)}
    values = np.outer(before, [0.4, 1.0, 0.7, 0.6, 0.5])
    values[7:, :] = NAN
    values[7, 1] = 4.0
    parts: dict[str, Any] = {
        "dataset": data,
        "model": Model(),
        "verdict": "explained",
        "effects": (EffectEstimate("stray_field_gradient", 0.97, estimates, ("viscous_drag",)),),
        "chosen": (gradient.from_vector([interval.estimate for interval in estimates.values()]),),
        "ranking": (
            RankedHypothesis(("stray_field_gradient",), 0.91, 812.0, 1.02, 1.1, 0.93),
            RankedHypothesis(("stray_field_gradient", "substrate_tilt"), 0.06, 809.2, 1.0, 1.2, 0.92),
            RankedHypothesis(("viscous_drag",), 0.03, 808.0, 1.4, 2.9, 0.8),
            RankedHypothesis(("substrate_tilt",), 0.0, 420.0, 7.9, 9.9, 0.41),
            RankedHypothesis(("friction_coefficient",), 0.0, 130.0, 11.1, None, None),
            RankedHypothesis((), 0.0, 0.0, 15.8, 15.8, 0.0),
        ),
        "gap": Gap(1.0, 16.2, 15.8, 1.1, Interval(0.93, 0.90, 0.95), tuple(ids), by_trial),
        "where": (
            Region("frequency_Hz", 0.81, low=12.0, high=15.0, sigmas=21.0),
            Region("channel", 0.74, value="y", sigmas=19.0),
            Region("trial", 0.55, value="f15", sigmas=34.0),
            Region("trial", 0.26, value="f12", sigmas=18.0),
            Region("missing_force", 0.7, value="y", sigmas=12.0),
            Region("position_y_m", 0.4, low=0.008, high=0.024, sigmas=8.0),
            Region("cycle_phase_deg", 0.3, low=90.0, high=180.0, sigmas=8.0),
        ),
        "next_trials": (
            NextTrial(
                "separates stray_field_gradient from viscous_drag: the one is faster, the other slower",
                {
                    "incline_deg": 0.0,
                    "duration_s": 2.0,
                    "field": {"kind": "rotating", "strength_T": 0.02, "frequency_Hz": 15.0},
                },
                0.82,
                {
                    "stray_field_gradient": {"mean_speed_m_per_s": (0.0312, 0.0004), "climbs": (0.97, 0.02)},
                    "viscous_drag": {"mean_speed_m_per_s": (0.0265, 0.0011), "climbs": (0.1, 0.02)},
                },
            ),
        ),
        "ruled_out": {"substrate_tilt": "f01", "friction_coefficient": "f01", "field_rolloff": "tilt05"},
        "heat_maps": (
            HeatMap("Trial and channel", "trial", "channel", tuple(ids), ("x", "y", "z", "tilt", "heading"), values),
            HeatMap(
                "Frequency and phase of the cycle",
                "frequency",
                "phase",
                tuple(f"{f:g} Hz" for f in FREQUENCIES),
                tuple(f"{45 * i}–{45 * i + 45}°" for i in range(8)),
                np.outer(before[:7], np.linspace(0.6, 1.4, 8)),
            ),
            HeatMap(
                "Contact and channel",
                "contact",
                "channel",
                ("airborne", "point", "line", "surface"),
                ("x", "y", "z"),
                np.array([[1.0, 4.0, 1.1], [NAN, NAN, NAN], [0.9, 2.5, 1.0], [0.8, 1.2, 0.9]]),
            ),
        ),
        "missing_wrench": wrench(),
        "overlays": tuple(overlays),
        "floors": tuple(
            TrialFloor(t.id, 2.5e-4, 0.12, 0.3, *((60, 6, 290) if t.track is not None else (0, 0, 1)))
            for t in data.trials
        ),
        "assumptions": (
            "The sensor's noise is white, with the standard deviations that the dataset states.",
            "The nominal mass, magnetization and friction are right to within 0.5 %.",
        ),
        "seed": 0,
        "seconds": 84.0,
        "version": "0.2.0",
    }
    return Diagnosis(**{**parts, **changes})


def small(**changes: Any) -> Diagnosis:
    """Return `made` with few figures, which take the most time."""
    known = made()
    few = {"overlays": known.overlays[:1], "missing_wrench": None, "heat_maps": known.heat_maps[:1]}
    return made(**{**few, **changes})


def no_gap() -> Diagnosis:
    gap = Gap(1.0, 1.02, 1.01, 1.01, Interval(NAN, NAN, NAN), ("f01",), {"f01": (1.02, 1.01, 1.01)})
    return made(
        verdict="no_gap",
        effects=(),
        chosen=(),
        ranking=(RankedHypothesis((), 0.99, 0.0, 1.0, 1.01, None),),
        gap=gap,
        where=(),
        next_trials=(),
        ruled_out={},
        heat_maps=(),
        missing_wrench=None,
        overlays=(),
    )


def outcomes_only() -> Diagnosis:
    """Return a diagnosis of outcomes that leave two effects tied, with what could not be measured as NaN."""
    data = lab(tracks=False)
    nothing = np.empty(0)
    overlays = tuple(Overlay(t.id, nothing, {}, {}, {}, {"climbs": (1.0, 0.0, NAN)}) for t in data.trials)
    return made(
        dataset=data,
        effects=(EffectEstimate("friction_coefficient", 0.5, {"factor": Interval(1.2, NAN, NAN, False)}, ("x",)),),
        chosen=(CATALOGUE["friction_coefficient"].from_vector([1.2]),),
        gap=Gap(NAN, 3.0, NAN, NAN, Interval(NAN, NAN, NAN), (), {"slope30": (3.0, NAN, NAN)}),
        heat_maps=(HeatMap("empty", "a", "b", ("r",), ("c",), np.array([[NAN]])),),
        missing_wrench=None,
        overlays=overlays,
        floors=tuple(TrialFloor(t.id, 1e-4, NAN, NAN, 0, 0, 1) for t in data.trials),
    )


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


def test_the_verdict_is_one_sentence_a_student_understands() -> None:
    assert headline(made()) == (
        "The robot is pulled along +y, more at high frequency, seen from 12 Hz up: a stray field gradient of "
        "0.048 ± 0.004 T/m along y, growing with the frequency to the power 2.1 ± 0.5 (stated at 10 Hz) explains 93 % "
        "of the gap on trials not fitted."
    )
    assert headline(no_gap()) == (
        "No gap: the nominal model explains the data to within noise (1.0 σ, noise alone gives 1.0 σ)."
    )
    assert headline(made(verdict="unexplained", effects=(), chosen=())).startswith("Unexplained: the gap is 16.2 σ")
    partial = headline(made(verdict="unexplained"))
    assert "The best partial cause is that the robot is pulled along +y" in partial
    assert "with it, 1.1 σ are left" in partial


def test_two_effects_are_both_named() -> None:
    tilt = EffectEstimate(
        "substrate_tilt", 0.9, {"slope_x_deg": Interval(0, -1, 1), "slope_y_deg": Interval(-3, -3.5, -2.5)}, ()
    )
    words = headline(made(effects=(*made().effects, tilt)))
    assert "and the substrate is not level, it rises along -y" in words
    assert "and a slope of -3.0° ± 0.5° along y, together, explain 93 %" in words


def test_the_summary_says_where_what_how_far_ties_and_next() -> None:
    said = dict(points(made()))
    assert "81 % of the gap at frequency 12 to 15 Hz" in said["where"]
    assert "trials f15, f12" in said["where"]
    assert said["missing"] == "the model lacks a force of 240 ± 15 nN towards +y at 15 Hz."
    assert "probability 97 %" in said["what"]
    assert "hardly narrowed" in said["what"]
    assert (
        "from 16.2 σ to 1.1 σ (with only the sensor's nuisances refitted: 15.8 σ; noise alone: 1.0 σ)"
        in said["how far"]
    )
    assert "90 to 95 %" in said["how far"]
    assert said["tied"] == "these trials cannot tell stray field gradient from viscous drag."
    assert "substrate tilt, friction coefficient by trial f01 (10 mT at 1 Hz, level)" in said["ruled out"]
    assert said["next trial"].startswith("20 mT at 15 Hz, level, 2 s: separates stray field gradient from viscous drag")
    assert max(map(len, summary(made()).splitlines())) <= 100


def test_cautions_name_what_weakens_a_diagnosis() -> None:
    assert "caution" not in dict(points(made()))
    said = " ".join(text for label, text in points(outcomes_only()) if label == "caution")
    assert "there are no tracks" in said
    assert "probability of 50 % only" in said
    floors = [replace(floor, frames=60, lost=50, numerical_sigmas=2.0) for floor in made().floors[:1]]
    said = " ".join(text for label, text in points(made(floors=tuple(floors))) if label == "caution")
    assert "half of the frames are lost in f01" in said
    assert "above the noise in f01" in said
    at_end = EffectEstimate("draft_angle", 0.9, {"draft_deg": Interval(8.0, 7.5, 8.0)}, ())
    assert "end of its plausible range" in dict(points(made(effects=(at_end,))))["caution"]


@pytest.mark.parametrize("name", list(CATALOGUE))
def test_every_effect_reads_naturally(name: str) -> None:
    kind = CATALOGUE[name]
    numbers = {p.key: Interval(0.5 * (p.neutral + p.high), p.neutral, p.high) for p in kind.parameters}
    phrase = phrase_of(EffectEstimate(name, 0.9, numbers, ()), lab())
    assert "_" not in phrase.cause + phrase.amount
    assert re.match(r"(a|an|friction) ?", phrase.amount)
    assert re.search(r"\d", phrase.amount)
    unknown = {p.key: Interval(NAN, NAN, NAN, False) for p in kind.parameters}
    assert "nan" not in headline(made(effects=(EffectEstimate(name, NAN, unknown, ()),)))


def test_an_effect_of_the_users_own_falls_back_to_its_docstring(tmp_path: Path, monkeypatch: Any) -> None:
    class OwnEffect:
        """Something <odd> drags on the coils.

        More words.
        """

        parameters = ()

    monkeypatch.setitem(CATALOGUE, "own_effect", OwnEffect)
    phrase = phrase_of(EffectEstimate("own_effect", 0.9, {"speed": Interval(2.0, 1.5, 2.5)}, ()), lab())
    assert phrase.cause == "something <odd> drags on the coils"
    assert phrase.amount == "own effect with speed = 2.0 ± 0.5"


@pytest.mark.parametrize(
    ("interval", "unit", "words"),
    [
        (Interval(0.0482, 0.0441, 0.0522), "T/m", "0.048 ± 0.004 T/m"),
        (Interval(5.1e-6, 4.3e-6, 5.9e-6), "m", "5.1 ± 0.8 µm"),
        (Interval(5.1e-6, 4.9e-6, 9.9e-6), "m", "5 µm (5 to 10)"),
        (Interval(0.0, -1e-7, 1e-7), "N", "0 ± 100 nN"),
        (Interval(12e-3, 10e-3, 14e-3), "s", "12 ± 2 ms"),
        (Interval(2.1e7, 1.9e7, 2.3e7), "S", "21 ± 2 MS"),
        (Interval(3.0, 2.0, 4.0), "degrees", "3.0° ± 1.0°"),
        (Interval(1.234, 1.22, 1.25), "1", "1.234 ± 0.015"),
        (Interval(NAN, NAN, NAN), "m", "unknown"),
        (Interval(2.0e-3, NAN, 1.0), "m", "2 mm"),
        (Interval(2.0, -np.inf, np.inf), "own unit", "2 own unit"),
    ],
)
def test_numbers_have_handy_units_and_sensible_digits(interval: Interval, unit: str, words: str) -> None:
    assert with_interval(interval, unit) == words


def test_shares_do_not_claim_certainty() -> None:
    assert [percent(share) for share in (0.0, 0.001, 0.934, 0.999, 1.0, NAN)] == [
        "0 %",
        "less than 1 %",
        "93 %",
        "more than 99 %",
        "100 %",
        "unknown",
    ]
    assert rounded(-0.0001, 0.1) == "0.00"


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


def test_saving_writes_three_files(tmp_path: Path) -> None:
    small().save(tmp_path / "out")
    assert {file.name for file in (tmp_path / "out").iterdir()} == {"diagnosis.json", "effects.toml", "report.html"}
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


def test_gaps_are_drawn_in_the_order_of_the_trials() -> None:
    ax = plots.plot_gap(made().gap, Figure().subplots())
    assert [label.get_text() for label in ax.get_yticklabels()] == [trial.id for trial in lab().trials]
    nominal = ax.collections[1].get_offsets()
    assert nominal[6].tolist() == pytest.approx([34.2, 6.0])


def tumble(*arguments: object, cwd: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "tumblers", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, cwd=cwd, timeout=120, check=False)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["data"], "--out"),
        (["nowhere", "--out", "out"], "nowhere"),
        (["data", "--out", "nowhere/out"], "'nowhere' does not"),
        (["data", "--out", "file"], "the file 'file'"),
        (["data", "--out", "out", "--jobs", "0"], "--jobs: found 0"),
        (["data", "--out", "out", "--seed", "-1"], "--seed: found -1"),
        (
            ["data", "--out", "out", "--effects", "friction_coefficient,wind"],
            "--effects: found 'wind', expected one of m",
        ),
        (["data", "--out", "out", "--effects", ""], "--effects: found ''"),
        (["data", "--out", "out", "--effects", "gone.py"], "gone.py: found no such file"),
        (["data", "--out", "out", "--effects", "bad.py"], "bad.py: found no effect"),
    ],
)
def test_bad_input_gets_one_line_and_writes_nothing(tmp_path: Path, arguments: list[str], words: str) -> None:
    lab(tracks=False).save(tmp_path / "data")
    (tmp_path / "file").write_text("")
    (tmp_path / "bad.py").write_text("x = 1\n")
    before = sorted(tmp_path.rglob("*"))
    done = tumble("diagnose", *arguments, cwd=tmp_path)
    assert done.returncode == 2, done.stderr
    assert done.stdout == ""
    assert words in done.stderr
    assert done.stderr.startswith("tumblers: ")
    assert done.stderr.count("\n") == 1
    assert sorted(path for path in tmp_path.rglob("*") if "__pycache__" not in str(path)) == before


def test_help_has_examples(tmp_path: Path) -> None:
    done = tumble("diagnose", "--help", cwd=tmp_path)
    assert done.returncode == 0
    assert "Examples:\n" in done.stdout


class Computation:
    """Stands for the computation, in the place where the command finds it."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, result: Diagnosis | BaseException) -> None:
        self.result, self.asked = result, {}
        module = ModuleType("tumblers.diagnosis.diagnose")
        module.diagnose = self.diagnose  # type: ignore[attr-defined]
        monkeypatch.setitem(sys.modules, module.__name__, module)

    def diagnose(self, dataset: Dataset, **asked: Any) -> Diagnosis:
        self.asked = asked
        if isinstance(self.result, BaseException):
            raise self.result
        return self.result


def command(monkeypatch: pytest.MonkeyPatch, *arguments: object) -> int:
    monkeypatch.setattr(sys, "argv", ["tumblers", "diagnose", *map(str, arguments)])
    try:
        return run()
    except KeyboardInterrupt:
        return 130


def test_the_command_writes_the_files_and_prints_the_summary(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    lab().save(tmp_path / "data")
    computation = Computation(monkeypatch, small())
    out = tmp_path / "out"
    effects = "draft_angle, size_error,draft_angle"
    arguments = (tmp_path / "data", "--out", out, "--effects", effects, "--jobs", 2, "--seed", 5)
    assert command(monkeypatch, *arguments) == 0
    said = capsys.readouterr()
    assert said.out.startswith(summary(small()))
    assert f"report: {out / 'report.html'}" in said.out
    assert said.err == ""
    assert {file.name for file in out.iterdir()} == {"diagnosis.json", "effects.toml", "report.html"}
    asked = {"effects": ["draft_angle", "size_error"], "jobs": 2, "seed": 5, "progress": True}
    assert computation.asked == asked


@pytest.mark.parametrize(("error", "status"), [(KeyboardInterrupt(), 130), (OSError(28, "No space left"), 1)])
def test_what_fails_or_is_interrupted_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException, status: int
) -> None:
    lab().save(tmp_path / "data")
    before = sorted(tmp_path.rglob("*"))

    def full(*_: object) -> None:
        raise error

    Computation(monkeypatch, error)
    for _ in ("while it is computed", "while it is written"):
        assert command(monkeypatch, tmp_path / "data", "--out", tmp_path / "out") == status
        assert sorted(tmp_path.rglob("*")) == before
        Computation(monkeypatch, small())
        monkeypatch.setattr("tumblers.diagnosis.diagnosis.write_files", full)


def test_a_gap_in_most_trials_is_counted_rather_than_listed() -> None:
    regions = tuple(Region("trial", 0.9 / (i + 2), value=f"f{f:02.0f}", sigmas=9.0) for i, f in enumerate(FREQUENCIES))
    assert dict(points(made(where=regions)))["where"] == "7 of 9 trials are off, f01 holds most (45 %)."


def test_the_public_names_are_there() -> None:
    assert tumblers.Diagnosis is Diagnosis
    assert tumblers.effects.CATALOGUE is CATALOGUE
    assert tumblers.dataset.Dataset is Dataset
    assert tumblers.blind.__doc__
