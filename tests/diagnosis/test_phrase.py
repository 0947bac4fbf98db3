"""A diagnosed effect in words."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from tumblers.diagnosis.result import EffectEstimate, Interval
from tumblers.diagnosis.wording.headline import headline
from tumblers.diagnosis.wording.phrase import phrase_of
from tumblers.effects.catalogue import CATALOGUE

from .example import NAN, lab, made


@pytest.mark.parametrize("name", list(CATALOGUE))
def test_every_effect_reads_naturally(name: str) -> None:
    kind = CATALOGUE[name]
    numbers = {p.key: Interval(0.5 * (p.neutral + p.high), p.neutral, p.high) for p in kind.parameters}
    phrase = phrase_of(EffectEstimate(name, 0.9, numbers, ()), lab())
    assert "_" not in phrase.cause + phrase.amount
    assert re.match(r"(a|an|friction) ?", phrase.amount)
    assert re.search(r"\d", phrase.amount)
    unknown = {p.key: Interval(NAN, NAN, NAN, False) for p in kind.parameters}
    assert "nan" not in headline(made(effects=(EffectEstimate(name, NAN, unknown, ()),)))


@pytest.mark.parametrize(
    ("factor", "drift", "cause", "amount"),
    [
        (
            (1.2, 1.1, 1.3),
            (0.1, -0.1, 0.3),
            "there is more friction than assumed",
            "a friction coefficient of 1.20 ± 0.10 times the nominal one (0.36 instead of 0.3)",
        ),
        # What a fit leaves of no drift.
        (
            (1.2, 1.1, 1.3),
            (2e-6, 1e-6, 0.3),
            "there is more friction than assumed",
            "a friction coefficient of 1.20 ± 0.10 times the nominal one (0.36 instead of 0.3)",
        ),
        (
            (1.0, 0.9, 1.1),
            (0.3, 0.2, 0.4),
            "friction grows in the course of a trial",
            "a friction coefficient that grows from each trial's start by 30 ± 10 % per second",
        ),
        (
            (0.8, 0.7, 0.9),
            (-0.3, -0.4, -0.2),
            "there is less friction than assumed at first, and it falls in the course of a trial",
            "a friction coefficient of 0.80 ± 0.10 times the nominal one (0.24 instead of 0.3) at each trial's start, "
            "falling by 30 ± 10 % per second,",
        ),
        # Without an interval it is the estimate that counts.
        (
            (1.0, NAN, NAN),
            (-0.3, NAN, NAN),
            "friction falls in the course of a trial",
            "a friction coefficient that falls from each trial's start by 30 % per second",
        ),
    ],
)
def test_a_drift_of_friction_is_told_where_it_is_off_zero(
    factor: tuple[float, float, float], drift: tuple[float, float, float], cause: str, amount: str
) -> None:
    numbers = {"factor": Interval(*factor), "drift_per_s": Interval(*drift)}
    phrase = phrase_of(EffectEstimate("friction_coefficient", 0.9, numbers, ()), lab())
    assert (phrase.cause, phrase.amount) == (cause, amount)


def test_an_effect_of_the_users_own_falls_back_to_its_docstring(tmp_path: Path, monkeypatch: Any) -> None:
    class OwnEffect:
        """Something <odd> drags on the coils.

        More words.
        """

        parameters = ()

    monkeypatch.setitem(CATALOGUE, "own_effect", OwnEffect)
    phrase = phrase_of(EffectEstimate("own_effect", 0.9, {"speed": Interval(2.0, 1.5, 2.5)}, ()), lab())
    assert phrase.cause == "something <odd> drags on the coils"
    assert phrase.amount == "own effect with speed = 2.0 ± 0.5"


@pytest.mark.parametrize(("along_x", "cause"), [((1.1, 1.3), "friction is not the same"), ((0.4, 2.5), "perhaps")])
def test_friction_is_told_to_depend_on_the_direction_where_the_intervals_say_so(
    along_x: tuple[float, float], cause: str
) -> None:
    numbers = {"e_t_factor": Interval(1.2, *along_x), "e_o_factor": Interval(0.74, 0.64, 0.76)}
    assert cause in phrase_of(EffectEstimate("friction_anisotropy", 0.7, numbers, ()), lab()).cause
