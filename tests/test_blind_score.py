from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import pytest

from tumblers import InputError
from tumblers.blind.answer import Answer, TrueCause, seal
from tumblers.blind.jitter import DIMENSIONS, NUMBERS, Jitter
from tumblers.blind.layout import STEADY_SIGMA
from tumblers.blind.page import page_of, print_scores
from tumblers.blind.records import Record, read_records
from tumblers.blind.repeated import Repeated
from tumblers.blind.score import Scores, _tie_sigma, score_records
from tumblers.blind.share import Share
from tumblers.blind.ties import Tie
from tumblers.dataset import Tolerance

LONGEST = "longest of the slowest of up to 12 trials again, alone"


def answer(kind: str, *effects: tuple[str, str, dict[str, float]], sigma: float = 5.0, **changes: Any) -> Answer:
    causes = tuple(TrueCause(name=n, form=f, form_seed=None, parameters=p, strength_sigma=sigma) for n, f, p in effects)
    trials = {"a": sigma, "b": sigma, "c": 0.1}
    affected = tuple(name for name, strength in trials.items() if strength >= 1.0)
    table: dict[str, Any] = {
        "kind": kind,
        "effects": causes,
        "strength_sigma": sigma if causes else 0.0,
        "strength_by_trial": trials,
        "affected_trials": affected,
        "where": {},
        "nuisances": {},
        "jitter": {},
        "jitter_sigma": 0.3,
    }
    return Answer(**(table | changes))


def said(
    verdict: str,
    *effects: tuple[str, dict[str, tuple[float, float, float]]],
    probability: float = 0.9,
    shrink: float | None = 0.95,
    ties: tuple[str, ...] = (),
    where: tuple[dict[str, Any], ...] = (),
) -> dict[str, Any]:
    return {
        "format": "tumblers-diagnosis/1",
        "verdict": verdict,
        "effects": [
            {
                "name": name,
                "probability": probability,
                "parameters": {k: {"estimate": e, "low": lo, "high": hi} for k, (e, lo, hi) in parameters.items()},
                "confounded_with": list(ties),
            }
            for name, parameters in effects
        ],
        "ranking": [{"effects": [name for name, _ in effects], "probability": probability}],
        "gap": {
            "noise_floor": 1.0,
            "before": 11.0,
            "after_nuisance_only": 6.0,
            "after": 11.0 - 10.0 * (shrink or 0.0),
            "shrink": None if shrink is None else {"estimate": shrink, "low": 0.0, "high": 1.0},
        },
        "where": list(where),
        "next_trials": [],
    }


FRICTION = ("friction_coefficient", "catalogue", {"factor": 0.8})
TILT = ("substrate_tilt", "curved", {"slope_x_deg": 2.0, "slope_y_deg": 0.0})
TWISTED = ("magnetization_misalignment", "catalogue", {"theta1_deg": 5.0, "theta2_deg": 179.0})


def record(number: int, truth: Answer, diagnosis: dict[str, Any] | None, seconds: float = 10.0) -> Record:
    name = f"dataset-{number:03d}"
    return Record(dataset=name, answer=truth, diagnosis=diagnosis, seconds=seconds, version="1.0")


def friction(low: float, high: float) -> tuple[str, dict[str, tuple[float, float, float]]]:
    return "friction_coefficient", {"factor": (0.8, low, high)}


