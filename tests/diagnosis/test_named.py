"""A known cause is named with its size, no cause is no gap, and what is said can be pasted and run."""

from __future__ import annotations

import json
from dataclasses import replace
from importlib import import_module
from pathlib import Path as File
from typing import Any

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from tumblers import Scenario, simulate
from tumblers.dataset import Dataset
from tumblers.diagnosis import Diagnosis, diagnose
from tumblers.diagnosis.fitting.fitter import Fitter
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.loss import robust_cost
from tumblers.diagnosis.gap.pose import Path
from tumblers.diagnosis.gap.simulator import Simulator, _rows_every
from tumblers.diagnosis.wording.words import summary
from tumblers.effects import get
from tumblers.effects.base import Effect

from .lab import PLANS, measure, plan

diagnosing = import_module("tumblers.diagnosis.diagnose")

CONSIDERED = ("size_error", "friction_coefficient", "field_rolloff", "viscous_drag")
TRUTHS: dict[str, Effect] = {
    "size_error": get("size_error").from_vector((1.06, 1.0)),
    "friction_coefficient": get("friction_coefficient").from_vector((0.6, 0.0)),
    "field_rolloff": get("field_rolloff").from_vector((0.03,)),
    "viscous_drag": get("viscous_drag").from_vector((0.02,)),
}


def seen(truth: Effect) -> Dataset:
    return measure(plan(), (truth,), clock_frames=0.2, origin_m=2e-5, heading_deg=0.5)


@pytest.fixture(scope="module")
def dragged() -> Diagnosis:
    return diagnose(seen(TRUTHS["viscous_drag"]), effects=CONSIDERED, jobs=2)


@pytest.fixture(scope="module")
def nothing() -> Diagnosis:
    return diagnose(measure(plan(), clock_frames=-0.2, origin_m=2e-5), effects=CONSIDERED, jobs=2)


def check_named(diagnosis: Diagnosis, truth: Effect) -> None:
    assert diagnosis.verdict == "explained"
    first = diagnosis.effects[0]
    assert first.name == truth.name
    # A share of 12 % belongs to all hypotheses, however strong the evidence is.
    assert first.probability > 0.85
    for parameter, value in zip(truth.parameters, truth.vector(), strict=True):
        interval = first.parameters[parameter.key]
        assert interval.low <= value <= interval.high, f"{parameter.key}: {value} is not in {interval}"
        assert interval.low <= interval.estimate <= interval.high
    assert diagnosis.gap.before > diagnosis.gap.after
    assert diagnosis.gap.shrink.estimate > 0.9


@pytest.mark.parametrize("name", ["size_error", "friction_coefficient", "field_rolloff"])
def test_a_cause_is_named_with_its_size(name: str) -> None:
    check_named(diagnose(seen(TRUTHS[name]), effects=CONSIDERED, jobs=2), TRUTHS[name])


def test_a_friction_that_drifts_is_named_with_its_drift() -> None:
    truth = get("friction_coefficient").from_vector((0.7, 0.4))
    diagnosis = diagnose(seen(truth), effects=CONSIDERED, jobs=2)
    check_named(diagnosis, truth)
    assert not diagnosis.effects[0].parameters["drift_per_s"].low <= 0.0
    assert "grows in the course of a trial" in " ".join(summary(diagnosis).split())


def test_drag_is_named_with_its_size(dragged: Diagnosis) -> None:
    check_named(dragged, TRUTHS["viscous_drag"])


def test_no_cause_is_no_gap(nothing: Diagnosis) -> None:
    assert nothing.verdict == "no_gap"
    assert nothing.effects == nothing.chosen == nothing.where == nothing.next_trials == ()
    assert nothing.effects_toml() == ""
    assert nothing.gap.after_nuisance_only < 1.1


@pytest.mark.parametrize("which", ["dragged", "nothing"])
def test_the_file_obeys_its_format(which: str, request: pytest.FixtureRequest) -> None:
    said = json.loads(request.getfixturevalue(which).to_json())
    assert said["format"] == "tumblers-diagnosis/1"
    assert said["verdict"] in ("no_gap", "explained", "unexplained")
    for effect in said["effects"]:
        assert 0.0 <= effect["probability"] <= 1.0
        assert isinstance(effect["confounded_with"], list)
        keys = {parameter.key for parameter in get(effect["name"]).parameters}
        assert set(effect["parameters"]) == keys
        for interval in effect["parameters"].values():
            assert interval["low"] <= interval["estimate"] <= interval["high"]
    ranking = said["ranking"]
    assert sum(ranked["probability"] for ranked in ranking) == pytest.approx(1.0, abs=1e-9)
    assert sorted(ranked["effects"] for ranked in ranking if len(ranked["effects"]) < 2) == sorted(
        [[], *([name] for name in CONSIDERED)]
    )
    assert ranking[0]["effects"] == [effect["name"] for effect in said["effects"]]
    for ranked in ranking[:1]:
        assert ranked["held_out_gap"] is not None
        assert ranked["shrink"] is not None
    gap = said["gap"]
    assert gap["unit"] == "noise sigmas"
    for key in ("noise_floor", "before", "after_nuisance_only", "after"):
        assert isinstance(gap[key], float), key
    assert 0.0 <= gap["shrink"]["low"] <= gap["shrink"]["estimate"] <= gap["shrink"]["high"] <= 1.0
    assert gap["held_out_trials"] == [trial.id for trial in plan().trials]
    expected = 1.0 - (gap["after"] - gap["noise_floor"]) / (gap["before"] - gap["noise_floor"])
    assert gap["shrink"]["estimate"] == pytest.approx(np.clip(expected, 0.0, 1.0))
    shares = [region["share_of_gap"] for region in said["where"]]
    assert shares == sorted(shares, reverse=True)
    for region in said["where"]:
        assert ("value" in region) != ({"low", "high"} <= set(region))
    for proposed in said["next_trials"]:
        assert {"why", "trial"} <= set(proposed)


