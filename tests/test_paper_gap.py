"""The paper's own gap against the whole catalogue: minutes, and beside `make test` for that."""

from __future__ import annotations

from pathlib import Path

from tumblers import dataset
from tumblers.diagnosis import diagnose

EXAMPLE = Path(__file__).parents[1] / "examples" / "aluminium_30deg"


def test_the_papers_outcomes_leave_two_causes_and_a_trial_that_parts_them() -> None:
    diagnosis = diagnose(dataset.load(EXAMPLE), jobs=2)
    assert diagnosis.verdict == "explained"
    pair = {"friction_coefficient", "line_contact_adhesion"}
    assert "Every measured number counts for itself in probabilities and intervals." in diagnosis.assumptions
    (first,) = diagnosis.effects
    assert first.name in pair
    assert pair - {first.name} <= set(first.confounded_with)
    inclines = [region for region in diagnosis.where if region.axis == "incline_deg"]
    assert inclines
    assert inclines[0].low is not None
    assert inclines[0].high is not None
    assert inclines[0].low <= 30.0 <= inclines[0].high
    assert not inclines[0].low <= 20.0 <= inclines[0].high
    assert [region.value for region in diagnosis.where if region.axis == "trial"][:1] == ["slope30"]
    assert diagnosis.next_trials
    # Of what friction and the strip predict at even odds: more than chance finds in as many draws. Within the lab's
    # ranges it may be little; then the trial beyond them tells.
    proposed = max(diagnosis.next_trials, key=lambda trial: trial.information_bits)
    assert proposed.information_bits > 0.1
    # Both are foretold, and told apart: not named among what is hardly told from the one that is chosen.
    assert pair <= set(proposed.predictions)
    (other,) = pair - {first.name}
    assert other in proposed.why.partition(":")[0].partition(", hardly")[0]
