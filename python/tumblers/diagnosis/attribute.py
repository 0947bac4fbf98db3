"""`attribute`: which effect of the catalogue, or which two, makes the gap.

Every effect is fitted, then pairs by forward selection from the best. Hypotheses are compared by Laplace's evidence,

```text
ln Z = -cost/(2c) - ½ ln det(1 + σ_u² JᵀJ/c) + ln prior,      c = max(1, cost of the best / number of measurements) n_c
```

with the prior u ~ N(0, σ_u² 1) on parameters in units of their range. Neighbouring frames and channels share what the
model itself gets wrong, so that n_c of them count as one; and where even the best hypothesis leaves more than noise,
everything that is concluded is widened by that (a quasi-likelihood; McCullagh and Nelder 1989, 9.2). Outcomes are few
and count each for one.
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
from .predictive import is_right, mean_square

__all__ = ["Attribution", "Contender", "OnPhase", "attribute"]

Floats = NDArray[np.float64]
OnPhase = Callable[[str, int, int], None]

# Prior odds: that there is no gap, one effect, two.
_PRIOR = {0: 0.4, 1: 0.45, 2: 0.15}
# A gap is left where a measurement's mean squared difference is above this; the floor is made so that noise gives less.
_LEFT = 0.95
# Fits that take so much off the objective are worth another look, so many of them; the search goes on from many more
# starts where a measurement's mean squared difference stays above this.
_CLEAR, _POLISHED, _WANTING = 20.0, 3, 0.85
# Shares of the way from neutral to each end of a range that are tried where nothing explains the gap, for effects with
# no more parameters than this.
_GRID, _FEW = (0.1, 0.3, 0.5, 0.7, 0.9, 1.0), 2
# Effects that lead after the first look are fitted in more steps.
_LEADING = 6
# So many neighbouring numbers of a track count as one.
_ALIKE = 4.0
# Of equals the one with fewer parameters is preferred, then the one that the catalogue lists first.
_PER_PARAMETER, _PER_PLACE = 0.15, 0.005
# How many hypotheses are fitted again from more starts, and with how many, where the first fits leave a gap.
_REFINED, _MORE_STARTS, _MOST_STARTS = 2, {1: 8, 2: 16}, 16
# Of an effect with more parameters than this only where it leads.
_MANY = 4
# Shares of the trials' time that are fitted on the way, from so many of the starts.
_STAGES, _FOLLOWED = (0.25, 0.5), 1
# Effects to which a second is added, and seconds that are fitted with each.
_FIRSTS, _SECONDS, _PAIRS_POLISHED = 2, 4, 2
# The second of them only where it leaves no more than so much of the objective of the best.
_NEAR_BEST = 1.5


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
    def point(self) -> Floats:
        """The parameters u, shape (p,)."""
        return np.empty(0) if self.fit is None else self.fit.point

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
    nominal = _nominal(fitter)
    gap = not is_right(comparison, nominal.residual)
    possible = [Hypothesis.of(kind, scenarios) for kind in kinds]
    possible = [h for h in possible if len(h.starts)]
    names = [h.names[0] for h in possible]

    def tell(phase: str, done: int, total: int) -> None:
        if on_phase is not None:
            on_phase(phase, done, total)

    tell("first look at every effect", 0, 1)
    zeros = [np.zeros(len(h.neutral)) for h in possible]
    scans = fitter.scan(possible, zeros, nominal.residual)
    singles: list[Contender] = []
    leading = sorted(points[0][0] for points in scans)[:_LEADING]
    for k, (hypothesis, points) in enumerate(zip(possible, scans, strict=True)):
        tell("fitting each effect", k, len(possible))
        cost, start = points[0]
        # Where nothing that was looked at is better than neutral, two steps from there suffice.
        evaluations = (6 if cost in leading else 4) if np.any(start) else 2
        singles.append(_contender(fitter.fit(hypothesis, start, evaluations=evaluations)))
    if singles and not is_right(comparison, min([nominal, *singles], key=lambda c: c.cost).residual):
        tell("a grid over every range", 0, 1)
        singles = _searched(fitter, singles)
    if not singles or min(c.cost for c in singles) > nominal.cost - _CLEAR:
        return _ranked([nominal, *singles], comparison, names)

    singles.sort(key=lambda c: c.cost)
    comparison.measure_noise_around(singles[0].effects)
    tell("a second look at the best", 0, 1)
    singles = _polished(fitter, _judged_again(fitter, singles), _POLISHED)
    nominal = _nominal(fitter)
    if mean_square(comparison, singles[0].residual) > _WANTING:
        for k in range(min(_REFINED, len(singles))):
            tell("more starts for the best", k, _REFINED)
            if k == 0 or len(singles[k].point) <= _MANY:
                singles[k] = _refined(fitter, singles[k], seed)
        singles.sort(key=lambda c: c.cost)
    contenders = list(singles)
    pairs = _pairs(fitter, singles, {h.names[0]: h for h in possible}, tell)
    if pairs:
        contenders = sorted([*singles, *pairs], key=lambda c: c.cost)
        tell("a last look at the best", 0, 1)
        comparison.measure_noise_around(contenders[0].effects)
        contenders = _polished(fitter, _judged_again(fitter, contenders), _PAIRS_POLISHED)
        nominal = _nominal(fitter)
    ranked = _ranked([nominal, *contenders], comparison, names)
    if gap and not ranked.contenders[0].names:
        # Around this hypothesis everything is noise, around the nominal model it is not: that is no explanation.
        comparison.measure_noise_around(())
        contenders = _judged_again(fitter, contenders)
        ranked = _ranked([_nominal(fitter), *contenders], comparison, names)
    return ranked


def _nominal(fitter: Fitter) -> Contender:
    residual = fitter.comparison.residual(fitter.comparison.nominal_paths)
    return Contender((), None, residual, fitter.cost(residual, np.zeros(1)))


def _judged_again(fitter: Fitter, contenders: Sequence[Contender]) -> list[Contender]:
    """Hold the same fits against another noise, the best first."""
    made = []
    for contender in contenders:
        fit = contender.fit
        assert fit is not None
        residual = fitter.residuals(fit.hypothesis, [fit.point])[0]
        made.append(_contender(replace(fit, residual=residual, cost=fitter.cost(residual, fit.point))))
    return sorted(made, key=lambda c: c.cost)


def _polished(fitter: Fitter, contenders: Sequence[Contender], count: int) -> list[Contender]:
    """Fit the best so many on from where they are; the best first."""
    made = list(contenders)
    for k, contender in enumerate(made[:count]):
        assert contender.fit is not None
        made[k] = _contender(fitter.fit(contender.fit.hypothesis, contender.fit.point, evaluations=8))
    return sorted(made, key=lambda c: c.cost)


def _contender(fit: Fit) -> Contender:
    return Contender(fit.hypothesis.names, fit, fit.residual, fit.cost)


def _searched(fitter: Fitter, singles: Sequence[Contender]) -> list[Contender]:
    """Fit effects of few parameters again from a grid over their ranges: a threshold shows only beyond it."""
    made = list(singles)
    for k, contender in enumerate(singles):
        assert contender.fit is not None
        hypothesis = contender.fit.hypothesis
        if len(contender.point) > _FEW:
            continue
        ends = [(j, end) for j in range(len(contender.point)) for end in (hypothesis.low[j], hypothesis.high[j])]
        unit = np.eye(len(contender.point))
        points = [share * end * unit[j] for j, end in ends if end != 0.0 for share in _GRID]
        residuals = fitter.residuals(hypothesis, points)
        costs = [fitter.cost(residual, point) for residual, point in zip(residuals, points, strict=True)]
        best = int(np.argmin(costs))
        if costs[best] < contender.cost - _CLEAR:
            other = _contender(fitter.fit(hypothesis, points[best], evaluations=6))
            made[k] = min(contender, other, key=lambda c: c.cost)
    return made


def _refined(fitter: Fitter, contender: Contender, seed: int) -> Contender:
    """Fit from many more starts over the range, each to the beginning of the trials first.

    Where an effect is strong, paths soon have nothing in common any more; their beginnings still have.
    """
    assert contender.fit is not None
    hypothesis = contender.fit.hypothesis
    tracked = tuple(i for i in fitter.trials if len(fitter.comparison.readers[i].observed.time_s))
    if not tracked:
        return contender
    free = hypothesis.high > hypothesis.low
    count = _MORE_STARTS.get(int(free.sum()), _MOST_STARTS)
    shares = qmc.Sobol(len(free), rng=np.random.default_rng(seed)).random(count)
    points = [*(hypothesis.low + share * (hypothesis.high - hypothesis.low) for share in shares), contender.fit.point]
    residuals = fitter.residuals(hypothesis, points, tracked, _STAGES[0])
    costs = [fitter.cost(residual, point, tracked) for residual, point in zip(residuals, points, strict=True)]
    fits = [contender.fit]
    for k in np.argsort(costs, kind="stable")[:_FOLLOWED]:
        point = points[k]
        for stage in _STAGES:
            point = fitter.fit(hypothesis, point, tracked, 5, stage).point
        fits.append(fitter.fit(hypothesis, point, evaluations=8))
    return _contender(min(fits, key=lambda fit: fit.cost))


def _pairs(
    fitter: Fitter,
    singles: Sequence[Contender],
    hypotheses: Mapping[str, Hypothesis],
    tell: OnPhase,
) -> list[Contender]:
    ordered = sorted(singles, key=lambda c: c.cost)
    # A second effect shows beside the best one; beside the next best only where the best leaves a gap.
    wanting = mean_square(fitter.comparison, ordered[0].residual) > _LEFT
    firsts = [c for c in ordered[: _FIRSTS if wanting else 1] if c.cost < _NEAR_BEST * ordered[0].cost]
    found: dict[frozenset[str], Contender] = {}
    for n, first in enumerate(firsts):
        tell("fitting pairs", n, len(firsts))
        assert first.fit is not None
        others = [h for name, h in hypotheses.items() if name not in first.names]
        joined = [first.fit.hypothesis + other for other in others]
        bases = [np.concatenate([first.fit.point, np.zeros(len(other.neutral))]) for other in others]
        scans = fitter.scan(joined, bases, first.residual, first.fit.jacobian)
        costs = [points[0][0] for points in scans]
        order = [k for k in np.argsort(costs, kind="stable")[:_SECONDS] if costs[k] < first.cost - _CLEAR]
        for k in order:
            names = frozenset(joined[k].names)
            contender = _contender(fitter.fit(joined[k], scans[k][0][1], evaluations=4))
            if names not in found or contender.cost < found[names].cost:
                found[names] = contender
    return _polished(fitter, sorted(found.values(), key=lambda c: c.cost), _PAIRS_POLISHED)


def _ranked(contenders: Sequence[Contender], comparison: Comparison, effects: Sequence[str]) -> Attribution:
    noted = [len(floor.outcome_scale) for floor in comparison.floors]
    alike = _ALIKE if comparison.count > sum(noted) else 1.0
    dispersion = alike * max(1.0, min(mean_square(comparison, contender.residual) for contender in contenders))
    listed = max(len(effects), 1)
    prior = {
        0: log(_PRIOR[0]),
        1: log(_PRIOR[1] / listed),
        2: log(_PRIOR[2] / max(listed * (listed - 1) // 2, 1)),
    }
    place = {name: k for k, name in enumerate(effects)}
    scored = []
    for c in contenders:
        # Outcomes stand for themselves.
        outcomes = sum(
            robust_cost(values[len(values) - count :]) for values, count in zip(c.residual.trials, noted, strict=True)
        )
        evidence = -0.5 * (c.cost + (alike - 1.0) * outcomes) / dispersion + prior[len(c.names)]
        evidence -= _PER_PARAMETER * len(c.point) + _PER_PLACE * sum(place[name] for name in c.names)
        if c.fit is not None:
            information = _information(c.fit.jacobian, dispersion) * PRIOR_SIGMA**2
            evidence -= 0.5 * float(np.linalg.slogdet(information)[1])
        scored.append((evidence, c))
    top = max(evidence for evidence, _ in scored)
    weights = np.exp([evidence - top for evidence, _ in scored])
    shares = weights / weights.sum()
    made = [
        replace(c, log_evidence=evidence, probability=float(share))
        for (evidence, c), share in zip(scored, shares, strict=True)
    ]
    made.sort(key=lambda c: -c.log_evidence)
    return Attribution(tuple(made), dispersion)
