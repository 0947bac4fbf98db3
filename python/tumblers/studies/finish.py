"""How the command of a study ends: its files and its words."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import typer

from ..same_settings import same_settings

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

__all__ = ["finish", "finished_design"]


def finish(run: Callable[[], xr.Dataset], words: Callable[[xr.Dataset], str], out: Path, plot: Path | None) -> None:
    """Run a study, write its files together, and say what it came to.

    Parameters
    ----------
    run, words
        Gives the result, and the lines that say what it came to.
    out, plot
        Where the result goes, and its figure, if one is wanted.
    """
    from ..atomic import write_files
    from ..netcdf import netcdf_bytes
    from ..step_choice import chosen_words
    from .words import warnings

    start = perf_counter()
    result = run()
    seconds = perf_counter() - start
    files: dict[Path, bytes | memoryview] = {out: netcdf_bytes(result)}
    if plot is not None:
        from ..plots.image import figure_bytes

        files[plot] = figure_bytes(result, plot.suffix.lower().removeprefix("."), draw=_figure_of(result))
    write_files(files)
    typer.echo("\n".join([words(result), *chosen_words(result.attrs), f"time: {seconds:.2f} s"]))
    for warning in warnings(result):
        typer.echo(f"tumblers: warning: {warning}", err=True)


def _figure_of(result: xr.Dataset) -> Callable[[xr.Dataset, Figure], Figure]:
    from . import plots

    name = str(result.attrs["title"]).removeprefix("tumblers ")
    figure: Callable[[xr.Dataset, Figure], Figure] = getattr(plots, f"plot_{name}")
    return figure


def finished_design(out: Path, settings: dict[str, Any]) -> xr.Dataset | None:
    """Return the design that is there already, None if there is no file.

    Parameters
    ----------
    out
        The file.
    settings
        What the design that is wanted depends on.

    Raises
    ------
    InputError
        A design of other settings, or something else.
    """
    if not out.exists():
        return None
    import xarray as xr

    try:
        with xr.open_dataset(out, engine="h5netcdf") as file:
            result = file.load()
        kept = json.loads(result.attrs["settings"])
    except (OSError, ValueError, KeyError):
        kept = None
    same_settings(kept, settings, out)
    return result
