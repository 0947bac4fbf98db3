"""The search for pairs: whose second effects are sought, what is searched far away, and what is kept."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from tumblers.diagnosis.fitting.fitter import Fitter
from tumblers.diagnosis.fitting.hypothesis import Hypothesis
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.what.beginnings import MANY
from tumblers.diagnosis.what.contender import Contender, of_fit, of_nominal
from tumblers.diagnosis.what.margins import SECOND
from tumblers.diagnosis.what.pair_search import PairSearch, kept
from tumblers.diagnosis.what.pairs import Pairs
from tumblers.diagnosis.what.search import Search
from tumblers.effects.camera_calibration import CameraCalibration
from tumblers.effects.friction_coefficient import FrictionCoefficient
from tumblers.effects.magnetization_misalignment import MagnetizationMisalignment
from tumblers.effects.magnetization_strength import MagnetizationStrength
from tumblers.effects.size_error import SizeError
from tumblers.effects.substrate_tilt import SubstrateTilt
from tumblers.effects.surface_roughness import SurfaceRoughness
from tumblers.effects.viscous_drag import ViscousDrag

from .lab import PLANS, coarse_lab, measure, plan, quiet

KINDS = (
    SizeError,
    MagnetizationMisalignment,
    MagnetizationStrength,
    FrictionCoefficient,
    SubstrateTilt,
    ViscousDrag,
)


@pytest.fixture(scope="module")
def search() -> Search:
    """A search over two effects of few parameters and two of many."""
    kinds = [SizeError, MagnetizationStrength, SurfaceRoughness, CameraCalibration]
    return Search(coarse_lab(SizeError(length_factor=1.1)), kinds, quiet, 0)


def held(fitter: Fitter, hypothesis: Hypothesis, cost: float) -> Contender:
    """Return a contender beside neutral, as if it had been settled with some objective."""
    fit = fitter.fit(hypothesis, np.full(len(hypothesis.neutral), 0.01), evaluations=1)
    return replace(of_fit(fitter, fit), cost=cost, log_determinant=0.0, step_credit=0.0, settled=True)


def as_they_are(_fitter: Fitter, contenders: Sequence[Contender], *_: object) -> list[Contender]:
    """Settle nothing."""
    return list(contenders)


def search_nothing(monkeypatch: pytest.MonkeyPatch, wanting: bool, enough: bool) -> None:
    """Leave pairs as they are, whatever a search would do with them, in a gap that is left or not."""
    monkeypatch.setattr("tumblers.diagnosis.what.pair_search.settled", as_they_are)
    monkeypatch.setattr("tumblers.diagnosis.what.pair_search.refined", as_they_are)
    monkeypatch.setattr("tumblers.diagnosis.what.pair_search.is_wanting", lambda *_: wanting)
    monkeypatch.setattr("tumblers.diagnosis.what.pair_search.is_enough", lambda *_: enough)
    monkeypatch.setattr(Pairs, "add", lambda *_: None)


def test_what_was_settled_does_not_give_way_to_what_was_not() -> None:
    fitter = coarse_lab(SizeError(length_factor=1.1))
    fitter.take_likeliest_noise(())
    made = of_nominal(fitter)
    old, new, better = replace(made, settled=True), replace(made, cost=-9.0), replace(made, cost=-9.0, settled=True)
    for contender, expected in ((new, old), (better, better)):
        assert kept([contender], [old]) == [expected]
    assert kept([new], [replace(old, settled=False)]) == [new]


@pytest.mark.parametrize("enough", [False, True])
def test_more_firsts_are_tried_where_every_pair_leaves_a_gap(enough: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    truth = (SizeError(length_factor=1.2), MagnetizationStrength(factor=0.7))
    dataset = measure(plan(PLANS[:1]), truth)
    search = Search(Fitter(Comparison(dataset, Simulator(dataset))), KINDS, quiet, 0)
    search.fitter.take_likeliest_noise(())
    nominal = of_nominal(search.fitter)
    # All as near to the best as a first has to be.
    singles = [replace(single, cost=nominal.cost) for single in search._singles(nominal)]
    tried: list[Contender] = []
    add = Pairs.add

    def spied(pairs: Pairs, first: Contender, others: Sequence[Contender]) -> None:
        tried.append(first)
        # One pair is enough to go on with.
        if len(tried) == 1:
            add(pairs, first, others)

    monkeypatch.setattr(Pairs, "add", spied)
    monkeypatch.setattr("tumblers.diagnosis.what.pair_search.is_enough", lambda *_: enough)
    monkeypatch.setattr("tumblers.diagnosis.what.pair_search.is_wanting", lambda *_: True)
    assert search.pairing.found(singles, strong=True)
    # What is exchanged later is another contender of the same name.
    assert [any(first is single for first in tried) for single in singles] == [True, True, *(3 * [not enough]), False]


def test_of_many_parameters_what_was_not_searched_is_searched_far_away_beside_the_best(
    search: Search, monkeypatch: pytest.MonkeyPatch
) -> None:
    fitter = search.fitter
    size, strength, rough, camera = search.possible
    assert [h.free > MANY for h in search.possible] == [False, False, True, True]
    first = held(fitter, size, 900.0)
    best, second, third = (
        held(fitter, h, cost) for h, cost in ((size + rough, 500.0), (size + strength, 600.0), (size + camera, 700.0))
    )
    sought: list[Contender] = []

    def far(_fitter: Fitter, contender: Contender, *_: object) -> Contender:
        sought.append(contender)
        return replace(contender, cost=100.0)

    monkeypatch.setattr("tumblers.diagnosis.what.pair_search.from_beginnings", far)
    # What is known is searched from where it is, wherever it stands.
    for found in ([best, second, third], [best, third, second]):
        sought.clear()
        made = search.pairing._with_many(found, first, [rough, camera], {frozenset(best.names)})
        assert sought == [third]
        assert [pair.names for pair in made] == [third.names, best.names, second.names]
    # What nobody fitted is searched from the best effect, with neutral beside it.
    sought.clear()
    made = search.pairing._with_many([best, second], first, [rough, camera], {frozenset(best.names)})
    (new,) = sought
    assert new.names == third.names
    np.testing.assert_allclose(new.point, [*first.point, *np.zeros(len(camera.neutral))], atol=1e-6)
    assert [pair.names for pair in made] == [third.names, best.names, second.names]


@pytest.mark.parametrize("strong", [True, False])
def test_a_pair_that_only_the_exchange_brings_is_searched_over_its_range_too(
    strong: bool, search: Search, monkeypatch: pytest.MonkeyPatch
) -> None:
    fitter = search.fitter
    size, strength, rough, camera = search.possible
    singles = [held(fitter, size, 1e6), held(fitter, strength, 2e6)]
    # The second of these has many parameters: it was searched from where it is alone.
    known = [held(fitter, h, cost) for h, cost in ((size + strength, 500.0), (size + rough, 600.0))]
    new = held(fitter, strength + camera, 400.0)
    exchanged: list[Contender] = []
    refined: list[Contender] = []
    sought: list[Contender] = []

    def refining(_fitter: Fitter, contenders: Sequence[Contender], count: int, *_: object) -> list[Contender]:
        refined.extend(contenders[:count])
        return list(contenders)

    def far(_fitter: Fitter, contender: Contender, *_: object) -> Contender:
        sought.append(contender)
        return contender

    monkeypatch.setattr("tumblers.diagnosis.what.pair_search.settled", as_they_are)
    monkeypatch.setattr("tumblers.diagnosis.what.pair_search.refined", refining)
    monkeypatch.setattr("tumblers.diagnosis.what.pair_search.from_beginnings", far)
    monkeypatch.setattr("tumblers.diagnosis.what.pair_search.is_wanting", lambda *_: False)
    monkeypatch.setattr(Pairs, "add", lambda *_: None)
    monkeypatch.setattr(Pairs, "join", lambda *_: None)
    monkeypatch.setattr(PairSearch, "exchanged", lambda *_: exchanged)
    for exchanged, expected in (
        ([new, *known], [new]),
        ([known[0], new, known[1]], [new]),
        (known, [known[1]]),
        ([new, known[1], known[0]], [new, known[1]]),
    ):
        refined.clear()
        sought.clear()
        made = search.pairing.found(singles, strong=strong, known=known)
        assert {pair.names for pair in made} == {pair.names for pair in exchanged}
        assert refined == (known if strong else [])
        assert sought == (expected if strong else [])


@pytest.mark.parametrize(("ln", "exchanged"), [(SECOND + 1.0, True), (SECOND - 1.0, False)])
@pytest.mark.parametrize("wanting", [True, False])
def test_what_would_not_be_named_is_not_exchanged(
    ln: float, exchanged: bool, wanting: bool, search: Search, monkeypatch: pytest.MonkeyPatch
) -> None:
    fitter = search.fitter
    size, strength, *_ = search.possible
    single = held(fitter, size, 1e4)
    pair = held(fitter, size + strength, 1e4 - fitter.comparison.objective_of(ln))
    seen: list[Contender] = []
    search_nothing(monkeypatch, wanting, enough=False)
    monkeypatch.setattr(Pairs, "join", lambda *_: None)
    monkeypatch.setattr(PairSearch, "_with_many", lambda _, found, *__: list(found))
    monkeypatch.setattr(PairSearch, "exchanged", lambda _, found, __: seen.extend(found) or list(found))
    search.pairing.found([single], strong=True, known=[pair])
    assert seen == ([pair] if exchanged else [])


@pytest.mark.parametrize("strong", [True, False])
@pytest.mark.parametrize("wanting", [True, False])
@pytest.mark.parametrize("enough", [True, False])
def test_where_a_cause_is_strong_the_best_are_joined_and_where_pairs_leave_a_gap_many_parameters_are_searched(
    strong: bool, wanting: bool, enough: bool, search: Search, monkeypatch: pytest.MonkeyPatch
) -> None:
    fitter = search.fitter
    size, strength, *many = search.possible
    singles = [held(fitter, size, 1e6), held(fitter, strength, 2e6)]
    known = [held(fitter, size + strength, 500.0)]
    joined: list[Sequence[Contender]] = []
    searched: list[Sequence[Hypothesis]] = []

    def with_many(
        _: PairSearch, found: Sequence[Contender], first: Contender, those: Sequence[Hypothesis], __: object
    ) -> list[Contender]:
        assert first is singles[0]
        searched.append(those)
        return list(found)

    search_nothing(monkeypatch, wanting, enough)
    monkeypatch.setattr(Pairs, "join", lambda _, those: joined.append(those))
    monkeypatch.setattr(PairSearch, "exchanged", lambda _, found, __: list(found))
    monkeypatch.setattr(PairSearch, "_with_many", with_many)
    search.pairing.found(singles, strong=strong, known=known)
    assert joined == ([singles] if strong else [])
    assert searched == ([many] if strong and wanting and not enough else [])


def test_what_is_far_away_and_in_the_best_pair_is_one_first_more_beside_what_is_known(
    search: Search, monkeypatch: pytest.MonkeyPatch
) -> None:
    fitter = search.fitter
    size, strength, rough, _ = search.possible
    first, other = held(fitter, size, 900.0), held(fitter, strength, 1000.0)
    known = [held(fitter, size + strength, 500.0)]
    new = held(fitter, size + rough, 400.0)
    firsts: list[Contender] = []

    def adding(pairs: Pairs, those: Contender, others: Sequence[Contender]) -> None:
        assert list(others) == [first, other]
        firsts.append(those)
        pairs._found[frozenset(new.names)] = new

    def far(*_: object) -> Contender:
        raise AssertionError("the whole search for pairs")

    monkeypatch.setattr("tumblers.diagnosis.what.pair_search.settled", as_they_are)
    monkeypatch.setattr("tumblers.diagnosis.what.pair_search.from_beginnings", far)
    monkeypatch.setattr(PairSearch, "exchanged", far)
    monkeypatch.setattr(Pairs, "join", far)
    monkeypatch.setattr(Pairs, "add", adding)
    assert search.pairing.beside(first, [first, other], known) == [new, *known]
    assert firsts == [first]


@pytest.mark.parametrize(
    ("paired", "likelier", "again"),
    [(True, True, "beside"), (True, False, "found"), (False, True, "found")],
)
def test_pairs_are_searched_again_as_a_whole_unless_what_is_far_away_is_in_a_pair_that_is_likelier(
    paired: bool, likelier: bool, again: str, search: Search, monkeypatch: pytest.MonkeyPatch
) -> None:
    fitter = search.fitter
    size, strength, rough, camera = search.possible
    near, far = held(fitter, size, 2e6), held(fitter, strength, 1e6)
    pair = held(fitter, (strength if paired else rough) + camera, 5e5 if likelier else 1.5e6)
    nominal = replace(near, cost=1e7)
    called: list[tuple[str, Sequence[Contender]]] = []

    def found(
        _: PairSearch, singles: Sequence[Contender], *, strong: bool, known: Sequence[Contender] = ()
    ) -> list[Contender]:
        assert strong
        called.append(("found", known))
        return [pair]

    def beside(
        _: PairSearch, first: Contender, singles: Sequence[Contender], known: Sequence[Contender]
    ) -> list[Contender]:
        assert first is far
        called.append(("beside", known))
        return list(known)

    monkeypatch.setattr("tumblers.diagnosis.what.search.settled", as_they_are)
    monkeypatch.setattr("tumblers.diagnosis.what.search.all_shaken", as_they_are)
    monkeypatch.setattr("tumblers.diagnosis.what.search.with_counterparts", as_they_are)
    monkeypatch.setattr("tumblers.diagnosis.what.search.resolved", lambda _, model, those, __: (model, those))
    monkeypatch.setattr("tumblers.diagnosis.what.search.is_wanting", lambda *_: True)
    monkeypatch.setattr("tumblers.diagnosis.what.search.is_enough", lambda *_: False)
    monkeypatch.setattr(search, "_singles", lambda _: [near, replace(far, cost=3e6)])
    monkeypatch.setattr(search, "_refined", list)
    monkeypatch.setattr(search, "_far", lambda *_: [far, near])
    monkeypatch.setattr(search, "_with_moved", lambda singles, pairs: (list(singles), list(pairs)))
    monkeypatch.setattr(search, "_with_shaken_pair", lambda singles, pairs: [*singles, *pairs])
    monkeypatch.setattr(PairSearch, "found", found)
    monkeypatch.setattr(PairSearch, "beside", beside)
    made = search._far_and_wide(nominal)
    assert called == [("found", ()), (again, [pair])]
    assert {contender.names for contender in made} == {near.names, far.names, pair.names}


@pytest.mark.parametrize(
    ("gained", "behind", "again"),
    [
        # Much likelier where the pair has it, and the best or near it.
        (6e5, 0.0, True),
        (6e5, 1e5, True),
        # By less than a tenth of what it leaves; or far behind the best even there.
        (3e4, 0.0, False),
        (6e5, 1e7, False),
    ],
)
def test_seconds_are_added_to_an_effect_that_the_best_pair_has_moved_to_where_it_is_far_better(
    gained: float, behind: float, again: bool, search: Search, monkeypatch: pytest.MonkeyPatch
) -> None:
    fitter = search.fitter
    size, strength, rough, camera = search.possible
    least = 1e6
    alone = held(fitter, strength, behind + least + gained)
    # Flattered by the noise around another.
    flattered = replace(alone, cost=0.5 * (behind + least), settled=False)
    moved = held(fitter, strength, behind + least)
    best, idle = held(fitter, size, least), held(fitter, camera, 1e9)
    pairs = [held(fitter, strength + rough, 5e5), held(fitter, size + rough, 6e5)]
    called: list[tuple[Contender, Sequence[Contender], Sequence[Contender]]] = []

    def nested(_: Fitter, single: Contender, those: Sequence[Contender]) -> Contender:
        assert list(those) == pairs[:1]
        assert single is alone
        return moved

    def beside(
        _: PairSearch, first: Contender, singles: Sequence[Contender], known: Sequence[Contender]
    ) -> list[Contender]:
        called.append((first, singles, known))
        return list(reversed(known))

    def by_itself(_: Fitter, single: Contender, *, evaluations: int) -> Contender:
        assert (single, evaluations) == (flattered, 1)
        return alone

    monkeypatch.setattr("tumblers.diagnosis.what.search.nested", nested)
    monkeypatch.setattr("tumblers.diagnosis.what.search.by_itself", by_itself)
    monkeypatch.setattr(PairSearch, "beside", beside)
    assert search._with_moved([best, alone, idle], pairs)[1] == (pairs[::-1] if again else pairs)
    called.clear()
    singles, found = search._with_moved([best, flattered, idle], pairs)
    assert set(singles) == {moved, best, idle}
    assert singles == sorted(singles, key=lambda single: single.total)
    assert found == (pairs[::-1] if again else pairs)
    assert called == ([(moved, singles, pairs)] if again else [])
    assert search._with_moved([best, alone], []) == ([best, alone], [])
