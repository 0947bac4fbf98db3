"""`concluded`: every contender in the steps, against the noise, and fitted as far, that what is concluded asks for.

The steps are chosen for the leader, and chosen anew where one that leads later cannot run in them. What comes near the
best is held against the noise around itself, what may be as good is fitted as far as the best, and what says the same
is lent the best's noise.
"""

from __future__ import annotations

from collections.abc import Sequence

from ...progress import OnPhase
from ..fitting.fitter import Fitter
from ..fitting.hypothesis import Hypothesis
from .contender import Contender, likeliest, likeliest_first, of_nominal, parsimonious_total
from .counterpart import as_good
from .margins import AS_GOOD, CLEAR, OPEN
from .nearby import all_shaken
from .own_noise import MOST_OWN, OWN, again, against_the_best, by_itself, each_by_itself, settled, settled_at
from .pairs import nested
from .sparse import as_far

__all__ = ["concluded", "in_steps_of", "resolved"]

# What is open, or as good by `AS_GOOD`, is fitted as far, so many single effects and pairs at most by the noise of the
# first, and so many single effects more by their own.
_EQUALLY_FAR, _PAIRS_EQUALLY_FAR, _OWN_EQUALLY_FAR = 3, 4, 1


def in_steps_of(
    fitter: Fitter, leader: Contender, contenders: Sequence[Contender], seed: int, tell: OnPhase
) -> list[Contender]:
    """Return the nominal model and the others again, in steps that are short enough for one of them.

    Parameters
    ----------
    fitter
        Of the dataset.
    leader
        One of the contenders.
    contenders
        What a search found, the nominal model among them.
    seed
        Of the points around fits.
    tell
        Is told the phase, how much of it is done, and of how much.
    """
    nominal = next(c for c in contenders if not c.names)
    others = [c for c in contenders if c.names and c.names != leader.names]
    return concluded(fitter, nominal, [leader, *others], seed, tell)


def concluded(
    fitter: Fitter, nominal: Contender, contenders: Sequence[Contender], seed: int, tell: OnPhase
) -> list[Contender]:
    """Return the nominal model and all others, each against the noise that counts.

    Parameters
    ----------
    fitter
        Of the dataset.
    nominal
        The nominal model.
    contenders
        The others, the leader first.
    seed
        Of the points around fits.
    tell
        Is told the phase, how much of it is done, and of how much.
    """
    while True:
        nominal, made = resolved(fitter, nominal, contenders, tell)
        contenders = _equally_far(fitter, each_by_itself(fitter, made, tell), seed, tell)
        # Against its own noise another may lead, which asks by itself for shorter steps still.
        if fitter.comparison.simulator.resolves(contenders[0].effects):
            return against_the_best(fitter, nominal, contenders)


def resolved(
    fitter: Fitter, nominal: Contender, contenders: Sequence[Contender], tell: OnPhase
) -> tuple[Contender, list[Contender]]:
    """Return the nominal model and the others in steps that are short enough for the leader.

    Parameters
    ----------
    fitter
        Of the dataset.
    nominal
        The nominal model.
    contenders
        The others, the leader first.
    tell
        Is told the phase, how much of it is done, and of how much.
    """
    made = list(contenders)
    # What moves so in one step and not in half of it is no motion of the model, and speaks for nothing.
    while fitter.comparison.halve_steps_for(made[0].effects):
        fitter.take_likeliest_noise(())
        nominal = of_nominal(fitter)
        made = settled(fitter, again(fitter, made), tell, OWN, MOST_OWN, fitted=True)
    return nominal, made


