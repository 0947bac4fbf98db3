"""Occam's factor: what a hypothesis pays for the parameters that it might have used otherwise.

A cause has a few numbers, and most real ones need some of them: a tilt leans one way, a gradient points along one axis,
a friction differs along the grain alone. The prior is a spike at neutral and a slab beside it (Mitchell and Beauchamp
1988): any set S of an effect's optional parameters may be neutral as long as the effect still acts, all sets being as
probable; but where an effect has parameters of its form, the sets with one of these at work share `FORM_SHARE` of the
prior, and the others share the rest. It acts if it moves what was measured: the prior is that of what makes a gap, and
a friction across a way that no trial leaves makes none. The fit's û minimizes -2 ln likelihood + |u|²/σ_u², of which
the likelihood alone is tempered by c. With the slab u ~ N(0, σ_u² 1), C⁻¹ = JᵀJ/c + 1/σ_u² and the slope -g of the
tempered posterior's exponent at û, its mean m and its integral are Laplace's,

```text
g = (1 - 1/c) û/σ_u²,      m = û - C g
ln Z = -(cost)/(2c) - ½ (1 - 1/c) |û|²/σ_u² + ½ gᵀ C g - ½ ln det(σ_u² C⁻¹)
```

and Savage's and Dickey's ratio gives those of the sets (Dickey 1971):

```text
ln Z_S - ln Z = ln N(0; m_S, C_SS) - ln N(0; 0, σ_u² 1)
ln Occam      = ln Z + cost/(2c) + ln (Σ_S P(S) Z_S / Z)
```

so that a parameter which the data know to be about zero costs its place among the sets alone, and one that they know to
be something else costs what it does without a spike. One that rests at neutral (`Hypothesis.rests`) has no slope that
the data could speak of: there it is neutral, and sets in which it is not have Z_S = 0.

No parameter costs more than if the slab were what one of n numbers says of it (the unit information prior; Kass and
Wasserman 1995, JASA 90, 928, and so Schwarz's criterion): with the eigenvalues λ of σ_u² (C⁻¹)_FF, F what is not in S,

```text
ln det(σ_u² (C⁻¹)_FF) = Σ ln λ   becomes   Σ ln min(λ, n)
```

Of two effects that do the same, the one with the narrower plausible range would lead else, and where motion hops, the
one whose derivatives happen to be less: how sharply the data know a number says nothing of whether it is at work. What
the prior says of how far from neutral a number is stays as it is.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from itertools import chain, combinations, product
from math import inf, log

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from ...effects.parameter import FORM_SHARE
from ..fitting.fit import Fit
from ..fitting.hypothesis import PRIOR_SIGMA, Hypothesis

__all__ = ["log_occam", "neutral_sets", "seldom_needed", "unneeded"]

Floats = NDArray[np.float64]

# Of more optional parameters than this an effect has too many sets; it has none then but the empty one.
_MOST = 8
# A parameter is idle that moves the tempered -2 ln likelihood by less than this over its prior's standard deviation: by
# less than one number's noise.
_IDLE = 1.0


def log_occam(fit: Fit, dispersion: float, numbers: float) -> float:
    """Return the logarithm of Occam's factor of a fit: what ln Z has beside -cost/(2c).

    Parameters
    ----------
    fit
        A hypothesis at its best.
    dispersion
        c, how many numbers count as one.
    numbers
        n, for how many independent numbers all that was measured counts.
    """
    covariance, slope, _ = _posterior(fit, dispersion)
    tempered = 0.5 * (1.0 - 1.0 / dispersion) * float(fit.point @ fit.point) / PRIOR_SIGMA**2
    shares = [share for _, share in _shares(fit, dispersion, numbers)]
    return 0.5 * float(slope @ covariance @ slope) - tempered + float(logsumexp(shares))


def unneeded(fit: Fit, dispersion: float, numbers: float) -> NDArray[np.bool_]:
    """Return which coordinates are neutral in the likeliest set, shape (p,).

    Parameters
    ----------
    fit, dispersion, numbers
        As in `log_occam`.
    """
    held, _ = max(_shares(fit, dispersion, numbers), key=lambda entry: entry[1])
    return np.isin(np.arange(len(fit.point)), held)


def seldom_needed(fit: Fit, dispersion: float, numbers: float) -> NDArray[np.bool_]:
    """Return which coordinates are rather neutral than not, all sets counted, shape (p,).

    The median probability model (Barbieri and Berger 2004); those of the likeliest set where that leaves an effect
    without what it acts by.

    Parameters
    ----------
    fit, dispersion, numbers
        As in `log_occam`.
    """
    shares = _shares(fit, dispersion, numbers)
    whole = float(logsumexp([share for _, share in shares]))
    neutral = np.zeros(len(fit.point))
    for held, share in shares:
        neutral[list(held)] += np.exp(share - whole)
    seldom = neutral > 0.5
    acting = np.flatnonzero(~seldom & (fit.hypothesis.high > fit.hypothesis.low)).tolist()
    return seldom if all(fit.hypothesis.at_work(acting)) else unneeded(fit, dispersion, numbers)


def neutral_sets(hypothesis: Hypothesis, idle: Collection[int] = ()) -> dict[tuple[int, ...], float]:
    """Return the sets S of coordinates that may be neutral while every effect acts, with ln P(S); the first is empty.

    Parameters
    ----------
    hypothesis
        One or two effects.
    idle
        Coordinates by which no effect acts, for they move nothing that was measured.
    """
    by_effect, first = [], 0
    for n, kind in enumerate(hypothesis.kinds):
        last = first + len(kind.parameters)
        free = [j for j in range(first, last) if hypothesis.high[j] > hypothesis.low[j]]
        places = [j for j in free if not kind.parameters[j - first].always]
        form = {j for j in free if kind.parameters[j - first].form}
        moving = [j for j in free if j not in idle]
        # What moves nothing at all acts by all that it has.
        acting = moving if hypothesis.at_work(moving)[n] else free
        sets: list[tuple[int, ...]] = [()]
        sets += [s for s in _subsets(places) if s and hypothesis.at_work([j for j in acting if j not in s])[n]]
        varying = [not form <= set(held) for held in sets]
        counts = {False: varying.count(False), True: varying.count(True)}
        parts = {False: 1.0 - FORM_SHARE, True: FORM_SHARE} if all(counts.values()) else {False: 1.0, True: 1.0}
        by_effect.append([(held, log(parts[v] / counts[v])) for held, v in zip(sets, varying, strict=True)])
        first = last
    return {
        tuple(chain.from_iterable(held for held, _ in sets)): sum(share for _, share in sets)
        for sets in product(*by_effect)
    }


def _idle(fit: Fit, dispersion: float) -> list[int]:
    """Return the coordinates that move nothing that was measured."""
    moves = np.sum(fit.jacobian**2, axis=0) * PRIOR_SIGMA**2 / dispersion
    return np.flatnonzero(moves < _IDLE).tolist()


def _subsets(places: Sequence[int]) -> Iterator[tuple[int, ...]]:
    most = len(places) if len(places) <= _MOST else 0
    return chain.from_iterable(combinations(places, count) for count in range(most + 1))


def _posterior(fit: Fit, dispersion: float) -> tuple[Floats, Floats, Floats]:
    """Return C, g and m."""
    covariance = fit.covariance(dispersion)
    slope = (1.0 - 1.0 / dispersion) * fit.point / PRIOR_SIGMA**2
    return covariance, slope, fit.point - covariance @ slope


def _shares(fit: Fit, dispersion: float, numbers: float) -> list[tuple[tuple[int, ...], float]]:
    """Return the sets with ln P(S) + ln Z_S, but for what all have in common."""
    covariance, _, mean = _posterior(fit, dispersion)
    information = PRIOR_SIGMA**2 * fit.information(dispersion)
    made = []
    sets = neutral_sets(fit.hypothesis, _idle(fit, dispersion))
    optional = set(chain.from_iterable(sets))
    resting = set(np.flatnonzero(fit.hypothesis.rests(fit.point)).tolist()) & optional
    for chosen, share in sets.items():
        if not resting <= set(chosen):
            made.append((chosen, -inf))
            continue
        held = list(chosen)
        away = float(mean[held] @ np.linalg.solve(covariance[np.ix_(held, held)], mean[held])) if held else 0.0
        free = np.delete(np.arange(len(mean)), held)
        known = np.linalg.eigvalsh(information[np.ix_(free, free)])
        # The prior's own share is 1, but for rounding.
        costs = 0.5 * float(np.sum(np.log(np.clip(known, 1.0, max(numbers, 1.0)))))
        made.append((chosen, share - 0.5 * away - costs))
    return made
