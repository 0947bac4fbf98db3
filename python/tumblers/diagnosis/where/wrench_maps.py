"""The missing wrench by phase, contact mode, place and frequency, and which of its components stand out."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import ceil, inf, log10

import numpy as np

from ...dataset import Dataset
from ...field import RotatingField, TableField
from ..result import MissingWrench, Region
from .cells import MODES
from .wrench_means import Windows, means
from .wrench_pieces import HALF_A_CYCLE

__all__ = ["SIGNIFICANT", "mapped", "wrench_regions"]

_PHASES = 8
_PLACES = 6
# What places are told apart by at most, over all of them, m.
_LEAST_M = 1e-6
_COMPONENTS = ("x", "y", "z")
# A component is missing from this many standard deviations on.
SIGNIFICANT = 3.0
# A field turns if this share of its strength is ever across its strongest: a logged ramp is not quite straight.
_ACROSS = 0.1


def mapped(dataset: Dataset, windows: Sequence[Windows], phased: Sequence[Windows]) -> MissingWrench:
    """Return the missing wrench with its means by phase, contact mode, place and frequency.

    Parameters
    ----------
    dataset
        Whose trials they are.
    windows
        By trial, along it.
    phased
        Of the same trials, those that tell phases and contact modes of the cycle.
    """
    labs = dataset.trials
    within = [[_at_phase(labs[w.trial].field, w, (b + 0.5) / _PHASES) for w in phased] for b in range(_PHASES)]
    # Phases that no window tells apart are one.
    firsts = [b for b in range(_PHASES) if b == 0 or within[b] != within[b - 1]]
    width = 360.0 / _PHASES
    phases = {f"{first * width:.0f}–{last * width:.0f}°": within[first] for first, last in pairwise([*firsts, _PHASES])}
    places = np.concatenate([w.place_y_m for w in windows])
    ends = np.linspace(places.min(), max(places.max(), places.min() + _LEAST_M), _PLACES + 1)
    ends[-1] = inf
    # As many digits as tell one end from the next.
    digits = max(1, ceil(-log10(1e3 * (ends[1] - ends[0]))))
    by_place = {
        f"{1e3 * low:.{digits}f}–{1e3 * min(high, places.max()):.{digits}f} mm": [
            [k for k, y in enumerate(w.place_y_m) if low <= y < high] for w in windows
        ]
        for low, high in pairwise(ends)
    }
    drives = {w.trial: _drive(labs[w.trial].field) for w in windows}
    by_frequency = {
        drive[1]: [list(range(len(w.start_s))) if drives[w.trial] == drive else [] for w in windows]
        for drive in sorted(set(drives.values()))
    }
    by_mode = {m: [[k for k, mode in enumerate(w.mode) if mode == m] for w in phased] for m in MODES}
    return MissingWrench(
        trials=tuple(labs[w.trial].id for w in windows for _ in w.start_s),
        start_s=np.concatenate([w.start_s for w in windows]),
        end_s=np.concatenate([w.end_s for w in windows]),
        wrench=np.concatenate([w.wrench for w in windows]),
        sigma=np.concatenate([w.sigma for w in windows]),
        prior_sigma=np.concatenate([np.tile(w.prior_sigma, (len(w.start_s), 1)) for w in windows]),
        by_phase=means(phased, phases),
        by_mode=means(phased, by_mode),
        by_place=means(windows, by_place),
        by_frequency=means(windows, by_frequency),
    )


def wrench_regions(missing: MissingWrench) -> tuple[Region, ...]:
    """Return the components of the missing wrench that stand clear of their uncertainty, the greatest share first.

    Parameters
    ----------
    missing
        The missing wrench.

    Returns
    -------
    tuple
        Regions on the axes ``missing_force`` and ``missing_torque``. With the mean over each frequency, a share is that
        of the component in ``Σ (w/σ)²``, less what noise gives; `sigmas` is the greatest ``|w/σ|``.
    """
    scaled = np.array([mean.wrench / mean.sigma for mean in missing.by_frequency.values()])
    excess = np.maximum(np.sum(scaled**2 - 1.0, axis=0), 0.0)
    clearest, greatest = np.argmax(np.abs(scaled), axis=0), np.max(np.abs(scaled), axis=0)
    averages = list(missing.by_frequency.values())
    regions = []
    for component in np.flatnonzero(greatest > SIGNIFICANT):
        share = float(excess[component] / max(float(excess.sum()), 1e-12))
        axis = "missing_force" if component < 3 else "missing_torque"
        at = averages[clearest[component]]
        mean, sigma = float(at.wrench[component]), float(at.sigma[component])
        value, sigmas = _COMPONENTS[component % 3], float(greatest[component])
        regions.append(Region(axis, share, value=value, sigmas=sigmas, missing=(mean, sigma)))
    return tuple(sorted(regions, key=lambda region: -region.share_of_gap))


def _drive(field: object) -> tuple[float, str]:
    """Return a field's frequency, Hz, where it has one, and what it is called."""
    if isinstance(field, RotatingField):
        return field.frequency_Hz, f"{field.frequency_Hz:g} Hz"
    return 0.0, "turning otherwise" if isinstance(field, TableField) and _turns(field) else "not rotating"


def _turns(field: TableField) -> bool:
    """Return whether a tabulated field is ever across its strongest."""
    rows = np.array(field.field_T)
    strength = np.linalg.norm(rows, axis=1)
    strongest = rows[np.argmax(strength)]
    across = np.linalg.norm(np.cross(rows, strongest), axis=1)
    return bool(across.max() > _ACROSS * strength.max() ** 2)


def _at_phase(field: object, windows: Windows, centre: float) -> list[int]:
    """Return the windows of half a cycle at most in which a phase, as a share of the cycle, lies."""
    if not isinstance(field, RotatingField):
        return []
    start, end = windows.start_s * field.frequency_Hz, windows.end_s * field.frequency_Hz
    after = (centre - start) % 1.0
    return [k for k in range(len(start)) if end[k] - start[k] <= HALF_A_CYCLE and after[k] < end[k] - start[k]]
