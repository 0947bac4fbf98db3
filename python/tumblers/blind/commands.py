"""The commands of ``tumblers blind``."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer

from ..errors import InputError
from ..options import numbers, output_file, path_argument, path_option
from ..parts import Parts, parts_beside

__all__ = ["blind_app"]

blind_app = typer.Typer(
    add_completion=False,
    rich_markup_mode=None,
    no_args_is_help=True,
    help="Datasets whose truth is drawn at random and sealed: make them, diagnose them, score the diagnoses.",
)

_Jobs = Annotated[int | None, typer.Option(help="Processes; all cores by default. The result does not depend on it.")]
_Directory = Annotated[Path, path_argument("DIR", "Folder of `tumblers blind make`.")]


@blind_app.command("make")
def _make(
    seed: Annotated[int, typer.Option(help="What everything is drawn from.")],
    count: Annotated[int, typer.Option(help="Number of datasets.")],
    out: Annotated[Path, path_option("--out", "Folder; made if it does not exist.")],
    jobs: _Jobs = None,
) -> None:
    """Write datasets of worlds that are not the model, their seals, and answers.json.

    What is done is kept in OUT.parts, answers and all, until the whole is written: the same command goes on from there.

    \b
    Examples:
      tumblers blind make --seed 1 --count 100 --out blind
    """  # noqa: D301
    from .make import make, make_settings

    parts = parts_beside(out)
    with _as_options():
        kept = Parts(parts, make_settings(seed, count))
        with kept.resumable():
            make(out, seed=seed, count=count, parts=parts, jobs=jobs, progress=True)
    kept.discard()
    typer.echo(f"{count} datasets and their answers in {out}")


@blind_app.command("run")
def _run(
    directory: _Directory,
    jobs: _Jobs = None,
    threads: Annotated[int, typer.Option(help="Threads of each diagnosis.")] = 1,
    only: Annotated[str, typer.Option(help="Numbers of the datasets to diagnose, such as 0,3 or 10:19.")] = "",
) -> None:
    """Diagnose every dataset that has no diagnosis of this version yet; the answers stay closed.

    \b
    Examples:
      tumblers blind run blind
      tumblers blind run blind --only 0:11 --jobs 2 --threads 2
    """  # noqa: D301
    from .run import run

    with _as_options():
        done, skipped, failed = run(directory, jobs=jobs, threads=threads, only=_numbers(only), progress=True)
    typer.echo(f"{done} diagnosed, {skipped} done before, {failed} failed")
    if failed:
        raise typer.Exit(1)


@blind_app.command("repeat")
def _repeat(
    directory: _Directory,
    count: Annotated[int, typer.Option(help="How many of them.")] = 5,
    threads: Annotated[int, typer.Option(help="Threads of a diagnosis.")] = 4,
) -> None:
    """Diagnose the datasets that took longest again, one after another: for their time, and for the same answer.

    Those with so few trials that their time has to hold, and as many of those with more.

    \b
    Examples:
      tumblers blind repeat blind --count 5 --threads 4
    """  # noqa: D301
    from .repeat import repeat

    with _as_options():
        same = repeat(directory, count=count, threads=threads, progress=True)
    typer.echo(f"{len(same)} diagnosed again, {sum(same.values())} of them the same")
    if not all(same.values()):
        raise typer.Exit(1)


@blind_app.command("score")
def _score(
    directory: _Directory,
    answers: Annotated[Path, path_option("--answers", "The file answers.json.")],
    out: Annotated[Path | None, path_option("--out", "Scores (.json).")] = None,
    page: Annotated[Path | None, path_option("--page", "Page (.md).")] = None,
) -> None:
    """Check every seal and score the diagnoses.

    \b
    Examples:
      tumblers blind score blind --answers blind/answers.json
      tumblers blind score blind --answers blind/answers.json --out scores.json --page docs/blind-results.md
    """  # noqa: D301
    from ..atomic import write_files
    from .page import page_of, print_scores
    from .score import score

    if out is not None:
        output_file("--out", out, (".json",), [answers])
    if page is not None:
        output_file("--page", page, (".md",), [answers, *([out] if out is not None else [])])
    scores = score(directory, answers)
    files: dict[Path, bytes | memoryview] = {}
    if out is not None:
        files[out] = scores.to_json().encode()
    if page is not None:
        files[page] = page_of(scores).encode()
    write_files(files)
    print_scores(scores)


def _numbers(text: str) -> list[int] | None:
    if not text:
        return None
    found = numbers("--only", text)
    if any(number != int(number) or number < 0 for number in found):
        raise InputError("--only", repr(text), "whole numbers such as 0,3 or 10:19")
    return [int(number) for number in found]


@contextmanager
def _as_options() -> Iterator[None]:
    """Name an argument as the command line does."""
    try:
        yield
    except InputError as error:
        if error.key in ("seed", "count", "jobs", "threads", "out", "only", "parts"):
            option = "out" if error.key == "parts" else error.key
            raise InputError(f"--{option}", error.found, error.expected, error.file) from None
        raise
