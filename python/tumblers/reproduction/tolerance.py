"""`Tolerance`: how far our number may lie from the paper's, and why; `words.TOLERANCES` says when that was written."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import Literal

__all__ = ["Tolerance", "absolute", "at_least", "at_most", "exact", "relative"]

Kind = Literal["exact", "absolute", "relative", "at_most", "at_least"]


@dataclass(frozen=True, slots=True)
class Tolerance:
    """How far our number may lie from the paper's.

    Attributes
    ----------
    kind
        ``exact``, ``absolute``, ``relative``, or, where the paper gives a limit, ``at_most`` and ``at_least``.
    size
        How much, in the number's unit, or as a share of the paper's number where relative; the limit itself for the
        last two.
    reason
        Why so much.
    """

    kind: Kind
    size: float
    reason: str

    def holds(self, paper: float | str, ours: float | str) -> bool:
        """Whether our number agrees with the paper's; what is no number never agrees with one.

        Parameters
        ----------
        paper, ours
            The two numbers, or words where the paper makes a statement.
        """
        if isinstance(ours, str):
            return self.kind == "exact" and paper == ours
        if not isfinite(ours):
            return False
        match self.kind:
            case "at_most":
                return ours <= self.size
            case "at_least":
                return ours >= self.size
        if isinstance(paper, str):
            return False
        margin = {"exact": 0.0, "absolute": self.size, "relative": self.size * abs(paper)}[self.kind]
        return abs(ours - paper) <= margin

    @property
    def words(self) -> str:
        """The tolerance in a few words, without its reason."""
        match self.kind:
            case "exact":
                return "exact"
            case "relative":
                return f"± {100.0 * self.size:g} %"
            case "at_most":
                return f"at most {self.size:g}"
            case "at_least":
                return f"at least {self.size:g}"
        return f"± {self.size:g}"


def exact(reason: str) -> Tolerance:
    """Return a tolerance that only the paper's own value meets."""
    return Tolerance("exact", 0.0, reason)


def absolute(size: float, reason: str) -> Tolerance:
    """Return a tolerance in the number's unit."""
    return Tolerance("absolute", size, reason)


def relative(size: float, reason: str) -> Tolerance:
    """Return a tolerance as a share of the paper's number."""
    return Tolerance("relative", size, reason)


def at_most(limit: float, reason: str) -> Tolerance:
    """Return a limit that our number must not pass."""
    return Tolerance("at_most", limit, reason)


def at_least(limit: float, reason: str) -> Tolerance:
    """Return a limit that our number must reach."""
    return Tolerance("at_least", limit, reason)
