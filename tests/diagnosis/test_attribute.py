"""Which contender leads by evidence, in what steps, and against which noise."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import log
from types import SimpleNamespace
from typing import Any

import pytest

from tumblers.diagnosis.what import attribute as attribution
from tumblers.diagnosis.what.contender import Contender

from .lab import NOTHING


def made(total: float, *names: str, settled: bool = False) -> Contender:
    """Return a contender, of which only its total is known."""
    return Contender(names, None, NOTHING, total, settled=settled)


def test_what_leads_by_the_noise_around_another_is_first_held_against_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    # Where the best leaves a gap, so far behind it a single effect is likelier than two.
    nominal, pair, idle = made(9900.0), made(5000.0, "a", "b", settled=True), made(5400.0, "c")
    comparison = SimpleNamespace(
        alike=8.0,
        independent=1000.0 / 8.0,
        simulator=SimpleNamespace(resolves=lambda _: True),
    )
    held: list[tuple[str, ...]] = []

    def by_itself(_: object, contender: Contender, evaluations: int) -> Contender:
        assert evaluations == 1
        held.append(contender.names)
        return replace(contender, cost=nominal.total, settled=True)

    def search(*_: Any) -> SimpleNamespace:
        return SimpleNamespace(contenders=lambda: [pair, nominal, idle], names=("a", "b", "c"))

    ranked, _ = attribution._ranked([pair, nominal, idle], comparison, ("a", "b", "c"), False)
    assert ranked[0].names == idle.names
    patched: dict[str, Any] = {
        "Fitter": lambda _: None,
        "Search": search,
        "_nominal_is_right": lambda _: False,
        "by_itself": by_itself,
        "seen_from_the_best": lambda _, found: found,
    }
    for name, instead in patched.items():
        monkeypatch.setattr(attribution, name, instead)
    found = attribution.attribute(comparison, [])
    assert held == [idle.names]
    assert found.contenders[0].names == pair.names
    # Nothing is asked where the nominal model leads, nor of what is held against a noise that it is near.
    assert attribution._flattered([made(0.0), idle]) == []
    assert attribution._flattered([idle, pair]) == [idle]
    assert attribution._flattered([replace(idle, lent=True), pair]) == []


def test_what_is_near_is_compared_by_both_noises_once_it_is_held_as_it_will_be(monkeypatch: pytest.MonkeyPatch) -> None:
    first, second = made(100.0, "a", settled=True), made(101.0, "b", settled=True)
    coarse, told = [True], []

    def by_both_noises(
        _: object, ranked: list[Contender], dispersion: float, __: Callable[..., None]
    ) -> list[Contender]:
        assert dispersion == 3.0
        told.append(("compared", ranked[0].names))
        return [replace(ranked[0], offset=5.0), *ranked[1:]]

    def flattered(ranked: list[Contender]) -> list[Contender]:
        # What the comparison has put first is not yet held against its own noise.
        return [c for c in ranked[:1] if c.names == second.names and c.settled and ("held", c.names) not in told]

    def each_by_itself(_: object, ranked: list[Contender], which: list[Contender], __: object) -> list[Contender]:
        told.append(("held", which[0].names))
        return list(ranked)

    def in_steps_of(_: object, leader: Contender, contenders: list[Contender], *_rest: object) -> list[Contender]:
        told.append(("in steps of", leader.names))
        coarse[0] = False
        return [replace(c, offset=0.0) for c in contenders]

    patched: dict[str, Any] = {
        "Fitter": lambda _: None,
        "Search": lambda *_: SimpleNamespace(contenders=lambda: [first, second], names=()),
        "_nominal_is_right": lambda _: False,
        "_ranked": lambda contenders, *_: (sorted(contenders, key=lambda c: c.total), 3.0),
        "_flattered": flattered,
        "_each_by_itself": each_by_itself,
        "by_both_noises": by_both_noises,
        "in_steps_of": in_steps_of,
        "seen_from_the_best": lambda _, found: found,
    }
    for name, instead in patched.items():
        monkeypatch.setattr(attribution, name, instead)
    comparison: Any = SimpleNamespace(simulator=SimpleNamespace(resolves=lambda _: not coarse[0]))
    found = attribution.attribute(comparison, [])
    # In steps that are too long nothing is compared; what is held anew is compared again, and nothing else.
    assert told == [("in steps of", ("a",)), ("compared", ("a",)), ("held", ("b",)), ("compared", ("b",))]
    assert [c.offset for c in found.contenders] == [5.0, 5.0]


def test_what_is_behind_by_both_noises_is_no_less_beside_the_nominal_model() -> None:
    nominal, comparison = made(100.0), SimpleNamespace(alike=1.0, independent=1000.0)
    # Likelier by enough that a nominal model which failed the predictive test is improbable.
    for offset in (0.0, 4.0):
        contender = replace(made(90.0, "a", settled=True), offset=offset)
        ranked, _ = attribution._ranked([nominal, contender], comparison, ("a",), False)
        nominal_evidence = next(c.log_evidence for c in ranked if not c.names)
        expected = -50.0 + log(attribution.PRIOR[0]) + log(attribution.REFUSED)
        assert nominal_evidence == pytest.approx(expected)
