"""The plausible range of every parameter of an effect, for the trials of a dataset."""

from __future__ import annotations

from ..effects.catalogue import CATALOGUE
from .diagnosis import Diagnosis

__all__ = ["neutral_values", "plausible_ranges", "turning_keys"]


def plausible_ranges(diagnosis: Diagnosis, name: str) -> dict[str, tuple[float, float]]:
    """Return the range that was searched for each parameter, over all trials, by its key.

    Parameters
    ----------
    diagnosis
        Whose trials count.
    name
        The effect; one that is not in the catalogue has no ranges.
    """
    if name not in CATALOGUE:
        return {}
    kind = CATALOGUE[name]
    ranges = {p.key: (p.neutral, p.neutral) for p in kind.parameters}
    for floor in diagnosis.floors:
        trial = diagnosis.dataset.trial(floor.trial)
        scenario = trial.scenario(diagnosis.dataset, floor.step_s, model=diagnosis.model)
        for parameter, (low, high) in zip(kind.parameters, kind.ranges(scenario), strict=True):
            widest = ranges[parameter.key]
            ranges[parameter.key] = min(widest[0], low), max(widest[1], high)
    return ranges


def neutral_values(name: str) -> dict[str, float]:
    """Return the value of each parameter of an effect that changes nothing, by its key."""
    return {p.key: p.neutral for p in CATALOGUE[name].parameters} if name in CATALOGUE else {}


def turning_keys(name: str) -> set[str]:
    """Return the keys of an effect's angles that turn on: their ranges have no ends."""
    return {p.key for p in CATALOGUE[name].parameters if p.turns} if name in CATALOGUE else set()
