"""`attribute`: which effect of the catalogue, or which two, makes the gap.

Every effect is fitted, then pairs by forward selection from the best. Hypotheses are compared by Laplace's evidence,

```text
ln Z = -cost/(2c) - ½ ln det(1 + σ_u² JᵀJ/c) + ln prior,      c = max(1, cost of the best / number of measurements) n_c
```

with the prior u ~ N(0, σ_u² 1) on parameters in units of their range. Neighbouring frames and channels share what the model
itself gets wrong, so that n_c of them count as one; and where even the best hypothesis leaves more than noise, everything that
is concluded is widened by that (a quasi-likelihood; McCullagh and Nelder 1989, 9.2). Outcomes are few and count each for one.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import log

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from ..effects.base import Effect
from .comparison import Comparison, Residual
from .fit import Fit, Fitter, robust_cost
from .hypothesis import PRIOR_SIGMA, Hypothesis

__all__ = ["Attribution", "Contender", "attribute"]

Floats = NDArray[np.float64]
OnPhase = Callable[[str, int, int], None]

# Prior odds: that there is no gap, one effect, two.
_PRIOR = {0: 0.4, 1: 0.45, 2: 0.15}
# A gap is left where a measurement's mean squared difference is above this; the floor is made so that noise gives less.
_LEFT = 0.95
# Fits that take so much off the objective are worth another look, so many of them; the search goes on from many more starts
# where a measurement's mean squared difference stays above this.
_CLEAR, _POLISHED, _WANTING = 20.0, 4, 0.85
# So many neighbouring numbers of a track count as one.
_ALIKE = 4.0
# Evidence that is nearer than this (a factor of 1.6) is equal.
_EQUAL = 0.5
# How many hypotheses are fitted again from more starts, and with how many, where the first fits leave a gap.
_REFINED, _MORE_STARTS = 3, {1: 8, 2: 16}
_MOST_STARTS = 16
# Effects to which a second is added, and seconds that are fitted with each.
_FIRSTS, _SECONDS = 2, 5


@dataclass(frozen=True, eq=False)
class Contender:
    """A hypothesis with its evidence.

    Attributes
    ----------
    names
        Its effects; none for the nominal model.
    fit
        None for the nominal model.
    residual
        How wrong it is over all trials.
    cost
        The objective.
    log_evidence
        ln Z, the prior included.
    probability
        Over all contenders.
    """

    names: tuple[str, ...]
    fit: Fit | None
    residual: Residual
    cost: float
    log_evidence: float = 0.0
    probability: float = 0.0

    @property
    def effects(self) -> tuple[Effect, ...]:
        """The effects at their best."""
        return () if self.fit is None else self.fit.hypothesis.effects(self.fit.point)


@dataclass(frozen=True, eq=False)
class Attribution:
    """Every hypothesis that was fitted.

    Attributes
    ----------
    contenders
        The best first.
    dispersion
        c.
    """

    contenders: tuple[Contender, ...]
    dispersion: float

    @property
    def nominal(self) -> Contender:
        """The nominal model."""
        return next(c for c in self.contenders if not c.names)

    def covariance(self, contender: Contender) -> Floats:
        """Return the posterior covariance of a contender's parameters u, shape (p, p)."""
        assert contender.fit is not None
        jacobian = contender.fit.jacobian
        return np.asarray(np.linalg.inv(_information(jacobian, self.dispersion)))


def _information(jacobian: Floats, dispersion: float) -> Floats:
    return jacobian.T @ jacobian / dispersion + np.eye(jacobian.shape[1]) / PRIOR_SIGMA**2


def attribute(
    comparison: Comparison, kinds: Sequence[type[Effect]], on_phase: OnPhase | None = None, seed: int = 0
) -> Attribution:
    """Fit every effect, and pairs where one leaves a gap.

    Parameters
    ----------
    comparison
        The dataset, ready to be compared.
    kinds
        The effects.
    on_phase
        Is told the phase, how much of it is done, and of how much.
    seed
        Of the further starts.
    """
    fitter = Fitter(comparison)
    scenarios = [comparison.simulator.nominal(i) for i in fitter.trials]
    still = comparison.residual(comparison.nominal_paths)
    nominal = Contender((), None, still, fitter.cost(still, np.zeros(1)))
    possible = [Hypothesis.of(kind, scenarios) for kind in kinds]
    possible = [h for h in possible if len(h.starts)]

    def tell(phase: str, done: int, total: int) -> None:
        if on_phase is not None:
            on_phase(phase, done, total)

    tell("first look at every effect", 0, 1)
    zeros = [np.zeros(len(h.neutral)) for h in possible]
    scans = fitter.scan(possible, zeros, still)
    singles: list[Contender] = []
    for k, (hypothesis, points) in enumerate(zip(possible, scans, strict=True)):
        tell("fitting each effect", k, len(possible))
        # Where nothing that was looked at is better than neutral, two steps from there suffice.
        evaluations = 6 if np.any(points[0]) else 2
        singles.append(_contender(fitter.fit(hypothesis, points[0], evaluations=evaluations)))
    order = sorted(range(len(singles)), key=lambda k: singles[k].cost)
    if singles and singles[order[0]].cost < nominal.cost - _CLEAR:
        for n, k in enumerate(order[:_POLISHED]):
            tell("a second look at the best", n, _POLISHED)
            fit = singles[k].fit
            assert fit is not None
            singles[k] = _contender(fitter.fit(fit.hypothesis, fit.point, evaluations=10))
        if _mean_square(comparison, min(singles, key=lambda c: c.cost)) > _WANTING:
            for n, k in enumerate(order[:_REFINED]):
                tell("more starts for the best", n, _REFINED)
                singles[k] = _refined(fitter, singles[k], scans[k], seed)
    contenders = [nominal, *singles]
    best = min(singles, key=lambda c: c.cost, default=nominal)
    if _mean_square(comparison, best) > _LEFT:
        contenders += _pairs(fitter, singles, {h.names[0]: h for h in possible}, tell)
    return _ranked(contenders, comparison, len(possible))


