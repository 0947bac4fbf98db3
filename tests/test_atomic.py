"""Files are written whole or not at all, and a writer that was killed leaves nothing for long."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tumblers.atomic import is_unfinished, try_to_write, write_files

pytestmark = pytest.mark.skipif(os.name == "nt", reason="there a process is not asked after: what it left stays")

# Says that it has begun, and then waits before the second file, the first not yet moved.
WRITER = """
import sys
from pathlib import Path
from tumblers.atomic import write_files

write_bytes = Path.write_bytes

def slow(self, data):
    if "two.nc" in self.name:
        print("begun", flush=True)
        sys.stdin.read()
    return write_bytes(self, data)

Path.write_bytes = slow
write_files({Path("one.nc"): b"half", Path("two.nc"): b"half"})
"""


def names(folder: Path) -> set[str]:
    return {file.name for file in folder.iterdir()}


def begun(folder: Path) -> subprocess.Popen[str]:
    """Start a process that has begun to write and does not go on."""
    process = subprocess.Popen(
        [sys.executable, "-c", WRITER], cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "begun\n"
    return process


def test_what_a_killed_writer_left_goes_with_the_next_write_of_that_file(tmp_path: Path) -> None:
    process = begun(tmp_path)
    process.send_signal(signal.SIGKILL)
    process.communicate()
    (left,) = tmp_path.iterdir()
    assert is_unfinished(left)
    write_files({tmp_path / "three.nc": b"other"})
    assert names(tmp_path) == {left.name, "three.nc"}
    write_files({tmp_path / "one.nc": b"whole"})
    assert names(tmp_path) == {"one.nc", "three.nc"}
    assert (tmp_path / "one.nc").read_bytes() == b"whole"


def test_what_another_writer_is_at_is_left_to_it(tmp_path: Path) -> None:
    process = begun(tmp_path)
    write_files({tmp_path / "one.nc": b"whole"})
    assert len(names(tmp_path)) == 2
    assert (tmp_path / "one.nc").read_bytes() == b"whole"
    process.communicate()
    assert process.returncode == 0
    assert names(tmp_path) == {"one.nc", "two.nc"}
    assert (tmp_path / "one.nc").read_bytes() == b"half"


def test_hidden_files_of_others_stay(tmp_path: Path) -> None:
    # The last is of a machine that has another name.
    others = {".one.nc.tmp", ".one.nc.backup.tmp", f".one.nc.{'g' * 32}.tmp", f".one.nc.{'0' * 32}.tmp"}
    for name in others:
        (tmp_path / name).write_text("mine")
    write_files({tmp_path / "one.nc": b"whole"})
    assert names(tmp_path) == {"one.nc", *others}


def test_where_one_file_cannot_be_written_none_is(tmp_path: Path) -> None:
    (tmp_path / "one.nc").write_bytes(b"before")
    with pytest.raises(FileNotFoundError):
        write_files({tmp_path / "one.nc": b"after", tmp_path / "none" / "two.nc": b"after"})
    assert names(tmp_path) == {"one.nc"}
    assert (tmp_path / "one.nc").read_bytes() == b"before"


def test_a_folder_in_the_way_of_one_leaves_the_others_as_they_were(tmp_path: Path) -> None:
    (tmp_path / "one.nc").write_bytes(b"before")
    (tmp_path / "two.nc").mkdir()
    with pytest.raises(IsADirectoryError, match=r"two\.nc"):
        write_files({tmp_path / "one.nc": b"after", tmp_path / "two.nc": b"after"})
    assert (tmp_path / "one.nc").read_bytes() == b"before"
    assert names(tmp_path) == {"one.nc", "two.nc"}


def test_what_is_tried_leaves_nothing(tmp_path: Path) -> None:
    (tmp_path / "one.nc").write_bytes(b"whole")
    try_to_write(tmp_path / "one.nc")
    with pytest.raises(OSError, match="too long"):
        try_to_write(tmp_path / ("n" * 240))
    with pytest.raises(FileNotFoundError):
        try_to_write(tmp_path / "gone" / "one.nc")
    assert names(tmp_path) == {"one.nc"}
    assert (tmp_path / "one.nc").read_bytes() == b"whole"