def scored(tie_sigma: float = 0.5) -> Scores:
    trial_a, trial_c = ({"axis": "trial", "value": value, "share_of_gap": 0.5} for value in "ac")
    records = [
        # Right, its parameter inside, trials a of a and b pointed out: an overlap of a half.
        record(0, answer("one", FRICTION), said("explained", friction(0.7, 0.9), where=(trial_a,))),
        # Right, its parameter outside, trials a and c pointed out where a and b are affected: a third.
        record(1, answer("one", FRICTION),
               said("explained", friction(0.81, 0.9), shrink=0.9, where=(trial_a, trial_c))),
        # Wrong, but in its own tie group.
        record(2, answer("one", FRICTION, sigma=20.0),
               said("explained", ("viscous_drag", {}), ties=("friction_coefficient",))),
        # Wrong, and below the strength that counts.
        record(3, answer("one", FRICTION, sigma=0.7), said("no_gap", probability=0.5)),
        # Another form; its interval does not count.
        record(4, answer("one", TILT),
               said("explained", ("substrate_tilt", {"slope_x_deg": (1.0, 0.9, 1.1)}), shrink=0.75)),
        # Both named, in another order; 179 degrees are inside from -185 to -178.
        record(
            5,
            answer("two", FRICTION, TWISTED),
            said(
                "explained",
                ("magnetization_misalignment", {"theta1_deg": (5.0, 4.0, 6.0), "theta2_deg": (-181.0, -185.0, -178.0)}),
                friction(0.7, 0.9),
            ),
        ),
        record(6, answer("two", FRICTION, TILT), said("explained", friction(0.7, 0.9), probability=0.3)),
        record(7, answer("none"), said("no_gap", shrink=None)),
        record(8, answer("none"), said("explained", friction(0.7, 0.9))),
        record(9, answer("outside", ("gusts", "outside", {"size": 0.5})), said("unexplained", friction(0.7, 0.9))),
        record(10, answer("outside", ("phase_jump", "outside", {}), where={"time_s": (0.4, 1.0)}),
               said("unexplained", where=({"axis": "time_s", "low": 0.5, "high": 0.9, "share_of_gap": 1.0},))),
        # What points everywhere points nowhere: 0.6 of 2 s.
        record(12, answer("outside", ("phase_jump", "outside", {}), where={"time_s": (0.4, 1.0)}),
               said("unexplained", where=({"axis": "time_s", "low": 0.0, "high": 2.0, "share_of_gap": 1.0},))),
        record(11, answer("outside", ("gusts", "outside", {})), None, seconds=200.0),
    ]  # fmt: skip
    return score_records(records, 7, lambda _: Tie(tie_sigma))


def value(scores: Scores, words: str) -> float | None:
    return next(c.value for c in scores.criteria if c.words.startswith(words))


def test_what_is_explained_is_right_where_all_causes_are_named_and_nothing_else() -> None:
    explained = scored().explained
    assert (explained.hits, explained.count) == (4, 7)
    assert "Of 7 that are `explained`, 4 name all" in page_of(scored())


@pytest.mark.parametrize("beside", [3.0, None])
def test_the_page_tells_what_two_causes_show_beside_each_other_where_the_answers_do(beside: float | None) -> None:
    truth = answer("two", FRICTION, TILT)
    truth = replace(truth, effects=tuple(replace(cause, beside_sigma=beside) for cause in truth.effects))
    page = page_of(score_records([record(0, truth, said("no_gap"))], 1, lambda _: Tie(0.0)))
    assert ("either of two alone and where the other is at work are to show 4.5 sigma" in page) == (beside is not None)
    assert ("of two with 1 sigma of either beside the other" in page) == (beside is not None)


def test_what_was_diagnosed_again_counts_for_time_and_sameness() -> None:
    again = [
        replace(
            record(number, answer("none"), said("no_gap", shrink=None)),
            repeated=Repeated(
                seconds=50.0 * (number + 1),
                processor_s=processor_s,
                threads=4,
                cores=2,
                same=number > 0,
                trials=trials,
            ),
        )
        for number, (processor_s, trials) in enumerate(((90.0, 1), (110.0, 6), (280.0, 12)))
    ]
    scores = score_records([*again, record(3, answer("none"), said("no_gap", shrink=None))], 7, lambda _: Tie(0.0))
    # 100 s on the wall and 110 s of the processors: 90 s on one core. 150 s and 280 s: 20 s, and 260 s on all.
    assert value(scores, f"{LONGEST}, on 4 cores by Amdahl's law, s") == pytest.approx(95.0)
    assert value(scores, "diagnosed again") == pytest.approx(2 / 3)
    derived = "at most 150 s, 280 s of the processors. On 4 cores that is at most 95 s by Amdahl's law, if what runs"
    assert f"on 4 threads (cores: 2): {derived}" in page_of(scores)


