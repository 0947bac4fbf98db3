from __future__ import annotations

from pathlib import Path

import pytest

from tumblers import (
    InputError,
    Scenario,
    TableField,
)


def with_table(text: str, csv: str = "field.csv") -> str:
    return text.replace('kind = "rotating"\nstrength_T = 0.010\nfrequency_Hz = 5', f'kind = "table"\ncsv = "{csv}"')


ROWS = "time_s,Bx_T,By_T,Bz_T\n0,0,0.01,0\n0.1,0,0,0.01\n0.5,0,-0.01,0\n"


def test_a_table_travels_with_its_scenario(scenario_file: Path, text: str, tmp_path: Path) -> None:
    (tmp_path / "field.csv").write_text(ROWS)
    scenario_file.write_text(with_table(text))
    scenario = Scenario.load(scenario_file)
    assert scenario.field == TableField(
        time_s=(0.0, 0.1, 0.5), field_T=((0.0, 0.01, 0.0), (0.0, 0.0, 0.01), (0.0, -0.01, 0.0))
    )
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    scenario.save(elsewhere / "saved.toml")
    (tmp_path / "field.csv").unlink()
    assert Scenario.load(elsewhere / "saved.toml") == scenario


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        (None, "found no such file: "),
        ("", "columns"),
        ("time_s,Bx_T,By_T\n0,0,0\n", "columns"),
        (ROWS.replace("Bz_T", "B_T"), "columns"),
        (
            ROWS.replace("time_s", "phase,time_s"),
            "expected the columns time_s, Bx_T, By_T, Bz_T, each once and no other",
        ),
        ("time_s,Bx_T,By_T,Bz_T\n0,0,0,0\n", "1 rows"),
        (ROWS.replace("0.1,0,0,0.01", "0.1,0,0"), "line 3 with 3 cells"),
        (ROWS.replace("0.1,0,0,0.01", "0.1,0,x,0.01"), "line 3: By_T 'x'"),
        (ROWS.replace("0.1,0,0,0.01", "0.1,0,nan,0.01"), "finite"),
        (ROWS.replace("0.1,", "0.6,"), "line 4"),
        (ROWS.replace("Bx_T", '"\nBx_T"').replace("0.1,", "x,"), "line 4: time_s 'x'"),
        (
            ROWS.replace("0.5,", "0.2,"),
            "field.csv: found 'field.csv' with rows from 0.0 s to 0.2 s, expected rows that cover 0 s to 0.25 s",
        ),
        (ROWS.replace("\n0,", "\n0.01,"), "cover 0 s to 0.25 s"),
    ],
)
def test_bad_tables_get_one_line(scenario_file: Path, text: str, tmp_path: Path, rows: str | None, words: str) -> None:
    if rows is not None:
        (tmp_path / "field.csv").write_text(rows)
    scenario_file.write_text(with_table(text))
    with pytest.raises(InputError) as caught:
        Scenario.load(scenario_file)
    line = str(caught.value)
    assert "\n" not in line
    assert line.startswith(f"{scenario_file}: field.")
    assert words in line
