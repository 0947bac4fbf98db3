"""Effects that say what a nominal number's being off says too: within its tolerance that is no gap."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import hypot

from ...dataset import Dataset
from ...effects.base import Effect
from ..gap.floor import MOST_OFF

__all__ = ["is_tolerated", "least_deviation", "tolerated"]

# Parameters that are a nominal number's factor, and the number; others of these effects are not tolerated at all.
_FACTORS: Mapping[str, Mapping[str, str]] = {
    "magnetization_strength": {"factor": "magnetization"},
    "friction_coefficient": {"factor": "friction_coefficient"},
    "adhesion_coefficient": {"factor": "adhesion"},
    "size_error": {"length_factor": "length", "height_factor": "height"},
}
_FORCE = "electrostatic_force"
# Of a torque m × B nobody knows whether the moment or the field is off, nor of what it lifts whether the weight is.
_SAME: Mapping[str, tuple[str, ...]] = {"magnetization": ("field_strength", "mass")}


def tolerated(kind: type[Effect], lab: Dataset) -> tuple[tuple[float, float], ...] | None:
    """Return between which values of each parameter an effect says what a nominal number may be off.

    Three standard deviations of the number's tolerance either way; None for what no nominal number's being off does,
    the neutral value alone for a parameter that is no number's factor.

    Parameters
    ----------
    kind
        The effect.
    lab
        Whose nominal numbers they are, and how well it knows them.
    """
    if kind.name == _FORCE:
        most = MOST_OFF * _force_deviation(lab)
        return ((-most, most),) if most > 0.0 else None
    numbers = _FACTORS.get(kind.name)
    if numbers is None:
        return None
    shares = [MOST_OFF * _share(numbers[p.key], lab) if p.key in numbers else 0.0 for p in kind.parameters]
    # A number that is hardly known may be off by more than it can be.
    return tuple(
        (max(p.neutral - share, p.low), min(p.neutral + share, p.high))
        for p, share in zip(kind.parameters, shares, strict=True)
    )


def is_tolerated(effects: Sequence[Effect], lab: Dataset) -> bool:
    """Return whether each effect keeps a nominal number within three standard deviations of its tolerance.

    Parameters
    ----------
    effects
        What is named.
    lab
        Whose nominal numbers they are, and how well it knows them.
    """

    def within(effect: Effect) -> bool:
        ends = tolerated(type(effect), lab)
        return ends is not None and all(a <= v <= b for v, (a, b) in zip(effect.vector(), ends, strict=True))

    return bool(effects) and all(map(within, effects))


def least_deviation(name: str, key: str, value: float, lab: Dataset) -> float:
    """Return the standard deviation that a parameter has at least: a factor's is that of its number.

    Parameters
    ----------
    name, key
        Of the effect and of its parameter.
    value
        The parameter.
    lab
        Whose nominal numbers they are, and how well it knows them.
    """
    if name == _FORCE:
        return _force_deviation(lab)
    number = _FACTORS.get(name, {}).get(key)
    return 0.0 if number is None else value * _share(number, lab)


def _share(number: str, lab: Dataset) -> float:
    """Return the standard deviation of a nominal number's factor, with that of others that nobody can tell from it."""
    return hypot(*(getattr(lab.tolerance, n) for n in (number, *_SAME.get(number, ()))))


def _force_deviation(lab: Dataset) -> float:
    return lab.tolerance.electrostatic_force * lab.substrate.electrostatic_force_N
