"""`Dataset`: what a lab measured, and what it believes about its robot."""

from __future__ import annotations

from dataclasses import dataclass, fields
from dataclasses import field as attribute
from os import PathLike
from pathlib import Path
from typing import Any

from ..check import sequence
from ..errors import InputError, show
from ..model import RELEASED_TORQUE, Model
from ..robot import Robot
from ..substrate import Substrate
from .document import texts_of, write_dataset
from .lab_trial import LabTrial
from .sensor import Sensor
from .tolerance import Tolerance

__all__ = ["FORMAT", "Dataset"]

FORMAT = "tumblers-dataset/1"
_PARTS: dict[str, Any] = {
    "robot": Robot,
    "substrate": Substrate,
    "sensor": Sensor,
    "model": Model,
    "tolerance": Tolerance,
}


@dataclass(frozen=True, kw_only=True, slots=True)
class Dataset:
    """Trials of one robot on one substrate.

    Attributes
    ----------
    robot, substrate, model
        What the lab believes: the nominal model.
    sensor
        How the tracks were measured.
    trials
        What was measured, at least one, each with an id of its own.
    tolerance
        How well the lab knows the nominal model's numbers.
    title
        One line.
    model_given
        The switches of `model` that the lab stated, in their order; those that are not at their default are always
        among them.
    directory
        The folder that it was read from, if any; two datasets are equal without it.

    Raises
    ------
    InputError
        A part of the wrong type, a robot without a body, no trials, two of the same id, or a track
        with rows outside its trial by more than the clock may be off.
    """

    robot: Robot
    substrate: Substrate
    sensor: Sensor
    trials: tuple[LabTrial, ...]
    model: Model = attribute(default_factory=Model)
    tolerance: Tolerance = attribute(default_factory=Tolerance)
    title: str = ""
    model_given: tuple[str, ...] = ()
    directory: Path | None = attribute(default=None, compare=False)

    def __post_init__(self) -> None:
        for name, kind in _PARTS.items():
            if not isinstance(getattr(self, name), kind):
                raise InputError(name, show(getattr(self, name)), f"a {name.capitalize()}")
        self.robot.body()
        # A title goes to terminals and reports.
        if not isinstance(self.title, str) or not self.title.isprintable():
            raise InputError("title", show(self.title), "one line of printable characters")
        trials = sequence("trial", self.trials, "an array of tables [[trial]]", _lab_trial)
        if not trials:
            raise InputError("trial", "no trials", "at least one [[trial]]")
        first: dict[str, int] = {}
        for i, trial in enumerate(trials):
            if trial.id in first:
                raise InputError(
                    f"trial[{i}].id", f"{show(trial.id)} again", f"another id than trial[{first[trial.id]}]"
                )
            first[trial.id] = i
            trial.covers_track(f"trial[{i}].track", self.sensor)
        switches = [f.name for f in fields(Model)]
        for name in self.model_given:
            if name not in switches:
                raise InputError("model_given", show(name), f"any of {', '.join(switches)}")
        # What a number for the step means. A diagnosis, which takes another where nothing is stated, has `model_given`.
        object.__setattr__(self, "model", self.model.with_torque(RELEASED_TORQUE))
        default = Model(magnetic_torque=RELEASED_TORQUE)
        given = tuple(
            name for name in switches if name in self.model_given or getattr(self.model, name) != getattr(default, name)
        )
        object.__setattr__(self, "trials", trials)
        object.__setattr__(self, "model_given", given)

    def trial(self, id: str) -> LabTrial:  # noqa: A002
        """Return a trial by its id.

        Parameters
        ----------
        id
            The trial's id.

        Raises
        ------
        InputError
            No trial of this id.
        """
        for trial in self.trials:
            if trial.id == id:
                return trial
        raise InputError("trial", show(id), f"one of {', '.join(trial.id for trial in self.trials)}")

    def texts(self) -> dict[str, str]:
        """Return the texts of the files that `save` writes, by their paths in the folder."""
        return texts_of(self, FORMAT)

    def save(self, directory: str | PathLike[str]) -> None:
        """Write ``dataset.toml`` and the tracks, in metres and seconds, whole or not at all.

        Parameters
        ----------
        directory
            The folder, made if it does not exist; a dataset that it holds is replaced.

        Raises
        ------
        OSError
            A folder that cannot be made or written to, or a full disk.
        """
        write_dataset(self, Path(directory), FORMAT)


def _lab_trial(key: str, value: object) -> LabTrial:
    if not isinstance(value, LabTrial):
        raise InputError(key, show(value), "a LabTrial")
    return value
