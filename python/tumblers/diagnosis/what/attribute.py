"""`attribute`: which effect of the catalogue, or which two, makes the gap.

What `Search` found is run in steps that are short enough for what leads. Hypotheses are compared by Laplace's evidence,

```text
ln Z = -(cost + ln det Σ)/(2c) + ln Occam + ln prior,
c = max(1, cost of the best / numbers that were measured, an outcome as n_c) n_c
```

with Σ the noise around each hypothesis, or around the best where it says the same (`own_noise`), and the prior
u ~ N(0, σ_u² 1) on parameters in units of their range. Those near the best are then compared by the mean over both
noises (`both_noises`). Neighbouring frames share what the model itself gets wrong, so that n_c numbers count as one
(`Comparison.alike`); and where even the best hypothesis leaves more than noise, everything that is concluded is widened
by that (a quasi-likelihood; McCullagh and Nelder 1989, 9.2). Outcomes are few and count each for one. A second effect
has to add more than the form of the first may be wrong by, and a small share of the probability belongs to all
hypotheses alike.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from math import exp, log

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear
from scipy.stats import chi2

from ...effects.base import Effect
from ...progress import OnPhase
from ..fitting.fit import Fit
from ..fitting.fitter import Fitter
from ..gap.comparison import Comparison
from ..gap.predictive import is_right
from .both_noises import by_both_noises
from .contender import Contender, likeliest, of_fit, of_nominal
from .last_fits import in_steps_of
from .margins import OPEN, SECOND
from .occam import log_occam
from .own_noise import by_itself
from .search import Search
from .tolerated import is_tolerated, tolerated

__all__ = ["LAPSE", "PRIOR", "REFUSED", "Attribution", "attribute", "seen_from_the_best"]

Floats = NDArray[np.float64]

# Prior probabilities: that there is no gap, one effect, two.
PRIOR = {0: 0.4, 1: 0.45, 2: 0.15}
# How often the likeliest is wrong however strong the evidence: a form that the catalogue lacks, a minimum that no
# search found. Shared by all, and of the order of what datasets with a known truth showed while this was developed.
LAPSE = 0.12
# By how much less probable the nominal model is once it has failed the predictive test, and something else is likelier
# by that: where one trial alone is far off, neighbouring frames that count as one say too little of it. And an effect
# that fails on trials left out where a tied one does not. A choice: how often a right model fails either is known to a
# few per cent only.
REFUSED = 0.02
# Trial points of the last fit of the best, from where it is: intervals are no better than it.
_LAST_POINTS = 12
# How much of a fit's Gaussian is looked at for a point that is within the nominal numbers' tolerances.
_WITHIN = 0.9
# Of equals the one that the catalogue lists first is preferred.
_PER_PLACE = 0.005


@dataclass(frozen=True, eq=False)
class Attribution:
    """Every hypothesis that was fitted.

    Attributes
    ----------
    contenders
        The best first.
    dispersion
        c.
    nominal_is_right
        Whether the nominal model passes the predictive test against its own noise.
    refused
        Names of those that trials left out, or their own run, put behind a tied one.
    order
        Names of the effects that were tried, as the catalogue lists them.
    """

    contenders: tuple[Contender, ...]
    dispersion: float
    nominal_is_right: bool
    refused: tuple[tuple[str, ...], ...] = ()
    order: tuple[str, ...] = ()

    @property
    def nominal(self) -> Contender:
        """The nominal model."""
        return next(c for c in self.contenders if not c.names)

    @property
    def doubt(self) -> float:
        """The nominal model's probability but for its shares of `LAPSE`, which are large where hypotheses are few."""
        return self.beyond_lapse(self.nominal)

    def doubt_within(self, rough: float) -> float:
        """Return the doubt if the nominal model's evidence, and no other, were by so much more than what was measured.

        Parameters
        ----------
        rough
            By how much ln of a likelihood may be off.
        """
        # Rounding may leave less than nothing of a probability that is all lapse.
        held = max(self.doubt, 0.0)
        rest = 1.0 - LAPSE - held
        return (1.0 - LAPSE) * held / (held + rest * exp(-rough))

    def beyond_lapse(self, contender: Contender) -> float:
        """Return a contender's probability but for its share of `LAPSE`.

        Parameters
        ----------
        contender
            One of them.
        """
        return contender.probability - self._lapse(contender)

    def log_odds(self, contender: Contender, name: str) -> float:
        """Return ln of the odds of a contender against an effect, by itself or beside another.

        Of equals the one that the catalogue lists first is preferred, but no effect is farther behind for its place.

        Parameters
        ----------
        contender
            One of them.
        name
            Of the effect.
        """
        evidence = [c.log_evidence + _place_cost(c.names, self.order) for c in self.contenders if name in c.names]
        return contender.log_evidence + _place_cost(contender.names, self.order) - float(np.logaddexp.reduce(evidence))

    def _lapse(self, contender: Contender) -> float:
        """Return a contender's share of `LAPSE`; what counts as the nominal model has left it its own."""
        share = LAPSE / len(self.contenders)
        if not contender.names:
            return (1 + sum(c.merged for c in self.contenders)) * share
        return 0.0 if contender.merged else share

    def refusing(self, refused: Collection[tuple[str, ...]]) -> Attribution:
        """Return the attribution with some contenders as improbable beside the others as `REFUSED` makes them.

        Parameters
        ----------
        refused
            Their names.
        """
        above = [self.beyond_lapse(c) * (REFUSED if c.names in refused else 1.0) for c in self.contenders]
        made = [
            replace(
                c,
                log_evidence=c.log_evidence + (log(REFUSED) if c.names in refused else 0.0),
                probability=self._lapse(c) + (1.0 - LAPSE) * more / sum(above),
            )
            for c, more in zip(self.contenders, above, strict=True)
        ]
        made.sort(key=lambda c: -c.log_evidence)
        return replace(self, contenders=tuple(made), refused=(*self.refused, *refused))


