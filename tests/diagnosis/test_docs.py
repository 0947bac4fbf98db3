"""What `docs/diagnosis.md` says of numbers that stand in the source."""

from __future__ import annotations

import re
from dataclasses import asdict
from pathlib import Path

import pytest

from tumblers.dataset import Tolerance

PAGE = Path(__file__).parents[2] / "docs" / "diagnosis.md"


def test_how_well_nominal_numbers_count_as_known_is_stated() -> None:
    text = " ".join(PAGE.read_text(encoding="utf-8").split())
    sentence = text.partition("count as known to within these standard deviations: ")[2].partition(". ")[0] + ","
    stated = {}
    for share, names in re.findall(r"([\d.]+) % of (.+?),(?= [\d.]+ %|$)", sentence):
        for name in re.split(r", | and ", names):
            stated[name.replace("the ", "").replace("field's ", "field ")] = float(share) / 100.0
    stated["friction coefficient"] = stated.pop("coefficient of friction")
    assert {name.replace(" ", "_"): share for name, share in stated.items()} == pytest.approx(asdict(Tolerance()))
