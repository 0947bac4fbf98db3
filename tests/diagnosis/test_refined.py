"""What is fitted again from points over its whole range."""

from __future__ import annotations

import numpy as np
import pytest

from tumblers.diagnosis.fitting.fitter import Fitter
from tumblers.diagnosis.what.beginnings import MANY
from tumblers.diagnosis.what.contender import Contender, of_fit
from tumblers.diagnosis.what.refined import refined
from tumblers.diagnosis.what.search import Search
from tumblers.effects.size_error import SizeError
from tumblers.effects.surface_roughness import SurfaceRoughness

from .lab import coarse_lab, quiet


def test_of_many_parameters_the_best_is_searched_over_its_range_and_another_pair_from_where_it_is(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fitter = coarse_lab()
    search = Search(fitter, [SizeError, SurfaceRoughness], quiet, 0)
    size, rough = sorted(search.possible, key=lambda hypothesis: hypothesis.free)
    assert size.free <= MANY < rough.free
    few, many, pair = (
        of_fit(fitter, fitter.fit(h, np.zeros(len(h.neutral)), evaluations=1)) for h in (size, rough, size + rough)
    )
    sought: list[tuple[str, Contender]] = []

    def over_the_range(_fitter: Fitter, contender: Contender, *_: object) -> Contender:
        sought.append(("range", contender))
        return contender

    def from_where_it_is(_fitter: Fitter, contender: Contender) -> Contender:
        sought.append(("here", contender))
        return contender

    monkeypatch.setattr("tumblers.diagnosis.what.refined.from_beginnings", over_the_range)
    monkeypatch.setattr("tumblers.diagnosis.what.refined.from_its_own_beginning", from_where_it_is)
    for contenders, expected in (
        ([pair, few], [("range", pair), ("range", few)]),
        ([few, pair], [("range", few), ("here", pair)]),
        ([few, many, pair], [("range", few)]),
    ):
        sought.clear()
        refined(fitter, contenders, 2, search.possible, 0, quiet)
        assert sought == expected
