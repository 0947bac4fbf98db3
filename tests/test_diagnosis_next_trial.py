from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tumblers.dataset import Dataset, LabTrial, Outcome, load
from tumblers.diagnosis.candidate import Candidate, candidates
from tumblers.diagnosis.next_trial import next_trials
from tumblers.diagnosis.simulator import Simulator
from tumblers.effects import get
from tumblers.effects.base import Effect
from tumblers.field import RotatingField, StaticField, field_from_table

EXAMPLE = Path(__file__).parents[1] / "examples" / "aluminium_30deg"
Hypotheses = list[tuple[tuple[str, ...], list[tuple[Effect, ...]]]]


@pytest.fixture(scope="module")
def dataset() -> Dataset:
    return load(EXAMPLE)


def samples(name: str, low: float, high: float) -> tuple[tuple[str, ...], list[tuple[Effect, ...]]]:
    return (name,), [(get(name).from_vector((float(value),)),) for value in np.linspace(low, high, 5)]


TIED: Hypotheses = [samples("line_contact_adhesion", 2e-6, 9e-6), samples("friction_coefficient", 1.08, 1.4)]


def test_the_papers_tie_is_broken(dataset: Dataset) -> None:
    proposed = next_trials(dataset, Simulator(dataset, 2), TIED, seed=1)
    assert proposed[0].information_bits > 0.3
    # The first is within what the lab has done, though others tell more.
    slopes = [trial.incline_deg for trial in dataset.trials]
    first = proposed[0].trial
    assert min(slopes) <= first["incline_deg"] <= max(slopes)
    assert (first["field"]["frequency_Hz"], first["field"]["strength_T"]) == (1.0, 0.02)
    assert all(set(p.predictions) == {"line_contact_adhesion", "friction_coefficient"} for p in proposed)
    assert all("separates line_contact_adhesion from friction_coefficient" in p.why for p in proposed)
    for p in proposed:
        # What a dataset takes as a [[trial]].
        LabTrial(
            id="next",
            field=field_from_table(p.trial["field"], Path()),
            duration_s=p.trial["duration_s"],
            incline_deg=p.trial["incline_deg"],
            outcome=Outcome(climbs=True),
        )


def test_a_seed_gives_the_same_trials_on_any_number_of_threads(
    dataset: Dataset, monkeypatch: pytest.MonkeyPatch
) -> None:
    field = RotatingField(strength_T=0.02, frequency_Hz=10.0)
    few = tuple(Candidate(field=field, incline_deg=slope, duration_s=0.5) for slope in (10.0, 20.0))
    monkeypatch.setattr("tumblers.diagnosis.next_trial.candidates", lambda *_: few)
    first, second = (next_trials(dataset, Simulator(dataset, threads), TIED, seed=1) for threads in (1, 2))
    assert first
    assert [(p.why, p.information_bits) for p in first] == [(p.why, p.information_bits) for p in second]


def test_the_same_hypothesis_twice_has_nothing_to_tell_apart(dataset: Dataset, monkeypatch: pytest.MonkeyPatch) -> None:
    few = (Candidate(field=RotatingField(strength_T=0.02, frequency_Hz=1.0), incline_deg=25.0, duration_s=1.0),)
    monkeypatch.setattr("tumblers.diagnosis.next_trial.candidates", lambda *_: few)
    simulator = Simulator(dataset, 2)
    assert next_trials(dataset, simulator, [TIED[1], TIED[1]], seed=1) == ()
    assert next_trials(dataset, simulator, TIED[:1], seed=1) == ()


def test_candidates_stay_within_what_the_lab_did(dataset: Dataset) -> None:
    options = candidates(dataset, 90)
    assert 20 <= len(options) <= 90
    assert len(set(options)) == len(options)
    for option in options:
        assert option.field.strength_T <= 0.020
        assert 0.0 <= option.incline_deg <= 55.0
        assert option.duration_s <= 4.0
        if isinstance(option.field, RotatingField):
            assert option.field.frequency_Hz == 1.0 or option.faster
    assert any(isinstance(option.field, StaticField) for option in options)
    assert len(candidates(dataset, 12)) == 12


def test_slopes_are_refined_between_the_next_ones(dataset: Dataset) -> None:
    field = RotatingField(strength_T=0.02, frequency_Hz=1.0)
    row = [Candidate(field=field, incline_deg=slope, duration_s=1.0) for slope in (30.0, 34.0, 38.0)]
    finer = row[1].steeper_and_flatter(row)
    assert [c.incline_deg for c in finer] == [31.0, 32.0, 33.0, 35.0, 36.0, 37.0]
