"""`with_counterparts`: other effects from where they do what the best one does.

Where an effect is strong, another that does the same has its best in a narrow valley far from neutral, which points
over the range miss. But what the first does is known, also at a share s of its strength, where both are linear: with r
the whitened differences, R what else is at work, and J the derivatives by the other's parameters q at neutral,

```text
t_s = r(R + s E) - r(R),      q_s = argmin_q |t_s - s J q|²
```

is about where the other does what the first does (Gauss and Newton's step from neutral, towards another model's motion
and not towards the data). So it is with each of the other's parameters alone: most causes need one or two numbers, and
with all of them a fit may end where one stands for what the linear step got wrong of another.

What does about as well there is fitted to the data from there: of two effects that do the same, neither is to lead
because the other was looked for in the wrong place.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...effects.base import Effect
from ...progress import OnPhase
from ..fitting.fit import Fit
from ..fitting.fitter import Fitter
from ..fitting.hypothesis import Hypothesis
from ..gap.predictive import is_wanting
from .contender import Contender, likeliest, likeliest_first
from .margins import AS_GOOD, ENOUGH
from .own_noise import IDLE_POINTS, against_itself, settled_at
from .step_credit import step_credit

__all__ = ["Counterpart", "as_good", "counterparts", "with_counterparts"]

Floats = NDArray[np.float64]

# Shares of the effect's strength: thresholds show only in the greater ones, and the least is the most linear.
_SHARES = (0.05, 0.25, 1.0)
# Of the first derivatives, in u; an effect of more parameters than this does a part of almost anything.
_STEP, _MOST_FREE = 1e-2, 5
# Where the other explains less of what the first does (of its sum of squares), it is no counterpart. A choice.
_EXPLAINED = 0.5
# Effects in the place of one that are fitted, in so many trial points, and how often the best may change by it.
_FITTED, _POINTS, _ROUNDS = 3, 4, 2


class Counterpart(NamedTuple):
    """Another effect in the place of one.

    Attributes
    ----------
    cost
        The objective there, against the noise around what has the one, without credit for its step.
    hypothesis
        What else is at work, and the other.
    point
        As u, shape (p,).
    """

    cost: float
    hypothesis: Hypothesis
    point: Floats


def with_counterparts(
    fitter: Fitter, contenders: Iterable[Contender], possible: Sequence[Hypothesis], tell: OnPhase
) -> list[Contender]:
    """Fit other effects from where they do what the best, or one of the best pair, does; the likeliest first.

    A pair may lead that adds less than a second effect must: where the best single effect leaves no gap, it is the
    one that others have to do the same as.

    Parameters
    ----------
    fitter
        Of the dataset.
    contenders
        One or two effects each, at least one of them single.
    possible
        Every effect by itself.
    tell
        Is told the phase, how much of it is done, and of how much.
    """
    made = {frozenset(contender.names): contender for contender in contenders}
    for k in range(_ROUNDS):
        tell("what else does the same", k, _ROUNDS)
        best, single = likeliest(made.values()), likeliest(c for c in made.values() if len(c.names) == 1)
        whole = best is single or is_wanting(fitter.comparison, single.residual)
        for contender in [best] if whole else [best, single]:
            _add_counterparts(fitter, contender, possible, made)
        if likeliest(made.values()) is best:
            break
    return likeliest_first(made.values())


def _add_counterparts(
    fitter: Fitter, best: Contender, possible: Sequence[Hypothesis], made: dict[frozenset[str], Contender]
) -> None:
    """Keep the counterparts of a contender that are better than what is known of the same effects."""
    assert best.fit is not None
    enough = fitter.comparison.objective_of(ENOUGH)
    for kind in best.fit.hypothesis.kinds:
        those = as_good(fitter, best, kind, possible)
        first = list(dict.fromkeys(c.hypothesis.names for c in those))[:_FITTED]
        # All against the noise around the contender.
        fits = [fitter.fit(c.hypothesis, c.point, evaluations=_POINTS) for c in those if c.hypothesis.names in first]
        fits.sort(key=lambda fit: fit.cost)
        for fit in [fit for fit in fits if _is_better(fitter, fit, made.get(frozenset(fit.hypothesis.names)))]:
            # Each against its own.
            other = settled_at(fitter, fit.hypothesis, fit.point, IDLE_POINTS, fit.steps)
            known = made.get(frozenset(other.names))
            if known is not None and known.fit is not None and not known.settled:
                known = against_itself(fitter, known.fit)
            if known is None or other.total < known.total - enough:
                made[frozenset(other.names)] = other


def _is_better(fitter: Fitter, fit: Fit, known: Contender | None) -> bool:
    """Return whether a fit is better than what is known of the same effects, against the noise of the moment."""
    if known is None or known.fit is None:
        return True
    return fit.cost <= fitter.again(known.fit).cost - fitter.comparison.objective_of(ENOUGH)


def as_good(
    fitter: Fitter, contender: Contender, kind: type[Effect], possible: Sequence[Hypothesis]
) -> list[Counterpart]:
    """Return the counterparts that do enough of what the contender does about the data, the likeliest first.

    Leaves the noise around the contender.

    Parameters
    ----------
    fitter, contender, kind, possible
        As in `counterparts`.
    """
    assert contender.fit is not None
    those = counterparts(fitter, contender, kind, possible)
    nominal, here = fitter.nominal()[1], fitter.again(contender.fit).cost + contender.step_credit
    worst = here + AS_GOOD * max(nominal - here, 0.0)
    return [counterpart for counterpart in those if counterpart.cost < worst]


def counterparts(
    fitter: Fitter, contender: Contender, kind: type[Effect], possible: Sequence[Hypothesis]
) -> list[Counterpart]:
    """Return the effects that do about what one effect of a contender does, the likeliest first.

    An effect is there by all of its parameters, and by the one of them that does it best alone.

    Leaves the noise around the contender.

    Parameters
    ----------
    fitter
        Of the dataset.
    contender
        One or two effects.
    kind
        The one of them that is exchanged.
    possible
        Every effect by itself.
    """
    assert contender.fit is not None
    whole, point = contender.fit.hypothesis, contender.point
    mine = np.array([name == kind.name for name, _ in whole.keys])
    rest = [h for h in possible if h.names[0] in contender.names and h.kinds != (kind,)]
    others = [h for h in possible if h.names[0] not in contender.names and 0 < h.free <= _MOST_FREE]
    fitter.take_likeliest_noise(contender.effects)
    # A wavelength or an exponent stays what it is however weak the effect.
    weaker = [np.where(mine, whole.weakened(point, share), point) for share in _SHARES]
    still, *moved = fitter.residuals(whole, [np.where(mine, 0.0, point), *weaker])
    weights = fitter.weights(moved[-1], fitter.trials)
    here = weights * still.over(fitter.trials)
    wanted = [weights * residual.over(fitter.trials) - here for residual in moved]
    found = []
    for other in others:
        hypothesis = rest[0] + other if rest else other
        base = np.concatenate([point[~mine], np.zeros(len(other.neutral))])
        for guesses in _guesses(fitter, hypothesis, base, len(other.neutral), weights, here, wanted):
            costs = [
                fitter.cost(r, p) + step_credit(fitter, hypothesis.effects(p))
                for r, p in zip(fitter.residuals(hypothesis, guesses), guesses, strict=True)
            ]
            if costs:
                best = int(np.argmin(costs))
                found.append(Counterpart(costs[best], hypothesis, guesses[best]))
    return sorted(found, key=lambda counterpart: counterpart.cost)


def _guesses(
    fitter: Fitter,
    hypothesis: Hypothesis,
    base: Floats,
    count: int,
    weights: Floats,
    here: Floats,
    wanted: Sequence[Floats],
) -> tuple[list[Floats], list[Floats]]:
    """Return by share where the last parameters do what is wanted, where they can: all of them, and each alone.

    Parameters
    ----------
    fitter, hypothesis
        What is simulated.
    base
        The point from which the last `count` parameters move, shape (p,).
    count
        How many move.
    weights
        Of the differences, shape (n,).
    here
        Weighted differences at the base, shape (n,).
    wanted
        By share, what the first effect changes, shape (n,).
    """
    last = np.arange(len(base) - count, len(base))
    free = [int(j) for j in last if hypothesis.high[j] > hypothesis.low[j]]
    signed = [_STEP if hypothesis.high[j] >= -hypothesis.low[j] else -_STEP for j in free]
    points = [base + h * np.eye(len(base))[j] for h, j in zip(signed, free, strict=True)]
    changed = fitter.residuals(hypothesis, points)
    table = np.column_stack(
        [(weights * r.over(fitter.trials) - here) / h for r, h in zip(changed, signed, strict=True)]
    )
    together, alone = list(range(len(free))), [[j] for j in range(len(free))] if len(free) > 1 else []

    def where(those: list[int]) -> list[Floats]:
        made = []
        for share, target in zip(_SHARES, wanted, strict=True):
            moves = np.linalg.lstsq(table[:, those], target, rcond=1e-6)[0]
            left = float(np.sum((target - table[:, those] @ moves) ** 2))
            if left < (1.0 - _EXPLAINED) * float(np.sum(target**2)):
                guess = base.copy()
                guess[[free[j] for j in those]] += moves / share
                made.append(np.clip(guess, hypothesis.low, hypothesis.high))
        return made

    return where(together), [guess for those in alone for guess in where(those)]
