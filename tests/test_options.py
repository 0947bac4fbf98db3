from __future__ import annotations

from pathlib import Path

import pytest

from tumblers.errors import InputError
from tumblers.folder import output_folder
from tumblers.options import output_file


def test_a_link_to_itself_is_an_output_like_another(tmp_path: Path) -> None:
    loop, other = tmp_path / "loop.nc", tmp_path / "other.nc"
    loop.symlink_to(loop)
    output_file("--out", loop, [".nc"], [other])
    with pytest.raises(InputError, match="named twice"):
        output_file("--out", other, [".nc"], [tmp_path / "." / "other.nc"])
    assert [path.name for path in tmp_path.iterdir()] == ["loop.nc"]


def test_a_folder_is_tried_by_a_name_that_is_written_later(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tried: list[Path] = []
    monkeypatch.setattr("tumblers.folder.try_to_write", tried.append)
    output_folder("--out", tmp_path / "out", ["a.json", "b.html"])
    assert tried == [tmp_path / "out" / "a.json"]
    assert not list(tmp_path.iterdir())
