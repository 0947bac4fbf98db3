"""A trial's conditions in words."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..dataset import LabTrial
from ..field import field_to_table

__all__ = ["condition_of", "condition_of_table"]


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
            # The default axis rolls the robot towards +y.
            backwards = " backwards" if field.get("rotation_axis", (-1.0, 0.0, 0.0))[0] > 0.5 else ""
            return f"{strength} at {field['frequency_Hz']:.3g} Hz{backwards}"
        case "static":
            direction = "/".join(f"{entry:.2g}" for entry in field.get("direction", ()))
            return f"static {strength} along {direction}" if direction else f"static {strength}"
    return "a tabulated field"
