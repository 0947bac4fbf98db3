"""`same_settings`: results that are there already, held against those that are wanted."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from .errors import InputError

__all__ = ["same_settings"]


def same_settings(kept: object, settings: Mapping[str, Any], where: Path) -> None:
    """Refuse results of other settings.

    Parameters
    ----------
    kept, settings
        Settings of the results that are there, and those wanted.
    where
        Where they are.

    Raises
    ------
    InputError
        For the key ``parts``: the first setting that differs.
    """
    if not isinstance(kept, Mapping):
        raise InputError("parts", f"no settings in {where}", "those of these results, or another file")
    for key in dict.fromkeys([*settings, *kept]):
        pair = kept.get(key), settings.get(key)
        # As text, a NaN is the same as another.
        if pair[0] != pair[1] and json.dumps(pair[0]) != json.dumps(pair[1]):
            found, expected = (_short(key, value) for value in pair)
            if found == expected:
                found, expected = f"another {key}", f"this {key}"
            raise InputError("parts", f"{found} in {where}", f"{expected}, or another file")


def _short(key: str, value: object) -> str:
    text = json.dumps(value)
    return f"another {key}" if len(text) > 40 else f"{key} {text}"
