"""Points beyond the thresholds of an effect: on lines from neutral to the ends of its range.

A threshold shows only beyond it, and what lies just beyond is neither like the nominal motion nor like what lies far
beyond: the lines are halved on either side of their best points, for the trials that are most off.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ..fitting.fitter import Fitter
from ..fitting.hypothesis import Hypothesis
from ..gap.comparison import Residual
from .margins import CLEAR

__all__ = ["beyond_thresholds"]

Floats = NDArray[np.float64]

# Shares of the way from neutral to each end of a range that are tried, how often the stretches beside the best of them
# are halved (where nothing moves at first, where it moves at once), for effects with no more parameters than this, for
# each of so many trials that are farthest off; the best points that are kept.
_GRID, _HALVINGS, _EARLY_HALVINGS, _FEW, _WORST, _HINTS = (0.2, 0.5, 0.8, 1.0), 12, 5, 2, 3, 2
# A stretch whose ends differ by less, in ln, has nothing in it; what is beyond a threshold may by chance be as bad as
# before.
_MOVED = 0.125


def beyond_thresholds(fitter: Fitter, hypothesis: Hypothesis, nominal: Residual) -> list[Floats]:
    """Return the points that are much better than the nominal model for a trial in which that is most off, best first.

    Parameters
    ----------
    fitter
        Of the dataset.
    hypothesis
        An effect; one of many parameters has too many lines, and gets none.
    nominal
        How wrong the nominal model is.
    """
    if hypothesis.free > _FEW:
        return []
    # By number: a robot that soon leaves the view says little, but may be farther off than any.
    off = [fitter.trial_cost(nominal, i) / max(fitter.comparison.weighed[i], 1.0) for i in fitter.trials]
    wrong = tuple(int(i) for i in np.argsort(off, kind="stable")[-_WORST:] if off[i] > 1.0)
    found: list[tuple[float, Floats]] = []
    clear = fitter.comparison.objective_of(CLEAR)
    zeros = np.zeros(len(hypothesis.neutral))
    for i in wrong:
        # With what all trials share fitted to this one alone, as along the lines.
        still = fitter.cost(fitter.residuals(hypothesis, [zeros], (i,))[0], zeros, (i,))
        lines = [_along(fitter, hypothesis, end, still, i) for end in hypothesis.ends]
        found += [(cost - still, point) for cost, point in lines if cost < still - clear]
    return [point for _, point in sorted(found, key=lambda entry: entry[0])[:_HINTS]]


def _along(fitter: Fitter, hypothesis: Hypothesis, end: Floats, still: float, trial: int) -> tuple[float, Floats]:
    """Return the least objective of a trial between neutral and an end of the range, and its point."""
    known = {0.0: still}
    clear, moved = fitter.comparison.objective_of(CLEAR), fitter.comparison.objective_of(_MOVED)
    shares: Sequence[float] = _GRID
    done, most = 0, _HALVINGS
    while shares and done <= most:
        points = [share * end for share in shares]
        residuals = fitter.residuals(hypothesis, points, (trial,))
        for share, point, residual in zip(shares, points, residuals, strict=True):
            known[share] = fitter.cost(residual, point, (trial,))
        order, least = sorted(known), min(known.values())
        # Of a plateau, its far end: beyond it something begins to move.
        place = max(n for n, share in enumerate(order) if known[share] < least + clear)
        near = order[max(place - 1, 0) : place + 2]
        shares = [0.5 * (a + b) for a, b in pairwise(near) if abs(known[a] - known[b]) > moved]
        if abs(known[order[1]] - still) <= clear:
            most = _HALVINGS
        elif done == 0:
            # No plateau: what is better than neutral is for least squares to find, what is not may begin early.
            most = 0 if least < still - clear else _EARLY_HALVINGS
        done += 1
    best = min(known, key=lambda share: known[share])
    return known[best], best * end