def test_the_answer_does_not_depend_on_the_number_of_threads(dragged: Diagnosis) -> None:
    again = diagnose(seen(TRUTHS["viscous_drag"]), effects=CONSIDERED, jobs=1)
    assert again.to_json() == dragged.to_json()
    assert again.effects_toml() == dragged.effects_toml()


def check_pasted(diagnosis: Diagnosis, folder: File) -> None:
    """Run each trial with the effects as they are pasted, and compare what is left with what the ranking states."""
    point = diagnosis.tracked_point
    assert f'# [camera] tracked_point = "{point}"' in diagnosis.effects_toml().splitlines()
    dataset = replace(diagnosis.dataset, sensor=replace(diagnosis.dataset.sensor, tracked_point=point))
    comparison = Comparison(dataset, Simulator(dataset, 1))
    comparison.simulator.step_s = [floor.step_s for floor in diagnosis.floors]
    comparison._start()
    paths = []
    for trial, floor in zip(dataset.trials, diagnosis.floors, strict=True):
        bare = trial.scenario(dataset, floor.step_s, model=diagnosis.model)
        file = folder / f"{trial.id}.toml"
        file.write_text(bare.to_toml() + "\n" + diagnosis.effects_toml(), encoding="utf-8")
        pasted = Scenario.load(file)
        assert pasted == diagnosis.scenario(trial.id)
        run = simulate(pasted)
        seen = "seen_" if "seen_position_m" in run else ""
        # A fit looks at a row in 2 ms and 60 in a cycle: between them a landing is not where it is.
        every = _rows_every(pasted)
        paths.append(
            Path(
                interval_s=every * floor.step_s,
                poses=np.hstack([run[f"{seen}{name}"].values[::every] for name in ("position_m", "orientation")]),
                contact_mode=run["contact_mode"].values[::every],
            )
        )
    Fitter(comparison).take_likeliest_noise(diagnosis.chosen)
    values = comparison.residual(paths).over(range(len(paths)))
    gap = np.sqrt(robust_cost(values) / comparison.count)
    # Of a clock that is late, a fit sees a little more than the trial's time.
    assert gap == pytest.approx(diagnosis.ranking[0].gap, rel=0.01)
    # Without the effect the gap is another one.
    assert diagnosis.gap.after_nuisance_only > 1.5 * gap


def test_the_pasted_effect_gives_the_gap_that_the_report_states(dragged: Diagnosis, tmp_path: File) -> None:
    check_pasted(dragged, tmp_path)


@pytest.mark.parametrize(
    ("name", "vector"),
    [
        ("stray_field_gradient", (0.0, 0.04, 0.0, 0.0)),
        ("camera_calibration", (1.02, 5.0, 2e-4, 0.0, 0.0)),
        ("center_of_mass_offset", (0.0, 2.5e-5, 0.0)),
    ],
)
def test_a_pasted_effect_of_several_numbers_does_so_too(name: str, vector: tuple[float, ...], tmp_path: File) -> None:
    diagnosis = diagnose(measure(plan(), (get(name).from_vector(vector),)), effects=(name,), jobs=2)
    assert [effect.name for effect in diagnosis.effects] == [name]
    check_pasted(diagnosis, tmp_path)


def test_a_pasted_effect_is_seen_at_the_point_that_was_tracked(tmp_path: File) -> None:
    bare = plan()
    planned = replace(bare, sensor=replace(bare.sensor, tracked_point="centre_of_mass"))
    truth = get("center_of_mass_offset").from_vector((0.0, 2.5e-5, 0.0))
    # What is measured says nothing of the point.
    dataset = replace(measure(planned, (truth,)), sensor=bare.sensor)
    diagnosis = diagnose(dataset, effects=("center_of_mass_offset",), jobs=2)
    assert diagnosis.tracked_point == json.loads(diagnosis.to_json())["tracked_point"] == "centre_of_mass"
    check_pasted(diagnosis, tmp_path)


def test_the_linear_algebra_of_a_diagnosis_has_one_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    found: list[int] = []
    attribute = diagnosing.attribute

    def noted(*rest: Any) -> Any:
        found.extend(pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas")
        return attribute(*rest)

    monkeypatch.setattr(diagnosing, "attribute", noted)
    with threadpool_limits(2):
        diagnose(measure(plan(PLANS[4:])), effects=("size_error",), jobs=1)
    assert found
    assert set(found) == {1}
