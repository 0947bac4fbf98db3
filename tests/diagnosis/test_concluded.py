"""What a diagnosis says beside its verdict: what is ruled out, and between what a next trial is sought."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tumblers.diagnosis.diagnose import _RULED_OUT, _Conclusion
from tumblers.diagnosis.gap.comparison import Residual
from tumblers.diagnosis.what.attribute import Attribution
from tumblers.diagnosis.what.contender import Contender

ORDER = ("friction_coefficient", "viscous_drag", "size_error", "draft_angle", "substrate_tilt")


def contender(*names: str, log_evidence: float = 0.0) -> Contender:
    nothing = np.zeros(0)
    residual = Residual((np.zeros(2),), nothing, nothing, nothing, nothing)
    return Contender(names, None, residual, 0.0, log_evidence=log_evidence, probability=0.1)


def concluded(*contenders: Contender) -> Any:
    return SimpleNamespace(
        attribution=Attribution(contenders, 1.0, False, order=ORDER),
        comparison=SimpleNamespace(
            dataset=SimpleNamespace(trials=(SimpleNamespace(id="up"),)), simulator=SimpleNamespace(threads=1)
        ),
        # Less of it is left with what is chosen.
        fitter=SimpleNamespace(trials=(0,), trial_cost=lambda residual, _trial: float(residual is not CHOSEN.residual)),
        seed=0,
    )


CHOSEN = contender("friction_coefficient")
FAR = -_RULED_OUT - 1.0


def test_what_is_likely_beside_another_is_not_ruled_out_for_being_unlikely_alone() -> None:
    drag, size = contender("viscous_drag", log_evidence=FAR), contender("size_error", log_evidence=FAR)
    pair = contender("friction_coefficient", "size_error", log_evidence=-1.0)
    assert _Conclusion._ruled_out(concluded(CHOSEN, drag, size), CHOSEN, {}) == {
        "viscous_drag": "up",
        "size_error": "up",
    }
    assert _Conclusion._ruled_out(concluded(CHOSEN, pair, drag, size), CHOSEN, {}) == {"viscous_drag": "up"}


def test_a_next_trial_is_sought_among_so_many_rivals(monkeypatch: pytest.MonkeyPatch) -> None:
    others = [contender(name, log_evidence=-1.0) for name in ORDER[1:]]
    sought: list[list[tuple[str, ...]]] = []
    stand_ins = {
        "samples": lambda *_: (),
        "in_one_step": lambda *_: None,
        "next_trials": lambda _dataset, _simulator, drawn, *_: sought.append([names for names, _ in drawn]),
    }
    for name, stand_in in stand_ins.items():
        monkeypatch.setitem(_Conclusion._next.__globals__, name, stand_in)
    tied = {"friction_coefficient": ORDER[1:]}
    for most in (3, 6):
        _Conclusion._next(concluded(CHOSEN, *others), CHOSEN, tied, most, lambda *_: None)
    assert [len(names) for names in sought] == [3, 5]
    assert sought[0] == [("friction_coefficient",), ("viscous_drag",), ("size_error",)]
