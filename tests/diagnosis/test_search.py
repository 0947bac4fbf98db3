"""How a search goes on in the right steps, and where the nominal model is right."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import pytest

from tumblers.diagnosis.fitting.fitter import Fitter
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.simulator import LONGEST_STEP_S, Simulator
from tumblers.diagnosis.what.contender import Contender, of_nominal
from tumblers.diagnosis.what.margins import NEAR
from tumblers.diagnosis.what.own_noise import OWN, beside
from tumblers.diagnosis.what.pair_search import PairSearch
from tumblers.diagnosis.what.pairs import Pairs
from tumblers.diagnosis.what.search import Search
from tumblers.effects.catalogue import CATALOGUE
from tumblers.effects.magnetization_strength import MagnetizationStrength
from tumblers.effects.size_error import SizeError

from .lab import PLANS, coarse_lab, measure, plan, quiet

MANY_KINDS = (
    "size_error",
    "magnetization_misalignment",
    "magnetization_strength",
    "friction_coefficient",
    "substrate_tilt",
    "viscous_drag",
)


def test_what_longer_steps_found_counts_by_what_it_is_in_the_right_ones(monkeypatch: pytest.MonkeyPatch) -> None:
    fitter = coarse_lab(SizeError(length_factor=1.1))
    comparison = fitter.comparison
    comparison.simulator.step_s = [0.5 * LONGEST_STEP_S] * 3
    comparison._start()
    search = Search(fitter, [CATALOGUE[name] for name in MANY_KINDS], quiet, 0)
    flattered: list[Contender] = []

    def found(nominal: Contender) -> list[Contender]:
        assert comparison.simulator.step_s == [LONGEST_STEP_S] * 3
        first, *others = search._singles(nominal)
        assert first.names == ("size_error",)
        # The last one's objective is what no error of a step could make it.
        flattered.append(replace(others[-1], cost=-1e9))
        return [*flattered, first, *others[:-1]]

    monkeypatch.setattr(search, "_far_and_wide", found)
    made = search.contenders()
    assert max(comparison.simulator.step_s) <= 0.5 * LONGEST_STEP_S
    assert len(made) == 1 + len(search.possible)
    best = min(made, key=lambda contender: contender.total)
    assert best.names == ("size_error",)
    assert best.settled
    assert best.total == pytest.approx(beside(fitter, best, best).total, rel=1e-9)
    (again,) = (contender for contender in made if contender.names == flattered[0].names)
    assert again.total > best.total + comparison.objective_of(NEAR)


@pytest.mark.parametrize(("named", "first", "exchanged"), [(True, 1, 1), (True, 0, 0), (False, 1, 0)])
def test_either_of_a_pair_that_only_the_right_steps_put_first_is_exchanged(
    named: bool, first: int, exchanged: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    fitter = coarse_lab(SizeError(length_factor=1.1), MagnetizationStrength(factor=0.7))
    search = Search(fitter, [CATALOGUE[name] for name in MANY_KINDS[:3]], quiet, 0)
    fitter.take_likeliest_noise(())
    singles = search._singles(of_nominal(fitter))
    pairs = Pairs(fitter, search.possible, {})
    pairs.add(singles[0], singles)
    ranked = pairs.likeliest_first()
    assert len(ranked) == 2
    # What the longer steps put first, before what leads in the right ones.
    found = [ranked[first], *(pair for pair in ranked if pair is not ranked[first]), *singles]
    called: list[tuple[Sequence[Contender], Sequence[Contender]]] = []

    def spied(_: PairSearch, pairs: Sequence[Contender], singles: Sequence[Contender]) -> list[Contender]:
        called.append((pairs, singles))
        return list(pairs)

    monkeypatch.setattr(PairSearch, "exchanged", spied)
    monkeypatch.setattr(PairSearch, "is_named", lambda *_: named)
    # However much one effect leaves.
    monkeypatch.setattr("tumblers.diagnosis.what.search.is_wanting", lambda *_: True)
    made = search._in_short_steps(found)
    assert made[0].names == ranked[0].names
    assert {contender.names for contender in made} == {contender.names for contender in found}
    assert len(made) == len(found)
    assert len(called) == exchanged
    for those, alone in called:
        assert those[0].names == ranked[0].names
        assert len(those) == 2
        assert {len(contender.names) for contender in alone} == {1}


def test_where_the_nominal_model_is_right_too_what_leads_is_held_against_its_own_noise() -> None:
    dataset = measure(plan(PLANS[:3]), seed=3)
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    nominal, *others = Search(fitter, [CATALOGUE[name] for name in MANY_KINDS], quiet, 0).contenders()
    assert not nominal.names
    held = [contender for contender in others if contender.settled]
    assert len(held) >= OWN
    assert held[0].total == pytest.approx(beside(fitter, held[0], held[0]).total, rel=1e-9)


@pytest.mark.parametrize(
    ("right", "worth", "finer", "searched"),
    [(True, True, 0.5, 1), (False, False, 0.5, 2), (False, True, 0.5, 1), (False, False, 1.0, 1)],
)
def test_where_longer_steps_hide_the_gap_the_right_ones_are_searched(
    right: bool, worth: bool, finer: float, searched: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    fitter = coarse_lab(SizeError(length_factor=1.1))
    comparison = fitter.comparison
    comparison.simulator.step_s = [finer * LONGEST_STEP_S] * 3
    comparison._start()
    search = Search(fitter, [CATALOGUE[name] for name in MANY_KINDS[:2]], quiet, 0)
    steps: list[float] = []

    def longer() -> bool:
        return max(comparison.simulator.step_s) > 0.5 * LONGEST_STEP_S

    def found(nominal: Contender) -> list[Contender]:
        steps.append(max(comparison.simulator.step_s))
        first, *others = search._singles(nominal)
        assert first.names == ("size_error",)
        # No likelier than the nominal model is what longer steps leave of it.
        return [first if worth or not longer() else replace(first, cost=nominal.total), *others]

    monkeypatch.setattr(search, "_far_and_wide", found)
    monkeypatch.setattr("tumblers.diagnosis.what.search.is_right", lambda *_: right and longer())
    assert search.contenders()[0].names == ("size_error",)
    assert len(steps) == searched
    # Where they do not, all of it is done in the longer ones, which are the quicker; and where none are longer, too.
    assert steps[-1] == (LONGEST_STEP_S if searched == 1 and not right else 0.5 * LONGEST_STEP_S)
    assert max(comparison.simulator.step_s) <= finer * LONGEST_STEP_S