def attribute(
    comparison: Comparison, kinds: Sequence[type[Effect]], on_phase: OnPhase | None = None, seed: int = 0
) -> Attribution:
    """Fit every effect, and pairs where one takes something off the gap.

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
    tell = on_phase or (lambda _phase, _done, _total: None)
    search = Search(fitter, kinds, tell, seed)
    contenders = search.contenders()
    resolves = comparison.simulator.resolves
    compared = False
    while True:
        right = _nominal_is_right(fitter)
        ranked, dispersion = _ranked(contenders, comparison, search.names, right)
        if flattered := _flattered(ranked):
            contenders, compared = _each_by_itself(fitter, ranked, flattered, tell), False
            continue
        if not compared and resolves(ranked[0].effects):
            contenders, compared = by_both_noises(fitter, ranked, dispersion, tell), True
            continue
        if resolves(ranked[0].effects):
            # The nominal model takes the lead then, or nothing does: it is run in any steps.
            ranked = _with_tolerated(fitter, ranked, dispersion) if right else ranked
            break
        contenders, compared = in_steps_of(fitter, ranked[0], contenders, seed, tell), False
    return seen_from_the_best(fitter, Attribution(tuple(ranked), dispersion, right, order=tuple(search.names)))


def seen_from_the_best(fitter: Fitter, attribution: Attribution) -> Attribution:
    """Take the noise around the best, as much of it as the best needs, fit that once more, and see all against it.

    Parameters
    ----------
    fitter
        Of the dataset; leaves the noise around the best.
    attribution
        Every hypothesis, against whatever noise.
    """
    fitter.take_likeliest_noise(attribution.contenders[0].effects)
    seen = [_seen(fitter, contender, first=k == 0) for k, contender in enumerate(attribution.contenders)]
    return replace(attribution, contenders=tuple(seen))


def _flattered(ranked: Sequence[Contender]) -> list[Contender]:
    """Return what leads, or may, by the noise around another that it is far from.

    Where even the best leaves a gap, what is far behind by the objective is near by evidence.
    """
    if not ranked[0].names:
        return []
    near = ranked[0].log_evidence - OPEN
    return [c for c in ranked if c.names and not (c.settled or c.lent) and c.log_evidence > near]


def _each_by_itself(
    fitter: Fitter, contenders: Sequence[Contender], which: Sequence[Contender], tell: OnPhase
) -> list[Contender]:
    """Hold some of the contenders against their own noise."""
    made = list(contenders)
    for n, contender in enumerate(which):
        tell("each against its own noise", n, len(which))
        made[made.index(contender)] = by_itself(fitter, contender, evaluations=1)
    return made


def _nominal_is_right(fitter: Fitter) -> bool:
    """Test the nominal model in the steps of the moment, against all that may be wrong around it."""
    fitter.comparison.take_noise_of(())
    return is_right(fitter.comparison, of_nominal(fitter).residual)


def _with_tolerated(fitter: Fitter, ranked: Sequence[Contender], dispersion: float) -> list[Contender]:
    """Count what says no more than that nominal numbers are off within their tolerances as the nominal model."""
    same = [c for c in ranked if c.fit is None or _may_be_tolerated(fitter, c.fit, dispersion)]
    probability, evidence = sum(c.probability for c in same), max(c.log_evidence for c in same)
    made = [replace(c, probability=0.0, merged=True) if c.names and c in same else c for c in ranked]
    made = [c if c.names else replace(c, probability=probability, log_evidence=evidence) for c in made]
    return sorted(made, key=lambda c: (-c.log_evidence, len(c.names)))


def _may_be_tolerated(fitter: Fitter, fit: Fit, dispersion: float) -> bool:
    """Return whether a fit, or a point that the data allow as well, is within what nominal numbers may be off.

    They allow a point within 90 % of Laplace's Gaussian where the objective is about as high as that foretells: past a
    threshold the Gaussian knows nothing.
    """
    hypothesis = fit.hypothesis
    lab = fitter.comparison.dataset
    if is_tolerated(hypothesis.effects(fit.point), lab):
        return True
    ends: list[tuple[float, float]] = []
    for kind in hypothesis.kinds:
        own = tolerated(kind, lab)
        if own is None:
            return False
        ends += zip(*(kind.to_fit(values) for values in zip(*own, strict=True)), strict=True)
    low, high = ((np.array(end) - hypothesis.neutral) / hypothesis.scale for end in zip(*ends, strict=True))
    root = np.linalg.cholesky(fit.information(dispersion)).T
    nearest, some = low.copy(), low < high
    rest = root @ fit.point - root[:, ~some] @ low[~some]
    nearest[some] = lsq_linear(root[:, some], rest, bounds=(low[some], high[some])).x
    most = float(chi2.ppf(_WITHIN, hypothesis.free))
    if float(np.sum((root @ (nearest - fit.point)) ** 2)) > most:
        return False
    fitter.take_likeliest_noise(hypothesis.effects(fit.point))
    there = fitter.residuals(hypothesis, [nearest])[0]
    return fitter.cost(there, nearest) - fitter.again(fit).cost <= (most + 2.0 * fitter.comparison.rough) * dispersion


def _place_cost(names: Sequence[str], order: Sequence[str]) -> float:
    """Return what a hypothesis's place in the catalogue costs it, ln."""
    return _PER_PLACE * sum(order.index(name) for name in names)


