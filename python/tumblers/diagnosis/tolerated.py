"""Whether effects say no more than that a nominal number is off within its tolerance: that is no gap."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ..effects.base import Effect
from ..scenario import Scenario
from .floor import TOLERANCES

__all__ = ["is_tolerated"]

# So many standard deviations may a nominal number be off.
_MOST = 3.0
# Parameters that are a nominal number's factor, and the number.
_FACTORS: Mapping[str, Mapping[str, str]] = {
    "magnetization_strength": {"factor": "magnetization"},
    "friction_coefficient": {"factor": "friction coefficient"},
    "adhesion_coefficient": {"factor": "adhesion"},
    "size_error": {"length_factor": "length", "height_factor": "height"},
}
_FORCE = "electrostatic_force"


def is_tolerated(effects: Sequence[Effect], scenarios: Sequence[Scenario]) -> bool:
    """Return whether each effect keeps a nominal number within three standard deviations of its tolerance.

    Parameters
    ----------
    effects
        What is named.
    scenarios
        The nominal ones of all trials.
    """
    return bool(effects) and all(_within(effect, scenarios) for effect in effects)


def _within(effect: Effect, scenarios: Sequence[Scenario]) -> bool:
    values = dict(zip((p.key for p in effect.parameters), effect.vector(), strict=True))
    if effect.name == _FORCE:
        (added,) = values.values()
        nominal = min(scenario.substrate.electrostatic_force_N for scenario in scenarios)
        return abs(added) <= _MOST * TOLERANCES["electrostatic force"] * nominal
    numbers = _FACTORS.get(effect.name)
    return numbers is not None and all(
        abs(values[key] - 1.0) <= _MOST * TOLERANCES[number] for key, number in numbers.items()
    )
