"""`seen_place`: where a robot was seen. One that is held up, or drawn on, is not where the model is."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..gap.observed import Observed

__all__ = ["seen_place"]

Floats = NDArray[np.float64]


def seen_place(observed: Observed, local: Floats, time_s: Floats, elsewhere: Floats) -> Floats:
    """Return where a robot was seen, less the origin that was fitted, m, shape (n, 2).

    Between two frames it is on a line between them, before the first and after the last where it was in those.

    Parameters
    ----------
    observed
        What was measured in the trial.
    local
        Its clock (s) and origin (m) as they were fitted, shape (4,).
    time_s
        By the clock of its track, shape (n,).
    elsewhere
        Where it is taken to be along an axis along which it was never seen, m, shape (n, 2).
    """
    place = elsewhere.copy()
    for axis, name in enumerate(("x", "y")):
        seen = observed.values.get(name, np.empty(0))
        found = np.isfinite(seen)
        if found.any():
            place[:, axis] = np.interp(time_s, observed.time_s[found], seen[found] - local[1 + axis])
    return place
