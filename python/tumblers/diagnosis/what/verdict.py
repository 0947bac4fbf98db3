"""Whether there is a gap, whether it is explained, and what cannot be told apart."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ..gap.comparison import Comparison
from ..gap.predictive import is_explained, is_right
from ..result import Verdict
from .attribute import Attribution
from .contender import Contender
from .margins import OPEN

__all__ = ["judge", "refused", "ties"]

# Where noise may explain it all, there is a gap only where that is less probable than this, with tracks also by an
# evidence that is off by as much as it may be.
_LEAST_DOUBT = 0.05
# Evidence or likelihoods less than this factor apart, ln 20; and that of tracks by `Comparison.rough` more.
_TIED = 3.0
# What adds less than this share of what an effect adds does not do the same: it goes an eighth of the way. A choice.
_MUCH = 0.25


def judge(comparison: Comparison, attribution: Attribution, foretold: bool) -> tuple[Verdict, Contender]:
    """Return the verdict, and the hypothesis that is chosen: the nominal model where there is no gap.

    Parameters
    ----------
    comparison
        The dataset.
    attribution
        Every hypothesis.
    foretold
        Whether the best hypothesis stood on trials that its fit had not seen, and its own run follows the data.
    """
    nominal, best = attribution.nominal, attribution.contenders[0]
    # What is wide enough around the nominal model hides a gap: where another is likelier, against its noise too.
    doubtful = attribution.doubt_within(comparison.rough) > _LEAST_DOUBT and is_right(comparison, nominal.residual)
    # What counts as the nominal model may make it more probable than what evidence ranks first.
    likelier = attribution.doubt >= attribution.beyond_lapse(best)
    if attribution.nominal_is_right and (not best.names or doubtful or likelier):
        return "no_gap", nominal
    if not best.names:
        return "unexplained", best
    return ("explained" if is_explained(comparison, best.residual) and foretold else "unexplained"), best


def refused(
    comparison: Comparison, contenders: Sequence[Contender], stands: Callable[[Contender], bool]
) -> tuple[tuple[str, ...], ...]:
    """Return the names of those that evidence ranks before a tied one, and trials that no fit saw after it.

    Where evidence cannot part hypotheses, what they say of trials left out does: the first that may explain the data by
    the predictive test, and stands there, leads. Where none does, or the nominal model is among them, none is refused.

    Parameters
    ----------
    comparison
        The dataset.
    contenders
        Those whose trials were left out, by evidence.
    stands
        Whether one stands on trials that its fit had not seen, and its own run follows the data.
    """
    before: list[tuple[str, ...]] = []
    for contender in contenders:
        if not contender.names or contenders[0].log_evidence - contender.log_evidence >= _TIED:
            return ()
        if is_explained(comparison, contender.residual) and stands(contender):
            return tuple(before)
        before.append(contender.names)
    return ()


def ties(
    comparison: Comparison, attribution: Attribution, chosen: Contender, lead_around: Callable[[Contender], float]
) -> dict[str, tuple[str, ...]]:
    """Return for each effect of the chosen set those that these trials cannot tell apart from it.

    Parsimony may prefer one to another that has more parameters: where likelihood alone does not, that is a tie still.
    So it is where the noise around the other, of which nobody knows that it is not the right one, does not part them.
    What does little of what the effect does is not tied with it, however little that is; nor is anything with an effect
    that does nothing.

    Parameters
    ----------
    comparison
        The dataset.
    attribution
        Every hypothesis.
    chosen
        The one that is reported.
    lead_around
        By how much the total of the one that is reported is less than another's, both against the noise around that;
        asked of those that are open (`OPEN`).
    """
    trials = range(len(comparison.readers))
    said = chosen.residual.over(trials)
    # An outcome counts for itself; a trial that either is far from, as any other.
    weights = np.concatenate(
        [np.where(np.arange(floor.size) < floor.tracked, 1.0, comparison.alike) for floor in comparison.floors]
    )
    limit = _TIED + comparison.rough
    known = {frozenset(contender.names): contender for contender in attribution.contenders}
    out: dict[str, list[str]] = {}
    for name in chosen.names:
        out[name] = []
        kept = frozenset(chosen.names) - {name}
        for names, other in known.items():
            if name in names or len(names) != len(chosen.names) or not kept < names:
                continue
            if kept in known and not _does_as_much(other, chosen, known[kept]):
                continue
            # What either would lose on average if the other were right.
            apart = float(np.sum(weights * (other.residual.over(trials) - said) ** 2)) / (2.0 * attribution.dispersion)
            behind = chosen.log_likelihood - other.log_likelihood
            # What evidence has beside likelihood: Occam's factor and the prior.
            beside = chosen.log_evidence - other.log_evidence - behind
            least = min(behind + beside, behind)
            if limit <= min(least, apart) and least < OPEN:
                around_other = lead_around(other) / (2.0 * attribution.dispersion)
                least = min(around_other + beside, around_other)
            if min(least, apart) < limit:
                (instead,) = names - kept
                out[name].append(instead)
    return {name: tuple(others) for name, others in out.items()}


def _does_as_much(other: Contender, chosen: Contender, without: Contender) -> bool:
    """Return whether another adds enough of what an effect adds to the likelihood of what has neither."""
    gain = chosen.log_likelihood - without.log_likelihood
    return gain > 0.0 and other.log_likelihood - without.log_likelihood > _MUCH * gain
