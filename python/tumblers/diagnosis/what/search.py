"""`Search`: the best point of every effect, and of the pairs that may be at work.

Where an effect is weak, differences are linear in it and a few steps of least squares from a scan suffice. Where it is
strong, the objective has many minima: thresholds, motions that soon have nothing in common. Then lines through the
ranges are halved, and many points over the whole range are fitted to the beginnings of the trials first, all of it in
longer steps than what is found is held in, unless those hide it.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...effects.base import Effect
from ...progress import OnPhase
from ..fitting.fitter import Fitter
from ..fitting.hypothesis import Hypothesis
from ..gap.predictive import is_right, is_wanting
from .beginnings import MANY, beginning, from_beginnings, promise
from .contender import Contender, likeliest, likeliest_first, of_fit, of_nominal
from .counterpart import with_counterparts
from .guided import found_again
from .last_fits import concluded, resolved
from .margins import AS_GOOD, CLEAR, NEAR
from .nearby import all_shaken, shaken
from .own_noise import IDLE_POINTS, MOST_OWN, OWN, again, by_itself, settled
from .pair_search import PairSearch, is_enough
from .pairs import firsts, nested
from .refined import refined, to_refine
from .thresholds import beyond_thresholds

__all__ = ["Search"]

Floats = NDArray[np.float64]

# What is likelier than the nominal model by less than so much, in ln, is not worth another look, for the prior asks for
# as much.
_WORTH = 4.5
# Trial points of a fit: of an effect that leads after the scan (so many do), and of another (where nothing is better
# than neutral only the derivatives are taken).
_LEADING, _LEADING_POINTS, _POINTS = 6, 6, 4
# Hypotheses that are fitted again from the beginnings of the trials; and of those whose points over the range follow
# the beginnings better than their fit does.
_REFINED, _PROMISING = 2, 4
# The leader of before, or an effect of the best pair, found farther away, is a new first of pairs where that takes more
# than this share of what it leaves off the objective.
_FARTHER = 0.1
# Of the best that have many minima beside one another, so many are searched by runs that are drawn to the tracks.
_GUIDED = 3


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
        self.worth = self.comparison.objective_of(_WORTH)
        self.clear = self.comparison.objective_of(CLEAR)
        # Points at which a threshold makes one trial right.
        self.hints: dict[tuple[str, ...], list[Floats]] = {}

    @property
    def names(self) -> list[str]:
        """Names of the effects that can be at work in these trials."""
        return [hypothesis.names[0] for hypothesis in self.possible]

    @property
    def pairing(self) -> PairSearch:
        """The search for pairs of what is possible, which a look at the nominal model narrows."""
        return PairSearch(self.fitter, self.possible, self.hints, self.worth, self.tell, self.seed)

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
        # The nominal model's noise may hide what an effect explains: the motion that it moves is the one that varies.
        singles = settled(self.fitter, self._singles(nominal), self.tell, OWN, MOST_OWN)
        if not singles or singles[0].total > nominal.total - self.worth:
            return [nominal, *singles]
        nominal, singles = resolved(self.fitter, nominal, singles, self.tell)
        if not is_right(self.comparison, nominal.residual):
            # Only in shorter steps it shows that it is wrong.
            return self._of_strong(nominal)
        singles = settled(self.fitter, singles, self.tell, OWN, MOST_OWN)
        if singles[0].total > nominal.total - self.worth:
            return concluded(self.fitter, nominal, singles, self.seed, self.tell)
        # What moves little near neutral may do much far away, and the same as what leads.
        singles = settled(self.fitter, self._elsewhere(singles, ()), self.tell)
        singles = all_shaken(self.fitter, singles, self.seed, self.tell)
        made = self._with_shaken_pair(singles, self.pairing.found(singles, strong=False))
        return concluded(self.fitter, nominal, made, self.seed, self.tell)

    def _of_strong(self, nominal: Contender) -> list[Contender]:
        """Search in longer steps, and hold what is found in the right ones.

        A strong cause moves the robot by much more than the longer steps get wrong. Where it does not, so that they
        show no gap or nothing that is worth a look, the right ones are searched.
        """
        found = self._in_longer_steps() or self._far_and_wide(nominal)
        if not found:
            return [nominal]
        made = self._in_short_steps(found)
        self.fitter.take_likeliest_noise(())
        return concluded(self.fitter, of_nominal(self.fitter), made, self.seed, self.tell)

    def _in_longer_steps(self) -> list[Contender]:
        """Return what a search in longer steps finds, the likeliest first; nothing where they hide the gap."""
        steps, found = list(self.comparison.simulator.step_s), []
        with self.comparison.in_longer_steps():
            longer = self.comparison.simulator.step_s != steps
            self.fitter.take_likeliest_noise(())
            nominal = of_nominal(self.fitter)
            if not is_right(self.comparison, nominal.residual):
                found = self._far_and_wide(nominal)
                # Steps may have been halved for what leads, with the noise.
                self.fitter.take_likeliest_noise(())
                if longer and found and found[0].total > of_nominal(self.fitter).total - self.worth:
                    found = []
        self.fitter.take_likeliest_noise(())
        return found

    def _in_short_steps(self, found: Sequence[Contender]) -> list[Contender]:
        """Hold what was found in those of the moment, if it was in longer ones, and fit the best on."""
        self.comparison.halve_steps_for(found[0].effects)
        self.fitter.take_likeliest_noise(found[0].effects)
        # What came near the best counts against its own noise here too.
        near = found[0].total + self.comparison.objective_of(NEAR)
        held = again(self.fitter, [c if c.total <= near else replace(c, settled=False) for c in found])
        made = settled(self.fitter, held, self.tell, fitted=True)
        made = likeliest_first([shaken(self.fitter, made[0], self.seed, self.tell), *made[1:]])
        made = self._guided(made)
        if len(made[0].names) == 1:
            return made
        singles, pairs = ([c for c in made if len(c.names) == count] for count in (1, 2))
        # Where in longer steps another led, it was the effects of that which were exchanged.
        if set(pairs[0].names) != set(found[0].names) and self.pairing.is_named(pairs[0], singles[0]):
            exchanged = self.pairing.exchanged(pairs, singles)
            if exchanged[0].names != pairs[0].names:
                exchanged[0] = shaken(self.fitter, exchanged[0], self.seed, self.tell)
            made = likeliest_first([*singles, *exchanged])
        single = nested(self.fitter, singles[0], made[:1])
        return likeliest_first([single, *(c for c in made if c is not singles[0])])

    def _guided(self, made: Sequence[Contender]) -> list[Contender]:
        """Search around the best again by runs drawn to the tracks, where there are many minima and a gap is left."""
        many = {h.names[0] for h in self.possible if len(h.close) > len(h.starts)}
        if many.isdisjoint(made[0].names) or not is_wanting(self.comparison, made[0].residual):
            return list(made)
        which = [k for k, contender in enumerate(made) if not many.isdisjoint(contender.names)][:_GUIDED]
        return likeliest_first(found_again(self.fitter, made, which, self.seed, self.tell))

    def _far_and_wide(self, nominal: Contender) -> list[Contender]:
        """Search over the whole ranges, add second effects, look for what does the same; the likeliest first."""
        singles, worth = self._singles(nominal), nominal.total - self.worth
        if not singles or singles[0].total > worth:
            return singles
        nominal, singles = resolved(self.fitter, nominal, singles, self.tell)
        singles = settled(self.fitter, singles, self.tell, OWN, MOST_OWN)
        singles = all_shaken(self.fitter, singles, self.seed, self.tell)
        pairs: list[Contender] = []
        searched: set[tuple[str, ...]] = set()
        worth = nominal.total - self.worth
        if is_wanting(self.comparison, singles[0].residual):
            searched = {singles[k].names for k in to_refine(singles, _REFINED)}
            singles = settled(self.fitter, self._refined(singles), self.tell)
        if singles[0].total <= worth:
            singles, pairs = self._with_moved(singles, self.pairing.found(singles, strong=True))
        # Where two effects leave no gap, what is far away is not looked for.
        if not is_enough(self.comparison, [*singles, *pairs]):
            far = settled(self.fitter, self._far(singles, searched), self.tell)
            near, singles = singles, far
            more = self.clear if near[0].names != far[0].names else max(self.clear, _FARTHER * far[0].cost)
            untried = near[0].total > worth
            if far[0].total <= worth and (untried or near[0].total - far[0].total > more):
                # Of what is in the best pair, and less likely by itself even so far away, much has been tried.
                paired = pairs and far[0].names[0] in pairs[0].names and pairs[0].total < far[0].total
                pairs = (
                    self.pairing.beside(far[0], singles, pairs)
                    if paired
                    else self.pairing.found(singles, strong=True, known=pairs)
                )
        elif not (pairs and pairs[0].total < singles[0].total - self.worth):
            singles = settled(self.fitter, self._elsewhere(singles, searched), self.tell)
        made = self._with_shaken_pair(singles, pairs) if singles[0].total <= worth else [*singles, *pairs]
        made = likeliest_first(made)
        return with_counterparts(self.fitter, made, self.possible, self.tell) if made[0].total <= worth else made

    def _with_moved(
        self, singles: Sequence[Contender], pairs: Sequence[Contender]
    ) -> tuple[list[Contender], list[Contender]]:
        """Fit the best pair's effects again from where they are in it, and add seconds to what is far better there.

        What the seconds were first added to was in the wrong place.
        """
        made, found = list(singles), list(pairs)
        for k, single in enumerate(singles):
            if not pairs or single.names[0] not in pairs[0].names:
                continue
            alone = single if single.settled else by_itself(self.fitter, single, evaluations=1)
            made[k] = moved = nested(self.fitter, alone, pairs[:1])
            farther = alone.total - moved.total > max(self.clear, _FARTHER * moved.cost)
            if farther and moved in firsts(likeliest_first(made)):
                found = self.pairing.beside(moved, likeliest_first(made), found)
        return likeliest_first(made), found

    def _with_shaken_pair(self, singles: Sequence[Contender], pairs: Sequence[Contender]) -> list[Contender]:
        """Look around the best pair, and for its best single effect again from there."""
        if not pairs:
            return list(singles)
        pairs = likeliest_first([shaken(self.fitter, pairs[0], self.seed, self.tell), *pairs[1:]])
        return likeliest_first([nested(self.fitter, singles[0], pairs[:1]), *singles[1:], *pairs])

    def _far(self, singles: Sequence[Contender], searched: Collection[tuple[str, ...]]) -> list[Contender]:
        """Search far away for those that no local fit can be trusted with, but for those that were searched so."""
        made = list(singles)
        self.tell("points over the whole range", _REFINED, _REFINED)
        self.fitter.take_likeliest_noise(made[0].effects)
        few = [k for k, c in enumerate(made) if c.free <= MANY and c.names not in searched]
        promises = {k: promise(self.fitter, made[k], self.seed) for k in few}
        promising = sorted(few, key=lambda k: -promises[k])[:_PROMISING]
        for k, contender in enumerate(made):
            many = contender.free > MANY and contender.names not in searched
            if many or (k in promising and promises[k] > self.clear):
                made[k] = from_beginnings(self.fitter, contender, self.possible, self.seed)
        return likeliest_first(made)

    def _elsewhere(self, singles: Sequence[Contender], searched: Collection[tuple[str, ...]]) -> list[Contender]:
        """Search far away for effects of one strength too where another leaves no gap: one of them may be the cause.

        Those are fitted that follow the beginnings of the trials about as well.
        """
        made, best = list(singles), singles[0]
        self.tell("points over the whole range", 0, 1)
        self.fitter.take_likeliest_noise(best.effects)
        goal = beginning(self.fitter, best)
        for k, contender in enumerate(made):
            if k == 0 or contender.names in searched:
                continue
            assert contender.fit is not None
            if contender.fit.hypothesis.strengths > 1:
                continue
            wanted = (1.0 - AS_GOOD) * (beginning(self.fitter, contender) - goal)
            if promise(self.fitter, contender, self.seed) > max(self.clear, wanted):
                other = from_beginnings(self.fitter, contender, self.possible, self.seed)
                known = contender if contender.settled else by_itself(self.fitter, contender, evaluations=1)
                made[k] = likeliest([known, by_itself(self.fitter, other, IDLE_POINTS)])
                self.fitter.take_likeliest_noise(best.effects)
        return likeliest_first(made)

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
                if fitter.cost(residual, point) < made[k].cost + self.clear:
                    other = of_fit(fitter, fitter.fit(hypothesis, point, evaluations=_LEADING_POINTS))
                    made[k] = likeliest([made[k], other])
        return made

    def _refined(self, singles: Sequence[Contender]) -> list[Contender]:
        return refined(self.fitter, singles, _REFINED, self.possible, self.seed, self.tell)
