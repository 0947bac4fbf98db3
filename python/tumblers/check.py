"""Checks of single values: each returns the value in its own type, or raises `InputError` for its key."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from numbers import Real
from typing import TypeVar

import numpy as np

from .errors import InputError, show

__all__ = [
    "Vector",
    "choice",
    "decimal",
    "direction",
    "number",
    "pair",
    "sequence",
    "text",
    "thread_count",
    "unit_quaternion",
    "vector",
]

Vector = tuple[float, float, float]
T = TypeVar("T")

# A vector this close to length one is left as it is, so that what has been normalised stays the same bits.
_UNIT = 1e-12
# A quaternion written with few digits is still meant to have length one.
_QUATERNION_UNIT = 1e-6
# More threads than any machine has cores only take its memory.
_MOST_THREADS = 1024


def number(
    key: str,
    value: object,
    *,
    above: float | None = None,
    least: float | None = None,
    below: float | None = None,
    most: float | None = None,
) -> float:
    """Return a finite number within its bounds as a float; a bool is not a number."""
    # Sweeps and fits check millions that are right: the words are for one that is not.
    if type(value) is float:
        found = value
    elif isinstance(value, bool | np.bool_) or not isinstance(value, Real):
        raise _refused(key, value, above, least, below, most)
    else:
        try:
            found = float(value)
        except OverflowError:
            found = math.inf
    if (
        not math.isfinite(found)
        or (above is not None and found <= above)
        or (least is not None and found < least)
        or (below is not None and found >= below)
        or (most is not None and found > most)
    ):
        raise _refused(key, value, above, least, below, most)
    return found


def _refused(
    key: str, value: object, above: float | None, least: float | None, below: float | None, most: float | None
) -> InputError:
    limits = [("greater than", above), ("of at least", least), ("less than", below), ("of at most", most)]
    bounds = " and ".join(f"{words} {limit:g}" for words, limit in limits if limit is not None)
    return InputError(key, show(value), f"a finite number {bounds}".strip())


def text(key: str, value: object, expected: str) -> str:
    """Return a string."""
    if not isinstance(value, str):
        raise InputError(key, show(value), expected)
    return value


def thread_count(key: str, value: object) -> int:
    """Return a number of threads or processes."""
    if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= _MOST_THREADS:
        raise InputError(key, show(value), f"a whole number of at least 1 and at most {_MOST_THREADS}")
    return value


def choice(key: str, value: object, choices: Sequence[str]) -> str:
    """Return one of `choices`."""
    if not isinstance(value, str) or value not in choices:
        raise InputError(key, show(value), " or ".join(choices))
    return value


def sequence(key: str, value: object, expected: str, item: Callable[[str, object], T]) -> tuple[T, ...]:
    """Return the items of a list, each checked by `item`."""
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, str | bytes) or not isinstance(value, Sequence):
        raise InputError(key, show(value), expected)
    return tuple(item(f"{key}[{i}]", entry) for i, entry in enumerate(value))


def _numbers(key: str, value: object, count: int) -> tuple[float, ...]:
    # Of a fit's millions of scenarios nearly all have been checked already.
    if type(value) is tuple and len(value) == count and {*map(type, value)} == {float}:
        checked: tuple[float, ...] = value
        if all(map(math.isfinite, checked)):
            return checked
    expected = f"a list of {count} numbers"
    found = sequence(key, value, expected, number)
    if len(found) != count:
        raise InputError(key, show(value), expected)
    return found


def decimal(text: str) -> float:
    """Return the number that a cell of a table holds.

    Raises
    ------
    ValueError
        Anything that other readers of tables would not take for one: Python also knows ``1_0`` and other scripts.
    """
    if "_" in text or not text.isascii():
        raise ValueError(text)
    return float(text)


def pair(key: str, value: object, *, most: float | None = None) -> tuple[float, float]:
    """Return two finite numbers, neither more than `most` from zero."""
    x, y = _numbers(key, value, 2)
    if most is not None:
        for i, entry in enumerate((x, y)):
            number(f"{key}[{i}]", entry, least=-most, most=most)
    return x, y


def vector(key: str, value: object) -> Vector:
    """Return three finite numbers."""
    x, y, z = _numbers(key, value, 3)
    return x, y, z


def direction(key: str, value: object) -> Vector:
    """Return three finite numbers that are not all zero, at length one."""
    found = vector(key, value)
    length = math.hypot(*found)
    if not 0.0 < length < math.inf:
        raise InputError(key, show(value), "a direction that is not zero")
    if abs(length - 1.0) <= _UNIT:
        return found
    # The largest component first, so that no length under- or overflows.
    scale = max(abs(component) for component in found)
    x, y, z = (component / scale for component in found)
    length = math.hypot(x, y, z)
    return x / length, y / length, z / length


def unit_quaternion(key: str, value: object) -> tuple[float, float, float, float]:
    """Return a unit quaternion ``w, x, y, z``."""
    w, x, y, z = _numbers(key, value, 4)
    length = math.hypot(w, x, y, z)
    if not abs(length - 1.0) <= _QUATERNION_UNIT:
        raise InputError(key, f"{show(value)} of length {length:g}", "a quaternion w, x, y, z of length 1")
    if abs(length - 1.0) <= _UNIT:
        return w, x, y, z
    return w / length, x / length, y / length, z / length