def test_the_time_of_more_trials_than_it_has_to_hold_for_is_told_apart() -> None:
    again = Repeated(seconds=150.0, processor_s=None, threads=4, cores=4, same=True, trials=12)
    longer = replace(again, seconds=250.0, trials=13, same=False)
    each = [
        replace(record(number, answer("none"), said("no_gap", shrink=None)), repeated=repeated)
        for number, repeated in enumerate((again, longer))
    ]
    scores = score_records(each, 7, lambda _: Tie(0.0))
    assert value(scores, f"{LONGEST}, on 4 cores, s") == 150.0
    assert value(scores, "diagnosed again") == 0.5
    page = page_of(scores)
    assert "The slowest of up to 12 trials again, one after another on 4 threads (cores: 4): at most 150 s." in page
    assert "The slowest of more again, one after another on 4 threads (cores: 4): at most 250 s." in page


@pytest.mark.parametrize(
    ("cores", "processor_s", "words", "expected"),
    [(4, 280.0, ", on 4 cores, s", 150.0), (2, None, ", s", 150.0), (None, 280.0, ", s", 150.0)],
)
def test_a_time_that_is_not_derived_is_said_as_it_was_measured(
    cores: int | None, processor_s: float | None, words: str, expected: float
) -> None:
    again = Repeated(seconds=150.0, processor_s=processor_s, threads=4, cores=cores, same=True, trials=6)
    one = replace(record(0, answer("none"), said("no_gap", shrink=None)), repeated=again)
    scores = score_records([one], 7, lambda _: Tie(0.0))
    assert value(scores, f"{LONGEST}{words}") == expected
    assert "at most 150 s." in page_of(scores)


def test_scores_are_those_computed_by_hand() -> None:
    scores = scored()
    # Records 0, 1, 2 and 4 count: 0, 1 and 4 are right.
    assert value(scores, "one effect of 3 sigma or more: named first") == 0.75
    assert value(scores, "one effect of 3 sigma or more: named first or truly tied") == 1.0
    assert value(scores, "two effects") == 0.5
    assert value(scores, "no effect") == 0.5
    assert value(scores, "outside") == pytest.approx(3 / 4)
    # 0: inside; 1: outside; 5: three inside.
    assert value(scores, "parameters") == pytest.approx(4 / 5)
    assert value(scores, "median shrink, the catalogue") == 0.95
    assert value(scores, "median shrink, another") == 0.75
    # 0: 1/2, 1: 1/3; nothing pointed out in 2, 4, 5, 6, 9, 10 and 12.
    assert scores.overlaps["dataset-000"] == 0.5
    assert scores.overlaps["dataset-001"] == pytest.approx(1 / 3)
    # 10: 0.4 of 0.6 s; 12: 0.6 of 2 s.
    assert (scores.regions["time_s"].hits, scores.regions["time_s"].count) == (1, 2)
    assert value(scores, "where: affected trials") == pytest.approx(1 / len(scores.overlaps))
    assert value(scores, "where: regions") == 0.5
    # a and b of a, b and c are affected: whoever points out all three has two thirds right.
    assert list(scores.everywhere.values()) == [pytest.approx(2 / 3)] * len(scores.overlaps)
    # Half of 10 over the floor by the sensor; of the 5 that it leaves 0.95 leave 0.5, and 0.75 leave 2.5.
    assert scores.shrinks["the catalogue's form"] == (0.5, 0.95, pytest.approx(0.9))
    assert scores.shrinks["another form"] == (0.5, 0.75, pytest.approx(0.5))
    assert value(scores, "longest") is None, "nothing was diagnosed again"
    assert value(scores, "diagnosed again") is None
    assert scores.seconds_longest == 200.0
    assert (scores.datasets, scores.diagnosed) == (13, 12)
    assert scores.confusion["friction_coefficient"] == {"friction_coefficient": 2, "no_gap": 1, "viscous_drag": 1}
    assert scores.confusion["outside"] == {"failed": 1, "unexplained": 3}
    assert {name: (s.hits, s.count) for name, s in scores.by_strength.items()} == {
        "0-1": (0, 1),
        "1-3": (0, 0),
        "3-10": (3, 3),
        ">=10": (0, 1),
    }


