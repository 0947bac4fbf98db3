"""`PairSearch`: the pairs of effects that may be at work, and what may stand in either one's place.

A second effect is added to the best ones, and where the cause is strong, the best are joined two and two. Where that
leaves a gap, more of them are firsts, and what no scan shows is searched far away: effects of many parameters beside
the best one. At last, where the best pair would be named, either effect of it is exchanged, for one may be the answer
to another that is wrong, and what that brings is searched over its range too.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...progress import OnPhase
from ..fitting.fitter import Fitter
from ..fitting.hypothesis import Hypothesis
from ..gap.comparison import Comparison
from ..gap.predictive import is_right, is_wanting
from .beginnings import MANY, from_beginnings
from .contender import Contender, likeliest, likeliest_first, of_fit, parsimonious_total
from .own_noise import settled
from .pairs import Pairs, firsts
from .refined import refined, to_refine

__all__ = ["PairSearch", "is_enough", "kept"]

Floats = NDArray[np.float64]

# Effects to which a second is added: the farther ones only where the best leaves a gap, more only where all pairs do.
_FIRSTS, _MORE_FIRSTS = 2, 5
# Pairs whose beginnings are searched.
_REFINED = 2
# How often the best may change by an exchange.
_ROUNDS = 2


def is_enough(comparison: Comparison, contenders: Sequence[Contender]) -> bool:
    """Return whether the likeliest leaves no gap that is wanting, or has two effects and passes the predictive test.

    Parameters
    ----------
    comparison
        The dataset.
    contenders
        At least one.
    """
    best = likeliest(contenders)
    return not is_wanting(comparison, best.residual) or (len(best.names) > 1 and is_right(comparison, best.residual))


def kept(found: Sequence[Contender], before: Sequence[Contender]) -> list[Contender]:
    """Return what was found, the likeliest first, but what was settled before where that is likelier or the new is not.

    What looks better against another's noise must not take its place.

    Parameters
    ----------
    found
        What is new.
    before
        What was known.
    """
    known = {frozenset(contender.names): contender for contender in before if contender.settled}
    made = []
    for contender in found:
        old = known.get(frozenset(contender.names), contender)
        made.append(likeliest([contender, old]) if contender.settled else old)
    return likeliest_first(made)


@dataclass(frozen=True)
class PairSearch:
    """Searches pairs.

    Attributes
    ----------
    fitter
        Of the dataset.
    possible
        Every effect by itself.
    hints
        By names, points at which a threshold makes one trial right.
    worth
        What takes less off the objective is not worth another look.
    tell
        Is told the phase, how much of it is done, and of how much.
    seed
        Of the points over the ranges.
    """

    fitter: Fitter
    possible: Sequence[Hypothesis]
    hints: Mapping[tuple[str, ...], Sequence[Floats]]
    worth: float
    tell: OnPhase
    seed: int

    def found(self, singles: Sequence[Contender], strong: bool, known: Sequence[Contender] = ()) -> list[Contender]:
        """Return the pairs with the best effects, the likeliest first; none where no second shows.

        Parameters
        ----------
        singles
            Effects by themselves, the likeliest first.
        strong
            Whether the cause is: it has minima of its own, far away.
        known
            Pairs that were found before.
        """
        pairs = self._pairs(known)
        # A second effect shows beside the best one; beside the next best only where the best leaves a gap.
        wanting = strong and is_wanting(self.fitter.comparison, singles[0].residual)
        near = firsts(singles[: _FIRSTS if wanting else 1])
        self._add(pairs, near, singles)
        if strong:
            pairs.join(singles)
        made = pairs.likeliest_first()
        if not made or made[0].total > singles[0].total - self.worth:
            return made
        made = self._settled(made, known)
        # Where both are strong, either alone may be far from the best.
        if wanting and not self._is_enough(made):
            pairs = self._pairs(made)
            self._add(pairs, firsts(singles[:_MORE_FIRSTS])[len(near) :], singles)
            made = self._settled(pairs.likeliest_first(), made)
        searched: set[frozenset[str]] = set()
        # However little the best leaves: against a sharper noise another may leave as little.
        if strong:
            searched |= {frozenset(made[k].names) for k in to_refine(made, _REFINED)}
            made = self._settled(refined(self.fitter, made, _REFINED, self.possible, self.seed, self.tell), made)
        if wanting and not self._is_enough(made):
            many = [h for h in self.possible if h.free > MANY and h.names != singles[0].names]
            made = self._settled(self._with_many(made, singles[0], many, searched), made)
            searched |= {frozenset(singles[0].names + h.names) for h in many}
        if self.is_named(made[0], singles[0]):
            made = self.exchanged(made, singles)
            new = [pair for pair in made[:_REFINED] if frozenset(pair.names) not in searched]
            if strong and new:
                made = self._settled(self._far(made, new), made)
        return made

    def beside(self, first: Contender, singles: Sequence[Contender], known: Sequence[Contender]) -> list[Contender]:
        """Return known pairs and those with one first that are better, the likeliest first.

        Parameters
        ----------
        first
            One effect, where it was not before.
        singles
            Effects by themselves, the likeliest first.
        known
            Pairs that were found before.
        """
        pairs = self._pairs(known)
        self._add(pairs, [first], singles)
        return self._settled(pairs.likeliest_first(), known)

    def is_named(self, pair: Contender, single: Contender) -> bool:
        """Return whether a pair would be named beside one effect; else it is no answer.

        Parameters
        ----------
        pair, single
            Two effects, and one.
        """
        return parsimonious_total(pair, self.fitter.comparison) < single.total

    def exchanged(self, found: Sequence[Contender], singles: Sequence[Contender]) -> list[Contender]:
        """Exchange either effect of the best pair: one may be the answer to another that is wrong.

        Parameters
        ----------
        found
            Pairs, the likeliest first.
        singles
            Effects by themselves.
        """
        made, held = list(found), set[str]()
        for n in range(_ROUNDS):
            self.tell("exchanging one of the pair", n, _ROUNDS)
            best = made[0]
            assert best.fit is not None
            pairs = self._pairs(made)
            for kind, other in zip(best.fit.hypothesis.kinds, best.names[::-1], strict=True):
                if other not in held:
                    pairs.exchange(best, kind, singles)
                    held.add(other)
            made = self._settled(pairs.likeliest_first(), made)
            if made[0].names == best.names:
                break
        return made

    def _with_many(
        self,
        found: Sequence[Contender],
        first: Contender,
        many: Sequence[Hypothesis],
        searched: Collection[frozenset[str]],
    ) -> list[Contender]:
        """Search far away for effects of many parameters beside the best one: where such a one is strong, no scan does.

        Pairs whose names are among those that were searched so already stay as they are.
        """
        those = []
        assert first.fit is not None
        for other in many:
            names = frozenset(first.names + other.names)
            if names in searched:
                continue
            pair = next((pair for pair in found if names == frozenset(pair.names)), None)
            if pair is None:
                start = np.concatenate([first.point, np.zeros(len(other.neutral))])
                self.fitter.take_likeliest_noise(first.effects)
                pair = of_fit(self.fitter, self.fitter.fit(first.fit.hypothesis + other, start, evaluations=1))
            those.append(pair)
        return self._far(found, those)

    def _far(self, found: Sequence[Contender], those: Sequence[Contender]) -> list[Contender]:
        """Search for some of the pairs over their whole range."""
        made = [pair for pair in found if pair not in those]
        for n, pair in enumerate(those):
            self.tell("pairs over the whole range", n, len(those))
            made.append(from_beginnings(self.fitter, pair, self.possible, self.seed))
        return likeliest_first(made)

    def _add(self, pairs: Pairs, near: Sequence[Contender], singles: Sequence[Contender]) -> None:
        for n, first in enumerate(near):
            self.tell("fitting pairs", n, len(near))
            pairs.add(first, singles)

    def _pairs(self, known: Sequence[Contender]) -> Pairs:
        return Pairs(self.fitter, self.possible, self.hints, known)

    def _settled(self, found: Sequence[Contender], before: Sequence[Contender]) -> list[Contender]:
        return kept(settled(self.fitter, found, self.tell), before)

    def _is_enough(self, contenders: Sequence[Contender]) -> bool:
        return is_enough(self.fitter.comparison, contenders)
