"""Many scenarios as one native call."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from .. import _core
from ..progress import OnProgress, native_call
from ..scenario import Scenario

__all__ = ["batch"]


def batch(scenarios: Sequence[Scenario], threads: int, on_progress: OnProgress) -> xr.Dataset:
    """Run scenarios and return speed (m/s), drift (m) and twist (degrees) over the dimension ``case``.

    Parameters
    ----------
    scenarios
        What to run.
    threads
        Number of threads, 0 for all.
    on_progress
        Told how many are done.

    Returns
    -------
    xarray.Dataset
        ``speed_m_per_s``, ``drift_m``, ``twist_deg``, ``unconverged_steps``; not a number where a run failed.

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
    columns = {
        "speed_m_per_s": (found["speed_m_per_s"], "m s-1"),
        "drift_m": (found["drift_m"], "m"),
        "twist_deg": (np.degrees(found["twist_rad"]), "degree"),
        "unconverged_steps": (found["unconverged_steps"].astype(np.float64), "1"),
    }
    return xr.Dataset(
        {
            name: ("case", np.where(failed, np.nan, values), {"units": units})
            for name, (values, units) in columns.items()
        }
    )