def test_calibration_is_that_computed_by_hand() -> None:
    scores = scored()
    # At 0.9: records 0, 1, 2, 4, 5, 7 and 8, of which 0, 1, 4, 5 and 7 are right; at 0.3: record 6, wrong.
    assert scores.reliability == {
        "0.2-0.4": (0.3, 0.0, 1),
        "0.8-1": (pytest.approx(0.9), pytest.approx(5 / 7), 7),
    }
    assert scores.calibration_error == pytest.approx((0.3 + 7 * (0.9 - 5 / 7)) / 8)


def test_a_tie_that_simulation_does_not_bear_out_does_not_count() -> None:
    words = "one effect of 3 sigma or more: named first or truly tied"
    assert value(scored(tie_sigma=1.5), words) == 0.75


@pytest.mark.parametrize(
    ("forms", "world", "expected"),
    [
        (("curved",), 2.7, Tie(2.7, 0.1)),
        # The truth itself bears it out; it has the catalogue's form; of two effects it is not asked.
        (("curved",), 0.9, Tie(0.9)),
        (("catalogue",), 2.7, Tie(2.7)),
        (("curved", "catalogue"), 2.7, Tie(2.7)),
    ],
)
def test_a_truth_of_one_effect_in_another_form_is_tied_by_its_effect_as_well(
    forms: tuple[str, ...], world: float, expected: Tie, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tumblers.blind.score.difference_sigma", lambda *_: world)
    monkeypatch.setattr("tumblers.blind.score.nearest_sigma", lambda *_: 0.1)
    causes = ("substrate_tilt", "friction_coefficient")
    numbers = ({"slope_y_deg": 3.0}, {"factor": 0.8})
    truth = answer("one", *zip(causes, forms, numbers, strict=False))
    truth = replace(
        truth, effects=tuple(replace(cause, form_seed=3) for cause in truth.effects), jitter=Jitter().table()
    )
    pulled = ("stray_field_gradient", {"gradient_T_per_m[1]": (0.02, 0.01, 0.03)})
    wrong = record(0, truth, said("explained", pulled, ties=("substrate_tilt",)))
    assert _tie_sigma(Path(), wrong) == expected


def test_a_tie_of_effects_counts_whatever_the_form_of_the_truth_shows_beside() -> None:
    words = "one effect of 3 sigma or more: named first or truly tied"
    truth = answer("one", TILT)
    pulled = ("stray_field_gradient", {"gradient_T_per_m[1]": (0.02, 0.01, 0.03)})
    wrong = said("explained", pulled, ties=("substrate_tilt",))
    for tie, hit, by_effect in ((Tie(2.7, 0.1), 1.0, 1), (Tie(2.7, 1.1), 0.0, 0), (Tie(0.9), 1.0, 0)):
        scores = score_records([record(0, truth, wrong)], 7, lambda _, tie=tie: tie)
        assert value(scores, words) == hit
        assert scores.tied_by_effect == by_effect


@pytest.mark.parametrize(
    ("named", "tie_sigma", "hits"),
    [
        (("friction_coefficient", "substrate_tilt"), 1.5, 1),
        (("friction_coefficient", "stray_field_gradient"), 0.5, 1),
        # Not by simulation; both in another's place; and one that is not named at all.
        (("friction_coefficient", "stray_field_gradient"), 1.5, 0),
        (("friction_anisotropy", "stray_field_gradient"), 0.5, 0),
        (("friction_coefficient",), 0.5, 0),
    ],
)
def test_of_two_effects_one_may_have_the_place_of_one_that_it_is_truly_tied_with(
    named: tuple[str, ...], tie_sigma: float, hits: int
) -> None:
    diagnosis = said("explained", *((name, {}) for name in named), ties=("substrate_tilt", "friction_coefficient"))
    scores = score_records([record(0, answer("two", FRICTION, TILT), diagnosis)], 7, lambda _: Tie(tie_sigma))
    assert scores.both_or_tied == Share(hits, 1)
    assert f"Of 1 with two effects, {hits} have both named, or one" in page_of(scores)


def test_the_page_and_the_tables_show_every_criterion(capsys: pytest.CaptureFixture[str]) -> None:
    scores = replace(scored(), drawn=20)
    page = page_of(scores)
    print_scores(scores)
    printed = capsys.readouterr().out
    assert "20 datasets drawn, 13 tried, 12 diagnosed; every seal whole" in " ".join(printed.split())
    assert "*" not in printed
    for criterion in scores.criteria:
        assert f"| {criterion.words} |" in page
    assert "20 datasets drawn from seed 7, 13 of them tried, 12 diagnosed by version 1.0" in page
    assert page.count("| **no** |") == sum(c.met is False for c in scores.criteria)
    table = json.loads(scores.to_json())
    assert table["format"] == "tumblers-blind-scores/2"
    assert len(table["rows"]) == 13


def test_the_page_says_how_far_the_worlds_numbers_are_off() -> None:
    page = page_of(scored())
    # Those that the diagnosis assumes are another file's: the page must not claim more than holds.
    for name, assumed in asdict(Tolerance()).items():
        drawn = DIMENSIONS if name in ("length", "height") else NUMBERS
        same = page.partition("itself assumes of ")[2].partition(";")[0]
        assert (name.replace("_", " ") in same) == (drawn == assumed), name
    assert f"a standard deviation of {100.0 * NUMBERS:g} %" in page
    alone = f"the world's own step alone show by more than {STEADY_SIGMA:g} sigma"
    assert f"a lab drops a trial in which the nominal numbers' being off and {alone}" in page


def test_scores_of_nothing_are_not_numbers() -> None:
    scores = score_records([record(0, answer("none"), None)], 1, lambda _: Tie(0.0))
    assert value(scores, "median shrink, another") is None
    assert "nothing to measure" in page_of(scores)


def write(directory: Path, truth: Answer, salt: str = "salt") -> Path:
    folder = directory / "dataset-000"
    folder.mkdir()
    table = truth.table()
    (folder / "seal.json").write_text(json.dumps({"format": "tumblers-seal/1", "sha256": seal(salt, table)}))
    answers = directory / "answers.json"
    entries = [{"dataset": folder.name, "salt": salt, "answer": table}]
    answers.write_text(json.dumps({"format": "tumblers-answers/1", "seed": 3, "answers": entries}))
    return answers


def test_records_come_back_as_they_were_written(tmp_path: Path) -> None:
    truth = answer("one", FRICTION, where={"time_s": (0.4, 1.0)})
    seed, records = read_records(tmp_path, write(tmp_path, truth))
    assert (seed, records[0].answer) == (3, truth)


@pytest.mark.parametrize(
    ("file", "text", "found"),
    [
        ("answers.json", "{", "malformed JSON"),
        ("answers.json", '{"format": "tumblers-answers/1", "answers": 3}', "no list of datasets"),
        ("answers.json", '{"format": "tumblers-answers/1", "seed": 1, "answers": []}', "no answer for dataset-000"),
        ("answers.json", "[]", "expected 'tumblers-answers/1'"),
        ("dataset-000/seal.json", '{"format": "tumblers-seal/1"}', "not the sealed one"),
        ("dataset-000/diagnosis.json", '{"format": "other"}', "expected 'tumblers-diagnosis/1'"),
        ("dataset-000/diagnosis.json", '{"format": "tumblers-diagnosis/1"}', "verdict: found no such key"),
        (
            "dataset-000/diagnosis.json",
            '{"format": "tumblers-diagnosis/1", "verdict": "explained", "ranking": [], "gap": {}, "where": [], '
            '"effects": [{"name": 5, "parameters": {}, "confounded_with": []}]}',
            r"effects\[0\]\.name: found 5, expected a name",
        ),
        (
            "dataset-000/run.json",
            '{"format": "tumblers-blind-run/1", "seconds": "x", "threads": 1, "version": "0"}',
            "seconds: found 'x', expected a finite number",
        ),
        (
            "dataset-000/repeat.json",
            '{"format": "tumblers-blind-repeat/1", "seconds": 5, "threads": 4, "cores": 2, "same": 1}',
            "same: found 1, expected true or false",
        ),
    ],
)
def test_files_are_refused_in_one_line(file: str, text: str, found: str, tmp_path: Path) -> None:
    answers = write(tmp_path, answer("none"))
    (tmp_path / file).write_text(text)
    with pytest.raises(InputError, match=found) as refused:
        read_records(tmp_path, answers)
    assert "\n" not in str(refused.value)
    assert refused.value.file is not None


def test_a_dataset_has_one_answer(tmp_path: Path) -> None:
    answers = write(tmp_path, answer("none"))
    table = json.loads(answers.read_text())
    answers.write_text(json.dumps({**table, "answers": table["answers"] * 2}))
    with pytest.raises(InputError, match="found 'dataset-000' again"):
        read_records(tmp_path, answers)


@pytest.mark.parametrize(
    ("cause", "found"),
    [
        (("friction_coefficient", "wears_off", {"factor": 0.8}), r"friction_coefficient\.form: found 'wears_off'"),
        (("friction_coefficient", "catalogue", {"factor": -0.8}), r"friction_coefficient\.factor: found -0\.8"),
        (("friction_coefficient", "catalogue", {"factor": [0.8]}), r"friction_coefficient\.factor: found \[0\.8\]"),
        (
            ("friction_coefficient", "catalogue", {"factr": 0.8}),
            r"friction_coefficient\.'factr': found no such parameter",
        ),
        (("friction_coefficient", "runs_in", {"factor": 0.8}), "form_seed: found None, expected a whole number"),
        (("static_friction", "catalogue", {}), "static_friction"),
        (("friction_coefficient", "catalogue", {}), "friction_coefficient: found what changes nothing"),
    ],
)
def test_a_cause_that_cannot_be_at_work_again_is_refused(
    cause: tuple[str, str, dict[str, Any]], found: str, tmp_path: Path
) -> None:
    answers = write(tmp_path, answer("two", ("viscous_drag", "catalogue", {"viscosity_Pa_s": 1e-3}), cause))
    with pytest.raises(InputError, match=rf"answers\.json: dataset-000\.effects\[1\]\..*{found}") as refused:
        read_records(tmp_path, answers)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("truth", "found"),
    [
        (("twoo", FRICTION), r"kind: found 'twoo', expected none or one or two or outside"),
        (("one",), "effects: found 0 causes with 0 names, expected 1 different ones for kind one"),
        (("none", FRICTION), "effects: found 1 causes with 1 names, expected 0"),
        (("two", FRICTION, FRICTION), "effects: found 2 causes with 1 names, expected 2"),
    ],
)
def test_causes_are_as_many_as_the_kind_says(truth: Any, found: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=rf"answers\.json: dataset-000\.{found}"):
        read_records(tmp_path, write(tmp_path, answer(*truth)))


