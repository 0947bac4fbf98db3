"""What a diagnosis says on a terminal."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tumblers.dataset import Tolerance
from tumblers.diagnosis.quantity import percent, rounded, with_interval
from tumblers.diagnosis.report.where import where_part
from tumblers.diagnosis.result import EffectEstimate, Failing, Interval, RankedHypothesis, Region
from tumblers.diagnosis.wording.condition import condition_of_table
from tumblers.diagnosis.wording.headline import headline
from tumblers.diagnosis.wording.phrase import title_of
from tumblers.diagnosis.wording.words import NO_TRIAL, points, summary
from tumblers.effects.catalogue import CATALOGUE

from .example import FREQUENCIES, NAN, lab, made, no_gap, outcomes_only


def test_the_verdict_is_one_sentence_a_student_understands() -> None:
    assert headline(made()) == (
        "The robot is pulled along +y, more at high frequency, mostly seen from 12 Hz up: a stray field gradient of "
        "0.048 ± 0.004 T/m along y, growing with the frequency to the power 2.1 ± 0.5 (stated at 10 Hz) explains 93 % "
        "of the gap on trials not fitted; viscous drag would as well."
    )
    (gradient,) = made().effects
    for others, said in (((), "trials not fitted."), (("viscous_drag", "x"), "fitted; another effect would as well.")):
        assert headline(made(effects=(replace(gradient, confounded_with=others),))).endswith(said)
    assert headline(no_gap()) == (
        "No gap: the nominal model explains the data to within noise (1.0 σ, noise alone gives 1.0 σ)."
    )
    assert headline(made(verdict="unexplained", effects=(), chosen=())).startswith("Unexplained: the gap is 16.2 σ")
    closing = headline(made(verdict="unexplained", failings=(Failing("trials left out"),)))
    assert "It would close, to 1.0 σ, if the robot is pulled along +y" in closing
    assert "too few trials show it" in closing
    # Not where something else speaks against it, too.
    for failing in (Failing("all trials", left=1.19, allowed=1.18), Failing("an outcome", ("f15",))):
        said = headline(made(verdict="unexplained", failings=(failing, Failing("trials left out"))))
        assert "The best partial cause is that" in said
    wide = tuple(replace(hypothesis, gap=3.0) for hypothesis in made().ranking)
    partial = headline(made(verdict="unexplained", ranking=wide))
    assert "The best partial cause is that the robot is pulled along +y" in partial
    assert "with it, 1.1 σ are left" in partial


def test_what_the_sensor_takes_of_an_unexplained_gap_is_told() -> None:
    gap = replace(made().gap, before=16.2, after_nuisance_only=9.0)
    said = headline(made(verdict="unexplained", effects=(), chosen=(), gap=gap))
    assert "the gap is 16.2 σ (9.0 σ with the sensor refitted, noise alone gives 1.0 σ)" in said
    less = headline(made(verdict="unexplained", effects=(), chosen=(), gap=replace(gap, after_nuisance_only=16.1)))
    assert "the gap is 16.2 σ (noise alone gives 1.0 σ)" in less


def test_an_unexplained_verdict_says_why() -> None:
    failings = (
        Failing("all trials", left=1.241, allowed=1.18),
        *(Failing("a trial", (f"f{k}",), 4.0 + k, 2.4) for k in range(4)),
        Failing("an outcome", ("slope30", "tilt05")),
        Failing("trials left out"),
        Failing("the path"),
    )
    partial = made(verdict="unexplained", failings=failings, gap=replace(made().gap, followed=0.04))
    assert [text for label, text in points(partial) if label == "why"] == [
        "1.11 σ are left with the partial cause over all trials, 1.09 σ count as noise.",
        "too much is left with the partial cause in f3 (2.65 σ, 1.55 σ count as noise), f2 (2.45 σ, 1.55 σ count as "
        "noise), f1 (2.24 σ, 1.55 σ count as noise) and 1 more.",
        "the outcome of slope30, tilt05 is contradicted with the partial cause.",
        "trials that are left out of the fit are not foretold by the others.",
        "the simulated robot itself comes only 4 % nearer to the measured one.",
    ]
    table = json.loads(partial.to_json())
    assert table["failings"][1] == {"test": "a trial", "trials": ["f0"], "left": 4.0, "allowed": 2.4}
    assert "why" not in dict(points(made()))
    nothing = points(made(verdict="unexplained", effects=(), chosen=(), failings=failings[5:6]))
    assert ("why", "the outcome of slope30, tilt05 is contradicted by the nominal model.") in nothing
    single = made(verdict="unexplained", failings=failings[6:7], gap=replace(made().gap, held_out_trials=()))
    assert dict(points(single))["why"].startswith("no trial could be left out of the fit")
    unknown = made(verdict="unexplained", failings=(Failing("a trial", ("f15",), NAN, 2.4),))
    assert "f15 (unknown σ, 1.55 σ count as noise)" in dict(points(unknown))["why"]


def test_two_effects_that_would_close_an_unexplained_gap_are_told() -> None:
    too_much = (Failing("all trials", left=1.21, allowed=1.18),)

    def said(gap: float, **changes: Any) -> list[str]:
        pair = replace(made().ranking[1], gap=gap)
        ranking = (replace(made().ranking[0], gap=1.1), pair, *made().ranking[2:])
        diagnosis = made(**{"verdict": "unexplained", "failings": too_much, "ranking": ranking, **changes})
        return [text for label, text in points(diagnosis) if label == "caution" and "would leave" in text]

    # Not where it would leave as much, where something else speaks against one, or where two are named.
    assert said(1.1) == said(1.0, failings=(Failing("trials left out"),)) == said(1.0, effects=()) == []
    assert said(1.0, verdict="explained", failings=()) == []
    (text,) = said(1.0)
    pair = "stray field gradient with substrate tilt"
    assert text.startswith(f"{pair} would leave 1.0 σ where they are fitted (probability 6 %)")


def test_the_file_has_the_headline_and_the_cautions_of_the_report() -> None:
    table = json.loads(outcomes_only().to_json())
    assert table["headline"] == headline(outcomes_only())
    assert table["cautions"] == [text for label, text in points(outcomes_only()) if label == "caution"] != []
    assert table["title"] == outcomes_only().dataset.title


def test_where_there_is_no_gap_what_is_left_is_told_and_what_is_likelier_all_the_same() -> None:
    told = dict(points(no_gap()))
    assert "caution" not in told
    gap = replace(no_gap().gap, before=4.0, after_nuisance_only=1.2, after=1.1)
    ranking = (RankedHypothesis(("viscous_drag",), 0.8, 3.0, 1.0, None, None), *no_gap().ranking)
    told = dict(points(replace(no_gap(), gap=gap, ranking=ranking)))
    assert "viscous drag has a probability of 80 %, but the nominal model follows the data" in told["caution"]
    (left,) = (text for text in told.values() if "numbers as stated" in text)
    assert left.index("1.1") < left.index("4") < left.index("1.2")


def test_where_outcomes_alone_leave_no_gap_nothing_is_said_of_noise() -> None:
    gap = replace(no_gap().gap, noise_floor=0.0, after_nuisance_only=0.9, after=0.7)
    said = headline(replace(no_gap(), gap=gap))
    assert said == "No gap: the nominal model contradicts no outcome (near the border of one, if at all: 0.7 σ)."


def test_of_what_is_tied_and_unlikely_the_headline_does_not_say_that_it_is_so() -> None:
    (gradient,) = made().effects
    unsure = replace(gradient, probability=0.19)
    words = headline(made(effects=(unsure,)))
    assert words.startswith(
        "Either of two effects may be the cause; if the robot is pulled along +y, more at high frequency, mostly seen "
        "from 12 Hz up (probability 19 %), a stray field gradient of 0.048 ± 0.004 T/m along y"
    )
    assert words.endswith("explains 93 % of the gap on trials not fitted.")
    more = replace(unsure, confounded_with=("viscous_drag", "substrate_tilt"))
    assert headline(made(effects=(more,))).startswith("Any of 3 effects may be the cause; if the robot is pulled")
    pair = headline(made(effects=(unsure, replace(unsure, name="viscous_drag", parameters={}, confounded_with=()))))
    assert pair.startswith("Other effects may be the causes; if the robot is pulled")
    assert "(probabilities 19 % and 19 %)" in pair
    # What nothing else does is said, however little is sure of it, and what is likelier than not.
    alone = replace(unsure, confounded_with=())
    assert headline(made(effects=(alone,))).startswith("The robot is pulled along +y")
    assert headline(made(effects=(replace(unsure, probability=0.6),))).startswith("The robot is pulled along +y")


def test_the_zero_that_was_taken_to_its_end_is_named() -> None:
    first, *others = made().floors
    floors = (replace(first, at_tolerance=("origin x", "origin z")), *others)
    cautions = " ".join(text for label, text in points(made(floors=floors)) if label == "caution")
    assert f"the origin and the zero of z of {first.trial} had to be taken to the end" in cautions


def test_two_effects_are_both_named() -> None:
    tilt = EffectEstimate(
        "substrate_tilt", 0.9, {"slope_x_deg": Interval(0, -1, 1), "slope_y_deg": Interval(-3, -3.5, -2.5)}, ()
    )
    words = headline(made(effects=(*made().effects, tilt)))
    assert "and the substrate is not level, it rises along -y" in words
    assert "and a slope of -3.0° ± 0.5° along y, together, explain 93 %" in words


def test_the_summary_has_the_verdict_of_the_file() -> None:
    lines = summary(made()).splitlines()
    assert "  verdict      explained; what is tied would explain it as well" in lines
    alone = tuple(replace(effect, confounded_with=()) for effect in made().effects)
    assert "  verdict      explained" in summary(made(effects=alone)).splitlines()
    assert "  verdict      no_gap" in summary(no_gap()).splitlines()


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
    assert [text for label, text in points(made()) if label == "next trial"] == [
        "20 mT at 15 Hz, level, 2 s: separates stray field gradient from viscous drag.",
        "the one is faster, the other slower.",
        "expected information over all of them: 0.82 bit.",
    ]
    assert max(map(len, summary(made()).splitlines())) <= 100


def test_amounts_of_two_nouns_explain_together() -> None:
    camera = {"scale": Interval(1.045, 1.036, 1.054), "heading_deg": Interval(0.0, -2.0, 2.0)}
    camera |= {f"origin_m[{i}]": Interval(0.0, -5e-5, 5e-5) for i in range(2)}
    camera |= {"time_offset_s": Interval(0.0, -8e-3, 8e-3)}
    words = headline(made(effects=(EffectEstimate("camera_calibration", 0.9, camera, ()),)))
    assert "a scale of 1.045 ± 0.009 and a heading of 0° ± 2° explain 93 %" in words
    # Of the origin and the clock, what is off.
    camera |= {"origin_m[1]": Interval(3e-4, 2.5e-4, 3.5e-4)}
    words = headline(made(effects=(EffectEstimate("camera_calibration", 0.9, camera, ()),)))
    assert "a heading of 0° ± 2° and an origin at " in words
    assert "along y explain 93 %" in words
    assert "along x explain" not in words


def test_of_what_is_ruled_out_a_terminal_names_a_few_and_the_report_all() -> None:
    names = list(CATALOGUE)[:9]
    diagnosis = made(ruled_out=dict.fromkeys(names, "f01"))
    assert dict(points(diagnosis))["ruled out"].endswith("; 3 more in the report.")
    said = dict(points(diagnosis, whole=True))["ruled out"]
    assert all(title_of(name) in said for name in names)
    assert "more in the report" not in said


def test_a_number_in_another_unit_is_among_the_cautions() -> None:
    substrate = replace(lab().substrate, friction_coefficient=30.0)
    said = dict(points(made(dataset=replace(lab(), substrate=substrate))))["caution"]
    assert said.startswith("friction_coefficient = 30 is more than a substrate has")


def test_an_effect_that_is_within_a_stated_tolerance_is_said_to_be() -> None:
    friction = EffectEstimate("friction_coefficient", 0.9, {"factor": Interval(1.08, 1.05, 1.1)}, ())
    wide = replace(lab(), tolerance=Tolerance(friction_coefficient=0.03))
    for dataset, said in ((lab(), False), (wide, True)):
        chosen = (CATALOGUE["friction_coefficient"].from_vector([1.08, 0.0]),)
        made_of = made(dataset=dataset, effects=(friction,), chosen=chosen)
        words = [text for label, text in points(made_of) if label == "caution"]
        assert any("measure that number first" in text for text in words) == said


def test_cautions_name_what_weakens_a_diagnosis() -> None:
    assert "caution" not in dict(points(made()))
    said = " ".join(text for label, text in points(outcomes_only()) if label == "caution")
    assert "there are no tracks" in said
    assert "probability of 50 % only" in said
    floors = [replace(floor, frames=60, lost=50, numerical_sigmas=2.0) for floor in made().floors[:1]]
    said = " ".join(text for label, text in points(made(floors=tuple(floors))) if label == "caution")
    assert "half of the frames are lost in f01" in said
    assert "above the noise in f01" in said
    floors = [replace(floor, frames=0, tolerance_sigmas=6.0) for floor in made().floors[:1]]
    said = " ".join(text for label, text in points(made(floors=tuple(floors))) if label == "caution")
    assert "move the outcome of f01 by more than 5 times its noise" in said
    at_end = EffectEstimate("draft_angle", 0.9, {"draft_deg": Interval(8.0, 7.5, 8.0)}, ())
    assert "end of its plausible range" in dict(points(made(effects=(at_end,))))["caution"]
    weak = EffectEstimate("draft_angle", 0.9, {"draft_deg": Interval(0.02, 0.01, 0.03)}, ())
    assert "caution" not in dict(points(made(effects=(weak,)))), "the range begins at the neutral value"
    said = " ".join(text for label, text in points(outcomes_only()) if label == "caution")
    assert "without adhesion" not in said
    assert "a zero of their own" not in said
    said = dict(points(made(z_origin_tolerance_m=5e-5)))["caution"]
    assert "heights were taken to be from a zero of their own in each trial" in said
    smooth = replace(made().dataset, substrate=replace(made().dataset.substrate, adhesion_N_per_m2=0.0))
    said = dict(points(made(dataset=smooth)))["caution"]
    assert (
        "without adhesion, and what multiplies it (adhesion coefficient, line contact adhesion) cannot be tried" in said
    )
    turned = {"theta1_deg": Interval(20.0, 18.0, 22.0), "theta2_deg": Interval(179.5, 170.0, 189.0)}
    at_end = EffectEstimate("magnetization_misalignment", 0.9, turned, ())
    assert "caution" not in dict(points(made(effects=(at_end,)))), "an angle that turns on has no end"


@pytest.mark.parametrize(
    ("interval", "unit", "words"),
    [
        (Interval(0.0482, 0.0441, 0.0522), "T/m", "0.048 ± 0.004 T/m"),
        (Interval(5.1e-6, 4.3e-6, 5.9e-6), "m", "5.1 ± 0.8 µm"),
        (Interval(5.1e-6, 4.9e-6, 9.9e-6), "m", "5.1 µm (4.9 to 10)"),
        (Interval(0.04, 0.04, 0.25), "1", "0.04 (0.04 to 0.25)"),
        (Interval(1.078, 1.069, 1.88), "1", "1.078 (1.069 to 1.9)"),
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


def test_a_gap_in_most_trials_is_counted_rather_than_listed() -> None:
    regions = tuple(Region("trial", 0.9 / (i + 2), value=f"f{f:02.0f}", sigmas=9.0) for i, f in enumerate(FREQUENCIES))
    assert dict(points(made(where=regions)))["where"] == "7 of 9 trials are off, f01 holds most (45 %)."


def test_what_may_act_in_a_part_alone_is_said_as_a_supposition() -> None:
    cycle = Region("cycle_phase_deg", 0.48, low=308.0, high=401.0, what="0.12 times the magnetic torque")
    place = Region("position_y_m", 0.41, low=8e-4, high=1.6e-3, what="240 nN more attraction")
    trial = Region("trial", 0.9, value="f15")
    one, both = (dict(points(made(where=where)))["where"] for where in ((trial, cycle), (trial, cycle, place)))
    one_with = (
        "With 0.12 times the magnetic torque at phase of the cycle 308 to 401° alone, 48 % of the gap would be gone"
    )
    or_with = "or, with 240 nN more attraction at place y 0.80 to 1.60 mm alone, 41 % of the gap would be gone"
    assert one.endswith(f". {one_with}.")
    assert both.endswith(f". {one_with}; {or_with}.")
    time = Region("time_s", 0.79, low=0.337, high=0.9, what="the field 26° behind where it should be")
    said = dict(points(made(where=(trial, time))))["where"]
    # It goes on.
    assert said.endswith(" With the field 26° behind where it should be from 0.34 s on, 79 % of the gap would be gone.")
    assert "would be gone" not in dict(points(made(where=(trial,))))["where"]
    entries = json.loads(made(where=(trial, cycle)).to_json())["where"]
    assert [entry.get("what") for entry in entries] == [None, cycle.what]
    assert cycle.what is not None
    assert cycle.what in where_part(made(where=(trial, cycle)))


@pytest.mark.parametrize(
    ("axis", "keys"), [("force", ("force_N", "force_sigma_N")), ("torque", ("torque_N_m", "torque_sigma_N_m"))]
)
def test_the_file_says_which_way_what_is_missing_points(axis: str, keys: tuple[str, str]) -> None:
    region = Region(f"missing_{axis}", 0.7, value="y", sigmas=4.0, missing=(-2e-7, 5e-8))
    (entry,) = json.loads(made(where=(region,)).to_json())["where"]
    assert [entry[key] for key in keys] == [-2e-7, 5e-8]


def test_why_refitting_the_sensor_may_widen_a_gap_is_said() -> None:
    wider = dict(points(made(gap=replace(made().gap, before=16.2, after_nuisance_only=18.0))))["how far"]
    assert "nuisances refitted: 18.0 σ, which is more, for it is foretold from the other trials; noise" in wider
    assert "which is more" not in dict(points(made()))["how far"]


def test_of_what_refitting_the_camera_closes_no_effect_takes_the_credit() -> None:
    gap = replace(made().gap, before=5.0, after_nuisance_only=2.0, after=1.1)
    assert headline(made(gap=gap)).endswith(
        "explains 90 % of what refitting the sensor leaves of the gap on trials not fitted, 2.0 σ that become 1.1 σ; "
        "viscous drag would as well."
    )
    assert "explains 93 % of the gap on trials not fitted" in headline(made())
    # The shrink of 0.3 is the camera's.
    idle = replace(gap, after=2.0, shrink=Interval(0.3, 0.1, 0.9))
    assert "too few for the others to foretell it" in headline(made(gap=idle))


def test_a_shrink_of_next_to_nothing_has_no_interval() -> None:
    gap = replace(made().gap, shrink=Interval(0.008, 0.006, 0.011))
    assert dict(points(made(gap=gap)))["how far"].endswith("the gap shrinks by less than 1 %.")


def test_a_tie_that_no_trial_undoes_says_so() -> None:
    assert dict(points(made(next_trials=())))["next trial"] == NO_TRIAL
    free = replace(made().effects[0], confounded_with=())
    assert "next trial" not in dict(points(made(next_trials=(), effects=(free,))))


@pytest.mark.parametrize(
    ("axis", "words"),
    [
        ((-1.0, 0.0, 0.0), "20 mT at 2 Hz, level"),
        ((1.0, 0.0, 0.0), "20 mT at 2 Hz backwards, level"),
        ((0.0, -1.0, 0.0), "20 mT at 2 Hz towards -x, level"),
        ((-(0.5**0.5), 0.5**0.5, 0.0), "20 mT at 2 Hz 45° from +y towards +x, level"),
        ((0.0, 0.0, 1.0), "20 mT at 2 Hz, level"),
    ],
)
def test_a_direction_is_told_where_it_is_not_the_usual_one(axis: tuple[float, float, float], words: str) -> None:
    field = {"kind": "rotating", "strength_T": 0.02, "frequency_Hz": 2.0, "rotation_axis": axis}
    assert condition_of_table({"field": field, "incline_deg": 0.0}) == words


def test_of_a_part_of_the_catalogue_it_is_said_that_it_is_one() -> None:
    few = tuple(hypothesis for hypothesis in made().ranking if hypothesis.gap != 12.0)
    assert dict(points(made(ranking=few)))["caution"].startswith(f"only 4 of the {len(CATALOGUE)} effects")
    assert "caution" not in dict(points(made()))
