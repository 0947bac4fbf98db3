"""`Pairs`: two effects at work together, each pair at the best that was found.

A second effect is added to a first, against the noise around that; or two are joined, each from its own best.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ..effects.base import Effect
from .contender import Contender, likeliest_first, of_fit
from .fit import Fitter
from .hypothesis import Hypothesis
from .own_noise import by_itself
from .step_credit import step_credit
from .thresholds import CLEAR

__all__ = ["Pairs", "firsts", "single_of"]

Floats = NDArray[np.float64]

# A first leaves no more than so much of the best one's objective beyond it.
_NEAR_BEST = 0.5
# Seconds that are fitted with each first; singles that are joined two and two, and joints that are fitted.
_SECONDS, _JOINED, _JOINTS = 3, 4, 2
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
        # What each is by itself is one more start.
        alone = {single.names: single.point for single in singles}
        others = [
            replace(h, starts=np.vstack([h.starts, alone[h.names], *self.hints.get(h.names, ())]))
            for h in self.possible
            if h.names != first.names and h.names in alone
        ]
        joined = [first.fit.hypothesis + other for other in others]
        bases = [np.concatenate([first.point, np.zeros(len(other.neutral))]) for other in others]
        scans = self.fitter.scan(joined, bases, first.residual, first.fit.jacobian)
        costs = [
            points[0][0] + step_credit(self.fitter, h.effects(points[0][1]))
            for h, points in zip(joined, scans, strict=True)
        ]
        for k in np.argsort(costs, kind="stable")[:_SECONDS]:
            if costs[k] < first.cost + first.step_credit - CLEAR:
                self._keep(joined[k], scans[k][0][1])

    def join(self, singles: Sequence[Contender]) -> None:
        """Fit the best of the best singles two and two, from each one's own best and from halves.

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
            points = [
                np.concatenate([a * first.point, b * second.point]) for a, b in ((1.0, 1.0), (1.0, 0.5), (0.5, 1.0))
            ]
            for point, residual in zip(points, self.fitter.residuals(both, points), strict=True):
                tried.append((self.fitter.cost(residual, point), len(tried), both, point))
        tried.sort(key=lambda entry: entry[:2])
        fitted: set[tuple[str, ...]] = set()
        for _, _, both, point in tried:
            if both.names not in fitted and len(fitted) < _JOINTS:
                fitted.add(both.names)
                self._keep(both, point)

    def _keep(self, hypothesis: Hypothesis, start: Floats) -> None:
        contender = of_fit(self.fitter, self.fitter.fit(hypothesis, start, evaluations=_POINTS))
        names = frozenset(hypothesis.names)
        if names not in self._found or contender.total < self._found[names].total:
            self._found[names] = contender


def firsts(singles: Sequence[Contender]) -> list[Contender]:
    """Return those of the best, best first, that are near enough to be a first of a pair."""
    # A total may be negative, for a determinant may be small; what the best leaves never is.
    near = singles[0].total + _NEAR_BEST * singles[0].cost
    return [contender for contender in singles if contender.total <= near]


def single_of(
    fitter: Fitter, possible: Sequence[Hypothesis], pair: Contender, kind: type[Effect], evaluations: int
) -> Contender:
    """Return one effect of a pair, fitted from where it is within it, as a contender of its own, settled.

    Parameters
    ----------
    fitter
        Of the dataset.
    possible
        Every effect by itself.
    pair
        Two effects.
    kind
        One of them.
    evaluations
        Trial points of the fit at most.
    """
    assert pair.fit is not None
    hypothesis = next(h for h in possible if h.kinds == (kind,))
    mine = np.array([name == kind.name for name, _ in pair.fit.hypothesis.keys])
    start = pair.point[mine]
    fitter.take_likeliest_noise(hypothesis.effects(start))
    fit = fitter.fit(hypothesis, start, evaluations=evaluations)
    return by_itself(fitter, of_fit(fitter, fit), evaluations=1)
