"""Many scenarios as one native call."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..progress import OnProgress, native_call
from ..scenario import Scenario

__all__ = ["mean_speeds"]


def mean_speeds(scenarios: Sequence[Scenario], threads: int, on_progress: OnProgress) -> NDArray[np.float64]:
    """Run n scenarios and return their mean speeds along y, m/s, shape (n,); not a number where a run failed.

    Parameters
    ----------
    scenarios
        What to run.
    threads
        Number of threads, 0 for all.
    on_progress
        Told how many are done.

    Raises
    ------
    InputError
        A scenario that cannot be run.
    SimulationError
        The native module gave up.
    """
    trials = [scenario.trial() for scenario in scenarios]
    with native_call("runs", len(trials), on_progress) as report:
        found = _core.sweep(trials, threads, report)
    failed = np.array([bool(error) for error in found["error"]], dtype=bool)
    return np.where(failed, np.nan, found["speed_m_per_s"])
