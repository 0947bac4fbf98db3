"""`Share`: how many of how many."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

__all__ = ["Share", "share_of", "together"]


@dataclass(frozen=True, slots=True)
class Share:
    """How many of how many."""

    hits: int
    count: int

    @property
    def share(self) -> float | None:
        """Hits over count; None of none."""
        return self.hits / self.count if self.count else None


def share_of(hits: Sequence[bool]) -> Share:
    """Return how many of some are true."""
    return Share(sum(hits), len(hits))


def together(shares: Iterable[Share]) -> Share:
    """Return all of them as one."""
    each = list(shares)
    return Share(sum(share.hits for share in each), sum(share.count for share in each))
