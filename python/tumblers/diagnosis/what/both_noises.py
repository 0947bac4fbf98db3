"""`by_both_noises`: what is about as good as the best is compared with it against the noise around either.

Each contender has the noise around itself, and near a threshold that around two that say the same can differ by much.
With T(a|b) the total of a, fitted on, against the noise around b, a contender c is behind the best b by the mean

```text
½ (T(c|b) - T(b|b)) + ½ (T(c|c) - T(b|c))
```

so that neither is held against the noise that favours the other alone. Of what is compared so, what leads then has the
evidence that what led before had: nothing gains on the rest by it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ...progress import OnPhase
from ..fitting.fitter import Fitter
from .contender import Contender
from .own_noise import lead_around

__all__ = ["by_both_noises"]

# What is less than this behind the best by evidence is compared so, so many at most. A choice: in near ties whose
# truth was known the mean moved what is between two contenders by up to 2.4.
_NEAR, _MOST = 3.0, 4


def by_both_noises(fitter: Fitter, ranked: Sequence[Contender], dispersion: float, tell: OnPhase) -> list[Contender]:
    """Return the contenders, those near the best behind it by the mean over both noises.

    Parameters
    ----------
    fitter
        Of the dataset. The noise is as before.
    ranked
        By evidence, the best first.
    dispersion
        c: a total's share of ln Z is -total/(2c).
    tell
        Is told the phase, how much of it is done, and of how much.
    """
    best, made = ranked[0], list(ranked)
    near = [
        k
        for k, other in enumerate(ranked)
        if k > 0 and len(other.names) == len(best.names) > 0 and best.log_evidence - other.log_evidence < _NEAR
    ][:_MOST]
    totals, evidence = {0: best.total}, {0: best.log_evidence}
    for n, k in enumerate(near):
        tell("against the noise around either", n, len(near))
        behind = 0.5 * (lead_around(fitter, best, ranked[k]) - lead_around(fitter, ranked[k], best))
        totals[k] = best.total + behind
        evidence[k] = ranked[k].log_evidence - 0.5 * (totals[k] - ranked[k].total) / dispersion
    more = 2.0 * dispersion * (max(evidence.values()) - best.log_evidence)
    for k, total in totals.items():
        made[k] = replace(ranked[k], offset=ranked[k].offset + total + more - ranked[k].total)
    return made
