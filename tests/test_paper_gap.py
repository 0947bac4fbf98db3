"""The paper's own gap against the whole catalogue: minutes, and beside `make test` for that."""

from __future__ import annotations

from tumblers import dataset
from tumblers.diagnosis import diagnose

from .diagnosis.test_edges import EXAMPLE, check_the_papers_gap


def test_the_papers_outcomes_leave_two_causes_and_a_trial_that_parts_them() -> None:
    check_the_papers_gap(diagnose(dataset.load(EXAMPLE), jobs=2))