def _equally_far(fitter: Fitter, contenders: Sequence[Contender], seed: int, tell: OnPhase) -> list[Contender]:
    """Fit what may be as good as the best as far as that, without what it does not need, and from where the best is."""
    comparison = fitter.comparison
    made = sorted(contenders, key=lambda contender: parsimonious_total(contender, comparison))
    best, (pairs, singles) = made[0], _near_the_first(fitter, made)
    if not pairs and not singles:
        return made
    for n, k in enumerate([*pairs, *singles]):
        tell("fitting those near the best as far", n, len(pairs) + len(singles))
        if k in singles:
            alone = made[k] if made[k].settled else by_itself(fitter, made[k], evaluations=1)
            made[k] = nested(fitter, alone, [c for c in made if len(c.names) > 1])
        made[k] = as_far(fitter, made[k], comparison.alike)
    each = [c.fit.hypothesis for c in made if c.fit is not None and len(c.names) == 1]
    pairs, singles = (sorted(those, key=lambda k: made[k].total) for those in (pairs, singles))
    behind = [(k, singles[0]) for k in singles[1:]]
    # Where one effect leads, what others do beside it is not concluded from; and a pair that is as good is as far.
    if len(best.names) > 1:
        clear = made[pairs[0]].total + comparison.objective_of(CLEAR)
        behind += [(k, pairs[0]) for k in pairs[1:] if made[k].total > clear]
    for n, (k, leading) in enumerate(behind):
        tell("from where the best is", n, len(behind))
        made[k] = _from_counterparts(fitter, made[k], made[leading], each)
    if len(best.names) == 1 and len(singles) > 1:
        # Where motion hops a fit stops on one side of a hop.
        around = all_shaken(fitter, likeliest_first(made[k] for k in singles), seed, tell, OPEN)
        made = [*around, *(contender for k, contender in enumerate(made) if k not in singles)]
    # A pair that adds less than a second effect must neither leads nor lends its noise: that would favour its own parts
    # before others that do the same.
    return sorted(made, key=lambda contender: parsimonious_total(contender, comparison))


def _near_the_first(fitter: Fitter, contenders: Sequence[Contender]) -> tuple[list[int], list[int]]:
    """Return the places of pairs and of single effects that may be as good as the first; none where it is alone.

    Leaves the noise around the first.
    """
    comparison, best = fitter.comparison, contenders[0]
    scores = [parsimonious_total(c, comparison) for c in contenders]
    open_to = scores[0] + comparison.objective_of(OPEN)
    # All against one noise: what does as the best does may have stopped beside its valley.
    fitter.take_likeliest_noise(best.effects)
    costs = [fitter.again(c.fit).cost + c.step_credit for c in contenders if c.fit is not None]
    worst = costs[0] + AS_GOOD * max(fitter.nominal()[1] - costs[0], 0.0)
    near = [
        k
        for k, (contender, cost) in enumerate(zip(contenders, costs, strict=True))
        if scores[k] < open_to or (len(contender.names) <= len(best.names) and cost < worst)
    ]
    if len(near) == 1:
        return [], []
    # Pairs fit better, and must not take the places of what may be named instead of them; nor must what another's noise
    # flatters.
    pairs = [k for k in near if len(contenders[k].names) > 1]
    singles = sorted((k for k in near if len(contenders[k].names) == 1), key=lambda k: (k != 0, costs[k]))
    # Nor must the noise of the first hide what is near by its own.
    waiting = singles[_EQUALLY_FAR:]
    own = [k for k in waiting if contenders[k].settled and scores[k] < open_to]
    singles = singles[:_EQUALLY_FAR] + sorted(own, key=lambda k: scores[k])[:_OWN_EQUALLY_FAR]
    return pairs[:_PAIRS_EQUALLY_FAR], singles


def _from_counterparts(fitter: Fitter, contender: Contender, best: Contender, each: Sequence[Hypothesis]) -> Contender:
    """Fit what shares all effects but one with the best also from where it does the same, and return what is likelier.

    Parameters
    ----------
    fitter
        Of the dataset.
    contender, best
        As many effects each.
    each
        Effects by themselves, all of the contender's among them.
    """
    assert best.fit is not None
    lacks = [kind for kind in best.fit.hypothesis.kinds if kind.name not in contender.names]
    if len(lacks) != 1:
        return contender
    mine = [hypothesis for hypothesis in each if hypothesis.names[0] in contender.names]
    for c in as_good(fitter, best, lacks[0], mine):
        from_there = as_far(fitter, settled_at(fitter, c.hypothesis, c.point), fitter.comparison.alike)
        contender = likeliest([contender, from_there])
    return contender
