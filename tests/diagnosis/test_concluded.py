"""What a diagnosis says beside its verdict: what is ruled out, and between what a next trial is sought."""

from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np

from tumblers.diagnosis.gap.comparison import Residual
from tumblers.diagnosis.result import Verdict
from tumblers.diagnosis.what.attribute import Attribution
from tumblers.diagnosis.what.contender import Contender
from tumblers.diagnosis.what.ruled_out import LEAST_ODDS, ruled_out
from tumblers.diagnosis.what_next.rivals import rivals

# One more than are sought among.
ORDER = (
    "friction_coefficient",
    "viscous_drag",
    "size_error",
    "draft_angle",
    "substrate_tilt",
    "field_rolloff",
    "contact_compliance",
)


def contender(*names: str, log_evidence: float = 0.0) -> Contender:
    nothing = np.zeros(0)
    residual = Residual((np.zeros(2),), nothing, nothing, nothing, nothing)
    return Contender(names, None, residual, 0.0, log_evidence=log_evidence, probability=0.1)


def attribution(*contenders: Contender) -> Attribution:
    return Attribution(contenders, 1.0, False, order=ORDER)


# Less of it is left with what is chosen.
FITTER: Any = SimpleNamespace(
    trials=(0,),
    trial_cost=lambda residual, _trial: float(residual is not CHOSEN.residual),
    comparison=SimpleNamespace(dataset=SimpleNamespace(trials=(SimpleNamespace(id="up"),))),
)
CHOSEN = contender("friction_coefficient")
FAR = -LEAST_ODDS - 1.0


def test_what_is_likely_beside_another_is_not_ruled_out_for_being_unlikely_alone() -> None:
    drag, size = contender("viscous_drag", log_evidence=FAR), contender("size_error", log_evidence=FAR)
    pair = contender("friction_coefficient", "size_error", log_evidence=-1.0)
    assert ruled_out(FITTER, attribution(CHOSEN, drag, size), CHOSEN, {}) == {"viscous_drag": "up", "size_error": "up"}
    assert ruled_out(FITTER, attribution(CHOSEN, pair, drag, size), CHOSEN, {}) == {"viscous_drag": "up"}


def test_a_next_trial_is_sought_among_so_many_rivals() -> None:
    others = [contender(name, log_evidence=-1.0) for name in ORDER[1:]]
    tied = {"friction_coefficient": ORDER[1:]}
    verdicts: tuple[tuple[Verdict, Sequence[str]], ...] = (("unexplained", ORDER[:3]), ("explained", ORDER[:6]))
    for verdict, found in verdicts:
        sought = rivals(attribution(CHOSEN, *others), CHOSEN, tied, verdict)
        assert [one.names for one in sought] == [(name,) for name in found]


def test_the_rivals_of_a_pair_keep_what_is_not_tied() -> None:
    pair = contender("viscous_drag", "size_error")
    swapped, alone = contender("viscous_drag", "draft_angle"), contender("draft_angle")
    assert rivals(attribution(pair, alone, swapped), pair, {"size_error": ("draft_angle",)}, "explained") == (
        pair,
        swapped,
    )