def test_a_cause_outside_the_catalogue_has_its_own_numbers(tmp_path: Path) -> None:
    truth = answer("outside", ("sticky_spot", "outside", {"place_m": [0.1, 0.2]}))
    assert read_records(tmp_path, write(tmp_path, truth))[1][0].answer.kind == "outside"


def test_the_forms_that_are_known_are_named(tmp_path: Path) -> None:
    truth = answer("one", ("friction_coefficient", "wears_off", {"factor": 0.8}))
    truth = replace(truth, effects=(replace(truth.effects[0], form_seed=3),))
    answers = write(tmp_path, truth)
    with pytest.raises(InputError, match="expected catalogue or runs_in or drifts_with_time"):
        read_records(tmp_path, answers)


@pytest.mark.parametrize(
    ("low", "high", "hit"), [(330.0, 470.0, True), (300.0, 480.0, True), (0.0, 120.0, True), (120.0, 240.0, False)]
)
def test_a_region_across_the_end_of_the_cycle_overlaps_one_at_its_beginning(low: float, high: float, hit: bool) -> None:
    truth = answer("outside", ("amplifier_dropout", "outside", {}), where={"cycle_phase_deg": (350.0, 460.0)})
    pointed = {"axis": "cycle_phase_deg", "low": low, "high": high, "share_of_gap": 1.0}
    scores = score_records([record(0, truth, said("unexplained", where=(pointed,)))], 1, lambda _: Tie(0.0))
    assert (scores.regions["cycle_phase_deg"].hits, scores.regions["cycle_phase_deg"].count) == (int(hit), 1)
