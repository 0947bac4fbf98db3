"""`seen_along`: where along y a robot was seen. One that is held up, or drawn on, is not where the model is."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.signal import medfilt

from ..gap.observed import Observed

__all__ = ["seen_along"]

Floats = NDArray[np.float64]

# Of so many frames the middle one counts: one that is mistracked is nowhere.
_FRAMES = 3


def seen_along(observed: Observed, local: Floats, time_s: Floats, elsewhere: Floats) -> Floats:
    """Return where along y a robot was seen, less the origin that was fitted, m, shape (n,).

    Between two frames it is on a line between them, before the first and after the last where it was in those. Across,
    where a robot that rolls straight does not go, being seen elsewhere is the gap itself, and no place of it.

    Parameters
    ----------
    observed
        What was measured in the trial.
    local
        Its clock (s) and origin (m) as they were fitted, shape (4,).
    time_s
        By the clock of its track, shape (n,).
    elsewhere
        Where it is taken to be if it was never seen, m, shape (n,).
    """
    seen = observed.values.get("y", np.empty(0))
    found = np.isfinite(seen)
    if not found.any():
        return elsewhere
    place = seen[found] - local[2]
    if len(place) >= _FRAMES:
        place[1:-1] = medfilt(place, _FRAMES)[1:-1]
    along: Floats = np.interp(time_s, observed.time_s[found], place)
    return along
