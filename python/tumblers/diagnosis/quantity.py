"""Numbers as a reader wants them: a handy unit, and no more digits than the uncertainty allows."""

from __future__ import annotations

from collections.abc import Sequence
from math import floor, isfinite, log10

from .result import Interval

__all__ = ["enumerated", "handy_unit", "percent", "plain", "rounded", "sigmas", "with_interval", "with_sigma"]

# Units that take a prefix, and the prefixes.
_SCALED = ("m", "N", "N m", "s", "S", "T", "Pa s", "m/s", "A/m")
_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"), (1e-12, "p"))
_WRITTEN = {"1": "", "degrees": "°", "m/N": "µm/µN"}
# An interval whose arms differ by more is written by its ends.
_LOPSIDED = 2.0
# An end counts as no nearer than this share of half the interval.
_FINEST = 0.02
_UNKNOWN = "unknown"


def handy_unit(value: float, unit: str) -> tuple[float, str]:
    """Return what to multiply a value of a unit by, and the unit that it has then.

    Parameters
    ----------
    value
        A typical size; zero or not finite for the unit as it is.
    unit
        ``m``, ``N``, ``degrees``, ``1`` for a pure number, or any other word.
    """
    if unit not in _SCALED or not isfinite(value) or value == 0.0:
        return 1.0, _WRITTEN.get(unit, unit)
    for size, prefix in _PREFIXES:
        # Rounding 999.9 up to 1000 is no harm.
        if abs(value) >= size:
            return 1.0 / size, prefix + unit
    return 1e12, f"p{unit}"


def rounded(value: float, error: float | None = None) -> str:
    """Return a number with the digits that its error leaves, or with three.

    Parameters
    ----------
    value, error
        In the same unit; no error where None, zero or not finite.
    """
    if not isfinite(value):
        return _UNKNOWN
    if error is None or not isfinite(error) or error <= 0.0 or max(abs(value), error) >= 1e6:
        return f"{value:z.3g}"
    leading = floor(log10(error))
    decimals = -leading + (1 if error < 1.95 * 10.0**leading else 0)
    if decimals > 9:
        return f"{value:z.3g}"
    return f"{round(value, decimals):z.{max(decimals, 0)}f}"


def with_interval(interval: Interval, unit: str) -> str:
    """Return an estimate with its 90 % interval: ``5.1 ± 0.8 µm``, or ``5.1 µm (4.9 to 10)`` where it is lopsided.

    Parameters
    ----------
    interval
        In SI units or degrees.
    unit
        Of the interval.
    """
    value, low, high = interval.estimate, interval.low, interval.high
    if not isfinite(value):
        return _UNKNOWN
    bounded = isfinite(low) and isfinite(high)
    half = 0.5 * (high - low) if bounded else 0.0
    factor, written = handy_unit(max(abs(value), abs(half)), unit)
    after = written if written in ("", "°") else f" {written}"
    value, low, high, half = factor * value, factor * low, factor * high, factor * half
    text = rounded(value, half)
    if not bounded:
        return f"{text}{after}"
    down, up = value - low, high - value
    if min(down, up) <= 0.0 or max(down, up) > _LOPSIDED * min(down, up):
        # By its nearer end, or it would look like one.
        nearer = min((arm for arm in (down, up) if arm > 0.0), default=0.0)
        fine = min(max(nearer, _FINEST * half), half)
        ends = (rounded(end, fine if arm < half else half) for end, arm in ((low, down), (high, up)))
        return f"{rounded(value, fine)}{after} ({' to '.join(ends)})"
    return f"{text} ± {rounded(half, half)}{after}" if written != "°" else f"{text}° ± {rounded(half, half)}°"


def with_sigma(value: float, sigma: float, unit: str) -> str:
    """Return a value with its standard deviation; see `with_interval`."""
    return with_interval(Interval(value, value - sigma, value + sigma), unit)


def sigmas(gap: float) -> str:
    """Return a gap in noise sigmas with one decimal, none from 100 on."""
    if not isfinite(gap):
        return _UNKNOWN
    return f"{gap:.1f}" if abs(gap) < 99.95 else f"{gap:.0f}"


def plain(value: float, unit: str) -> str:
    """Return a value in a handy unit, with three digits."""
    return with_interval(Interval(value, float("nan"), float("nan")), unit)


def enumerated(items: Sequence[str]) -> str:
    """Return words as an enumeration: ``a, b and c``."""
    return " and ".join([", ".join(items[:-1]), items[-1]] if len(items) > 1 else items)


def percent(share: float) -> str:
    """Return a share as a percentage, ``unknown`` where it is not finite."""
    if not isfinite(share):
        return _UNKNOWN
    if 0.0 < share < 0.01:
        return "less than 1 %"
    # What is nearly certain is not certain.
    return "more than 99 %" if 0.99 < share < 1.0 else f"{100.0 * share:.0f} %"
