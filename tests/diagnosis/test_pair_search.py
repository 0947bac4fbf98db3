"""The search for pairs: what is searched far away, and what is not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from tumblers.diagnosis.beginnings import MANY
from tumblers.diagnosis.contender import Contender, of_fit
from tumblers.diagnosis.fitter import Fitter
from tumblers.diagnosis.hypothesis import Hypothesis
from tumblers.diagnosis.pair_search import PairSearch
from tumblers.diagnosis.search import Search
from tumblers.effects.camera_calibration import CameraCalibration
from tumblers.effects.magnetization_strength import MagnetizationStrength
from tumblers.effects.size_error import SizeError
from tumblers.effects.surface_roughness import SurfaceRoughness

from .lab import coarse_lab, quiet


@pytest.fixture(scope="module")
def search() -> Search:
    """A search over two effects of few parameters and two of many."""
    kinds = [SizeError, MagnetizationStrength, SurfaceRoughness, CameraCalibration]
    return Search(coarse_lab(SizeError(length_factor=1.1)), kinds, quiet, 0)


def idle(fitter: Fitter, hypothesis: Hypothesis, cost: float) -> Contender:
    """Return a contender at neutral, as if it had been settled with some objective."""
    made = of_fit(fitter, fitter.fit(hypothesis, np.zeros(len(hypothesis.neutral)), evaluations=1))
    return replace(made, cost=cost, settled=True)


def as_they_are(_fitter: Fitter, contenders: Sequence[Contender], *_: object) -> list[Contender]:
    """Settle nothing."""
    return list(contenders)


def test_of_many_parameters_what_is_not_among_the_best_pairs_is_searched_far_away_beside_the_best(
    search: Search, monkeypatch: pytest.MonkeyPatch
) -> None:
    fitter = search.fitter
    size, strength, rough, camera = search.possible
    assert [h.free > MANY for h in search.possible] == [False, False, True, True]
    first = idle(fitter, size, 900.0)
    best, second, third = (
        idle(fitter, h, cost) for h, cost in ((size + rough, 500.0), (size + strength, 600.0), (size + camera, 700.0))
    )
    sought: list[Contender] = []

    def far(_fitter: Fitter, contender: Contender, *_: object) -> Contender:
        sought.append(contender)
        return replace(contender, cost=100.0)

    monkeypatch.setattr("tumblers.diagnosis.pair_search.from_beginnings", far)
    pairing = search.pairing
    # What is known is searched from where it is, what nobody fitted from the best effect with neutral beside it.
    made = pairing._with_many([best, second, third], first)
    assert sought == [third]
    assert [pair.names for pair in made] == [third.names, best.names, second.names]
    sought.clear()
    made = pairing._with_many([best, second], first)
    assert [pair.names for pair in sought] == [third.names]
    assert [pair.names for pair in made] == [third.names, best.names, second.names]
    sought.clear()
    assert pairing._with_many([best, third, second], first) == [best, second, third]
    assert not sought


@pytest.mark.parametrize("strong", [True, False])
def test_a_pair_that_only_the_exchange_brings_is_searched_over_its_range_too(
    strong: bool, search: Search, monkeypatch: pytest.MonkeyPatch
) -> None:
    fitter = search.fitter
    size, strength, rough, camera = search.possible
    singles = [idle(fitter, size, 1e6), idle(fitter, strength, 2e6)]
    known = [idle(fitter, h, cost) for h, cost in ((size + strength, 500.0), (size + rough, 600.0))]
    new = idle(fitter, strength + camera, 400.0)
    sought: list[list[Contender]] = []

    def refined(_fitter: Fitter, contenders: Sequence[Contender], count: int, *_: object) -> list[Contender]:
        sought.append(list(contenders[:count]))
        return list(contenders)

    monkeypatch.setattr("tumblers.diagnosis.pair_search.settled", as_they_are)
    monkeypatch.setattr("tumblers.diagnosis.pair_search.refined", refined)
    monkeypatch.setattr("tumblers.diagnosis.pair_search.is_wanting", lambda *_: False)
    monkeypatch.setattr("tumblers.diagnosis.pairs.Pairs.add", lambda *_: None)
    monkeypatch.setattr("tumblers.diagnosis.pairs.Pairs.join", lambda *_: None)
    monkeypatch.setattr(PairSearch, "exchanged", lambda *_: [new, *known])
    made = search.pairing.found(singles, strong=strong, known=known)
    assert [pair.names for pair in made] == [pair.names for pair in (new, *known)]
    assert sought == ([known, [new]] if strong else [])
