"""`Search`: the best point of every effect, and of the pairs that may be at work.

Where an effect is weak, differences are linear in it and a few steps of least squares from a scan suffice. Where it is
strong, the objective has many minima: thresholds, motions that soon have nothing in common. Then lines through the
ranges are halved, and many points over the whole range are fitted to the beginnings of the trials first.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ..effects.base import Effect
from ..progress import OnPhase
from .beginnings import MANY, from_beginnings, promise
from .contender import Contender, of_fit, of_nominal
from .fit import Fit, Fitter
from .hypothesis import Hypothesis
from .nearby import points_around
from .predictive import is_right, mean_square
from .thresholds import CLEAR, beyond_thresholds

__all__ = ["Search"]

Floats = NDArray[np.float64]

# What takes less than so much, times the numbers that count as one, off the nominal model's objective is not worth
# another look, for the prior asks for as much.
_WORTH = 9.0
# Trial points of a fit: of an effect that leads after the scan (so many do), and of another (where nothing is better
# than neutral only the derivatives are taken); where a fit has only to follow another noise; of a pair, and where a
# good fit is taken further.
_LEADING, _LEADING_POINTS, _POINTS, _IDLE_POINTS, _PAIR_POINTS, _POLISH_POINTS = 6, 6, 4, 2, 4, 6
# How many fits are held against their own noise, how often it is measured after a further fit at most, and what that
# must take off the objective for another round.
_SETTLED, _ROUNDS, _ENOUGH = 2, 2, 5.0
# What comes so near to the best is held against its own noise, so many at most.
_NEAR, _MOST_NEAR = 300.0, 6
# A gap is left where the mean square stays above this against the likeliest noise.
_WANTING = 1.1
# Hypotheses that are fitted again from the beginnings of the trials; and of those whose points over the range follow
# the beginnings better than their fit does.
_REFINED, _PROMISING = 2, 4
# Effects to which a second is added, the farther ones only where the best leaves a gap, and they leave no more than so
# much of its objective beyond it; seconds that are fitted with each; singles that are joined two and two, and joints
# that are fitted.
_FIRSTS, _NEAR_BEST, _SECONDS, _JOINED, _JOINTS = 2, 0.5, 3, 4, 2
# How many of the points around a fit are fitted on in so many trial points, and how often all this.
_SHAKEN_FITS, _SHAKEN_POINTS, _SHAKES = 2, 3, 2
# Pairs whose beginnings are searched, and singles for which one of the best pair is exchanged.
_PAIRS_REFINED, _EXCHANGED = 2, 6


class Search:
    """Searches the catalogue.

    Parameters
    ----------
    fitter
        Of the dataset.
    kinds
        The effects.
    tell
        Is told the phase, how much of it is done, and of how much.
    seed
        Of the points over the range.
    """

    def __init__(self, fitter: Fitter, kinds: Sequence[type[Effect]], tell: OnPhase, seed: int) -> None:
        self.fitter, self.comparison, self.tell, self.seed = fitter, fitter.comparison, tell, seed
        scenarios = [self.comparison.simulator.nominal(i) for i in fitter.trials]
        possible = [Hypothesis.of(kind, scenarios) for kind in kinds]
        self.possible = [hypothesis for hypothesis in possible if len(hypothesis.starts)]
        self.worth = _WORTH * self.comparison.alike
        # Points at which a threshold makes one trial right.
        self.hints: dict[tuple[str, ...], list[Floats]] = {}

    @property
    def names(self) -> list[str]:
        """Names of the effects that can be at work in these trials."""
        return [hypothesis.names[0] for hypothesis in self.possible]

    def contenders(self) -> list[Contender]:
        """Return the nominal model and what was fitted, those that count against their own noise."""
        self.fitter.take_likeliest_noise(())
        nominal = of_nominal(self.fitter)
        singles = self._singles(nominal)
        if not singles or singles[0].total > nominal.total - self.worth:
            return [nominal, *singles]
        if self.comparison.halve_steps_for(singles[0].effects):
            self.fitter.take_likeliest_noise(())
            nominal, singles = of_nominal(self.fitter), self._judged_again(singles)
        singles = self._settled(singles)
        singles = sorted([self._shaken(singles[0]), *singles[1:]], key=_total)
        # What is weak is found where it starts: only a strong cause has minima of its own, far away.
        strong = not is_right(self.comparison, nominal.residual)
        if strong and self._is_wanting(singles[0]):
            singles = self._settled(self._far(singles))
        if singles[0].total > nominal.total - self.worth:
            return self._against_the_best(nominal, self._each_by_itself(singles))
        pairs = self._pairs(singles, strong)
        if pairs:
            pairs = sorted([self._shaken(pairs[0]), *pairs[1:]], key=_total)
            singles = [self._nested(pairs[0], singles[0]), *singles[1:]]
        return self._against_the_best(nominal, self._each_by_itself([*singles, *pairs]))

    def _far(self, singles: Sequence[Contender]) -> list[Contender]:
        """Search far away for the best, and where they leave a gap for those that no local fit can be trusted with."""
        made = self._refined(singles, _REFINED)
        refined = {contender.names for contender in singles[:_REFINED]}
        if self._is_wanting(made[0]):
            self.tell("points over the whole range", _REFINED, _REFINED)
            self.fitter.take_likeliest_noise(made[0].effects)
            few = [k for k, c in enumerate(made) if len(c.point) <= MANY and c.names not in refined]
            promises = {k: promise(self.fitter, made[k], self.seed) for k in few}
            promising = sorted(few, key=lambda k: -promises[k])[:_PROMISING]
            for k, contender in enumerate(made):
                many = len(contender.point) > MANY and contender.names != singles[0].names
                if many or (k in promising and promises[k] > CLEAR):
                    made[k] = from_beginnings(self.fitter, contender, self.possible, self.seed)
        return sorted(made, key=_total)

    def _nested(self, pair: Contender, single: Contender) -> Contender:
        """Fit the best single effect again from where it is in a pair: alone it must not have been fitted less far."""
        if single.names[0] not in pair.names or pair.total > single.total - CLEAR:
            return single
        assert single.fit is not None
        (kind,) = single.fit.hypothesis.kinds
        alone = self._alone(pair, kind, _POLISH_POINTS)
        return min(single, replace(alone, settled=True), key=_total)

    def _judged_again(self, contenders: Sequence[Contender]) -> list[Contender]:
        """Hold the same fits against another noise, the best first."""
        return sorted((of_fit(self.fitter, self.fitter.again(fit)) for fit in _fits(contenders)), key=_total)

    def _singles(self, nominal: Contender) -> list[Contender]:
        self.tell("first look at every effect", 0, 1)
        zeros = [np.zeros(len(h.neutral)) for h in self.possible]
        scans = self.fitter.scan(self.possible, zeros, nominal.residual)
        singles: list[Contender] = []
        leading = sorted(points[0][0] for points in scans)[:_LEADING]
        for k, (hypothesis, points) in enumerate(zip(self.possible, scans, strict=True)):
            self.tell("fitting each effect", k, len(self.possible))
            cost, start = points[0]
            count = (_LEADING_POINTS if cost in leading else _POINTS) if np.any(start) else 1
            singles.append(of_fit(self.fitter, self.fitter.fit(hypothesis, start, evaluations=count)))
        if singles and not is_right(self.comparison, min([nominal, *singles], key=_total).residual):
            singles = self._searched(nominal, singles)
        return sorted(singles, key=_total)

    def _is_wanting(self, contender: Contender) -> bool:
        return mean_square(self.comparison, contender.residual) > _WANTING

    def _searched(self, nominal: Contender, singles: Sequence[Contender]) -> list[Contender]:
        """Fit effects of few parameters again from the best point on a line through their ranges."""
        fitter = self.fitter
        made = list(singles)
        for k, contender in enumerate(singles):
            self.tell("lines through every range", k, len(singles))
            assert contender.fit is not None
            hypothesis = contender.fit.hypothesis
            points = beyond_thresholds(fitter, hypothesis, nominal.residual)
            self.hints[contender.names] = points
            for point, residual in zip(points, fitter.residuals(hypothesis, points), strict=True):
                if fitter.cost(residual, point) < made[k].cost - CLEAR:
                    other = of_fit(fitter, fitter.fit(hypothesis, point, evaluations=_LEADING_POINTS))
                    made[k] = min(made[k], other, key=_total)
        return made

    def _settled(self, contenders: Sequence[Contender]) -> list[Contender]:
        """Hold the best so many against their own noise and fit them on; the best first."""
        made = sorted(contenders, key=_total)
        for k, contender in enumerate(made[:_SETTLED]):
            if contender.settled:
                continue
            self.tell("another look at the best", k, _SETTLED)
            assert contender.fit is not None
            best = self._against_itself(contender.fit)
            for _ in range(_ROUNDS):
                assert best.fit is not None
                fit = self.fitter.fit(best.fit.hypothesis, best.point, evaluations=_POLISH_POINTS)
                other = self._against_itself(fit) if fit.cost < best.cost - _ENOUGH else best
                if other.total >= best.total:
                    break
                best = other
            assert best.fit is not None
            # The derivatives where it is, against its own noise.
            self.fitter.take_likeliest_noise(best.effects)
            here = self.fitter.fit(best.fit.hypothesis, best.point, evaluations=1)
            made[k] = replace(of_fit(self.fitter, here), settled=True)
        return sorted(made, key=_total)

    def _shaken(self, contender: Contender) -> Contender:
        """Look around a fit for a better one, which small local minima keep least squares from.

        Where motion hops, a small change of a parameter changes the differences by steps: the objective is rough.
        """
        rng, best = np.random.default_rng(self.seed), contender
        for k in range(_SHAKES):
            self.tell("around the best", k, _SHAKES)
            assert best.fit is not None
            hypothesis = best.fit.hypothesis
            self.fitter.take_likeliest_noise(best.effects)
            points = points_around(best.fit, self.comparison.alike, rng)
            residuals = self.fitter.residuals(hypothesis, points)
            costs = [self.fitter.cost(residual, point) for residual, point in zip(residuals, points, strict=True)]
            starts = [points[n] for n in np.argsort(costs, kind="stable")[:_SHAKEN_FITS]]
            fits = [self.fitter.fit(hypothesis, start, evaluations=_SHAKEN_POINTS) for start in starts]
            other = min((self._against_itself(fit) for fit in fits), key=_total)
            if other.total > best.total - _ENOUGH:
                break
            best = replace(other, settled=True)
        return best

    def _each_by_itself(self, contenders: Sequence[Contender]) -> list[Contender]:
        """Hold what comes near the best against its own noise too: another's may flatter it, or wrong it."""
        made = sorted(contenders, key=_total)
        count = 0
        for k, contender in enumerate(made):
            assert contender.fit is not None
            if contender.settled or contender.total > made[0].total + _NEAR:
                continue
            self.tell("each against its own noise", count, _MOST_NEAR)
            self.fitter.take_likeliest_noise(contender.effects)
            fit = self.fitter.fit(contender.fit.hypothesis, contender.point, evaluations=_IDLE_POINTS)
            made[k] = replace(of_fit(self.fitter, fit), settled=True)
            count += 1
            if count == _MOST_NEAR:
                break
        return sorted(made, key=_total)

    def _against_the_best(self, nominal: Contender, contenders: Sequence[Contender]) -> list[Contender]:
        """Hold all that come near the best against its noise too, and keep what is likelier.

        Near a threshold the noise around two hypotheses that say the same can differ by much. What is better than
        another has to be so against one noise.
        """
        best = contenders[0]
        made = [best]
        for contender in (nominal, *contenders[1:]):
            near = contender.total <= best.total + _NEAR
            other = self._beside(contender, best) if near else contender
            lent = other.total < contender.total and self._says_the_same(contender, best, other)
            made.append(other if lent else contender)
        return made

    def _says_the_same(self, contender: Contender, best: Contender, lent: Contender) -> bool:
        """Return whether a contender is about as near to the best against its own noise as against the best's.

        What the best changes moves more easily where it is at work: its noise may hide the very gap that it closes.
        """
        own = self._beside(contender, contender)
        return own.total - self._beside(best, contender).total < lent.total - best.total + CLEAR

    def _beside(self, contender: Contender, around: Contender) -> Contender:
        """Hold a contender against the noise around another."""
        self.fitter.take_likeliest_noise(contender.effects, around.effects)
        if contender.fit is None:
            return of_nominal(self.fitter)
        return replace(of_fit(self.fitter, self.fitter.again(contender.fit)), settled=contender.settled)

    def _against_itself(self, fit: Fit) -> Contender:
        """Hold a fit against its own noise."""
        self.fitter.take_likeliest_noise(fit.hypothesis.effects(fit.point))
        return of_fit(self.fitter, self.fitter.again(fit))

    def _refined(self, contenders: Sequence[Contender], count: int) -> list[Contender]:
        """Fit the best so many again from points over their whole range, the beginnings of the trials first.

        Where an effect is strong, paths soon have nothing in common any more; their beginnings still have.
        """
        made = list(contenders)
        for k, contender in enumerate(made[:count]):
            self.tell("points over the whole range", k, count)
            if k == 0 or len(contender.point) <= MANY:
                made[k] = from_beginnings(self.fitter, contender, self.possible, self.seed)
        return sorted(made, key=_total)

    def _pairs(self, singles: Sequence[Contender], strong: bool) -> list[Contender]:
        """Add a second effect to the best; none where none shows."""
        found: dict[frozenset[str], Contender] = {}
        # A second effect shows beside the best one; beside the next best only where the best leaves a gap.
        wanting = strong and self._is_wanting(singles[0])
        firsts = _firsts(singles[: _FIRSTS if wanting else 1])
        for n, first in enumerate(firsts):
            self.tell("fitting pairs", n, len(firsts))
            self._added(first, singles, found)
        if wanting:
            self._joined(singles, found)
        pairs = sorted(found.values(), key=_total)
        if not pairs or pairs[0].total > singles[0].total - self.worth:
            return pairs
        pairs = self._settled(pairs)
        found = {frozenset(pair.names): pair for pair in pairs}
        # The best second may be the answer to a first that is wrong: with it held, is there a better first?
        best = pairs[0]
        assert best.fit is not None
        for n, kind in enumerate(best.fit.hypothesis.kinds):
            self.tell("exchanging one of the pair", n, 2)
            if kind.name not in firsts[0].names:
                self._added(self._alone(best, kind, _IDLE_POINTS), singles[:_EXCHANGED], found)
        pairs = sorted(found.values(), key=_total)
        # However little the best leaves: against a sharper noise another may leave as little.
        if strong:
            pairs = self._refined(pairs, _PAIRS_REFINED)
        return self._settled(pairs)

    def _alone(self, pair: Contender, kind: type[Effect], points: int) -> Contender:
        """Return one effect of a pair, as it is within it, as a contender of its own."""
        assert pair.fit is not None
        hypothesis = next(h for h in self.possible if h.kinds == (kind,))
        mine = np.array([name == kind.name for name, _ in pair.fit.hypothesis.keys])
        return self._against_itself(self.fitter.fit(hypothesis, pair.point[mine], evaluations=points))

    def _added(self, first: Contender, singles: Sequence[Contender], found: dict[frozenset[str], Contender]) -> None:
        """Fit the seconds that promise most beside a first, against its noise."""
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
        costs = [points[0][0] for points in scans]
        for k in np.argsort(costs, kind="stable")[:_SECONDS]:
            if costs[k] < first.cost - CLEAR:
                self._keep(joined[k], scans[k][0][1], found)

    def _joined(self, singles: Sequence[Contender], found: dict[frozenset[str], Contender]) -> None:
        """Fit the best of the best singles two and two, from each one's own best and from halves."""
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
                self._keep(both, point, found)

    def _keep(self, hypothesis: Hypothesis, start: Floats, found: dict[frozenset[str], Contender]) -> None:
        contender = of_fit(self.fitter, self.fitter.fit(hypothesis, start, evaluations=_PAIR_POINTS))
        names = frozenset(hypothesis.names)
        if names not in found or contender.total < found[names].total:
            found[names] = contender


def _fits(contenders: Sequence[Contender]) -> list[Fit]:
    return [contender.fit for contender in contenders if contender.fit is not None]


def _firsts(singles: Sequence[Contender]) -> list[Contender]:
    """Return those of the best, best first, that are near enough to be a first of a pair."""
    # A total may be negative, for a determinant may be small; what the best leaves never is.
    near = singles[0].total + _NEAR_BEST * singles[0].cost
    return [contender for contender in singles if contender.total <= near]


def _total(contender: Contender) -> float:
    return contender.total
