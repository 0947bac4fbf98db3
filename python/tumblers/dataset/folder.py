"""Reading a dataset's folder."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields
from os import PathLike
from pathlib import Path
from typing import TypeVar

from ..check import text
from ..errors import InputError, shorten, show, unreadable
from ..field import Field, field_from_table, in_its_csv
from ..model import Model
from ..regular_file import read_regular
from ..robot import Robot
from ..section import known_keys, read_section, require_table
from ..substrate import Substrate
from ..toml import parse_toml
from .dataset import FORMAT, Dataset
from .lab_trial import LabTrial
from .outcome import Outcome
from .sensor import TYPICAL_ANGLE_NOISE_DEG, TYPICAL_POSITION_NOISE_M, Sensor
from .tolerance import Tolerance
from .track import ANGLES, Track
from .track_csv import TrackFile, read_track_csv

__all__ = ["load"]

_FILE = "dataset.toml"
_REQUIRED = ("format", "robot", "substrate", "trial")
_TYPICAL = {"position_noise_m": TYPICAL_POSITION_NOISE_M, "angle_noise_deg": TYPICAL_ANGLE_NOISE_DEG}
T = TypeVar("T")


def load(path: str | PathLike[str]) -> Dataset:
    """Return the dataset of a folder, checked as a whole, its tracks read.

    Parameters
    ----------
    path
        The folder, or the ``dataset.toml`` in it.

    Raises
    ------
    InputError
        One line that names the file, the key, what was found and what was expected.
    """
    file = Path(path)
    if in_folder := file.is_dir():
        file /= _FILE
    try:
        # What the user names is taken as it is; what is found in the folder has to be a file in it.
        read = read_regular if in_folder else Path.read_bytes
        contents = _contents(_inside(None, _FILE, file.parent) if in_folder else file, read)
        return _dataset(contents, file.parent)
    except InputError as error:
        raise error.in_file(file) from None


def _contents(file: Path, read: Callable[[Path], bytes]) -> str:
    try:
        return read(file).decode("utf-8-sig")
    except (OSError, ValueError) as error:
        # A NUL byte is not for a line.
        name = None if isinstance(error, OSError) else repr(str(file))[1:-1]
        raise InputError(None, unreadable(error), f"a {FORMAT} file, or its folder", name) from None


def _dataset(contents: str, directory: Path) -> Dataset:
    table = parse_toml(contents)
    if "format" in table and table["format"] != FORMAT:
        raise InputError("format", show(table["format"]), f"'{FORMAT}'")
    known_keys("", table, [*_REQUIRED, "title", "model", "tolerance", "sensor"], _REQUIRED)
    if not isinstance(table["trial"], list):
        raise InputError("trial", show(table["trial"]), "an array of tables [[trial]]")
    robot = Robot.from_table(table["robot"])
    substrate = read_section(Substrate, "substrate", table["substrate"])
    model = read_section(Model, "model", table.get("model", {}))
    tolerance = read_section(Tolerance, "tolerance", table.get("tolerance", {}))
    stated = require_table("sensor", table.get("sensor", {}))
    sensor = read_section(Sensor, "sensor", {**_TYPICAL, **stated})
    trials = tuple(_trial(i, entry, directory, sensor) for i, entry in enumerate(table["trial"]))
    _each_has_its_own_track(table["trial"], directory)
    for i, trial in enumerate(trials):
        if trial.track is not None:
            _noise_is_stated(stated, i, trial.track)
    return Dataset(
        title=table.get("title", ""),
        robot=robot,
        substrate=substrate,
        model=model,
        tolerance=tolerance,
        sensor=sensor,
        trials=trials,
        model_given=tuple(table.get("model", {})),
        directory=directory,
    )


def _noise_is_stated(stated: Mapping[str, object], i: int, track: Track) -> None:
    for channel in track.channels:
        angle = channel in ANGLES
        # A sensor of heights may be another one than the camera.
        keys = ["angle_noise_deg"] if angle else ["z_noise_m"] * (channel == "z_m") + ["position_noise_m"]
        if not any(key in stated for key in keys):
            raise InputError(f"sensor.{keys[-1]}", "no such key", f"the noise of {channel} in trial[{i}].track")


def _each_has_its_own_track(entries: Sequence[Mapping[str, str]], directory: Path) -> None:
    """Refuse one file for two trials: it would count twice, and foretell itself where one of them is held out."""
    first: dict[Path, int] = {}
    for i, entry in enumerate(entries):
        if "track" in entry:
            before = first.setdefault((directory / entry["track"]).resolve(), i)
            if before != i:
                expected = (
                    f"another file than trial[{before}] (trials {show(entries[before]['id'])}, {show(entry['id'])})"
                )
                raise InputError(f"trial[{i}].track", f"{show(entry['track'])} again", expected)


def _trial(i: int, value: object, directory: Path, sensor: Sensor) -> LabTrial:
    key = f"trial[{i}]"
    table = dict(require_table(key, value))
    names = [f.name for f in fields(LabTrial)]

    def read(name: str, reader: Callable[[object], T]) -> T | None:
        return reader(table[name]) if name in table else None

    try:
        known_keys("trial", table, names, ["id", "field", "duration_s"])
        field = _field(table["field"], directory)
        file = read("track", lambda entry: _track(entry, directory, sensor))
        made = {
            "field": field,
            "track": None if file is None else file.track,
            "outcome": read("outcome", lambda entry: read_section(Outcome, "outcome", entry)),
        }
        trial = LabTrial(**(table | made))  # type: ignore[arg-type]
        if file is not None:
            # The whole dataset checks it again, and would not know where in the file it is.
            trial.covers_track("track", sensor, file.time_of)
        return trial
    except InputError as error:
        raise _in_trial(in_its_csv(error, table.get("field")), key, table.get("id")) from None


def _in_trial(error: InputError, key: str, id_: object) -> InputError:
    where = (error.key or "").removeprefix("trial.")
    if where.startswith("sensor."):
        return error
    # Among fourteen trials a number is hard to find.
    named = isinstance(id_, str) and where != "id"
    expected = f"{error.expected} (trial {show(id_)})" if named else error.expected
    return InputError(f"{key}.{where}", error.found, expected)


def _field(value: object, directory: Path) -> Field:
    table = require_table("field", value)
    if isinstance(table.get("csv"), str):
        _inside("field.csv", table["csv"], directory)
    return field_from_table(table, directory)


def _track(value: object, directory: Path, sensor: Sensor) -> TrackFile:
    path = _inside("track", text("track", value, "a path"), directory)
    return read_track_csv("track", path, shorten(repr(value)[1:-1]), sensor)


def _inside(key: str | None, name: object, directory: Path) -> Path:
    """Return the path of a file in the dataset's folder, or refuse one that is elsewhere."""
    if name == "":
        raise InputError(key, show(name), "a path that starts at the dataset's folder")
    path = Path(str(name))
    if path.is_absolute():
        raise InputError(key, show(name), "a path that starts at the dataset's folder")
    try:
        found = (directory / path).resolve()
        if not found.is_relative_to(directory.resolve()):
            raise InputError(key, f"{show(name)}, which leads out of the dataset's folder", "a file in it")
    except (OSError, RuntimeError):
        raise InputError(key, f"{show(name)}, which cannot be followed", "a file in the dataset's folder") from None
    except ValueError as error:
        if isinstance(error, InputError):
            raise
        raise InputError(key, f"{show(name)}: {unreadable(error)}", "a file in the dataset's folder") from None
    return found
