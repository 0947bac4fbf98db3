"""`Parts`: kept whole, never mixed with others, and nothing that is not theirs is ever touched."""

from __future__ import annotations

from pathlib import Path

import pytest

from tumblers import InputError
from tumblers.parts import Parts, parts_beside

from .kill import files_of

SETTINGS = {"drafts_deg": [0.0, float("nan")], "seed": 1}


def never() -> object:
    raise AssertionError("computed again")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return tmp_path / "out.nc.parts"


def test_a_part_is_computed_once(folder: Path) -> None:
    kept = Parts(folder, SETTINGS)
    assert not folder.exists()
    assert kept.part("one", lambda: [1.5], bool) == [1.5]
    assert Parts(folder, SETTINGS).part("one", never, bool) == [1.5]
    with pytest.raises(InputError, match=r"parts: found something else in .*one\.json"):
        kept.part("one", never, lambda held: held != [1.5])
    kept.discard()
    assert not folder.exists()


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("notes.txt", "mine", "no such file at .*settings.json"),
        ("settings.json", "[1]", "no settings in"),
        ("settings.json", "{", "text that is no JSON in"),
        ("settings.json", "[" * 100_000, "text that is no JSON in"),
        ("settings.json", '{"drafts_deg": [0.0, NaN], "seed": 2}', "seed 2 in .*, expected seed 1, or another file"),
    ],
)
def test_a_folder_of_anything_else_is_refused_and_stays(folder: Path, name: str, content: str, words: str) -> None:
    folder.mkdir()
    (folder / name).write_text(content)
    with pytest.raises(InputError, match=f"^parts: found {words}"):
        Parts(folder, SETTINGS)
    assert files_of(folder) == {name: content.encode()}


def test_a_file_in_the_folders_place_is_refused(folder: Path) -> None:
    folder.write_text("mine")
    with pytest.raises(InputError, match=r"^parts: found the file .*, expected a folder of these results, or none"):
        Parts(folder, SETTINGS)
    assert folder.read_text() == "mine"


def test_what_a_killed_write_left_is_no_part_and_goes_with_them(folder: Path) -> None:
    folder.mkdir()
    unfinished = folder / f".settings.json.{'0' * 32}.tmp"
    unfinished.write_text("{")
    kept = Parts(folder, SETTINGS)
    with pytest.raises(KeyboardInterrupt), kept.resumable():
        raise KeyboardInterrupt
    kept.part("one", lambda: 1, bool)
    assert {file.name for file in folder.iterdir()} == {"settings.json", "one.json", unfinished.name}
    kept.discard()
    assert not folder.exists()


def test_parts_that_were_discarded_halfway_are_cleared_up(folder: Path) -> None:
    kept = Parts(folder, SETTINGS)
    for name in ("one", "two"):
        kept.part(name, lambda: 1, bool)
    (folder / "settings.json").rename(folder / "ended.json")
    (folder / "one.json").unlink()
    before = files_of(folder)
    with pytest.raises(InputError, match=r"^parts: found seed 1 in .*, expected seed 2"):
        Parts(folder, {**SETTINGS, "seed": 2})
    assert files_of(folder) == before
    Parts(folder, SETTINGS)
    assert not folder.exists()


def test_what_is_not_of_the_results_stays(folder: Path) -> None:
    kept = Parts(folder, SETTINGS)
    kept.part("one", lambda: 1, bool)
    (folder / "mine").mkdir()
    (folder / "mine" / "settings.json").write_text("{}")
    (folder / "mine.nc").mkdir()
    (folder / ".notes").write_text("mine")
    kept.discard()
    assert files_of(folder) == {"mine/settings.json": b"{}", ".notes": b"mine"}
    assert (folder / "mine.nc").is_dir()


def test_another_process_may_end_the_same_results(folder: Path) -> None:
    kept, other = Parts(folder, SETTINGS), Parts(folder, SETTINGS)
    kept.part("one", lambda: 1, bool)
    assert other.part("one", never, bool) == 1
    other.discard()
    kept.part("two", lambda: 2, bool)
    assert Parts(folder, SETTINGS).part("two", never, bool) == 2


def test_other_results_that_were_begun_meanwhile_are_neither_mixed_nor_removed(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    kept = Parts(folder, SETTINGS)
    Parts(folder, {"seed": 2}).part("one", lambda: 2, bool)
    before = files_of(folder)
    for name in ("one", "two"):
        with pytest.raises(InputError, match=r"^parts: found drafts_deg null in"):
            kept.part(name, lambda: 1, bool)
    kept.discard()
    with pytest.raises(KeyboardInterrupt), kept.resumable():
        raise KeyboardInterrupt
    assert files_of(folder) == before
    assert capsys.readouterr().err == ""


def test_ctrl_c_says_what_is_kept_and_leaves_nothing_where_nothing_is(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    kept = Parts(folder, SETTINGS)
    kept._begin()
    with pytest.raises(KeyboardInterrupt), kept.resumable():
        raise KeyboardInterrupt
    assert not folder.exists()
    kept.part("one", lambda: 1, bool)
    with pytest.raises(SystemExit) as left, kept.resumable():
        raise KeyboardInterrupt
    assert left.value.code == 130
    assert capsys.readouterr().err == (
        f"tumblers: interrupted, 1 parts kept in {folder}: the same command goes on from there\n"
    )
    assert Parts(folder, SETTINGS).part("one", never, bool) == 1


def test_parts_lie_beside_what_they_are_of(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert parts_beside(Path("out.nc")) == Path("out.nc.parts")
    assert parts_beside(Path()) == tmp_path.with_name(f"{tmp_path.name}.parts")
