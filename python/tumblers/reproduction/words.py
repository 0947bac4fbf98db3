"""What the page, the document and the terminal say alike."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from .choice import Choices
from .row import Row

__all__ = ["HEADS", "Counts", "choice_words", "verdict_words"]


@dataclass(frozen=True, slots=True)
class Counts:
    """How many rows match, differ for a reason that a run shows, are only moved by one, and differ without any.

    Attributes
    ----------
    rows, match, explained, moved, open
        All of them, and the four parts.
    """

    rows: int
    match: int
    explained: int
    moved: int
    open: int

    @classmethod
    def of(cls, rows: Sequence[Row]) -> Counts:
        """Return the counts of some rows.

        Parameters
        ----------
        rows
            Rows of any results.
        """
        match = sum(row.verdict == "match" for row in rows)
        explained = sum(row.explained for row in rows)
        moved = sum(row.moved and not row.explained for row in rows)
        return cls(len(rows), match, explained, moved, len(rows) - match - explained - moved)

    @property
    def words(self) -> str:
        """The counts as a sentence or two."""
        strict, loose = (
            100.0 * part / max(self.rows, 1)
            for part in (self.match + self.explained, self.match + self.explained + self.moved)
        )
        return (
            f"{self.rows} rows: {self.match} match; {self.explained} differ and a change of one choice moves them to "
            f"the paper's value, with more rows matching than before; {self.moved} differ and such a change moves them "
            f"at the cost of other rows; {self.open} differ and nothing tried moves them there. {strict:.0f} % match "
            f"or are explained by a run, {loose:.0f} % with those that are moved at a cost."
        )

    def cells(self) -> tuple[str, ...]:
        """Return the counts as the cells of a table, under `HEADS`."""
        return tuple(map(str, (self.rows, self.match, self.explained, self.moved, self.open)))


HEADS = ("rows", "match", "explained", "moved at a cost", "open")


def choice_words() -> str:
    """Return the choices that all rows have in common, in words."""
    default = Choices()
    return (
        f"the same in all rows: torque {default.magnetic_torque}, adhesion acting at {default.adhesion_acts_at} and "
        f"entering {default.adhesion_enters}, a step of {default.step_s:g} s, e_r = {default.e_r_m:g} m, a line "
        f"contact {default.line_contact_width_m * 1e6:g} µm wide, the robot {default.pose} at rest"
    )


def verdict_words(row: Row) -> str:
    """Return a row's verdict, and whether a run shows why.

    Parameters
    ----------
    row
        The row.
    """
    if row.verdict == "match":
        return "match"
    return f"differs, {'explained' if row.explained else 'moved at a cost' if row.moved else 'open'}"
