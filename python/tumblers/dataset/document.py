"""The files of a dataset: their texts, and writing them."""

from __future__ import annotations

import re
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from ..atomic import write_files
from ..field import field_to_table
from ..section import as_section, write_entry, write_section, write_value
from .tolerance import Tolerance
from .track_csv import write_track_csv

if TYPE_CHECKING:
    from .dataset import Dataset
    from .lab_trial import LabTrial

__all__ = ["texts_of", "write_dataset"]

_FILE_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_+-]{0,63}")


def texts_of(dataset: Dataset, version: str) -> dict[str, str]:
    """Return the texts of a dataset's files by their paths in its folder.

    Parameters
    ----------
    dataset
        The dataset.
    version
        The name of the format.
    """
    names = _track_names(dataset)
    tracks = {
        name: write_track_csv(trial.track)
        for name, trial in zip(names, dataset.trials, strict=True)
        if trial.track is not None
    }
    # The file that names the others comes last.
    return {**tracks, "dataset.toml": _to_toml(dataset, names, version)}


def write_dataset(dataset: Dataset, directory: Path, version: str) -> None:
    """Write a dataset to a folder, whole or not at all.

    Parameters
    ----------
    dataset
        The dataset.
    directory
        The folder, made if it does not exist.
    version
        The name of the format.

    Raises
    ------
    OSError
        A folder that cannot be made or written to, or a full disk.
    """
    contents = {directory / name: text.encode() for name, text in texts_of(dataset, version).items()}
    with ExitStack() as undo:
        for folder in sorted({parent for path in contents for parent in path.parents}, key=lambda p: len(p.parts)):
            if not folder.exists():
                folder.mkdir(exist_ok=True)
                undo.callback(_remove_empty, folder)
        write_files(contents)
        undo.pop_all()


def _remove_empty(folder: Path) -> None:
    with suppress(OSError):
        folder.rmdir()


def _track_names(dataset: Dataset) -> list[str]:
    """Return a file for each trial's track: by its id where all ids are file names, otherwise by its number."""
    ids = [trial.id for trial in dataset.trials]
    if all(_FILE_NAME.fullmatch(id_) for id_ in ids) and len({id_.casefold() for id_ in ids}) == len(ids):
        return [f"tracks/{id_}.csv" for id_ in ids]
    return [f"tracks/{i:03d}.csv" for i in range(len(ids))]


def _to_toml(dataset: Dataset, names: list[str], version: str) -> str:
    model = {name: getattr(dataset.model, name) for name in dataset.model_given}
    return "\n".join(
        [
            f"format = {write_value(version)}\ntitle = {write_value(dataset.title)}\n",
            write_section("robot", dataset.robot.to_table()),
            write_section("substrate", as_section(dataset.substrate)),
            *([write_section("model", model)] if model else []),
            *_tolerance(dataset.tolerance),
            write_section("sensor", as_section(dataset.sensor)),
            *(_trial(trial, name) for trial, name in zip(dataset.trials, names, strict=True)),
        ]
    )


def _tolerance(tolerance: Tolerance) -> list[str]:
    """Return the section of what is not as it is assumed where nothing is stated, nothing where all is."""
    assumed = as_section(Tolerance())
    stated = {key: share for key, share in as_section(tolerance).items() if share != assumed[key]}
    return [write_section("tolerance", stated)] if stated else []


def _trial(trial: LabTrial, name: str) -> str:
    table = as_section(trial)
    table["field"] = field_to_table(trial.field)
    if trial.track is not None:
        table["track"] = name
    if trial.outcome is not None:
        table["outcome"] = as_section(trial.outcome)
    return write_entry("trial", table)
