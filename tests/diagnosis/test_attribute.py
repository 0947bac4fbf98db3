"""Which contender leads by evidence, in what steps, and against which noise."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from importlib import import_module
from types import SimpleNamespace
from typing import Any

import pytest

from tumblers.diagnosis.contender import Contender

from .lab import NOTHING, coarse_lab

# The package has the function by the module's name.
attribution = import_module("tumblers.diagnosis.attribute")


def test_what_leads_once_another_counts_as_the_nominal_model_imposes_its_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    slow, fast = SimpleNamespace(effects=("slow",)), SimpleNamespace(effects=("fast",))
    resolved, asked = {slow.effects}, []

    def in_steps_of(_: object, leader: Any, made: list[Any], __: Callable[..., None]) -> list[Any]:
        asked.append(leader)
        resolved.add(leader.effects)
        return made

    patched: dict[str, Any] = {
        "Search": lambda *_: SimpleNamespace(contenders=lambda: [slow, fast], names=()),
        "_nominal_is_right": lambda _: True,
        "_ranked": lambda made, *_: (made, 1.0),
        "_flattered": lambda _: [],
        # The one that led counts as the nominal model.
        "_with_tolerated": lambda _, made, __: made[::-1],
        "in_steps_of": in_steps_of,
        "seen_from_the_best": lambda _, found: found,
    }
    for name, instead in patched.items():
        monkeypatch.setattr(attribution, name, instead)
    comparison = coarse_lab().comparison
    monkeypatch.setattr(comparison.simulator, "resolves", lambda effects: effects in resolved)
    found = attribution.attribute(comparison, [])
    assert asked == [fast]
    assert found.contenders == (fast, slow)


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
