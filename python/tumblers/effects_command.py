"""The command ``tumblers effects``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .atomic import write_files
from .effects import CATALOGUE, get
from .effects.description import describe, effects_page, headline
from .errors import InputError
from .options import EffectFiles, load_effect_files, output_file, path_option

__all__ = ["effects"]


def effects(
    name: Annotated[str | None, typer.Argument(help="Effect to describe; all are listed without it.")] = None,
    effects: EffectFiles = None,
    page: Annotated[Path | None, path_option("--page", "All effects as a page in Markdown (.md).")] = None,
) -> None:
    """List the effects that a scenario may have and a diagnosis looks for, or describe one with a table to paste.

    \b
    Examples:
      tumblers effects
      tumblers effects friction_anisotropy
      tumblers effects coil_yaw --effects coil_yaw.py
    """  # noqa: D301 - \b keeps the lines of an example apart
    if page is not None:
        output_file("--page", page, (".md",), [])
        if name is not None:
            raise InputError("--page", "it beside an effect", "it with all effects")
    load_effect_files(effects)
    if name is not None:
        typer.echo(describe(get(name, "NAME")), nl=False)
    elif page is not None:
        write_files({page: effects_page(CATALOGUE.values()).encode()})
    else:
        for effect in CATALOGUE.values():
            typer.echo(f"{effect.name:28}{headline(effect)}")