def _seen(fitter: Fitter, contender: Contender, first: bool) -> Contender:
    """Hold a contender against the noise of the moment; the first with its derivatives."""
    if contender.fit is None:
        now = of_nominal(fitter)
    elif first:
        last = fitter.fit(
            contender.fit.hypothesis, contender.point, evaluations=_LAST_POINTS, steps=contender.fit.steps
        )
        now = of_fit(fitter, last)
    else:
        now = of_fit(fitter, fitter.again(contender.fit))
    return replace(
        now,
        log_likelihood=contender.log_likelihood,
        log_evidence=contender.log_evidence,
        probability=contender.probability,
        merged=contender.merged,
    )


def _ranked(
    contenders: Sequence[Contender], comparison: Comparison, effects: Sequence[str], nominal_is_right: bool
) -> tuple[list[Contender], float]:
    # By the determinant too: what is vague leaves little of anything.
    dispersion = max(comparison.alike, likeliest(contenders).cost / comparison.independent)
    # One effect alone on the list would be likelier than none before anything is seen, and lead without doing anything.
    listed = max(len(effects), 2)
    prior = {
        0: log(PRIOR[0]),
        1: log(PRIOR[1] / listed),
        2: log(PRIOR[2] / (listed * (listed - 1) // 2)) - SECOND,
    }
    scored = []
    for c in contenders:
        likelihood = -0.5 * c.total / dispersion
        evidence = likelihood + prior[len(c.names)]
        evidence -= _place_cost(c.names, effects)
        if c.fit is not None:
            evidence += log_occam(c.fit, dispersion, comparison.independent)
        scored.append((evidence, replace(c, log_likelihood=likelihood)))
    # Where nothing is likelier by as much, what does nothing would lead. Each by itself: what one is behind another by
    # says nothing of the nominal model.
    nominal = next(c for _, c in scored if not c.names)
    highest = max(c.log_likelihood + 0.5 * c.offset / dispersion for _, c in scored)
    if not nominal_is_right and highest > nominal.log_likelihood - log(REFUSED):
        scored = [(evidence + (0.0 if c.names else log(REFUSED)), c) for evidence, c in scored]
    top = max(evidence for evidence, _ in scored)
    weights = np.exp([evidence - top for evidence, _ in scored])
    shares = (1.0 - LAPSE) * weights / weights.sum() + LAPSE / len(weights)
    made = [
        replace(c, log_evidence=evidence, probability=float(share))
        for (evidence, c), share in zip(scored, shares, strict=True)
    ]
    made.sort(key=lambda c: -c.log_evidence)
    return made, dispersion
