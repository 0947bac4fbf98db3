"""What is about as good as the best is compared with it against the noise around either."""

from __future__ import annotations

from typing import Any

import pytest

from tumblers.diagnosis.what import both_noises
from tumblers.diagnosis.what.both_noises import by_both_noises
from tumblers.diagnosis.what.contender import Contender


def ranked(name: str, total: float, log_evidence: float) -> Contender:
    nothing: Any = None
    return Contender(tuple(filter(None, name.split("+"))), nothing, nothing, total, log_evidence=log_evidence)


def compared(
    contenders: list[Contender],
    around: dict[tuple[str, str], float],
    monkeypatch: pytest.MonkeyPatch,
    dispersion: float = 1.0,
) -> dict[str, float]:
    """Return totals after; `around` has a total by what is held, and around what. What is not in it is not asked."""

    def lead(_fitter: Any, contender: Contender, other: Contender) -> float:
        mine, theirs = "+".join(contender.names), "+".join(other.names)
        return around[theirs, theirs] - around[mine, theirs]

    monkeypatch.setattr(both_noises, "lead_around", lead)
    nothing: Any = None
    made = by_both_noises(nothing, contenders, dispersion, lambda *_: None)
    assert [c.names for c in made] == [c.names for c in contenders]
    return {"+".join(c.names): c.total for c in made}


def test_what_is_near_is_behind_the_best_by_the_mean_over_both_noises(monkeypatch: pytest.MonkeyPatch) -> None:
    contenders = [ranked("best", 100.0, 0.0), ranked("near", 105.0, -2.9), ranked("far", 101.0, -3.1)]
    # The noise around the one hides what the other says, and the other way round.
    around = {("best", "best"): 90.0, ("near", "best"): 120.0, ("near", "near"): 140.0, ("best", "near"): 150.0}
    assert compared(contenders, around, monkeypatch) == {"best": 100.0, "near": 110.0, "far": 101.0}


def test_where_the_mean_is_the_difference_of_before_nothing_changes(monkeypatch: pytest.MonkeyPatch) -> None:
    # The best by evidence is not the likeliest: others pay more for their parameters.
    contenders = [ranked("best", 100.0, -51.0), ranked("costly", 90.0, -52.0), ranked("far", 105.0, -56.1)]
    around = {("best", "best"): 80.0, ("costly", "best"): 70.0, ("costly", "costly"): 60.0, ("best", "costly"): 70.0}
    assert compared(contenders, around, monkeypatch) == {"best": 100.0, "costly": 90.0, "far": 105.0}


@pytest.mark.parametrize("dispersion", [1.0, 8.0])
def test_what_comes_before_the_best_by_it_sets_the_best_back(
    dispersion: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    worth = 2.0 * dispersion
    contenders = [
        ranked("best", 100.0, 0.0),
        ranked("a", 100.0 + 1.5 * worth, -1.5),
        ranked("b", 100.0 + 2.0 * worth, -2.0),
        ranked("", 100.0 + 9.0 * worth, -9.0),
    ]
    # Against its own noise the one is as before, against the other's far ahead.
    around = {
        ("best", "best"): 100.0,
        ("a", "best"): 100.0 + worth,
        ("a", "a"): 70.0,
        ("best", "a"): 70.0 + 6.0 * worth,
    }
    around |= {("b", "best"): 100.0 + 2.0 * worth, ("b", "b"): 50.0, ("best", "b"): 50.0 - 2.0 * worth}
    found = compared(contenders, around, monkeypatch, dispersion)
    # It has what the best had, and nothing gains on the nominal model.
    behind = {name: (total - 100.0) / worth for name, total in found.items()}
    assert behind == pytest.approx({"a": 0.0, "best": 2.5, "b": 4.5, "": 9.0})


def test_no_more_than_four_are_compared(monkeypatch: pytest.MonkeyPatch) -> None:
    contenders = [ranked("best", 100.0, 0.0), *(ranked(name, 101.0, -0.5) for name in "abcde")]
    around = {("best", "best"): 100.0}
    for name in "abcd":
        around |= {(name, "best"): 103.0, (name, name): 100.0, ("best", name): 97.0}
    found = compared(contenders, around, monkeypatch)
    assert found == {"best": 100.0, **dict.fromkeys("abcd", 103.0), "e": 101.0}


def test_what_has_other_effects_more_or_none_is_not_compared_so(monkeypatch: pytest.MonkeyPatch) -> None:
    for best, other in (("a", "a+b"), ("a+b", "a"), ("a", ""), ("", "a")):
        contenders = [ranked(best, 100.0, 0.0), ranked(other, 101.0, -0.5)]
        assert compared(contenders, {}, monkeypatch) == {best: 100.0, other: 101.0}


def test_what_was_compared_before_is_put_where_it_is_now(monkeypatch: pytest.MonkeyPatch) -> None:
    around = {("best", "best"): 90.0, ("near", "best"): 100.0, ("near", "near"): 90.0, ("best", "near"): 100.0}
    near = Contender(("near",), None, ranked("", 0.0, 0.0).residual, 99.0, offset=7.0, log_evidence=-1.0)
    # Level by the mean, and so ahead by what its total was more than it by evidence.
    assert compared([ranked("best", 100.0, 0.0), near], around, monkeypatch) == {"best": 104.0, "near": 104.0}
