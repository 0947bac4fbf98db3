"""The command ``tumblers diagnose``."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter
from typing import Annotated

import typer

from .check import thread_count
from .errors import InputError
from .folder import output_folder
from .options import path_argument, path_option

__all__ = ["diagnose"]


def diagnose(
    dataset: Annotated[Path, path_argument("DATASET", "Folder with dataset.toml, tumblers-dataset/1.")],
    out: Annotated[
        Path,
        path_option("--out", "Folder for diagnosis.json, effects.toml, scenario.toml, report.html; made if missing."),
    ],
    effects: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME,..|FILE.py",
            help="Effects to try: names, files of your own, `catalogue` for all of it (the default).",
        ),
    ] = None,
    jobs: Annotated[int | None, typer.Option(help="Threads; all by default. The result does not depend on it.")] = None,
    seed: Annotated[int, typer.Option(help="What the starts and the bootstrap are drawn from.")] = 0,
) -> None:
    """Say where model and measurement part, which effect causes it, and how far adding it closes the gap.

    \b
    Examples:
      tumblers diagnose examples/aluminium_30deg --out diagnosis
      tumblers diagnose lab/spring --effects friction_coefficient,stray_field_gradient,coil_yaw.py --out diagnosis
    """  # noqa: D301 - \b keeps the lines of an example apart
    from .diagnosis.diagnosis import FILES, is_ours

    output_folder("--out", out, FILES)
    strange = [] if is_ours(out) else [name for name in FILES if (out / name).exists()]
    if strange:
        raise InputError("--out", f"'{out / strange[0]}', of no diagnosis", "a folder of its own")
    if jobs is not None:
        thread_count("--jobs", jobs)
    if seed < 0:
        raise InputError("--seed", str(seed), "a whole number of at least 0")
    from .dataset import likely_slips, load

    measured = load(dataset)
    names = None if effects is None else _effect_names(effects)
    from .diagnosis.diagnose import diagnose as run
    from .diagnosis.wording.words import summary

    for slip in likely_slips(measured):
        # Now rather than after the minutes that a diagnosis takes.
        typer.echo(f"tumblers: warning: {slip}", err=True)
    start = perf_counter()
    try:
        diagnosis = run(measured, effects=names, jobs=jobs, seed=seed, progress=True)
    except InputError as error:
        # What the options may be was checked: it is the dataset that is refused.
        raise error.in_file(dataset) from None
    diagnosis.save(out)
    typer.echo(summary(diagnosis))
    typer.echo(f"\nreport: {out / 'report.html'}\ntime: {perf_counter() - start:.1f} s")


def _effect_names(texts: list[str]) -> list[str]:
    from .effects.catalogue import CATALOGUE, get, load_file

    names: list[str] = []
    # Before a file adds its own to it.
    listed = list(CATALOGUE)
    for word in (word.strip() for text in texts for word in text.split(",")):
        if word == "catalogue":
            names += listed
        elif word.endswith(".py"):
            names += [effect.name for effect in load_file(word)]
        else:
            names.append(get(word, "--effects").name)
    return list(dict.fromkeys(names))
