"""Contenders against the noise around themselves, and around the best.

The noise around a hypothesis is what moves its paths (`Floor`). Another's may flatter a contender, or wrong it, so that
what counts is held against its own. Near a threshold, though, the noise around two hypotheses that say the same can
differ by much: to what comes near the best, and says the same, the noise around the best is lent where it is likelier
against it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import inf

import numpy as np
from numpy.typing import NDArray

from ...progress import OnPhase
from ..fitting.fit import Fit
from ..fitting.fitter import Fitter
from ..fitting.hypothesis import Hypothesis
from .contender import Contender, likeliest_first, of_fit, of_nominal, parsimonious_total
from .margins import CLEAR, ENOUGH, NEAR

__all__ = [
    "IDLE_POINTS",
    "MOST_OWN",
    "OWN",
    "POLISH_POINTS",
    "again",
    "against_itself",
    "against_the_best",
    "beside",
    "by_itself",
    "each_by_itself",
    "lead_around",
    "settled",
    "settled_at",
]

Floats = NDArray[np.float64]

# Trial points of a fit that has only to follow another noise, and of a good one that is taken further.
IDLE_POINTS, POLISH_POINTS = 2, 6
# Effects that are held against their own noise before one counts as best, and how many where that gains much.
OWN, MOST_OWN = 4, 6
# How many of other fits are (the defaults of `settled`), and how often it is measured after a further fit at most.
_SETTLED, _ROUNDS = 2, 2
# What another may gain by its own noise, over the most that one has gained: at one threshold, in a dataset whose truth
# was known, five effects gained 640 to 790.
_AS_MUCH = 1.5
# What comes near to the best is held against its own noise, so many at most.
_MOST_NEAR = 6


def again(fitter: Fitter, contenders: Sequence[Contender]) -> list[Contender]:
    """Hold the same fits against the noise of the moment, or their own; the likeliest first.

    Their own is for what was settled, or near the best by its own when that one's was lent to it.

    None of them counts as settled. The noise may be left around any of them.

    Parameters
    ----------
    fitter
        Of the dataset, in other steps than before.
    contenders
        The nominal model among them is left out.
    """
    own = [contender.settled or contender.lent for contender in contenders]
    made = [of_fit(fitter, fitter.again(c.fit)) for c, by in zip(contenders, own, strict=True) if c.fit and not by]
    # At a threshold, which another step moves, the point itself may look hopeless against the nominal model's.
    made += [against_itself(fitter, c.fit) for c, by in zip(contenders, own, strict=True) if c.fit and by]
    return likeliest_first(made)


def against_itself(fitter: Fitter, fit: Fit) -> Contender:
    """Hold a fit against its own noise, which is left around it.

    Parameters
    ----------
    fitter
        Of the dataset.
    fit
        Found against any noise.
    """
    fitter.take_likeliest_noise(fit.hypothesis.effects(fit.point))
    return of_fit(fitter, fitter.again(fit))


def settled(
    fitter: Fitter,
    contenders: Sequence[Contender],
    tell: OnPhase,
    count: int = _SETTLED,
    most: int = _SETTLED,
    fitted: bool = False,
) -> list[Contender]:
    """Hold the best against their own noise and fit them on; the best first, and the leader always settled.

    The noise around one may be much more than that around another: near a threshold, what looks far behind may gain as
    much by its own as the best did.

    Parameters
    ----------
    fitter
        Of the dataset.
    contenders
        Without the nominal model.
    tell
        Is told the phase, how much of it is done, and of how much.
    count
        How many of the best are held so.
    most
        How many at most where others would lead if they gained about as much by it.
    fitted
        Whether they were fitted before, in other steps: what leads after `most`, flattered by the noise around
        another, is then fitted on only if it still leads against its own.
    """
    made = likeliest_first(contenders)
    held: set[Contender] = set()
    gain, done = 0.0, 0
    while (k := next((k for k, contender in enumerate(made) if not contender.settled), None)) is not None:
        leading = min((contender.total for contender in made if contender.settled), default=inf)
        if k > 0 and (done >= most or (k >= count and made[k].total - _AS_MUCH * gain >= leading)):
            break
        tell("another look at the best", min(done, most), most)
        before = made[k]
        if not fitted or done < most or before in held:
            made[k] = _settled(fitter, before)
            gain = max(gain, before.total - made[k].total)
            done += 1
        else:
            assert before.fit is not None
            made[k] = against_itself(fitter, before.fit)
            held.add(made[k])
        made = likeliest_first(made)
    return made


def _settled(fitter: Fitter, contender: Contender) -> Contender:
    """Hold a fit against its own noise, and fit it on as long as that helps."""
    assert contender.fit is not None
    best = against_itself(fitter, contender.fit)
    enough = fitter.comparison.objective_of(ENOUGH)
    for _ in range(_ROUNDS):
        assert best.fit is not None
        fit = fitter.fit(best.fit.hypothesis, best.point, evaluations=POLISH_POINTS, steps=best.fit.steps)
        other = against_itself(fitter, fit) if fit.cost < best.cost - enough else best
        if other.total >= best.total:
            break
        best = other
    assert best.fit is not None
    # The derivatives where it is, against its own noise.
    return by_itself(fitter, best, evaluations=1)


def each_by_itself(fitter: Fitter, contenders: Sequence[Contender], tell: OnPhase) -> list[Contender]:
    """Hold what comes near the best against its own noise too: another's may flatter it, or wrong it.

    The best is the one that will lead: a pair is only if it adds as much as a second effect must.

    Parameters
    ----------
    fitter
        Of the dataset.
    contenders
        Without the nominal model.
    tell
        Is told the phase, how much of it is done, and of how much.

    Returns
    -------
    list
        The same, what leads first, which is settled.
    """

    def best_first(those: Sequence[Contender]) -> list[Contender]:
        return sorted(those, key=lambda contender: parsimonious_total(contender, fitter.comparison))

    made = best_first(contenders)
    count = 0
    # Where all of the nearest lost by it, the leader may be one that has not been held so.
    while count < _MOST_NEAR or not made[0].settled:
        far = made[0].total + fitter.comparison.objective_of(NEAR)
        waiting = [k for k, contender in enumerate(made) if not contender.settled and contender.total <= far]
        if not waiting:
            break
        tell("each against its own noise", min(count, _MOST_NEAR), _MOST_NEAR)
        made[waiting[0]] = by_itself(fitter, made[waiting[0]], IDLE_POINTS)
        made = best_first(made)
        count += 1
    return made


def by_itself(fitter: Fitter, contender: Contender, evaluations: int) -> Contender:
    """Hold a contender against its own noise and fit it on, its derivatives where it ends.

    Leaves the noise around it.

    Parameters
    ----------
    fitter
        Of the dataset.
    contender
        Not the nominal model.
    evaluations
        Trial points of the fit at most; of one, only the derivatives are taken.
    """
    assert contender.fit is not None
    return settled_at(fitter, contender.fit.hypothesis, contender.point, evaluations, contender.fit.steps)


def settled_at(
    fitter: Fitter, hypothesis: Hypothesis, point: Floats, evaluations: int = 1, steps: Floats | None = None
) -> Contender:
    """Hold a hypothesis at a point against its own noise there and fit it on, its derivatives where it ends.

    Leaves the noise around that point.

    Parameters
    ----------
    fitter
        Of the dataset.
    hypothesis, point
        Some effects at work.
    evaluations
        Trial points of the fit at most; of one, only the derivatives are taken.
    steps
        Of the first derivatives.
    """
    fitter.take_likeliest_noise(hypothesis.effects(point))
    return replace(of_fit(fitter, fitter.fit(hypothesis, point, evaluations=evaluations, steps=steps)), settled=True)


def against_the_best(fitter: Fitter, nominal: Contender, contenders: Sequence[Contender]) -> list[Contender]:
    """Hold all that come near the best against its noise too; of those that say the same, keep what is likelier.

    Near a threshold the noise around two hypotheses that say the same can differ by much. What is better than another
    has to be so against one noise. What is near only by the noise of the moment is held against its own.

    Parameters
    ----------
    fitter
        Of the dataset.
    nominal
        The nominal model.
    contenders
        The others, the best first.
    """
    best = contenders[0]
    made = [best]
    for contender in (nominal, *contenders[1:]):
        near = contender.total <= best.total + fitter.comparison.objective_of(NEAR)
        made.append(_lent(fitter, contender, best) if near else contender)
    return made


def _lent(fitter: Fitter, contender: Contender, best: Contender) -> Contender:
    """Return a contender against the noise around the best where that may be lent to it, else against its own."""
    # An effect that does nothing would else look as good as the best by the best's noise, and the nominal model not.
    own = contender if contender.settled or not contender.names else beside(fitter, contender, contender)
    if own.total > best.total + fitter.comparison.objective_of(NEAR):
        return own
    other = beside(fitter, own, best)
    if other.total < own.total and _says_the_same(fitter, own, best, other):
        return _with_slopes(fitter, other, best)
    return own if own.settled or own.fit is None else by_itself(fitter, own, evaluations=1)


def _with_slopes(fitter: Fitter, lent: Contender, around: Contender) -> Contender:
    """Return a contender against the noise around another, its derivatives against that too.

    It does not count as settled: in shorter steps, or after another has led, it is held against its own noise first.
    """
    if lent.fit is None:
        return lent
    fitter.take_likeliest_noise(lent.effects, around.effects)
    fit = fitter.fit(lent.fit.hypothesis, lent.point, evaluations=1, steps=lent.fit.steps)
    return replace(of_fit(fitter, fit), lent=True)


def _says_the_same(fitter: Fitter, contender: Contender, best: Contender, lent: Contender) -> bool:
    """Return whether a contender is about as near to the best against its own noise as against the best's.

    What the best changes moves more easily where it is at work: its noise may hide the very gap that it closes.
    """
    own = beside(fitter, contender, contender)
    clear = fitter.comparison.objective_of(CLEAR)
    return own.total - beside(fitter, best, contender).total < lent.total - best.total + clear


def lead_around(fitter: Fitter, contender: Contender, other: Contender) -> float:
    """Return by how much a contender's total is less than another's against the noise around that.

    The noise is as before.

    Parameters
    ----------
    fitter
        Of the dataset.
    contender, other
        Neither is the nominal model. Both are fitted on against that noise: a fit has followed its own.
    """
    floors = fitter.comparison.floors
    totals = []
    for one in (other, contender):
        held = beside(fitter, one, other)
        assert held.fit is not None
        fit = fitter.fit(held.fit.hypothesis, held.point, evaluations=POLISH_POINTS, steps=held.fit.steps)
        totals.append(min(held.total, of_fit(fitter, fit).total))
    fitter.comparison.floors = floors
    return totals[0] - totals[1]


def beside(fitter: Fitter, contender: Contender, around: Contender) -> Contender:
    """Hold a contender against the noise around another.

    Parameters
    ----------
    fitter
        Of the dataset.
    contender, around
        Either may be the nominal model.
    """
    fitter.take_likeliest_noise(contender.effects, around.effects)
    if contender.fit is None:
        return of_nominal(fitter)
    return replace(of_fit(fitter, fitter.again(contender.fit)), settled=contender.settled)