def _contender(fit: Fit) -> Contender:
    return Contender(fit.hypothesis.names, fit, fit.residual, fit.cost)


def _mean_square(comparison: Comparison, contender: Contender) -> float:
    values = contender.residual.over(range(len(contender.residual.trials)))
    return robust_cost(values) / max(comparison.count, 1)


def _refined(fitter: Fitter, contender: Contender, scanned: Sequence[Floats], seed: int) -> Contender:
    """The best of fits from many more starts over the range."""
    assert contender.fit is not None
    hypothesis = contender.fit.hypothesis
    free = hypothesis.high > hypothesis.low
    count = _MORE_STARTS.get(int(free.sum()), _MOST_STARTS)
    sobol = qmc.Sobol(len(free), rng=np.random.default_rng(seed))
    share = sobol.random(count)
    points = list(hypothesis.low + share * (hypothesis.high - hypothesis.low))
    residuals = fitter.residuals(hypothesis, points)
    tried = sorted(zip((fitter.cost(r, p) for r, p in zip(residuals, points, strict=True)), range(count), strict=True))
    starts = [contender.fit.point, points[tried[0][1]], *scanned[1:2]]
    fits = [fitter.fit(hypothesis, start, evaluations=10) for start in starts]
    return _contender(min([contender.fit, *fits], key=lambda fit: fit.cost))


def _pairs(
    fitter: Fitter,
    singles: Sequence[Contender],
    hypotheses: Mapping[str, Hypothesis],
    tell: OnPhase,
) -> list[Contender]:
    firsts = sorted(singles, key=lambda c: c.cost)[:_FIRSTS]
    found: dict[frozenset[str], Contender] = {}
    for n, first in enumerate(firsts):
        tell("fitting pairs", n, len(firsts))
        assert first.fit is not None
        others = [h for name, h in hypotheses.items() if name not in first.names]
        joined = [first.fit.hypothesis + other for other in others]
        bases = [np.concatenate([first.fit.point, np.zeros(len(other.neutral))]) for other in others]
        scans = fitter.scan(joined, bases, first.residual, first.fit.jacobian)
        looks = [fitter.residuals(h, [points[0]])[0] for h, points in zip(joined, scans, strict=True)]
        costs = [fitter.cost(look, points[0]) for look, points in zip(looks, scans, strict=True)]
        order = np.argsort(costs, kind="stable")[:_SECONDS]
        for k in order:
            names = frozenset(joined[k].names)
            contender = _contender(fitter.fit(joined[k], scans[k][0], evaluations=8))
            if names not in found or contender.cost < found[names].cost:
                found[names] = contender
    return list(found.values())


def _ranked(contenders: Sequence[Contender], comparison: Comparison, effects: int) -> Attribution:
    outcomes = sum(len(floor.outcome_scale) for floor in comparison.floors)
    alike = comparison.count / max(outcomes + (comparison.count - outcomes) / _ALIKE, 1.0)
    dispersion = alike * max(1.0, min(_mean_square(comparison, contender) for contender in contenders))
    pairs = max(effects * (effects - 1) // 2, 1)
    prior = {0: log(_PRIOR[0]), 1: log(_PRIOR[1] / max(effects, 1)), 2: log(_PRIOR[2] / pairs)}
    scored = []
    for c in contenders:
        evidence = -0.5 * c.cost / dispersion + prior[len(c.names)]
        if c.fit is not None:
            information = _information(c.fit.jacobian, dispersion) * PRIOR_SIGMA**2
            evidence -= 0.5 * float(np.linalg.slogdet(information)[1])
        scored.append((evidence, c))
    place = {c.names: k for k, c in enumerate(contenders)}
    top = max(evidence for evidence, _ in scored)
    weights = np.exp([evidence - top for evidence, _ in scored])
    shares = weights / weights.sum()
    made = [
        replace(c, log_evidence=evidence, probability=float(share))
        for (evidence, c), share in zip(scored, shares, strict=True)
    ]
    # Of equals the one with the fewest parameters comes first, as listed in the catalogue.
    made.sort(key=lambda c: -c.log_evidence)
    equal = [c for c in made if made[0].log_evidence - c.log_evidence < _EQUAL]
    first = min(equal, key=lambda c: (0 if c.fit is None else len(c.fit.point), place[c.names]))
    made.sort(key=lambda c: c is not first)
    return Attribution(tuple(made), dispersion)
