"""The effects that are ruled out: improbable alone, and beside another."""

from __future__ import annotations

from math import log

import numpy as np

from ..fitting.fitter import Fitter
from .attribute import REFUSED, Attribution
from .contender import Contender

__all__ = ["LEAST_ODDS", "ruled_out"]

# ln of the odds against an effect that is ruled out: those against what has failed the predictive test.
LEAST_ODDS = -log(REFUSED)


def ruled_out(
    fitter: Fitter, attribution: Attribution, chosen: Contender, tied: dict[str, tuple[str, ...]]
) -> dict[str, str]:
    """Return each effect that is ruled out, with the trial that speaks most against it alone.

    Parameters
    ----------
    fitter
        Of the dataset.
    attribution
        Every contender.
    chosen
        What the verdict is of.
    tied
        For each effect of it those that cannot be told from it.
    """
    out = {}
    named = {*chosen.names, *(other for others in tied.values() for other in others)}
    for contender in attribution.contenders:
        if len(contender.names) != 1 or contender.names[0] in named:
            continue
        if attribution.log_odds(chosen, contender.names[0]) < LEAST_ODDS:
            continue
        against = [
            fitter.trial_cost(contender.residual, i) - fitter.trial_cost(chosen.residual, i) for i in fitter.trials
        ]
        worst = int(np.argmax(against))
        if against[worst] > 0.0:
            out[contender.names[0]] = fitter.comparison.dataset.trials[worst].id
    return out
