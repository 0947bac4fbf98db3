"""`Pairs`: two effects at work together, each pair at the best that was found.

A second effect is added to a first, against the noise around that; or two are joined, each from its own best.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ...effects.base import Effect
from ..fitting.fitter import Fitter
from ..fitting.hypothesis import Hypothesis
from .contender import Contender, likeliest, likeliest_first, of_fit
from .least import least
from .margins import AS_GOOD, CLEAR
from .own_noise import POLISH_POINTS, by_itself
from .step_credit import step_credit

__all__ = ["Pairs", "firsts", "nested"]

Floats = NDArray[np.float64]

# A first leaves no more than so much of the best one's objective beyond it.
_NEAR_BEST = 0.5
# Seconds that are fitted with each first; singles that are joined two and two, joints that are fitted, and shares of
# what each is by itself: of two that do much the same either alone does what both do, and is about twice too much. With
# as many a pair was found in a dataset with a known truth in which it had not been.
_SECONDS, _JOINED, _JOINTS = 3, 8, 4
_HALVES = ((1.0, 1.0), (1.0, 0.5), (0.5, 1.0), (0.5, 0.5))
# Shares of the way to either end of a range that are tried of what may stand in another's place.
_GRID = (0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 1.0)
# Trial points of a fit.
_POINTS = 4


class Pairs:
    """Pairs of effects that were fitted.

    Parameters
    ----------
    fitter
        Of the dataset.
    possible
        Every effect by itself.
    hints
        By names, points at which a threshold makes one trial right.
    found
        Pairs that were fitted before.
    """

    def __init__(
        self,
        fitter: Fitter,
        possible: Sequence[Hypothesis],
        hints: Mapping[tuple[str, ...], Sequence[Floats]],
        found: Sequence[Contender] = (),
    ) -> None:
        self.fitter, self.possible, self.hints = fitter, possible, hints
        self._found = {frozenset(pair.names): pair for pair in found}

    def likeliest_first(self) -> list[Contender]:
        """Return the best of every pair, the likeliest first."""
        return likeliest_first(self._found.values())

    def add(self, first: Contender, singles: Sequence[Contender]) -> None:
        """Fit the seconds that promise most beside a first, against its noise.

        Parameters
        ----------
        first
            One effect.
        singles
            Those that may be the second, by themselves.
        """
        if not first.settled:
            # Its differences and derivatives are against another noise.
            first = by_itself(self.fitter, first, evaluations=1)
        assert first.fit is not None
        self.fitter.take_likeliest_noise(first.effects)
        others = [other for other in self._seconds(singles) if other.names != first.names]
        joined = [first.fit.hypothesis + other for other in others]
        bases = [np.concatenate([first.point, np.zeros(len(other.neutral))]) for other in others]
        scans = self.fitter.scan(joined, bases, first.residual, first.fit.jacobian)
        costs = [
            points[0][0] + step_credit(self.fitter, h.effects(points[0][1]))
            for h, points in zip(joined, scans, strict=True)
        ]
        clear = self.fitter.comparison.objective_of(CLEAR)
        for k in np.argsort(costs, kind="stable")[:_SECONDS]:
            if costs[k] < first.cost + first.step_credit - clear:
                self._keep(joined[k], scans[k][0][1])

    def exchange(self, pair: Contender, kind: type[Effect], singles: Sequence[Contender]) -> None:
        """Fit what may stand in the place of one effect of a pair, against the pair's noise.

        The other is held where it is: by itself it would move to where it makes up for what is missing, and there
        another second looks best.

        Parameters
        ----------
        pair
            Two effects.
        kind
            The one of them that is exchanged.
        singles
            Those that may take its place, by themselves.
        """
        assert pair.fit is not None
        kept = next(h for h in self.possible if h.names[0] in pair.names and h.kinds != (kind,))
        point = pair.point[[name == kept.names[0] for name, _ in pair.fit.hypothesis.keys]]
        self.fitter.take_likeliest_noise(pair.effects)
        still, whole = self.fitter.residuals(kept, [point])[0], self.fitter.again(pair.fit)
        limit = whole.cost + AS_GOOD * max(self.fitter.cost(still, point) - whole.cost, 0.0)
        tried: list[tuple[float, int, Hypothesis, Floats]] = []
        for other in self._seconds(singles):
            if other.names[0] in pair.names:
                continue
            both = kept + other
            points = [np.concatenate([point, start]) for start in [*other.starts, *_lines(other)]]
            for cost, start in least(self.fitter, both, points, 1, limit=limit, shown=[still, whole.residual]):
                tried.append((cost + step_credit(self.fitter, both.effects(start)), len(tried), both, start))
        for _, _, both, start in sorted(tried, key=lambda entry: entry[:2])[:_SECONDS]:
            self._keep(both, start)

    def join(self, singles: Sequence[Contender]) -> None:
        """Fit the best of the best singles two and two, from all and from halves of what either is alone.

        Against the noise around the best one.

        Parameters
        ----------
        singles
            Effects by themselves, the best first.
        """
        self.fitter.take_likeliest_noise(singles[0].effects)
        tried: list[tuple[float, int, Hypothesis, Floats]] = []
        for first, second in combinations(singles[:_JOINED], 2):
            assert first.fit is not None
            assert second.fit is not None
            both = first.fit.hypothesis + second.fit.hypothesis
            points = [np.concatenate([_share(first, a), _share(second, b)]) for a, b in _HALVES]
            for point, residual in zip(points, self.fitter.residuals(both, points), strict=True):
                tried.append((self.fitter.cost(residual, point), len(tried), both, point))
        tried.sort(key=lambda entry: entry[:2])
        fitted: set[tuple[str, ...]] = set()
        for _, _, both, point in tried:
            if both.names not in fitted and len(fitted) < _JOINTS:
                fitted.add(both.names)
                self._keep(both, point)

    def _seconds(self, singles: Sequence[Contender]) -> list[Hypothesis]:
        """Return the effects of some singles; what each is by itself is one more start."""
        alone = {single.names: single.point for single in singles}
        return [
            replace(h, starts=np.vstack([h.starts, alone[h.names], *self.hints.get(h.names, ())]))
            for h in self.possible
            if h.names in alone
        ]

    def _keep(self, hypothesis: Hypothesis, start: Floats) -> None:
        """Fit a pair, and keep it where it is better than what is known of it, both against the noise of the moment."""
        contender = of_fit(self.fitter, self.fitter.fit(hypothesis, start, evaluations=_POINTS))
        known = self._found.get(frozenset(hypothesis.names))
        if known is None or known.fit is None or contender.cost < self.fitter.again(known.fit).cost:
            self._found[frozenset(hypothesis.names)] = contender


def _share(single: Contender, share: float) -> Floats:
    assert single.fit is not None
    return single.fit.hypothesis.weakened(single.point, share)


def _lines(other: Hypothesis) -> list[Floats]:
    """Return points over the range of an effect of one strength, and over that of its form by itself."""
    if other.strengths != 1:
        return []
    return [share * end for end in other.ends for share in _GRID]


def firsts(singles: Sequence[Contender]) -> list[Contender]:
    """Return those of the best, best first, that are near enough to be a first of a pair."""
    # A total may be negative, for a determinant may be small; what the best leaves never is.
    near = singles[0].total + _NEAR_BEST * singles[0].cost
    return [contender for contender in singles if contender.total <= near]


def nested(fitter: Fitter, single: Contender, pairs: Iterable[Contender]) -> Contender:
    """Fit an effect again from where it is in the best of some pairs: alone it must not have been fitted less far.

    Parameters
    ----------
    fitter
        Of the dataset.
    single
        One effect; it stays as it is where no pair has it that is clearly better.
    pairs
        Two effects each.
    """
    least = single.total - fitter.comparison.objective_of(CLEAR)
    better = [p for p in pairs if single.names[0] in p.names and p.total <= least]
    if not better:
        return single
    pair = likeliest(better)
    assert single.fit is not None
    assert pair.fit is not None
    hypothesis = single.fit.hypothesis
    start = pair.point[[name == single.names[0] for name, _ in pair.fit.hypothesis.keys]]
    fitter.take_likeliest_noise(hypothesis.effects(start))
    fit = fitter.fit(hypothesis, start, evaluations=POLISH_POINTS)
    return likeliest([single, by_itself(fitter, of_fit(fitter, fit), evaluations=1)])
