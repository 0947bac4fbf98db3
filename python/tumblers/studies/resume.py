"""`Parts`: a long computation in parts on the disk, so that the next call goes on where one stopped."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ..atomic import write_files
from ..errors import InputError, unreadable

__all__ = ["Parts", "other_setting"]

_SETTINGS = "settings.json"


class Parts:
    """Results that are kept in a folder, each in a file that is written whole or not at all.

    Parameters
    ----------
    folder
        The folder, made if it is missing; None keeps nothing.
    settings
        What the results depend on, as JSON has it.

    Raises
    ------
    InputError
        A folder of other settings, or one that is not of parts.
    OSError
        The folder cannot be written to.
    """

    def __init__(self, folder: Path | None, settings: Mapping[str, Any]) -> None:
        self.folder = folder
        if folder is None:
            return
        file = folder / _SETTINGS
        if folder.exists():
            try:
                kept = json.loads(file.read_text(encoding="utf-8"))
            except (OSError, ValueError) as error:
                raise InputError("parts", f"{unreadable(error)} at {file}", "a folder of this study, or none") from None
            other = other_setting(kept, settings)
            if other is not None:
                found, expected = other
                raise InputError("parts", f"{found} in {folder}", f"{expected}, or another file")
            return
        folder.mkdir()
        write_files({file: json.dumps(settings, indent=1).encode()})

    def part(self, name: str, compute: Callable[[], Any]) -> Any:
        """Return a part: from its file, or computed and then kept.

        Parameters
        ----------
        name
            Its name.
        compute
            Returns it, in what JSON can hold.
        """
        if self.folder is None:
            return compute()
        file = self.folder / f"{name}.json"
        if file.exists():
            return json.loads(file.read_text(encoding="utf-8"))
        result = compute()
        write_files({file: json.dumps(result).encode()})
        return result


def other_setting(kept: object, settings: Mapping[str, Any]) -> tuple[str, str] | None:
    """Return the first setting that differs, as it was kept and as it is; None if all are the same.

    Parameters
    ----------
    kept, settings
        Settings of the results that are there, and those wanted.
    """
    if not isinstance(kept, Mapping):
        return "no settings", "those of this study"
    for key in dict.fromkeys([*settings, *kept]):
        if kept.get(key) != settings.get(key):
            words = [_short(key, table.get(key)) for table in (kept, settings)]
            if words[0] == words[1]:
                words = [f"another {key}", f"this {key}"]
            return words[0], words[1]
    return None


def _short(key: str, value: object) -> str:
    text = json.dumps(value)
    return f"another {key}" if len(text) > 40 else f"{key} {text}"
