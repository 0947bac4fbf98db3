"""The command ``tumblers view``, and the options for pictures of a run that it shares with ``tumblers simulate``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .errors import InputError, unreadable
from .options import PLOT_SUFFIXES, EffectFiles, load_effect_files, output_file, path_argument, path_option

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["AnimateOption", "CycleOption", "Pictures", "SnapshotsOption", "ViewOption", "view"]

SnapshotsOption = Annotated[
    Path | None, path_option("--snapshots", "The robot from above at several times (.png, .pdf or .svg).")
]
CycleOption = Annotated[
    Path | None, path_option("--cycle", "One cycle of the field from the side (.png, .pdf or .svg).")
]
AnimateOption = Annotated[Path | None, path_option("--animate", "Animation (.gif, or .mp4 where there is ffmpeg).")]
ViewOption = Annotated[Path | None, path_option("--view", "Interactive 3-D view, one page (.html).")]

_SUFFIXES = {"snapshots": PLOT_SUFFIXES, "cycle": PLOT_SUFFIXES, "animate": (".gif", ".mp4"), "view": (".html",)}


@dataclass(frozen=True, kw_only=True, slots=True)
class Pictures:
    """Files for the pictures of a run; None for one that is not wanted.

    Attributes
    ----------
    snapshots, cycle, animate, view
        The robot from above, a cycle from the side, the animation, the 3-D page.
    """

    snapshots: Path | None = None
    cycle: Path | None = None
    animate: Path | None = None
    view: Path | None = None

    @property
    def wanted(self) -> dict[str, Path]:
        """The files that are wanted, by the name of their option."""
        paths = {field.name: getattr(self, field.name) for field in fields(self)}
        return {name: path for name, path in paths.items() if path is not None}

    def check(self, taken: Sequence[Path]) -> None:
        """Refuse files that could not be written in the end, before anything is computed.

        Parameters
        ----------
        taken
            Files that have another use.

        Raises
        ------
        InputError
            A wrong suffix, a folder that is missing, a file named twice, or an mp4 without ffmpeg.
        """
        used = list(taken)
        for name, path in self.wanted.items():
            output_file(f"--{name}", path, _SUFFIXES[name], used)
            used.append(path)
        if self.animate is not None:
            from .plots.animation import check_animation_kind

            check_animation_kind("--animate", _kind(self.animate))

    def files(self, run: xr.Dataset) -> dict[Path, bytes | memoryview]:
        """Return the content of the files that are wanted.

        Parameters
        ----------
        run
            Result of `tumblers.simulate`.

        Raises
        ------
        InputError
            Something else than a run.
        SimulationError
            ffmpeg failed.
        """
        made: dict[Path, bytes | memoryview] = {}
        if self.snapshots is not None:
            from .plots.pictures import snapshots_bytes

            made[self.snapshots] = snapshots_bytes(run, _kind(self.snapshots))
        if self.cycle is not None:
            from .plots.pictures import cycle_bytes

            made[self.cycle] = cycle_bytes(run, _kind(self.cycle))
        if self.view is not None:
            from .view import view_page

            made[self.view] = view_page(run).encode()
        if self.animate is not None:
            from .plots.animation import animation_bytes

            made[self.animate] = animation_bytes(run, _kind(self.animate), progress=True)
        return made


def view(
    run: Annotated[Path, path_argument("RUN.nc", "Result of `tumblers simulate`.")],
    snapshots: SnapshotsOption = None,
    cycle: CycleOption = None,
    animate: AnimateOption = None,
    view: ViewOption = None,
    effects: EffectFiles = None,
) -> None:
    """Draw a saved run: from above, one cycle from the side, as an animation, as an interactive 3-D page.

    \b
    Examples:
      tumblers view run.nc --view run.html
      tumblers view run.nc --snapshots above.png --cycle cycle.png --animate run.gif
    """  # noqa: D301 - \b keeps the lines of an example apart
    pictures = Pictures(snapshots=snapshots, cycle=cycle, animate=animate, view=view)
    if not pictures.wanted:
        raise InputError(None, "no picture asked for", ", ".join(f"--{name}" for name in _SUFFIXES))
    pictures.check([run])
    load_effect_files(effects)
    loaded = _load(run)
    from .atomic import write_files

    try:
        files = pictures.files(loaded)
    except InputError as error:
        raise error.in_file(run) from None
    write_files(files)
    typer.echo("\n".join(f"{name}: {path}" for name, path in pictures.wanted.items()))


def _load(path: Path) -> xr.Dataset:
    import xarray as xr

    expected = "a netCDF file of `tumblers simulate`"
    try:
        path.open("rb").close()
    except (OSError, ValueError) as error:
        raise InputError(None, unreadable(error), expected, path) from None
    try:
        return xr.load_dataset(path, engine="h5netcdf")
    except (OSError, ValueError, KeyError):
        raise InputError(None, "a file that is no netCDF-4", expected, path) from None


def _kind(path: Path) -> str:
    return path.suffix.lower().removeprefix(".")
