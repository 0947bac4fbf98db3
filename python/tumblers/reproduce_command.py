"""The command ``tumblers reproduce``."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter
from typing import Annotated

import typer

from .check import thread_count
from .errors import InputError
from .folder import output_folder
from .options import numbers, output_file, path_option

__all__ = ["reproduce"]


def reproduce(
    out: Annotated[
        Path, path_option("--out", "Folder for reproduction.json, index.html, figures and data; made if missing.")
    ],
    only: Annotated[
        str | None, typer.Option(metavar="NUMBERS", help="Results to run, 2,7 or 1:4; all ten without it.")
    ] = None,
    jobs: Annotated[int | None, typer.Option(help="Threads; all by default. The result does not depend on it.")] = None,
    page: Annotated[Path | None, path_option("--page", "All rows as a page in Markdown (.md).")] = None,
) -> None:
    """Run every result of the paper and set our numbers beside the paper's, with a verdict and a tested reason.

    \b
    Examples:
      tumblers reproduce --out reproduction
      tumblers reproduce --only 2,7 --out reproduction
      tumblers reproduce --out reproduction --page docs/reproduction.md
    """  # noqa: D301 - \b keeps the lines of an example apart
    wanted = None if only is None else _wanted(only)
    if page is not None:
        output_file("--page", page, (".md",), [])
        if only is not None:
            raise InputError("--page", "it beside --only", "it with all results")
    if jobs is not None:
        thread_count("--jobs", jobs)
    from .reproduction.reproduce import chosen
    from .reproduction.reproduce import reproduce as run
    from .reproduction.reproduction import file_names
    from .reproduction.terminal import print_counts

    output_folder("--out", out, file_names(chosen(wanted)))
    start = perf_counter()
    reproduction = run(wanted, jobs=jobs, progress=True)
    reproduction.save(out, page, progress=True)
    print_counts(reproduction)
    typer.echo(f"\npage: {out / 'index.html'}\ntime: {perf_counter() - start:.1f} s")


def _wanted(text: str) -> list[int]:
    from .reproduction.reproduce import NUMBERS

    expected = f"numbers of results from {NUMBERS[0]} to {NUMBERS[-1]}, such as 2,7 or 1:4"
    try:
        found = numbers("--only", text)
    except InputError:
        raise InputError("--only", repr(text), expected) from None
    if any(number not in NUMBERS for number in found):
        raise InputError("--only", repr(text), expected)
    return [int(number) for number in found]
