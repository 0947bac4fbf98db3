"""The rows as a page in Markdown."""

from __future__ import annotations

from collections.abc import Sequence

from .examine import Examined
from .reproduction import Reproduction
from .row import shown
from .words import HEADS, KINDS, SHARES, TITLE, TOLERANCES, Counts, choice_words, verdict_words

__all__ = ["document", "introduction", "section", "table"]

_HEADS = ("robot", "quantity", "set", "paper", "ours", "tolerance", "verdict")


def document(reproduction: Reproduction) -> str:
    """Return the page ``reproduction.md``.

    Parameters
    ----------
    reproduction
        What was run.
    """
    parts = [introduction(), Counts.of(reproduction.rows).words, _counts(reproduction)]
    parts += [section(one) for one in reproduction.examined]
    return "\n\n".join(parts) + "\n"


def introduction() -> str:
    """Return what the page says before the numbers."""
    return "\n\n".join(
        (
            f"# {TITLE}",
            "Written by `tumblers reproduce --out DIR --page docs/reproduction.md`: every number and statement of the "
            "paper's results, ours beside it, and where they part, what a change of one choice makes of it.",
            TOLERANCES,
            "A set says whose numbers of the substrate a row was run with, the `text`'s or the `released` code's, and, "
            "where a draft is involved, by which formula: `geometric` is what is drawn, `as_released` what the "
            "released code computes. PDMS on aluminium has numbers in the released code only; there the set `text` "
            f"takes the text's only table for aluminium, that of SU-8. All else is {choice_words()}.",
            KINDS,
            SHARES,
        )
    )


def section(one: Examined) -> str:
    """Return a result's part of the page: its table, its tolerances, and why rows differ.

    Parameters
    ----------
    one
        The result.
    """
    parts = [table(one)]
    found = [
        f"- {row.claim.robot}, {row.claim.quantity} ({row.set_name}): {row.why}." for row in one.rows if row.trials
    ]
    if found:
        parts += ["Why rows differ:", "\n".join(found)]
    return "\n\n".join(parts)


def table(one: Examined) -> str:
    """Return a result's heading, rows and tolerances; only the kinds of rows that differ depend on the suspects.

    Parameters
    ----------
    one
        The result.
    """
    rows = [
        (
            row.claim.robot,
            row.claim.quantity,
            row.set_name,
            shown(row.claim.paper),
            shown(row.ours),
            row.claim.tolerance.words,
            verdict_words(row),
        )
        for row in one.rows
    ]
    return "\n\n".join((f"## {one.result.number}. {one.result.title}", _table(_HEADS, rows), _tolerances(one)))


def _tolerances(one: Examined) -> str:
    found = dict.fromkeys((claim.tolerance.words, claim.tolerance.reason) for claim in one.result.claims)
    return "Tolerances: " + "; ".join(f"{words}: {reason}" for words, reason in found) + "."


def _counts(reproduction: Reproduction) -> str:
    lines = [(str(one.result.number), one.result.title, *Counts.of(one.rows).cells()) for one in reproduction.examined]
    return _table(("", "result", *HEADS), lines)


def _table(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join(f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in line)} |" for line in lines)
