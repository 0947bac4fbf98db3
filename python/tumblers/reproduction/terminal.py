"""The counts as a table on a terminal."""

from __future__ import annotations

from .reproduction import Reproduction
from .words import HEADS, Counts

__all__ = ["print_counts"]


def print_counts(reproduction: Reproduction) -> None:
    """Print how many rows of each result match and differ.

    Parameters
    ----------
    reproduction
        What was run.
    """
    from rich.console import Console
    from rich.table import Table

    console = Console()
    table = Table()
    for heading in ("", "result"):
        table.add_column(heading, overflow="fold")
    for heading in HEADS:
        table.add_column(heading, justify="right")
    for one in reproduction.examined:
        table.add_row(str(one.result.number), one.result.title, *Counts.of(one.rows).cells())
    console.print(table)
    console.print(Counts.of(reproduction.rows).words, highlight=False)
