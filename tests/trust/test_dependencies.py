"""Dependencies are locked and from one place, and unsafe code stands only where it was reviewed."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
CRATES_IO = "registry+https://github.com/rust-lang/crates.io-index"
# Allocators that count, for the tests that a step allocates nothing: `GlobalAlloc` is an unsafe trait.
REVIEWED = {"crates/dynamics/tests/no_allocation.rs": 5, "crates/mncp/tests/allocation.rs": 9}
UNSAFE = re.compile(r"\bunsafe\b")


def manifest(path: Path) -> dict[str, Any]:
    return tomllib.loads(path.read_text())


def test_every_locked_crate_is_from_crates_io_with_a_checksum_or_from_here() -> None:
    packages = tomllib.loads((ROOT / "Cargo.lock").read_text())["package"]
    here = {package["name"] for package in packages if "source" not in package}
    assert all(name.startswith("tumblers-") for name in here), here
    for package in packages:
        if package["name"] not in here:
            assert package["source"] == CRATES_IO, package["name"]
            assert re.fullmatch(r"[0-9a-f]{64}", package["checksum"]), package["name"]


def test_unsafe_stands_only_where_it_was_reviewed() -> None:
    found = {}
    for file in sorted((ROOT / "crates").rglob("*.rs")):
        # Comments may speak of it.
        code = [line.split("//", 1)[0] for line in file.read_text().splitlines()]
        count = sum(len(UNSAFE.findall(line)) for line in code)
        if count:
            found[file.relative_to(ROOT).as_posix()] = count
    assert found == REVIEWED


def test_every_crate_forbids_unsafe_code() -> None:
    assert manifest(ROOT / "Cargo.toml")["workspace"]["lints"]["rust"]["unsafe_code"] == "forbid"
    for crate in sorted((ROOT / "crates").iterdir()):
        lints = manifest(crate / "Cargo.toml")["lints"]
        by_itself = "#![forbid(unsafe_code)]" in (crate / "src" / "lib.rs").read_text()
        assert lints == {"workspace": True} or by_itself, crate.name
