"""``[[effect]]`` entries of a scenario."""

from __future__ import annotations

from .errors import InputError, show
from .section import require_table

__all__ = ["refuse_effects"]


def refuse_effects(value: object) -> None:
    """Raise `InputError` for the first entry: this version has no effects, and none is left out in silence."""
    if not isinstance(value, list):
        raise InputError("effect", show(value), "an array of tables [[effect]]")
    for i, entry in enumerate(value):
        key = f"effect[{i}]"
        table = require_table(key, entry)
        if not isinstance(table.get("name"), str):
            raise InputError(
                f"{key}.name", show(table["name"]) if "name" in table else "no such key", "an effect's name"
            )
        raise InputError(f"{key}.name", show(table["name"]), "no [[effect]]: effects are not available in this version")
