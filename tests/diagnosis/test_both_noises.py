"""What is about as good as the best is compared with it against the noise around either."""

from __future__ import annotations

from typing import Any

import pytest

from tumblers.diagnosis import both_noises
from tumblers.diagnosis.both_noises import by_both_noises
from tumblers.diagnosis.contender import Contender


def ranked(name: str, total: float, log_evidence: float) -> Contender:
    nothing: Any = None
    return Contender(tuple(filter(None, name.split("+"))), nothing, nothing, total, log_evidence=log_evidence)


def compared(
    contenders: list[Contender], around: dict[tuple[str, str], float], monkeypatch: pytest.MonkeyPatch
) -> dict[str, float]:
    """Return totals after; `around` has a total by what is held, and around what."""
    asked: list[tuple[str, str]] = []

    def lead(_fitter: Any, contender: Contender, other: Contender) -> float:
        mine, theirs = "+".join(contender.names), "+".join(other.names)
        asked.append((mine, theirs))
        return around[theirs, theirs] - around[mine, theirs]

    monkeypatch.setattr(both_noises, "lead_around", lead)
    nothing: Any = None
    made = by_both_noises(nothing, contenders, lambda *_: None)
    assert [c.names for c in made] == [c.names for c in contenders]
    assert {name for pair in asked for name in pair} <= {name for pair in around for name in pair}
    return {"+".join(c.names): c.total for c in made}


def test_what_is_near_is_behind_the_best_by_the_mean_over_both_noises(monkeypatch: pytest.MonkeyPatch) -> None:
    contenders = [ranked("best", 100.0, 0.0), ranked("near", 150.0, -2.9), ranked("far", 101.0, -3.1)]
    # The noise around the one hides what the other says, and the other way round.
    around = {("best", "best"): 90.0, ("near", "best"): 120.0, ("near", "near"): 140.0, ("best", "near"): 150.0}
    assert compared(contenders, around, monkeypatch) == {"best": 100.0, "near": 110.0, "far": 101.0}


def test_what_comes_before_the_best_by_it_sets_the_best_back(monkeypatch: pytest.MonkeyPatch) -> None:
    contenders = [
        ranked("best", 100.0, 0.0),
        ranked("a", 103.0, -1.0),
        ranked("b", 104.0, -2.0),
        ranked("", 140.0, -9.0),
    ]
    around = {("best", "best"): 100.0, ("a", "best"): 101.0, ("a", "a"): 100.0, ("best", "a"): 121.0}
    around |= {("b", "best"): 106.0, ("b", "b"): 50.0, ("best", "b"): 52.0}
    # Nothing gains on the nominal model.
    found = compared(contenders, around, monkeypatch)
    assert found == {"a": 100.0, "best": 110.0, "b": 112.0, "": 140.0}


def test_what_has_other_effects_more_or_none_is_not_compared_so(monkeypatch: pytest.MonkeyPatch) -> None:
    for best, other in (("a", "a+b"), ("a+b", "a"), ("a", ""), ("", "a")):
        contenders = [ranked(best, 100.0, 0.0), ranked(other, 101.0, -0.5)]
        assert compared(contenders, {}, monkeypatch) == {best: 100.0, other: 101.0}


def test_what_was_compared_before_is_put_where_it_is_now(monkeypatch: pytest.MonkeyPatch) -> None:
    around = {("best", "best"): 90.0, ("near", "best"): 100.0, ("near", "near"): 90.0, ("best", "near"): 100.0}
    near = Contender(("near",), None, ranked("", 0.0, 0.0).residual, 99.0, set_back=7.0, log_evidence=-1.0)
    assert compared([ranked("best", 100.0, 0.0), near], around, monkeypatch)["near"] == 100.0
