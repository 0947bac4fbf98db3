"""`Speed`: our steps per second against a peer's, one row of a table."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from .clock import Contestant, Ratio, alternate, microseconds, ratio
from .page import table

__all__ = ["COPIES", "Speed", "speed_lines", "speed_table", "timed"]

# Runs of 2000 steps in one sample on one thread: tenths of a second, which outlast the bursts of a shared machine.
COPIES = 64


@dataclass(frozen=True)
class Speed:
    """One robot in one situation.

    Attributes
    ----------
    situation, peer
        What is run, and the peer's call and settings.
    threads
        Number of threads; with one the processor's time counts, with more the time on the wall.
    ours_us, theirs_us
        Median time of a step, µs: with several threads, of all robots together.
    ratio
        Our steps per second over theirs.
    processor_ratio
        The same by the processor's time of all threads, which other work on the machine does not lengthen.
    """

    situation: str
    peer: str
    threads: int
    ours_us: float
    theirs_us: float
    ratio: Ratio
    processor_ratio: Ratio


def timed(
    situation: str,
    peer: str,
    threads: int,
    contestants: tuple[Contestant, Contestant],
    repetitions: int,
    tell: Callable[[], None],
) -> Speed:
    """Time our contestant and theirs in turn.

    Parameters
    ----------
    situation, peer, threads
        As in `Speed`.
    contestants
        Ours, then theirs.
    repetitions
        How many.
    tell
        Called after each.
    """
    samples = alternate(dict(zip(("ours", "theirs"), contestants, strict=True)), repetitions, tell)
    wall = threads > 1
    ours, theirs = samples["ours"], samples["theirs"]
    return Speed(
        situation,
        peer,
        threads,
        microseconds(ours, wall),
        microseconds(theirs, wall),
        ratio(ours, theirs, wall),
        ratio(ours, theirs),
    )


def speed_table(rows: list[Speed], peer: str) -> str:
    """Return the rows as Markdown.

    Parameters
    ----------
    rows
        What was timed.
    peer
        The peer's name.
    """
    head = ["what runs", f"{peer}'s call and settings", "threads", "ours, µs a step", f"{peer}, µs a step"]
    body = [
        [
            row.situation,
            row.peer,
            str(row.threads),
            f"{row.ours_us:.3g}",
            f"{row.theirs_us:.3g}",
            f"**{row.ratio.median:.3g}** ({row.ratio.least:.3g} to {row.ratio.greatest:.3g})"
            + (f"; of processor times {row.processor_ratio.median:.3g}" if row.threads > 1 else ""),
        ]
        for row in rows
    ]
    return table([*head, "our steps per second over theirs"], body)


def speed_lines(rows: list[Speed]) -> list[str]:
    """Return the rows as a command says them.

    Parameters
    ----------
    rows
        What was timed.
    """
    return [
        f"{row.situation}, {row.peer}, {row.threads} thread{'s' if row.threads > 1 else ''}: {row.ours_us:.3g} against"
        f" {row.theirs_us:.3g} µs a step, ratio {row.ratio.median:.3g}"
        for row in rows
    ]
