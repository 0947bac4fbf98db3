"""A trial's conditions in words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import atan2, degrees, hypot
from typing import Any

from ...dataset import LabTrial
from ...field import field_to_table

__all__ = ["condition_of", "condition_of_table"]

_ROLLS_FORWARD = (-1.0, 0.0, 0.0)
# Degrees off the y axis, and the horizontal part of the rotation axis, from which on a direction is worth a word.
_OFF_DEG, _LEVEL = 1.0, 0.02


def condition_of(trial: LabTrial) -> str:
    """Return a trial's field and slope in words: ``10 mT at 12 Hz, level``."""
    return condition_of_table({"field": field_to_table(trial.field), "incline_deg": trial.incline_deg})


def condition_of_table(trial: Mapping[str, Any]) -> str:
    """Return the field and the slope of a ``[[trial]]`` table in words.

    Parameters
    ----------
    trial
        Any of its keys ``field``, ``incline_deg`` and ``duration_s``.
    """
    words = [_field(trial.get("field", {}))]
    incline = trial.get("incline_deg", 0.0)
    words.append("level" if incline == 0.0 else f"{'up' if incline > 0.0 else 'down'} {abs(incline):.3g}°")
    if "duration_s" in trial:
        words.append(f"{trial['duration_s']:.3g} s")
    return ", ".join(words)


def _field(field: Mapping[str, Any]) -> str:
    strength = f"{1e3 * field['strength_T']:.3g} mT" if "strength_T" in field else ""
    match field.get("kind"):
        case "rotating":
            towards = _direction(field.get("rotation_axis", _ROLLS_FORWARD))
            return f"{strength} at {field['frequency_Hz']:.3g} Hz{towards}"
        case "static":
            direction = "/".join(f"{entry:.2g}" for entry in field.get("direction", ()))
            return f"static {strength} along {direction}" if direction else f"static {strength}"
    return "a tabulated field"


def _direction(axis: Sequence[float]) -> str:
    """Return where a field about an axis rolls the robot, a × n, in words; nothing where that is +y."""
    x, y = axis[1], -axis[0]
    off = degrees(atan2(x, y))
    if hypot(x, y) < _LEVEL or abs(off) < _OFF_DEG:
        return ""
    side = "+x" if off > 0.0 else "-x"
    if abs(off) > 180.0 - _OFF_DEG:
        return " backwards"
    return f" towards {side}" if abs(abs(off) - 90.0) < _OFF_DEG else f" {abs(off):.3g}° from +y towards {side}"
