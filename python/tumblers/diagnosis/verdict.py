"""Whether there is a gap, whether it is explained, and what cannot be told apart.

The posterior predictive test holds the mean squared difference, over all trials and in the worst one, against what a
right model gives: the floor is made so that this is below 1.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .attribute import Attribution, Contender
from .comparison import Comparison
from .fit import robust_cost
from .result import Gap, Verdict

__all__ = ["judge", "mean_squares", "ties"]

# A right model's mean square over all numbers, and in its worst trial.
_EXPLAINED, _WORST = 1.25, 2.0
# And on trials that no fit has seen.
_FORETOLD, _NO_WORSE = 1.5, 1.02
# A gap is called one where the best effects take away more than this share of the noise's variance.
_LEAST_GAP = 0.01
# Evidence that is less than this factor apart (ln 20), or predictions that differ by less than this in noise sigmas.
_TIED, _SAME = 3.0, 0.25


def mean_squares(contender: Contender) -> NDArray[np.float64]:
    """Return Σρ/n of each trial, shape (trials,)."""
    return np.array([robust_cost(values) / max(len(values), 1) for values in contender.residual.trials])


def _mean_square(comparison: Comparison, contender: Contender) -> float:
    return float(np.average(mean_squares(contender), weights=comparison.sizes))


def judge(comparison: Comparison, attribution: Attribution, gap: Gap) -> tuple[Verdict, Contender]:
    """Return the verdict, and the hypothesis that is chosen: the nominal model where there is no gap.

    Parameters
    ----------
    comparison
        The dataset.
    attribution
        Every hypothesis.
    gap
        On trials that the best hypothesis had not seen.
    """
    nominal, best = attribution.nominal, attribution.contenders[0]
    if _right(comparison, nominal) and (
        not best.names or _mean_square(comparison, nominal) - _mean_square(comparison, best) < _LEAST_GAP
    ):
        return "no_gap", nominal
    if not best.names:
        return "unexplained", best
    # Where the trial that shows the effect is left out, nothing can foretell it: then no worse than nominal is enough.
    foretold = bool(gap.held_out_trials) and (
        gap.after**2 <= _FORETOLD or gap.after <= _NO_WORSE * gap.after_nuisance_only
    )
    return ("explained" if _right(comparison, best) and foretold else "unexplained"), best


def _right(comparison: Comparison, contender: Contender) -> bool:
    each = mean_squares(contender)
    # In a trial of few numbers noise alone gives more.
    worst = _WORST * (1.0 + 2.0 * np.sqrt(2.0 / np.maximum(comparison.sizes, 1)))
    return bool(_mean_square(comparison, contender) <= _EXPLAINED and np.all(each <= worst))


def ties(comparison: Comparison, attribution: Attribution, chosen: Contender) -> dict[str, tuple[str, ...]]:
    """Return for each effect of the chosen set those that these trials cannot tell apart from it.

    Parameters
    ----------
    comparison
        The dataset.
    attribution
        Every hypothesis.
    chosen
        The one that is reported.
    """
    trials = range(len(comparison.readers))
    said = chosen.residual.over(trials)
    out: dict[str, list[str]] = {name: [] for name in chosen.names}
    for other in attribution.contenders:
        if len(other.names) != len(chosen.names) or other.names == chosen.names:
            continue
        swapped = [name for name in chosen.names if name not in other.names]
        put_in = [name for name in other.names if name not in chosen.names]
        if len(swapped) != 1:
            continue
        apart = float(np.sqrt(np.mean((other.residual.over(trials) - said) ** 2)))
        if chosen.log_evidence - other.log_evidence < _TIED or apart < _SAME:
            out[swapped[0]].append(put_in[0])
    return {name: tuple(dict.fromkeys(others)) for name, others in out.items()}
