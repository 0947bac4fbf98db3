"""The ten results: what the paper says is all there, and the committed page is what the code writes."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import get_args

import numpy as np
import pytest

from tumblers.reproduction.document import introduction, section, table
from tumblers.reproduction.examine import Examined, examine
from tumblers.reproduction.results import RESULTS
from tumblers.reproduction.results.errors import angles
from tumblers.reproduction.row import Kind
from tumblers.reproduction.suspect import DRAFT, STANDARD
from tumblers.reproduction.words import Counts

PAGE = Path(__file__).parents[2] / "docs" / "reproduction.md"
BY_NUMBER = {result.number: result for result in RESULTS}
KINDS = [kind for kind in get_args(Kind) if kind != "match"]


@cache
def as_chosen(number: int) -> Examined:
    """A result without its suspects: seconds, where all of it takes minutes."""
    return examine(BY_NUMBER[number], 0, lambda done: None, tried=())


def without_kinds(page: str) -> str:
    return re.sub(rf"differs, ({'|'.join(KINDS)}) \|", "differs |", page)


def values(number: int, set_name: str) -> Mapping[tuple[str, str], float | str]:
    return {(r.claim.robot, r.claim.quantity): r.ours for r in as_chosen(number).rows if r.set_name == set_name}


def test_all_ten_results_are_there() -> None:
    assert list(BY_NUMBER) == list(range(1, 11))
    assert len({result.name for result in RESULTS}) == 10


@pytest.mark.parametrize("result", RESULTS, ids=lambda result: result.name)
def test_every_claim_has_a_reason_and_is_made_once(result) -> None:  # type: ignore[no-untyped-def]
    assert all(claim.tolerance.reason for claim in result.claims)
    said = [(claim.robot, claim.quantity) for claim in result.claims]
    assert len(said) == len(set(said))
    assert {choices.parameters for choices in result.sets.values()} == {"text", "released"}


@pytest.mark.parametrize("result", RESULTS, ids=lambda result: result.name)
def test_no_result_leaves_a_suspect_out(result) -> None:  # type: ignore[no-untyped-def]
    """Every choice that the paper leaves open is tried; the draft's formula too, where a set names one."""
    assert set(STANDARD) <= set(result.suspects)
    assert (set(DRAFT) <= set(result.suspects)) is any("as_released" in name for name in result.sets)


@pytest.mark.parametrize("number", range(1, 11))
def test_the_committed_page_has_our_numbers(number: int) -> None:
    """Every row of every result as the code computes it now; of what kind a differing row is takes the suspects."""
    assert without_kinds(table(as_chosen(number))) in without_kinds(PAGE.read_text(encoding="utf-8"))


@pytest.mark.parametrize("number", [3, 4, 10])
def test_the_committed_page_has_our_reasons(number: int) -> None:
    """Every reason of three results that run quickly, their suspects run again."""
    assert section(examine(BY_NUMBER[number], 0, lambda done: None)) in PAGE.read_text(encoding="utf-8")


def test_the_committed_page_says_what_it_is() -> None:
    assert PAGE.read_text(encoding="utf-8").startswith(introduction())


def test_the_committed_page_counts_its_own_rows() -> None:
    """The sentence, and the table of the results, by the kinds of the rows below them."""
    text = PAGE.read_text(encoding="utf-8")
    parts = text.split("\n## ")[1:]
    found = [re.findall(r"\| (match|differs, [a-z ]+) \|$", part, re.MULTILINE) for part in parts]
    numbers = [[kinds.count(words) for words in ("match", *(f"differs, {kind}" for kind in KINDS))] for kinds in found]
    assert [sum(kinds) for kinds in numbers] == [len(kinds) for kinds in found]
    for part, kinds in zip(parts, numbers, strict=True):
        title = part.splitlines()[0].replace(". ", " | ", 1)
        assert f"\n| {title} | {sum(kinds)} | {' | '.join(map(str, kinds))} |\n" in text
    counts = Counts(sum(map(sum, numbers)), *(sum(kinds) for kinds in zip(*numbers, strict=True)))
    assert f"\n{counts.words}\n" in text


def test_the_committed_page_gives_the_reason_of_every_row_by_its_kind() -> None:
    """A reason begins as its row's kind in the table asks."""
    lead = {
        "explained": "shown by a run: ",
        "moved at a cost": "moved by a run, at the cost of other rows: ",
        "open": "none of the ",
    }
    for part in PAGE.read_text(encoding="utf-8").split("\n## ")[1:]:
        cells = [line.strip("| ").replace("\\|", "\0").split(" | ") for line in part.splitlines()]
        rows = [[cell.replace("\0", "|") for cell in row] for row in cells if row[-1].startswith("differs, ")]
        reasons = [line for line in part.splitlines() if line.startswith("- ")]
        assert len(rows) == len(reasons)
        for (robot, quantity, set_name, *_, verdict), reason in zip(rows, reasons, strict=True):
            assert reason.startswith(f"- {robot}, {quantity} ({set_name}): ")
            assert lead[verdict.removeprefix("differs, ")] in reason


def test_slopes_of_paper_are_those_of_the_table() -> None:
    assert [values(2, "text")["cuboid", f"climbs {incline}°"] for incline in (5, 10, 15, 30, 45, 60)] == list("YYYYYN")


def test_adhesion_is_the_text_s_with_the_text_s_parameters_only() -> None:
    """C L W: 1.19 N/m² in the text, 3.7148 in the released code."""
    quantity = ("cuboid", "adhesion with L × W on the slope, N")
    assert values(3, "text")[quantity] == pytest.approx(1.19 * 8e-4 * 4e-4)
    assert values(3, "released")[quantity] == pytest.approx(3.7148 * 8e-4 * 4e-4)


def test_the_draft_s_formula_makes_the_paper_s_tolerance() -> None:
    """Both drafts beside the text's 2°: the drawn one keeps 50 µm to 1° only."""
    quantity = ("spiked (SS)", "greatest φ that keeps |d_e| ≤ 50 µm, °")
    assert values(7, "released, as_released")[quantity] == 2.0
    assert values(7, "released, geometric")[quantity] == 1.0


def test_a_draft_that_cannot_be_built_is_said() -> None:
    assert values(7, "released, as_released")["spiked ends (SES)", "|d_e| at φ = 12°, µm"] == "refused: a face vanishes"
    assert values(9, "released, as_released")["spiked ends (SES)", "cases run"] == 12 * 37


@pytest.mark.parametrize(
    ("found", "words"),
    [
        ([], "none"),
        ([20.0], "20"),
        ([20.0, 30.0, 40.0, 200.0, 210.0], "20 to 40, 200 to 210"),
        ([-10.0, 0.0], "-10 to 0"),
    ],
)
def test_angles_as_ranges(found: list[float], words: str) -> None:
    assert angles(np.array(found), 10.0) == words
