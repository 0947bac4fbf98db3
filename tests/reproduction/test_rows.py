"""Tolerances, verdicts, and what a differing row says."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import nan
from typing import ClassVar

import pytest
import xarray as xr
from matplotlib.figure import Figure

from tumblers import InputError
from tumblers.progress import OnProgress
from tumblers.reproduction.choice import Choices
from tumblers.reproduction.claim import Claim
from tumblers.reproduction.examine import examine, most_runs
from tumblers.reproduction.paper_result import PaperResult
from tumblers.reproduction.row import shown
from tumblers.reproduction.suspect import STANDARD, Suspect, suspects
from tumblers.reproduction.tolerance import Tolerance, absolute, at_least, at_most, exact, relative
from tumblers.reproduction.words import Counts


@pytest.mark.parametrize(
    ("tolerance", "paper", "ours", "holds"),
    [
        (exact(""), "Y", "Y", True),
        (exact(""), "Y", "N", False),
        (exact(""), 13.0, 13.0, True),
        (exact(""), 13.0, 12.0, False),
        (absolute(0.5, ""), 10.0, 10.5, True),
        (absolute(0.5, ""), 10.0, 10.6, False),
        (relative(0.1, ""), -20.0, -21.9, True),
        (relative(0.1, ""), -20.0, -22.1, False),
        (at_most(50.5, ""), "at most 50", 50.4, True),
        (at_most(50.5, ""), "at most 50", 50.6, False),
        (at_least(0.5, ""), "often", 0.5, True),
        (at_least(0.5, ""), "often", 0.4, False),
        (at_most(50.5, ""), "at most 50", nan, False),
        (absolute(0.5, ""), 0.0, nan, False),
        (absolute(0.5, ""), 0.0, "no flip", False),
        (absolute(0.5, ""), "Y", 0.0, False),
    ],
)
def test_tolerance(tolerance: Tolerance, paper: float | str, ours: float | str, holds: bool) -> None:
    assert tolerance.holds(paper, ours) is holds


@pytest.mark.parametrize(
    ("value", "words"),
    [(-0.0, "0"), (1093.39995, "1093"), (3.808e-7, "3.808e-07"), (nan, "no value"), ("Y", "Y"), (0.99782, "0.9978")],
)
def test_values_are_shown_with_four_digits(value: float | str, words: str) -> None:
    assert shown(value) == words


def test_a_suspect_that_changes_nothing_is_not_tried() -> None:
    tried = suspects(STANDARD, Choices(parameters="released"))
    assert "the released parameters" not in [suspect.words for suspect in tried]
    assert "the text's parameters" in [suspect.words for suspect in tried]


def claim(quantity: str, paper: float, read: str) -> Claim:
    return Claim(
        robot="cuboid",
        quantity=quantity,
        paper=paper,
        tolerance=absolute(0.1, "as an example"),
        measure=lambda data: float(data[read]),
    )


class Example(PaperResult):
    """Two numbers that depend on e_r, one that depends on the width, and one that depends on nothing."""

    number = 1
    name = "example"
    title = "Example"
    sets: ClassVar = {"text": Choices(), "released": Choices(parameters="released")}
    suspects = (
        Suspect("small e_r", {"e_r_m": 1.0}),
        Suspect("wide", {"line_contact_width_m": 2.0}),
        Suspect("broken", {"step_s": 3.0}),
        Suspect("the released parameters", {"parameters": "released"}),
    )
    runs = 2
    claims = (
        claim("mended", 1.0, "e_r"),
        claim("spoilt", 0.1, "e_r"),
        claim("moved alone", 2.0, "width"),
        claim("never", 7.0, "nothing"),
    )

    def __init__(self) -> None:
        self.ran: list[Choices] = []

    def simulate(self, choices: Choices, threads: int, on_progress: OnProgress) -> xr.Dataset:
        self.ran.append(choices)
        if choices.step_s == 3.0:
            raise InputError("run.step_s", "3", "less")
        on_progress(self.runs)
        return xr.Dataset({"e_r": choices.e_r_m, "width": choices.line_contact_width_m, "nothing": 0.0})

    def figure(self, data: Mapping[str, xr.Dataset], figure: Figure) -> None:
        figure.subplots()


def test_what_moves_a_row_is_found_by_a_run() -> None:
    told: list[int] = []
    example = Example()
    rows = {row.claim.quantity: row for row in examine(example, 1, told.append).rows if row.set_name == "text"}
    assert [row.verdict for row in rows.values()] == ["differs", "match", "differs", "differs"]
    mended, alone, never = rows["mended"], rows["moved alone"], rows["never"]
    # e_r mends one row and spoils another: moved, and no explanation.
    assert mended.kind == "moved at a cost"
    assert (
        mended.why
        == "moved by a run, at the cost of other rows: 1 with small e_r (1 of the set's 4 rows then match, 1 before)"
    )
    assert alone.kind == "explained"
    assert alone.why == "shown by a run: 2 with wide (2 of the set's 4 rows then match, 1 before)"
    assert never.kind == "open"
    assert rows["spoilt"].kind == "match"
    assert never.why == (
        "none of the 4 choices tried explains it: a run that fails with broken; "
        "unchanged with small e_r, wide, the released parameters"
    )
    assert rows["spoilt"].trials == ()
    assert told == sorted(told)
    assert told[-1] == most_runs(example) == 2 * (2 + 4 + 3)


def test_the_counts_name_every_kind_and_both_shares() -> None:
    counts = Counts.of(examine(Example(), 1, lambda done: None).rows)
    assert (counts.rows, counts.match, counts.explained, counts.moved, counts.open) == (8, 2, 2, 2, 2)
    assert counts.words == (
        "8 rows: 2 match, 6 differ. Of those that differ, 2 are explained by a change of one choice that was run, 2 "
        "are moved by one at the cost of other rows, 2 are open. Match or explained: 4 of 8, 50.0 %; with those moved "
        "at a cost: 6 of 8, 75.0 %."
    )


def test_the_same_choices_are_run_once() -> None:
    example = Example()
    examine(example, 1, lambda done: None)
    assert len(example.ran) == len(set(example.ran))
    assert example.sets["released"] in example.ran


def test_suspects_wait_until_a_row_differs() -> None:
    example = Example()
    example.claims = example.claims[1:2]  # type: ignore[misc]
    told: list[int] = []
    rows = examine(example, 1, told.append).rows
    assert [row.verdict for row in rows] == ["match", "match"]
    assert example.ran == list(example.sets.values())
    assert told[-1] == most_runs(example)


def test_a_row_in_json() -> None:
    row = examine(Example(), 1, lambda done: None).rows[2]
    table = row.table()
    assert {key: table[key] for key in ("number", "name", "robot", "quantity", "paper", "ours", "verdict")} == {
        "number": 1,
        "name": "example",
        "robot": "cuboid",
        "quantity": "moved alone",
        "paper": 2.0,
        "ours": 0.0,
        "verdict": "differs",
    }
    assert (table["kind"], table["moved_by"]) == ("explained", ["wide"])
    assert (table["set"], table["parameters"], table["draft_model"]) == ("text", "text", "geometric")
    assert table["tolerance"] == "± 0.1"
    assert replace(row, ours=nan).table()["ours"] is None
