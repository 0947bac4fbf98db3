"""`Target`: what was aimed at, what was measured, and whether it was met."""

from __future__ import annotations

from dataclasses import dataclass

from .page import table

__all__ = ["Target", "target_table"]


@dataclass(frozen=True)
class Target:
    """One aim.

    Attributes
    ----------
    what
        In words, with the unit.
    aim, measured
        The bound and the figure.
    at_most
        Whether the figure has to lie below the bound.
    disturbed
        Whether it is a time on the wall while other work ran.
    """

    what: str
    aim: float
    measured: float
    at_most: bool
    disturbed: bool = False

    @property
    def met(self) -> bool:
        """Whether it was reached."""
        return self.measured <= self.aim if self.at_most else self.measured >= self.aim

    @property
    def verdict(self) -> str:
        """Met or missed, in words."""
        if self.met:
            return "met"
        return "**missed**, while other work ran" if self.disturbed else "**missed**"


def target_table(targets: list[Target]) -> str:
    """Return the aims as Markdown.

    Parameters
    ----------
    targets
        All of them.
    """
    rows = [
        [
            target.what,
            f"{'≤' if target.at_most else '≥'} {target.aim:g}",
            f"{target.measured:.3g}",
            target.verdict,
        ]
        for target in targets
    ]
    return table(["aim", "bound", "measured", ""], rows)
