"""`Search`: the best point of every effect, and of the pairs that may be at work.

Where an effect is weak, differences are linear in it and a few steps of least squares from a scan suffice. Where it is
strong, the objective has many minima: thresholds, motions that soon have nothing in common. Then lines through the
ranges are halved, and many points over the whole range are fitted to the beginnings of the trials first, all of it in
longer steps than what is found is held in.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..effects.base import Effect
from ..progress import OnPhase
from .beginnings import MANY, beginning, from_beginnings, from_its_own_beginning, promise
from .contender import Contender, likeliest, likeliest_first, of_fit, of_nominal
from .counterpart import counterparts
from .fit import Fit, Fitter
from .hypothesis import SECOND, Hypothesis
from .least import least
from .nearby import points_around
from .own_noise import (
    ENOUGH,
    IDLE_POINTS,
    NEAR,
    POLISH_POINTS,
    again,
    against_itself,
    against_the_best,
    by_itself,
    each_by_itself,
    settled,
    settled_at,
)
from .pairs import AS_GOOD, Pairs, firsts, single_of
from .predictive import is_right, mean_square
from .sparse import as_far
from .thresholds import CLEAR, beyond_thresholds

__all__ = ["Search"]

Floats = NDArray[np.float64]

# What takes less than so much, times the numbers that count as one, off the nominal model's objective is not worth
# another look, for the prior asks for as much.
_WORTH = 9.0
# Trial points of a fit: of an effect that leads after the scan (so many do), and of another (where nothing is better
# than neutral only the derivatives are taken).
_LEADING, _LEADING_POINTS, _POINTS = 6, 6, 4
# Effects that are held against their own noise before one counts as best, and how many where that gains much.
_OWN, _MOST_OWN = 4, 6
# A gap is left where the mean square stays above this against the likeliest noise.
_WANTING = 1.1
# Hypotheses that are fitted again from the beginnings of the trials; and of those whose points over the range follow
# the beginnings better than their fit does.
_REFINED, _PROMISING = 2, 4
# The leader of before, found farther away, is a new first of pairs where that takes more than this share of what it
# leaves off the objective.
_FARTHER = 0.1
# Effects to which a second is added: the farther ones only where the best leaves a gap, more only where all pairs do.
_FIRSTS, _MORE_FIRSTS = 2, 5
# Fits that are looked around, how many of the points around one are fitted on in so many trial points, and how often.
_SHAKEN, _SHAKEN_FITS, _SHAKEN_POINTS, _SHAKES = 3, 2, 3, 2
# Pairs whose beginnings are searched.
_PAIRS_REFINED = 2
# Other effects that are fitted from where they do what the best does, and how often the best may change by it, or by
# an exchange.
_COUNTERPARTS, _ROUNDS = 3, 2
# What is less than about e^12 behind the best, or as good by `AS_GOOD`, is fitted as far, so many at most: a total
# moves by some e^3 with the place around which its noise is measured, and by more with where a fit stopped.
_OPEN, _EQUALLY_FAR = 12.0, 3


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
        """Return the nominal model and what was fitted, those that count against their own noise or the best's."""
        self.fitter.take_likeliest_noise(())
        nominal = of_nominal(self.fitter)
        enough = self.comparison.nuisances.enough(nominal.residual.local)
        held = (hypothesis.without(enough) for hypothesis in self.possible)
        self.possible = [hypothesis for hypothesis in held if len(hypothesis.starts)]
        # What is weak is found where it starts: only a strong cause has minima of its own, far away.
        return self._of_strong(nominal) if not is_right(self.comparison, nominal.residual) else self._of_weak(nominal)

    def _of_weak(self, nominal: Contender) -> list[Contender]:
        singles = self._singles(nominal)
        if not singles or singles[0].total > nominal.total - self.worth:
            return [nominal, *singles]
        nominal, singles = self._resolved(nominal, singles)
        if not is_right(self.comparison, nominal.residual):
            # Only in shorter steps it shows that it is wrong.
            return self._of_strong(nominal)
        singles = settled(self.fitter, singles, self.tell, _OWN, _MOST_OWN)
        if singles[0].total > nominal.total - self.worth:
            return self._concluded(nominal, singles)
        singles = self._all_shaken(singles)
        return self._concluded(nominal, self._with_shaken_pair(singles, self._pairs(singles, strong=False)))

    def _of_strong(self, nominal: Contender) -> list[Contender]:
        """Search in longer steps, and hold what is found in the right ones.

        A strong cause moves the robot by much more than the longer steps get wrong.
        """
        with self.comparison.in_longer_steps():
            self.fitter.take_likeliest_noise(())
            found = self._far_and_wide(of_nominal(self.fitter))
        if not found:
            return [nominal]
        made = self._in_short_steps(found)
        self.fitter.take_likeliest_noise(())
        return self._concluded(of_nominal(self.fitter), made)

    def _in_short_steps(self, found: Sequence[Contender]) -> list[Contender]:
        """Hold what was found in longer steps in those of the moment, and fit the best on."""
        self.comparison.halve_steps_for(found[0].effects)
        self.fitter.take_likeliest_noise(found[0].effects)
        # What came near the best counts against its own noise here too.
        near = found[0].total + NEAR
        held = again(self.fitter, [c if c.total <= near else replace(c, settled=False) for c in found])
        made = settled(self.fitter, [replace(contender, settled=False) for contender in held], self.tell)
        made = likeliest_first([self._shaken(made[0]), *made[1:]])
        if len(made[0].names) == 1:
            return made
        single = likeliest(contender for contender in made if len(contender.names) == 1)
        return likeliest_first([self._nested(made[0], single), *(c for c in made if c is not single)])

    def _far_and_wide(self, nominal: Contender) -> list[Contender]:
        """Search over the whole ranges, add second effects, look for what does the same; the likeliest first."""
        singles, worth = self._singles(nominal), nominal.total - self.worth
        if not singles or singles[0].total > worth:
            return singles
        nominal, singles = self._resolved(nominal, singles)
        singles = settled(self.fitter, singles, self.tell, _OWN, _MOST_OWN)
        singles = self._all_shaken(singles)
        pairs: list[Contender] = []
        refined: set[tuple[str, ...]] = set()
        worth = nominal.total - self.worth
        if self._is_wanting(singles[0]):
            refined = {singles[k].names for k in _to_refine(singles, _REFINED)}
            singles = settled(self.fitter, self._refined(singles, _REFINED), self.tell)
        if singles[0].total <= worth:
            pairs = self._pairs(singles, strong=True)
        # Where two effects leave no gap, what is far away is not looked for.
        if not self._is_enough([*singles, *pairs]):
            far = settled(self.fitter, self._far(singles, refined), self.tell)
            near, singles = singles, far
            more = CLEAR if near[0].names != far[0].names else max(CLEAR, _FARTHER * far[0].cost)
            untried = near[0].total > worth
            if far[0].total <= worth and (untried or near[0].total - far[0].total > more):
                pairs = self._pairs(singles, strong=True, known=pairs)
        elif not (pairs and pairs[0].total < singles[0].total - self.worth):
            singles = settled(self.fitter, self._elsewhere(singles, refined), self.tell)
        made = self._with_shaken_pair(singles, pairs) if singles[0].total <= worth else [*singles, *pairs]
        made = likeliest_first(made)
        return self._with_counterparts(made) if made[0].total <= worth else made

    def _with_shaken_pair(self, singles: Sequence[Contender], pairs: Sequence[Contender]) -> list[Contender]:
        """Look around the best pair, and for its best single effect again from there."""
        if not pairs:
            return list(singles)
        pairs = likeliest_first([self._shaken(pairs[0]), *pairs[1:]])
        return likeliest_first([self._nested(pairs[0], singles[0]), *singles[1:], *pairs])

    def in_steps_of(self, leader: Contender, contenders: Sequence[Contender]) -> list[Contender]:
        """Return the nominal model and the others again, in steps that are short enough for one of them.

        Parameters
        ----------
        leader
            One of them.
        contenders
            What `contenders` returned.
        """
        nominal = next(c for c in contenders if not c.names)
        others = [c for c in contenders if c.names and c.names != leader.names]
        return self._concluded(nominal, [leader, *others])

    def _concluded(self, nominal: Contender, contenders: Sequence[Contender]) -> list[Contender]:
        """Return the nominal model and all others, each against the noise that counts."""
        while True:
            nominal, made = self._resolved(nominal, contenders)
            contenders = self._equally_far(each_by_itself(self.fitter, made, self.tell))
            # Against its own noise another may lead, which asks for shorter steps still.
            if self.comparison.simulator.resolves(contenders[0].effects):
                return against_the_best(self.fitter, nominal, contenders)

    def _equally_far(self, contenders: Sequence[Contender]) -> list[Contender]:
        """Fit what may be as good as the best as far as that, without what it does not need."""
        alike, made = self.comparison.alike, list(contenders)
        scores = [c.total + 2.0 * alike * SECOND * (len(c.names) - 1) for c in made]
        order = np.argsort(scores, kind="stable").tolist()
        best, open_to = made[order[0]], scores[order[0]] + 2.0 * alike * _OPEN
        # All against one noise: what does as the best does may have stopped beside its valley.
        self.fitter.take_likeliest_noise(best.effects)
        costs = [self.fitter.again(c.fit).cost + c.step_credit for c in made if c.fit is not None]
        here = costs[order[0]]
        as_good = here + AS_GOOD * max(self.fitter.nominal()[1] - here, 0.0)
        alike_kind = [len(c.names) == len(best.names) and cost < as_good for c, cost in zip(made, costs, strict=True)]
        near = [k for k in order if scores[k] < open_to or alike_kind[k]]
        if len(near) == 1:
            return made
        for n, k in enumerate(near[:_EQUALLY_FAR]):
            self.tell("fitting those near the best as far", n, min(len(near), _EQUALLY_FAR))
            made[k] = as_far(self.fitter, made[k], alike)
        return likeliest_first(made)

    def _resolved(self, nominal: Contender, contenders: Sequence[Contender]) -> tuple[Contender, list[Contender]]:
        """Return the nominal model and the others in steps that are short enough for the leader."""
        made = list(contenders)
        # What moves so in one step and not in half of it is no motion of the model, and speaks for nothing.
        while self.comparison.halve_steps_for(made[0].effects):
            self.fitter.take_likeliest_noise(())
            nominal = of_nominal(self.fitter)
            made = settled(self.fitter, again(self.fitter, made), self.tell, _OWN, _MOST_OWN)
        return nominal, made

    def _far(self, singles: Sequence[Contender], refined: Collection[tuple[str, ...]]) -> list[Contender]:
        """Search far away for those that no local fit can be trusted with, but for those that were refined."""
        made = list(singles)
        self.tell("points over the whole range", _REFINED, _REFINED)
        self.fitter.take_likeliest_noise(made[0].effects)
        few = [k for k, c in enumerate(made) if c.free <= MANY and c.names not in refined]
        promises = {k: promise(self.fitter, made[k], self.seed) for k in few}
        promising = sorted(few, key=lambda k: -promises[k])[:_PROMISING]
        for k, contender in enumerate(made):
            many = contender.free > MANY and contender.names not in refined
            if many or (k in promising and promises[k] > CLEAR):
                made[k] = from_beginnings(self.fitter, contender, self.possible, self.seed)
        return likeliest_first(made)

    def _elsewhere(self, singles: Sequence[Contender], refined: Collection[tuple[str, ...]]) -> list[Contender]:
        """Search far away for effects of one parameter too where another leaves no gap: one of them may be the cause.

        Those are fitted that follow the beginnings of the trials about as well.
        """
        made, best = list(singles), singles[0]
        self.tell("points over the whole range", 0, 1)
        self.fitter.take_likeliest_noise(best.effects)
        goal = beginning(self.fitter, best)
        for k, contender in enumerate(made):
            if k == 0 or contender.free > 1 or contender.names in refined:
                continue
            wanted = (1.0 - AS_GOOD) * (beginning(self.fitter, contender) - goal)
            if promise(self.fitter, contender, self.seed) > max(CLEAR, wanted):
                other = from_beginnings(self.fitter, contender, self.possible, self.seed)
                made[k] = by_itself(self.fitter, other, IDLE_POINTS)
                self.fitter.take_likeliest_noise(best.effects)
        return likeliest_first(made)

    def _with_counterparts(self, contenders: Sequence[Contender]) -> list[Contender]:
        """Fit other effects from where they do what the best, or one of the best pair, does.

        A pair may lead that adds less than a second effect must: where the best single effect leaves no gap, it is the
        one that others have to do the same as.
        """
        made = {frozenset(contender.names): contender for contender in contenders}
        for k in range(_ROUNDS):
            self.tell("what else does the same", k, _ROUNDS)
            best, single = likeliest(made.values()), likeliest(c for c in made.values() if len(c.names) == 1)
            for contender in [best] if best is single or self._is_wanting(single) else [best, single]:
                self._add_counterparts(contender, made)
            if likeliest(made.values()) is best:
                break
        return likeliest_first(made.values())

    def _add_counterparts(self, best: Contender, made: dict[frozenset[str], Contender]) -> None:
        """Keep the counterparts of a contender that are better than what is known of the same effects."""
        assert best.fit is not None
        for kind in best.fit.hypothesis.kinds:
            those = counterparts(self.fitter, best, kind, self.possible)
            # All against the noise around the contender.
            nominal, here = self.fitter.nominal()[1], self.fitter.again(best.fit).cost + best.step_credit
            worst = here + AS_GOOD * max(nominal - here, 0.0)
            near = [c for c in those if c.cost < worst][:_COUNTERPARTS]
            fits = [self.fitter.fit(c.hypothesis, c.point, evaluations=_POINTS) for c in near]
            for fit in [fit for fit in fits if self._is_better(fit, made.get(frozenset(fit.hypothesis.names)))]:
                # Each against its own.
                other = settled_at(self.fitter, fit.hypothesis, fit.point, IDLE_POINTS, fit.steps)
                known = made.get(frozenset(other.names))
                if known is not None and known.fit is not None and not known.settled:
                    known = against_itself(self.fitter, known.fit)
                if known is None or other.total < known.total - ENOUGH:
                    made[frozenset(other.names)] = other

    def _is_better(self, fit: Fit, known: Contender | None) -> bool:
        """Return whether a fit is better than what is known of the same effects, against the noise of the moment."""
        return known is None or known.fit is None or fit.cost <= self.fitter.again(known.fit).cost - ENOUGH

    def _nested(self, pair: Contender, single: Contender) -> Contender:
        """Fit the best single effect again from where it is in a pair: alone it must not have been fitted less far."""
        if single.names[0] not in pair.names or pair.total > single.total - CLEAR:
            return single
        assert single.fit is not None
        (kind,) = single.fit.hypothesis.kinds
        return likeliest([single, single_of(self.fitter, self.possible, pair, kind, POLISH_POINTS)])

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
        if singles and not is_right(self.comparison, likeliest([nominal, *singles]).residual):
            singles = self._searched(nominal, singles)
        return likeliest_first(singles)

    def _is_enough(self, contenders: Sequence[Contender]) -> bool:
        best = likeliest(contenders)
        return not self._is_wanting(best) or (len(best.names) > 1 and is_right(self.comparison, best.residual))

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
                # Right for a trial, it may be about as wrong as neutral for all: what else it asks for, the fit shows.
                if fitter.cost(residual, point) < made[k].cost + CLEAR:
                    other = of_fit(fitter, fitter.fit(hypothesis, point, evaluations=_LEADING_POINTS))
                    made[k] = likeliest([made[k], other])
        return made

    def _all_shaken(self, contenders: Sequence[Contender]) -> list[Contender]:
        """Look around the best, and around those that are about as good: none is to lead because it alone was."""
        near = contenders[0].total + CLEAR
        chosen = [k for k, contender in enumerate(contenders) if contender.settled and contender.total < near]
        made = list(contenders)
        for k in chosen[:_SHAKEN]:
            made[k] = self._shaken(contenders[k])
        return likeliest_first(made)

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
            starts = [point for _, point in least(self.fitter, hypothesis, points, _SHAKEN_FITS)]
            ends = [self.fitter.descend(hypothesis, start, evaluations=_SHAKEN_POINTS) for start in starts]
            cost, point = min(ends, key=lambda end: end[0])
            # What is clearly worse against this noise is not looked at against its own.
            if cost > self.fitter.again(best.fit).cost + CLEAR:
                break
            other = settled_at(self.fitter, hypothesis, point)
            if other.total > best.total - ENOUGH:
                break
            best = other
        return best

    def _refined(self, contenders: Sequence[Contender], count: int) -> list[Contender]:
        """Fit the best so many again from points over their whole range, the beginnings of the trials first.

        Where an effect is strong, paths soon have nothing in common any more; their beginnings still have. A pair of
        many parameters that is not the best starts from where it is and from nowhere else; a single such one stays.
        """
        made = list(contenders)
        wide = _to_refine(made, count)
        for k, contender in enumerate(made[:count]):
            self.tell("points over the whole range", k, count)
            if k in wide:
                made[k] = from_beginnings(self.fitter, contender, self.possible, self.seed)
            elif len(contender.names) > 1:
                made[k] = from_its_own_beginning(self.fitter, contender)
        return likeliest_first(made)

    def _pairs(self, singles: Sequence[Contender], strong: bool, known: Sequence[Contender] = ()) -> list[Contender]:
        """Add a second effect to the best, beside pairs that are known; none where none shows."""
        pairs = Pairs(self.fitter, self.possible, self.hints, known)
        # A second effect shows beside the best one; beside the next best only where the best leaves a gap.
        wanting = strong and self._is_wanting(singles[0])
        near = firsts(singles[: _FIRSTS if wanting else 1])
        for n, first in enumerate(near):
            self.tell("fitting pairs", n, len(near))
            pairs.add(first, singles)
        if wanting:
            pairs.join(singles)
        found = pairs.likeliest_first()
        if not found or found[0].total > singles[0].total - self.worth:
            return found
        found = _kept(settled(self.fitter, found, self.tell), known)
        pairs = Pairs(self.fitter, self.possible, self.hints, found)
        # Where both are strong, either alone may be far from the best.
        if wanting and not self._is_enough(found):
            for n, first in enumerate(far := firsts(singles[:_MORE_FIRSTS])[len(near) :]):
                self.tell("fitting pairs", n, len(far))
                pairs.add(first, singles)
            found = _kept(settled(self.fitter, pairs.likeliest_first(), self.tell), found)
            pairs = Pairs(self.fitter, self.possible, self.hints, found)
        # However little the best leaves: against a sharper noise another may leave as little.
        if strong:
            found = _kept(settled(self.fitter, self._refined(found, _PAIRS_REFINED), self.tell), found)
        # A pair that would not be named beside a single effect that leaves no gap is no answer.
        named = found[0].total < singles[0].total - 2.0 * self.comparison.alike * SECOND
        return self._exchanged(found, singles) if wanting or named else found

    def _exchanged(self, found: Sequence[Contender], singles: Sequence[Contender]) -> list[Contender]:
        """Exchange either effect of the best pair: one may be the answer to another that is wrong."""
        made, held = list(found), set[str]()
        for n in range(_ROUNDS):
            self.tell("exchanging one of the pair", n, _ROUNDS)
            best = made[0]
            assert best.fit is not None
            pairs = Pairs(self.fitter, self.possible, self.hints, made)
            for kind, other in zip(best.fit.hypothesis.kinds, best.names[::-1], strict=True):
                if other not in held:
                    pairs.exchange(best, kind, singles)
                    held.add(other)
            made = _kept(settled(self.fitter, pairs.likeliest_first(), self.tell), made)
            if made[0].names == best.names:
                break
        return made


def _kept(found: Sequence[Contender], before: Sequence[Contender]) -> list[Contender]:
    """Return what was found, the likeliest first, but what was settled before where that is likelier or the new is not.

    What looks better against another's noise must not take its place.
    """
    known = {frozenset(contender.names): contender for contender in before if contender.settled}
    made = []
    for contender in found:
        old = known.get(frozenset(contender.names), contender)
        made.append(likeliest([contender, old]) if contender.settled else old)
    return likeliest_first(made)


def _to_refine(contenders: Sequence[Contender], count: int) -> list[int]:
    """Return the places, of the first so many, of the best one and of those with few parameters."""
    return [k for k, contender in enumerate(contenders[:count]) if k == 0 or contender.free <= MANY]
