"""What is held against its own noise, and what is fitted on."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.what import own_noise
from tumblers.diagnosis.what.contender import Contender
from tumblers.diagnosis.what.margins import SECOND
from tumblers.diagnosis.what.own_noise import again, against_the_best, each_by_itself, settled

# Against the noise around another, and around itself.
LENT = {"a": 1.0, "b": 2.0, "c": 3.0, "d": 4.0, "e": 5.0}
OWN = {"a": 50.0, "b": 60.0, "c": 70.0, "d": 80.0, "e": 30.0}


@pytest.mark.parametrize(("before", "expected"), [(True, ("abe", "cde")), (False, ("abcde", ""))])
def test_what_was_fitted_before_and_leads_by_another_s_noise_is_first_held_against_its_own(
    before: bool, expected: tuple[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    nothing: Any = None
    fitted, held = [], []

    def contender(name: Any, cost: float) -> Contender:
        return Contender((name,), name, nothing, cost)

    def fit_on(_fitter: Any, contender: Contender) -> Contender:
        fitted.append(contender.names[0])
        return replace(contender, cost=OWN[contender.names[0]], settled=True)

    def hold(_fitter: Any, fit: Any) -> Contender:
        held.append(fit)
        return contender(fit, OWN[fit])

    monkeypatch.setattr(own_noise, "_settled", fit_on)
    monkeypatch.setattr(own_noise, "against_itself", hold)
    found = settled(nothing, [contender(*each) for each in LENT.items()], lambda *_: None, fitted=before)
    assert ("".join(fitted), "".join(held)) == expected
    assert found[0].names == ("e",)
    assert found[0].settled


def made(name: str, total: float, settled: bool = False) -> Contender:
    """Return a contender whose fit is its name; one of two effects has them joined by a plus."""
    fit: Any = name or None
    nothing: Any = None
    return Contender(tuple(filter(None, name.split("+"))), fit, nothing, total, settled=settled)


def counting(alike: float) -> Any:
    """Return a fitter of which only that is asked how much ln counts in a total."""
    comparison = SimpleNamespace(alike=alike)
    comparison.objective_of = lambda ln: Comparison.objective_of(comparison, ln)
    return SimpleNamespace(comparison=comparison)


def test_what_leads_by_another_s_noise_is_held_against_its_own_though_a_pair_is_likelier(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def hold(_fitter: Any, contender: Contender, _points: int) -> Contender:
        return replace(contender, cost=4000.0, settled=True)

    monkeypatch.setattr(own_noise, "by_itself", hold)
    monkeypatch.setattr(own_noise, "_MOST_NEAR", 0)
    fitter = counting(1.0)
    # The pair takes less off than a second effect must, so that the idle one would lead.
    pair = made("cause+second", 100.0 - SECOND, settled=True)
    found = each_by_itself(fitter, [pair, made("idle", 98.0), made("cause", 100.0, settled=True)], lambda *_: None)
    assert [contender.names for contender in found] == [("cause",), ("cause", "second"), ("idle",)]


@pytest.mark.parametrize(
    ("of_the_moment", "settled", "own", "lent", "total"),
    [
        # Says the same, in a noise of its own: the best's is lent.
        (150.0, True, 150.0, 110.0, 110.0),
        # Near by the noise of the moment alone, and far by its own: nothing is lent.
        (104.0, False, 4000.0, 104.0, 4000.0),
        # Near by both.
        (104.0, False, 150.0, 104.0, 104.0),
        # Far by the noise of the moment too: it stays.
        (3000.0, False, 4000.0, 104.0, 3000.0),
    ],
)
def test_the_best_s_noise_is_lent_to_what_is_near_by_its_own(
    of_the_moment: float, settled: bool, own: float, lent: float, total: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    # By what is held, and around what.
    totals = {("a", "a"): own, ("a", "best"): lent, ("best", "a"): own, ("", "best"): 5000.0, ("", ""): 5000.0}

    def hold(_fitter: Any, contender: Contender, around: Contender) -> Contender:
        return replace(contender, cost=totals["+".join(contender.names), "+".join(around.names)])

    monkeypatch.setattr(own_noise, "beside", hold)
    monkeypatch.setattr(
        own_noise, "_with_slopes", lambda _fitter, contender, _around: replace(contender, settled=False)
    )
    best, contender = made("best", 100.0, settled=True), made("a", of_the_moment, settled)
    found = against_the_best(counting(8.0), made("", 5000.0), [best, contender])
    assert [c.names for c in found] == [("best",), (), ("a",)]
    assert [c.total for c in found] == [100.0, 5000.0, total]


def test_what_is_near_by_its_own_noise_and_is_lent_none_has_its_slopes_against_its_own(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # By what is held, and around what: it says something else than the best.
    totals = {("a", "a"): 150.0, ("a", "best"): 104.0, ("best", "a"): 50.0, ("", "best"): 5000.0}
    sloped: list[tuple[tuple[str, ...], int]] = []

    def hold(_fitter: Any, contender: Contender, around: Contender) -> Contender:
        return replace(contender, cost=totals["+".join(contender.names), "+".join(around.names)])

    def by_itself(_fitter: Any, contender: Contender, evaluations: int) -> Contender:
        sloped.append((contender.names, evaluations))
        return replace(contender, settled=True)

    monkeypatch.setattr(own_noise, "beside", hold)
    monkeypatch.setattr(own_noise, "by_itself", by_itself)
    best = made("best", 100.0, settled=True)
    *_, found = against_the_best(counting(8.0), made("", 5000.0), [best, made("a", 104.0)])
    assert (found.total, found.settled, found.lent) == (150.0, True, False)
    assert sloped == [(("a",), 1)]


def test_what_was_lent_a_noise_is_held_against_its_own_in_other_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(own_noise, "of_fit", lambda _fitter, fit: made(fit, 1.0))
    monkeypatch.setattr(own_noise, "against_itself", lambda _fitter, fit: made(fit, 2.0))
    fitter: Any = SimpleNamespace(again=lambda fit: fit)
    lent = replace(made("lent", 9.0), lent=True)
    found = again(fitter, [made("", 9.0), made("settled", 9.0, settled=True), lent, made("far", 9.0)])
    assert {c.names: c.total for c in found} == {("far",): 1.0, ("settled",): 2.0, ("lent",): 2.0}
    assert not any(c.settled or c.lent for c in found)
