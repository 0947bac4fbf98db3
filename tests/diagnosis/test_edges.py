"""Datasets at the edge of what can be diagnosed: an honest word or one line."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tumblers import EffectError, InputError
from tumblers.dataset import Dataset, LabTrial, Outcome, Track
from tumblers.diagnosis import diagnose
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.predictive import _worst, is_right
from tumblers.diagnosis.gap.reading import reached
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.where.localise import localise
from tumblers.diagnosis.wording.caution import cautions
from tumblers.diagnosis.wording.words import summary
from tumblers.effects import CATALOGUE, get, load_file
from tumblers.effects.size_error import SizeError
from tumblers.field import StaticField, TableField
from tumblers.presets import drive

from .lab import OFF, PLANS, measure, plan, without

CONSIDERED = ("size_error", "friction_coefficient", "viscous_drag")
DRAG = get("viscous_drag").from_vector((0.02,))

WEAK_AMPLIFIER = '''
from dataclasses import dataclass, replace
from typing import ClassVar

from tumblers.effects import Effect, Parameter


@dataclass(frozen=True, kw_only=True, slots=True)
class WeakAmplifier(Effect):
    """The coils get less current than they are told."""

    name: ClassVar[str] = "weak_amplifier"
    source: ClassVar[str] = "Ohm"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(key="factor", neutral=1.0, low=0.3, high=1.5, unit="1", meaning="field over the nominal one"),
    )
    factor: float = 1.0

    def act(self, scenario):
        """Return the scenario with another field."""
        field = scenario.field
        return replace(scenario, field=replace(field, strength_T=field.strength_T * self.factor))
'''


def moved(data: Dataset, share: float) -> Dataset:
    """Return a dataset in which the robots got on by another share of the way along y."""

    def track(old: Track) -> Track:
        return Track(time_s=old.time_s, channels={**old.channels, "y_m": share * old.channels["y_m"]})

    return replace(
        data, trials=tuple(replace(t, track=track(t.track)) if t.track is not None else t for t in data.trials)
    )


def test_one_trial_with_a_gap_is_never_explained() -> None:
    diagnosis = diagnose(measure(plan(PLANS[1:2]), (DRAG,)), effects=CONSIDERED, jobs=2)
    assert diagnosis.verdict == "unexplained"
    assert diagnosis.gap.held_out_trials == ()
    assert any("one measured trial" in said for said in diagnosis.assumptions)
    assert json.loads(diagnosis.to_json())["gap"]["shrink"]["estimate"] is not None


def test_one_trial_without_a_gap_is_no_gap() -> None:
    assert diagnose(measure(plan(PLANS[1:2])), effects=CONSIDERED, jobs=2).verdict == "no_gap"


def test_effects_in_another_order_are_the_same_answer() -> None:
    data = measure(plan(PLANS[1:2]), (DRAG,))
    one, other = (diagnose(data, effects=names, jobs=2) for names in (CONSIDERED, CONSIDERED[::-1]))
    assert [entry.log_evidence for entry in one.ranking] == [entry.log_evidence for entry in other.ranking]


def test_a_dataset_in_which_every_frame_is_lost_is_refused_in_one_line() -> None:
    data = measure(plan(PLANS[:2]))
    for name in ("f02", "f05"):
        data = without(data, name, slice(None))
    with pytest.raises(InputError) as caught:
        diagnose(data, effects=CONSIDERED)
    assert "every frame is lost" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_outcomes_that_contradict_each_other_are_not_explained() -> None:
    def trial(name: str, climbs: bool) -> LabTrial:
        outcome = Outcome(climbs=climbs)
        return LabTrial(id=name, field=drive(0.020, 1.0), duration_s=1.0, incline_deg=20.0, outcome=outcome)

    data = replace(plan(PLANS[:1]), trials=tuple(trial(f"t{k}", climbs=k % 2 == 0) for k in range(6)))
    diagnosis = diagnose(data, effects=CONSIDERED, jobs=2)
    assert diagnosis.verdict == "unexplained"
    assert "nothing in the catalogue" in summary(diagnosis) or "unexplained" in summary(diagnosis).lower()


def _noted(name: str, outcome: Outcome, still: bool = False) -> Dataset:
    """Two tracks that the model follows, and an outcome of one of them or of a third trial that lies still."""
    data = measure(plan(PLANS[:2]))
    if still:
        weak = StaticField(strength_T=3e-4, direction=(0.0, 1.0, 0.0))
        trial = LabTrial(id=name, field=weak, duration_s=0.5, incline_deg=5.0, outcome=outcome)
        return replace(data, trials=(*data.trials, trial))
    return replace(data, trials=tuple(replace(t, outcome=outcome) if t.id == name else t for t in data.trials))


def _slid(way_m: float) -> Dataset:
    """Two tracks that the model follows, and a robot without a field, seen at the start and a way further down."""
    track = Track(time_s=np.array([0.0, 0.5]), channels={"x_m": np.zeros(2), "y_m": np.array([0.0, -way_m])})
    trial = LabTrial(id="slid", field=OFF, duration_s=0.5, incline_deg=30.0, track=track)
    data = measure(plan(PLANS[:2]))
    return replace(data, trials=(*data.trials, trial))


@pytest.mark.parametrize(
    ("data", "right"),
    [
        (lambda: _noted("f05", Outcome(climbs=True)), True),
        (lambda: _noted("f05", Outcome(climbs=False)), False),
        (lambda: _noted("f05", Outcome(mean_speed_m_per_s=0.1, sigma_m_per_s=1e-3)), False),
        (lambda: _noted("lies", Outcome(climbs=False), still=True), True),
        (lambda: _slid(1e-6), True),
        (lambda: _slid(2e-3), False),
        (lambda: _noted("lies", Outcome(climbs=True), still=True), False),
    ],
)
def test_an_outcome_that_contradicts_a_track_or_a_model_at_rest_is_not_hidden_by_tracks(
    data: Callable[[], Dataset], right: bool
) -> None:
    known = data()
    comparison = Comparison(known, Simulator(known, 1))
    assert is_right(comparison, comparison.residual(comparison.nominal_paths)) == right


def test_noise_alone_leaves_an_outcome_out_once_in_a_thousand() -> None:
    # 3.3 sigma.
    assert float(_worst(np.array(1))) == pytest.approx(10.83, abs=0.01)
    # A track's limit is that of a form that is a little wrong, not that of noise.
    assert float(_worst(np.array(400))) == pytest.approx(2.0 * (1.0 + 2.0 * np.sqrt(2.0 / 400.0)))


@pytest.mark.parametrize("share", [10.0, -1.0])
def test_far_outside_the_model_is_unexplained(share: float) -> None:
    data = moved(measure(plan(PLANS[:3])), share)
    diagnosis = diagnose(data, effects=CONSIDERED, jobs=2)
    assert diagnosis.verdict == "unexplained"
    assert diagnosis.gap.after > 5.0
    assert summary(diagnosis)
    assert json.loads(diagnosis.to_json())["gap"]["after"] > 5.0


def test_a_trial_of_which_nothing_was_measured_has_no_gap() -> None:
    data = without(measure(plan(PLANS[:3])), "f05", slice(None))
    diagnosis = diagnose(data, effects=CONSIDERED, jobs=2)
    by_trial = json.loads(diagnosis.to_json())["gap"]["by_trial"]
    assert set(by_trial["f05"].values()) == {None}
    assert all(value is not None for value in by_trial["f02"].values())
    assert summary(diagnosis)


@pytest.mark.parametrize("strength_T", [0.0, 0.001])
@pytest.mark.parametrize("climbs", [True, False])
def test_a_robot_at_rest_does_not_climb(strength_T: float, climbs: bool) -> None:
    field = StaticField(strength_T=strength_T, direction=(0.0, 1.0, 0.0))
    outcome = Outcome(climbs=climbs)
    trial = LabTrial(id="a", field=field, duration_s=0.5, incline_deg=5.0, outcome=outcome)
    data = replace(plan(PLANS[:1]), trials=(trial,))
    comparison = Comparison(data, Simulator(data, 1))
    (path,) = comparison.nominal_paths
    assert path is not None
    (wrong,) = comparison.residual([path]).trials[0]
    # As of one that does not get on in a rotating field: the likelihood is smooth.
    share = comparison.readers[0].read_outcomes(path)["climbed_share"]
    assert abs(share) < 1e-6
    assert abs(wrong) == pytest.approx(abs(reached(0.0, climbs)), rel=1e-3)
    assert abs(reached(0.0, True)) > 3.0 * abs(reached(0.0, False))


@pytest.mark.parametrize(
    ("change", "line"),
    [
        ({"duration_s": 1e-4}, r"trial[1].duration_s: found 0.0001 s, expected at least two steps of the simulation"),
        (
            {"duration_s": 1e6},
            "trial[1].duration_s: found 1e+06 s at 5 Hz and 0.002 s for its clock, which make 500000001 poses of "
            "500000302, expected at most 500000 in all trials",
        ),
        (
            {"field": drive(0.01, 1e6)},
            "trial[1].duration_s: found 0.6 s at 1e+06 Hz and 0.002 s for its clock, which make 36120000 poses of ",
        ),
        ({"duration_s": 1e308}, "trial[1].duration_s: found 1e+308 s at 5 Hz and 0 s for its clock, which make inf "),
        ({"field": drive(0.01, 1e308)}, "trial[1].duration_s: found 0.6 s at 1e+308 Hz and 0.002 s for its clock, "),
    ],
)
def test_what_would_fill_the_memory_is_refused_before_it_does(change: dict[str, Any], line: str) -> None:
    data = plan(PLANS[:2])
    data = replace(data, trials=(data.trials[0], replace(data.trials[1], **change)))
    with pytest.raises(InputError) as caught:
        diagnose(data, effects=CONSIDERED)
    assert str(caught.value).startswith(line)
    assert len(str(caught.value)) < 250


@pytest.mark.parametrize(
    ("sensor", "line"),
    [
        ({"time_offset_s": 7.0}, r"^sensor\.time_offset_s: found 7 s, expected no more than the longest trial"),
        (
            {"frames_per_second": 0.02},
            r"^sensor\.frames_per_second: found 0\.02, half a frame of which is 25 s, expected no more than ",
        ),
    ],
)
def test_a_clock_that_may_be_off_by_more_than_a_trial_is_refused(sensor: dict[str, Any], line: str) -> None:
    data = plan(PLANS[:2])
    with pytest.raises(InputError, match=line):
        diagnose(replace(data, sensor=replace(data.sensor, **sensor)), effects=CONSIDERED)


def test_the_poses_are_those_of_what_is_run() -> None:
    # 120 000 poses a second: what the clock may be late by makes most of them.
    data = plan([("fast", drive(0.01, 7000.0), 0.0)])
    Simulator(data, 1)
    with pytest.raises(InputError, match=r"0\.6 s at 7000 Hz and 0\.602 s for its clock, which make 504840 poses of"):
        Simulator(replace(data, sensor=replace(data.sensor, time_offset_s=0.6)), 1)


@pytest.mark.parametrize(
    ("act", "line"),
    [
        ("pass", "weak_amplifier: act returned None, expected a scenario"),
        ("return scenario.field.direction", "weak_amplifier: act failed with AttributeError: .*direction"),
        (
            "return replace(scenario, substrate=replace(scenario.substrate, friction_coefficient=-1.0))",
            "weak_amplifier: no trial takes it from any of its starts: .*friction_coefficient: found -1",
        ),
    ],
)
def test_an_effect_whose_act_fails_says_so(tmp_path: Path, act: str, line: str) -> None:
    (tmp_path / "weak.py").write_text(WEAK_AMPLIFIER.split("        field = ")[0] + f"        {act}\n")
    (kind,) = load_file(tmp_path / "weak.py")
    try:
        with pytest.raises(EffectError, match=line):
            diagnose(measure(plan(PLANS[:2])), effects=[kind.name])
    finally:
        del CATALOGUE[kind.name]


@pytest.mark.parametrize("effects", [["friction_coefficient", 3], [None]])
def test_effects_are_named(effects: list[Any]) -> None:
    with pytest.raises(InputError, match="expected a name"):
        diagnose(plan(PLANS[:1]), effects=effects)


def test_a_zero_that_is_off_in_some_trials_is_pointed_out() -> None:
    data = measure(plan(), seed=2)
    track = data.trials[1].track
    assert track is not None
    shifted = replace(track, channels={**track.channels, "y_m": track.channels["y_m"] + 3e-4})
    data = replace(data, trials=(data.trials[0], replace(data.trials[1], track=shifted), *data.trials[2:]))
    diagnosis = diagnose(data, effects=CONSIDERED, jobs=2)
    assert diagnosis.verdict == "unexplained"
    floors = {floor.trial: floor.at_tolerance for floor in diagnosis.floors}
    assert "origin y" in floors["f05"]
    assert any("the origin" in said and "f05" in said and "the robot's start" in said for said in cautions(diagnosis))
    # Nothing that was tried closes it, and nothing is named for it.
    assert diagnosis.effects == ()
    explained = diagnose(measure(plan(), (DRAG,)), effects=("viscous_drag",), jobs=2)
    assert explained.verdict == "explained"
    assert not any("had to be taken" in said for said in cautions(explained))


def test_a_tabulated_field_is_as_good_as_another() -> None:
    time = np.linspace(0.0, 0.7, 141)
    angle = 2.0 * np.pi * 3.0 * time
    rows = tuple((0.0, float(0.01 * np.cos(a)), float(0.01 * np.sin(a))) for a in angle)
    table = TableField(time_s=tuple(time.tolist()), field_T=rows)
    fields = [("table", table, 0.0), ("f05", drive(0.010, 5.0), 0.0), ("slope", table, 10.0)]
    none = diagnose(measure(plan(fields)), effects=CONSIDERED, jobs=2)
    assert none.verdict == "no_gap"
    drag = diagnose(measure(plan(fields), (DRAG,)), effects=CONSIDERED, jobs=2)
    assert drag.effects[0].name == "viscous_drag"


def test_a_track_of_two_frames_counts_for_what_it_is() -> None:
    data = measure(plan(PLANS[:3]))
    first = data.trials[0].track
    assert first is not None
    short = Track(
        time_s=first.time_s[[5, 20]], channels={name: values[[5, 20]] for name, values in first.channels.items()}
    )
    data = replace(data, trials=(replace(data.trials[0], track=short), *data.trials[1:]))
    diagnosis = diagnose(data, effects=CONSIDERED, jobs=2)
    assert diagnosis.verdict == "no_gap"
    assert diagnosis.floors[0].frames == 2


def test_a_track_of_one_frame_counts_for_what_it_is() -> None:
    data = measure(plan(PLANS[:3]))
    first = data.trials[0].track
    assert first is not None
    short = Track(time_s=first.time_s[[5]], channels={name: values[[5]] for name, values in first.channels.items()})
    data = replace(data, trials=(replace(data.trials[0], track=short), *data.trials[1:]))
    assert diagnose(data, effects=CONSIDERED, jobs=2).verdict == "no_gap"


def test_a_track_of_the_first_frame_alone_has_no_missing_wrench() -> None:
    # A tracker that loses the robot at once: there is a gap, but in none of the time that this one shows.
    data = measure(plan(PLANS[:3]), (SizeError(length_factor=1.3),))
    track = Track(time_s=np.array([0.0]), channels={"x_m": np.zeros(1), "y_m": np.zeros(1)})
    data = replace(data, trials=(replace(data.trials[0], track=track), *data.trials[1:]))
    diagnosis = diagnose(data, effects=CONSIDERED, jobs=2)
    assert diagnosis.verdict != "no_gap"
    assert diagnosis.missing_wrench is not None
    assert diagnosis.floors[0].frames == 1


def test_an_effect_of_ones_own_is_found(tmp_path: Path) -> None:
    file = tmp_path / "weak_amplifier.py"
    file.write_text(WEAK_AMPLIFIER, encoding="utf-8")
    (kind,) = load_file(file)
    try:
        truth = kind.from_vector((0.5,))
        diagnosis = diagnose(measure(plan(), (truth,)), effects=[*CONSIDERED, "weak_amplifier"], jobs=2)
        first = diagnosis.effects[0]
        assert first.name == "weak_amplifier"
        interval = first.parameters["factor"]
        assert interval.low <= 0.5 <= interval.high
        assert "weak_amplifier" in diagnosis.effects_toml()
        assert summary(diagnosis)
    finally:
        del CATALOGUE["weak_amplifier"]


@pytest.mark.parametrize("effects", [[], ["no_such_effect"], "size_error"])
def test_effects_that_are_not_there_are_refused(effects: list[str]) -> None:
    with pytest.raises(InputError, match="effect"):
        diagnose(plan(PLANS[:1]), effects=effects)


@pytest.mark.parametrize("jobs", [0, -1, True, 1.5])
def test_jobs_that_make_no_sense_are_refused(jobs: int) -> None:
    with pytest.raises(InputError, match="jobs"):
        diagnose(plan(PLANS[:1]), jobs=jobs)


@pytest.mark.parametrize("count", [3, 6, 12, 24])
def test_of_few_outcomes_noise_alone_is_seldom_a_gap(count: int) -> None:
    trial = LabTrial(id="lies", field=OFF, duration_s=0.05, outcome=Outcome(tilt_deg=0.0, sigma_deg=1.0))
    data = replace(plan(), trials=tuple(replace(trial, id=f"lies{k}") for k in range(count)))
    comparison = Comparison(data, Simulator(data, 1))
    still = comparison.residual(comparison.nominal_paths)
    rng = np.random.default_rng(0)
    noise = [tuple(rng.normal(size=(count, 1))) for _ in range(1000)]
    refused = sum(not is_right(comparison, replace(still, trials=values)) for values in noise)
    # By all of them once in a hundred, by one of them once in a thousand each; and three deviations of such a count.
    expected = 1000.0 * (0.01 + 0.001 * count)
    assert refused <= expected + 3.0 * np.sqrt(expected)
    # A tilt that is off by three sigmas in all of them is no noise.
    assert not is_right(comparison, replace(still, trials=(np.full(1, 3.0),) * count))


def test_where_a_climb_was_noted_that_the_model_does_not_make_is_told() -> None:
    data = _noted("lies", Outcome(climbs=True), still=True)
    comparison = Comparison(data, Simulator(data, 1))
    residual = comparison.residual(comparison.nominal_paths)
    regions, _ = localise(comparison, residual, comparison.nominal_paths)
    assert [region.value for region in regions if region.axis == "trial"] == ["lies"]
