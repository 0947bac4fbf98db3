"""The page that each command writes its own section of."""

from __future__ import annotations

import re
from pathlib import Path

__all__ = ["SECTIONS", "table", "with_section", "written_page"]

_HEADER = """# Performance

Written by the commands of the sections below, each its own section, and not by hand. A figure is a ratio of
alternating repetitions in one run on one machine, or says what else it is; a target that is missed is called missed.
The benchmarks of the crates alone are in [benches/README.md](../benches/README.md)."""
# Name of the section, in the order of the page: what writes it.
SECTIONS = {
    "mujoco": "python benches/against_mujoco.py",
    "drake": "python benches/against_drake.py",
    "accuracy": "python benches/time_to_accuracy.py",
}


def _begin(name: str) -> str:
    return f"<!-- {name}: written by `{SECTIONS[name]} --page docs/performance.md` -->"


def _end(name: str) -> str:
    return f"<!-- end of {name} -->"


def with_section(page: str, name: str, text: str) -> str:
    """Return a page with one section replaced, the others as they were.

    Parameters
    ----------
    page
        The page so far, empty if there is none.
    name
        A key of `SECTIONS`.
    text
        The section's Markdown.
    """
    found = {key: match.group(1) for key in SECTIONS if (match := _pattern(key).search(page))}
    found[name] = f"\n{text.strip()}\n"
    parts = [f"{_begin(key)}{found[key]}{_end(key)}" for key in SECTIONS if key in found]
    return "\n\n".join([_HEADER, *parts]) + "\n"


def _pattern(name: str) -> re.Pattern[str]:
    return re.compile(re.escape(_begin(name)) + "(.*?)" + re.escape(_end(name)), re.DOTALL)


def written_page(path: Path, name: str, text: str) -> bytes:
    """Return the bytes of a page file with one section replaced.

    Parameters
    ----------
    path
        The page, which need not exist.
    name, text
        The section, and its Markdown.
    """
    page = path.read_text(encoding="utf-8") if path.exists() else ""
    return with_section(page, name, text).encode()


def table(head: list[str], rows: list[list[str]]) -> str:
    """Return a Markdown table.

    Parameters
    ----------
    head, rows
        Its cells.
    """
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)
