"""What a figure was measured on: a class of machine, never its name."""

from __future__ import annotations

import os
import platform
import sys
from datetime import UTC, datetime
from typing import Any

__all__ = ["conditions", "conditions_in_words", "is_busy", "load", "threads"]

# Runnable threads of others, in parts of the cores, beyond which times on the wall are not those of an idle machine.
_BUSY = 0.1


def threads() -> int:
    """Return how many threads this process may use at once."""
    # macOS knows no affinity.
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def load() -> float:
    """Return the load average of the last minute."""
    return os.getloadavg()[0]


def conditions(versions: dict[str, str], load_before: float, repetitions: int) -> dict[str, Any]:
    """Return what the page says of the machine.

    Parameters
    ----------
    versions
        Of the engines.
    load_before
        Load average before the first measurement.
    repetitions
        How many.
    """
    return {
        "date": datetime.now(UTC).date().isoformat(),
        "cores": threads(),
        "architecture": platform.machine(),
        "versions": {**versions, "python": platform.python_version(), "platform": sys.platform},
        "load_average_before": load_before,
        "repetitions": repetitions,
    }


def is_busy(found: dict[str, Any]) -> bool:
    """Return whether other work ran when the measurement began.

    Parameters
    ----------
    found
        What `conditions` returned.
    """
    return bool(found["load_average_before"] > _BUSY * found["cores"])


def conditions_in_words(found: dict[str, Any]) -> str:
    """Return the machine in one paragraph.

    Parameters
    ----------
    found
        What `conditions` returned.
    """
    versions = ", ".join(f"{name} {version}" for name, version in found["versions"].items() if name != "platform")
    text = (
        f"Measured on {found['date']}: a {found['cores']}-core {found['architecture']} machine, {versions};"
        f" {found['repetitions']} alternating repetitions after one that does not count."
    )
    if is_busy(found):
        text += (
            f" **Other work ran on it (load average {found['load_average_before']:.1f} before the start)**: processor"
            " times and their ratios hold; times on the wall, and what follows from them, are of a shared machine."
        )
    return text
