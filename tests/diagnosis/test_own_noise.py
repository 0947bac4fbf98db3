"""What is held against its own noise, and what is fitted on."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from tumblers.diagnosis import own_noise
from tumblers.diagnosis.contender import Contender
from tumblers.diagnosis.own_noise import settled

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

    def fit_on(_fitter: Any, made: Contender) -> Contender:
        fitted.append(made.names[0])
        return replace(made, cost=OWN[made.names[0]], settled=True)

    def hold(_fitter: Any, fit: Any) -> Contender:
        held.append(fit)
        return contender(fit, OWN[fit])

    monkeypatch.setattr(own_noise, "_settled", fit_on)
    monkeypatch.setattr(own_noise, "against_itself", hold)
    made = settled(nothing, [contender(*each) for each in LENT.items()], lambda *_: None, fitted=before)
    assert ("".join(fitted), "".join(held)) == expected
    assert made[0].names == ("e",)
    assert made[0].settled
