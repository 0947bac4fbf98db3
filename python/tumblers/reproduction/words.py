"""What the page, the document and the terminal say alike."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import get_args

from .choice import Choices
from .row import Kind, Row

__all__ = ["HEADS", "KINDS", "SHARES", "TITLE", "TOLERANCES", "Counts", "choice_words", "verdict_words"]


TITLE = "The paper's results, and ours"
TOLERANCES = (
    "Every row has a tolerance and a reason for it. They were written before this command first ran, but not blind: "
    "the paper's values were known, and so were sweeps that had explored the model. Adhesion on W × H is held to one "
    "of the last digit given, that on L × W to half of it, since W × H times C was known to be 4.76e-8 N where the "
    "text says 4.7e-8 N. After the first run, how adhesion on W × H is read off a run was changed, and so were some of "
    "the sets and of the choices that are tried."
)
KINDS = (
    "A row that differs is run again with one choice changed, each in turn. It is explained if a change moves our "
    "value to the paper's and more rows of the same result and set match with it than without it; moved at a cost if a "
    "change moves it, but spoils at least as many rows as it mends; open if nothing tried moves it. With two dozen "
    "choices some will meet a number by chance: beside each that does stands how many rows then match."
)
SHARES = (
    "Two shares are given. The first counts the rows that match or are explained. The second counts those moved at a "
    "cost too: to the letter they also differ for a reason that a run shows, since one choice was changed and the "
    "number moved to the paper's. They stand apart because a choice that spoils as much as it mends is a poor reason."
)


@dataclass(frozen=True, slots=True)
class Counts:
    """How many rows there are of each kind.

    Attributes
    ----------
    rows, match, explained, moved, open
        All of them, and the four kinds.
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
        kinds = [row.kind for row in rows]
        return cls(len(rows), *(kinds.count(kind) for kind in get_args(Kind)))

    @property
    def words(self) -> str:
        """The counts, and the two shares, as a few sentences."""
        strict = self.match + self.explained
        return (
            f"{self.rows} rows: {self.match} match, {self.rows - self.match} differ. Of those that differ, "
            f"{self.explained} are explained by a change of one choice that was run, {self.moved} are moved by one at "
            f"the cost of other rows, {self.open} are open. Match or explained: {self._share(strict)}; with those "
            f"moved at a cost: {self._share(strict + self.moved)}."
        )

    def cells(self) -> tuple[str, ...]:
        """Return the counts as the cells of a table, under `HEADS`."""
        return tuple(map(str, (self.rows, self.match, self.explained, self.moved, self.open)))

    def _share(self, part: int) -> str:
        return f"{part} of {self.rows}, {100.0 * part / max(self.rows, 1):.1f} %"


HEADS = ("rows", *get_args(Kind))


def choice_words() -> str:
    """Return the choices that all rows have in common, in words."""
    default = Choices()
    return (
        f"the same in all rows: torque {default.magnetic_torque}, adhesion acting at {default.adhesion_acts_at} and "
        f"entering {default.adhesion_enters}, a step of {default.step_s:g} s, e_r = {default.e_r_m:g} m, a line "
        f"contact {default.line_contact_width_m * 1e6:g} µm wide, the robot {default.pose} at rest"
    )


def verdict_words(row: Row) -> str:
    """Return a row's verdict, and of what kind it is where it differs.

    Parameters
    ----------
    row
        The row.
    """
    return "match" if row.verdict == "match" else f"differs, {row.kind}"
