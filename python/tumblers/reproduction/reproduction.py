"""`Reproduction`: all results that were run, and their files."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from os import PathLike
from pathlib import Path
from typing import Any

import xarray as xr

from ..atomic import write_files
from ..netcdf import netcdf_bytes
from ..progress import OnPhase, phases
from ..version import __version__
from .examine import Examined
from .paper_result import PaperResult
from .row import Row

__all__ = ["Reproduction", "file_names"]

_ROWS, _PAGE = "reproduction.json", "index.html"


def file_names(results: Iterable[PaperResult]) -> list[str]:
    """Return the names of the files that `Reproduction.save` writes for some results.

    Parameters
    ----------
    results
        What is run.
    """
    return [_ROWS, _PAGE, *(name for result in results for name in _figure_and_data(result))]


@dataclass(frozen=True, slots=True)
class Reproduction:
    """All results that were run.

    Attributes
    ----------
    examined
        The results, in the paper's order.
    """

    examined: tuple[Examined, ...]

    @property
    def rows(self) -> tuple[Row, ...]:
        """All rows, in the paper's order."""
        return tuple(row for one in self.examined for row in one.rows)

    def table(self) -> dict[str, Any]:
        """Return what ``reproduction.json`` holds."""
        return {"tumblers_version": __version__, "results": [row.table() for row in self.rows]}

    def save(
        self,
        directory: str | PathLike[str],
        page: str | PathLike[str] | None = None,
        *,
        progress: bool | OnPhase = False,
    ) -> None:
        """Write ``reproduction.json``, ``index.html``, and a figure and the data of each result; all files or none.

        Parameters
        ----------
        directory
            The folder, made if missing; its parent must exist.
        page
            Where the page in Markdown goes, if it is wanted.
        progress
            True for a bar while figures are drawn, or a callback, as in `tumblers.progress.phases`.

        Raises
        ------
        OSError
            The folder cannot be made or written to, or the disk is full.
        """
        # matplotlib waits until there is something to draw.
        from .document import document
        from .page import figure_png, page_html

        figures: dict[int, bytes] = {}
        with phases(progress) as tell:
            for one in self.examined:
                tell("figures", len(figures), len(self.examined))
                figures[one.result.number] = figure_png(one)
        contents: dict[str, bytes | memoryview] = {
            _ROWS: (json.dumps(self.table(), indent=1, ensure_ascii=False, allow_nan=False) + "\n").encode(),
            _PAGE: page_html(self, figures).encode(),
        }
        for one in self.examined:
            picture, data = _figure_and_data(one.result)
            contents[picture] = figures[one.result.number]
            contents[data] = netcdf_bytes(_one_dataset(one))
        folder = Path(directory)
        files = {folder / name: content for name, content in contents.items()}
        if page is not None:
            files[Path(page)] = document(self).encode()
        new = not folder.exists()
        folder.mkdir(exist_ok=True)
        try:
            write_files(files)
        except BaseException:
            if new:
                folder.rmdir()
            raise


def _figure_and_data(result: PaperResult) -> tuple[str, str]:
    return f"{result.stem}.png", f"{result.stem}.nc"


def _one_dataset(one: Examined) -> xr.Dataset:
    names = list(one.data)
    data: xr.Dataset = xr.concat(list(one.data.values()), xr.DataArray(names, dims="set", name="set"))
    choices = {name: asdict(chosen) for name, chosen in one.result.sets.items()}
    attrs = {"title": one.result.title, "tumblers_version": __version__, "choices": json.dumps(choices)}
    return data.assign_attrs(attrs)
