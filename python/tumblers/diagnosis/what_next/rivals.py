"""The hypotheses that a next trial is sought for: the chosen one, and it with one effect replaced by a tied one."""

from __future__ import annotations

from ..result import Verdict
from ..what.attribute import Attribution
from ..what.contender import Contender

__all__ = ["PARTIAL_RIVALS", "RIVALS", "rivals"]

# How many at most, and of what does not explain the gap.
RIVALS, PARTIAL_RIVALS = 6, 3


def rivals(
    attribution: Attribution, chosen: Contender, tied: dict[str, tuple[str, ...]], verdict: Verdict
) -> tuple[Contender, ...]:
    """Return the chosen contender and the likeliest of those that are tied with it, in their order.

    Parameters
    ----------
    attribution
        Every contender.
    chosen
        What the verdict is of.
    tied
        For each effect of it those that cannot be told from it.
    verdict
        On which depends how many are returned at most, the chosen one among them.
    """
    found = [chosen]
    for contender in attribution.contenders:
        for name, others in tied.items():
            swapped = {*chosen.names} - {name}
            rival = any(set(contender.names) == swapped | {other} for other in others)
            if rival and contender not in found:
                found.append(contender)
    return tuple(found[: PARTIAL_RIVALS if verdict == "unexplained" else RIVALS])
