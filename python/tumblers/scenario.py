"""`Scenario`: one simulated run, and its TOML format ``tumblers-scenario/1``."""

from __future__ import annotations

from dataclasses import dataclass, replace
from dataclasses import field as attribute
from math import inf
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from . import _core
from .atomic import write_files
from .camera import Camera
from .check import sequence
from .errors import InputError, show, unreadable
from .field import Field, RotatingField, TableField, field_from_table, field_to_table, in_its_csv
from .initial import Initial
from .model import RELEASED_TORQUE, MagneticTorque, Model
from .native_trial import native_trial
from .relief import Relief
from .robot import Robot
from .run import AUTO, Run, StepLength
from .section import as_section, known_keys, read_section, write_entry, write_section
from .substrate import Substrate
from .surroundings import Surroundings
from .toml import parse_toml

if TYPE_CHECKING:
    from .effects.base import Effect

__all__ = ["FORMAT", "Scenario"]

FORMAT = "tumblers-scenario/1"
_REQUIRED = ("format", "robot", "substrate", "field", "run")
_PARTS: dict[str, Any] = {
    "robot": Robot,
    "substrate": Substrate,
    "field": Field,
    "run": Run,
    "model": Model,
    "initial": Initial,
    "relief": Relief,
    "surroundings": Surroundings,
    "camera": Camera,
}
# These are written only where they say something.
_EXTRAS = ("initial", "relief", "surroundings", "camera")
# A cycle of the field that is cut into fewer steps is another motion.
_STEPS_PER_CYCLE = 20


@dataclass(frozen=True, kw_only=True, slots=True)
class Scenario:
    """One simulated run: a robot on a substrate in a field.

    Attributes
    ----------
    robot, substrate, field, run
        Its parts.
    model, initial
        The model's switches and the state at the start. Where the model leaves the time of the torque open, it is set:
        ``midpoint`` if the step is ``"auto"``, ``end_of_step`` if it is a number.
    relief, surroundings, camera
        The substrate's heights, what else acts on the robot, and how the run is seen.
    effects
        Causes of a gap between model and measurement, each of which edits the scenario, in their order.

    Raises
    ------
    InputError
        A part of the wrong type, a tabulated field that does not cover the run, or a step of more than a twentieth of a
        rotating field's period.
    """

    robot: Robot
    substrate: Substrate
    field: Field
    run: Run
    model: Model = attribute(default_factory=Model)
    initial: Initial = attribute(default_factory=Initial)
    relief: Relief = attribute(default_factory=Relief)
    surroundings: Surroundings = attribute(default_factory=Surroundings)
    camera: Camera = attribute(default_factory=Camera)
    effects: tuple[Effect, ...] = ()

    def __post_init__(self) -> None:
        for name, kind in _PARTS.items():
            if not isinstance(getattr(self, name), kind):
                raise InputError(name, show(getattr(self, name)), f"a {name.capitalize()}")
        object.__setattr__(self, "effects", _checked_effects(self.effects))
        # A number is that of a file that means the released scheme, which damps; a step that is to be accurate has the
        # one that gets there in the longest steps (docs/performance.md).
        torque = RELEASED_TORQUE if self.run.step_s != AUTO else "midpoint"
        object.__setattr__(self, "model", self.model.with_torque(torque))
        if isinstance(self.field, TableField):
            self.field.covers(self.run.duration_s)
        if isinstance(self.field, RotatingField) and self.run.step_s != AUTO:
            longest = 1.0 / (_STEPS_PER_CYCLE * self.field.frequency_Hz)
            if self.run.fixed_step_s > longest * (1.0 + 1e-9):
                cycle = f"1/{_STEPS_PER_CYCLE} of the field's period at {self.field.frequency_Hz:g} Hz"
                raise InputError("run.step_s", show(self.run.step_s), f"at most {longest:g} s, {cycle}")

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Self:
        """Return the scenario of a TOML file, checked as a whole.

        Parameters
        ----------
        path
            The file.

        Raises
        ------
        InputError
            One line that names the file, the key, what was found and what was expected.
        """
        path = Path(path)
        try:
            text = path.read_bytes().decode("utf-8")
        except OSError as error:
            raise InputError(None, unreadable(error), f"a {FORMAT} file", path) from None
        except ValueError as error:
            raise InputError(None, unreadable(error), f"a {FORMAT} file", repr(str(path))[1:-1]) from None
        try:
            return cls.from_toml(text, directory=path.parent)
        except InputError as error:
            raise error.in_file(path) from None

    @classmethod
    def from_toml(cls, text: str, *, directory: str | PathLike[str] = ".") -> Self:
        """Return the scenario of a TOML text.

        Parameters
        ----------
        text
            A scenario in the format ``tumblers-scenario/1``.
        directory
            Where a relative ``csv`` is looked for.

        Raises
        ------
        InputError
            One line that names the key, what was found and what was expected.
        """
        table = parse_toml(text)
        if "format" in table and table["format"] != FORMAT:
            raise InputError("format", show(table["format"]), f"'{FORMAT}'")
        known_keys("", table, [*_REQUIRED, "model", *_EXTRAS, "effect"], _REQUIRED)
        try:
            scenario = cls(
                robot=Robot.from_table(table["robot"]),
                substrate=read_section(Substrate, "substrate", table["substrate"]),
                field=field_from_table(table["field"], Path(directory)),
                run=read_section(Run, "run", table["run"]),
                model=read_section(Model, "model", table.get("model", {})),
                initial=read_section(Initial, "initial", table.get("initial", {})),
                relief=read_section(Relief, "relief", table.get("relief", {})),
                surroundings=read_section(Surroundings, "surroundings", table.get("surroundings", {})),
                camera=read_section(Camera, "camera", table.get("camera", {})),
                effects=_effects_from(table["effect"]) if "effect" in table else (),
            )
        except InputError as error:
            raise in_its_csv(error, table["field"]) from None
        scenario.check()
        return scenario

    def to_toml(self) -> str:
        """Return the scenario as TOML, every default written out, complete in itself."""
        parts: dict[str, dict[str, object]] = {
            "robot": self.robot.to_table(),
            "substrate": as_section(self.substrate),
            "field": field_to_table(self.field),
            "run": as_section(self.run),
            "model": as_section(self.model),
        }
        for name in _EXTRAS:
            part = getattr(self, name)
            if part != _PARTS[name]():
                parts[name] = as_section(part)
        written = [write_section(name, part) for name, part in parts.items()]
        written += [write_entry("effect", effect.to_table()) for effect in self.effects]
        return "\n".join([f'format = "{FORMAT}"\n', *written])

    def save(self, path: str | PathLike[str]) -> None:
        """Write the scenario to a TOML file, whole or not at all.

        Parameters
        ----------
        path
            The file; one that exists is replaced.

        Raises
        ------
        OSError
            The folder is missing or cannot be written to, or the disk is full.
        """
        write_files({Path(path): self.to_toml().encode()})

    def effective(self) -> Scenario:
        """Return the scenario that every effect has edited, in their order, and that has none left.

        Raises
        ------
        InputError
            What an effect makes of its part is refused.
        """
        scenario: Scenario = self
        for effect in self.effects:
            scenario = effect.edit(scenario)
        return replace(scenario, effects=()) if scenario.effects else scenario

    @property
    def magnetic_torque(self) -> MagneticTorque:
        """Where in the step the torque is taken."""
        torque = self.model.magnetic_torque
        assert torque is not None
        return torque

    @property
    def longest_step_s(self) -> float:
        """The longest step that the time of the run and a rotating field's period allow, s."""
        longest = self.run.duration_s
        if isinstance(self.field, RotatingField):
            longest = min(longest, 1.0 / (_STEPS_PER_CYCLE * self.field.frequency_Hz))
        return longest

    @property
    def stability_bound_s(self) -> float:
        """The step from which on ``start_of_step`` is unstable, s; infinite where the torque is taken otherwise."""
        if self.magnetic_torque != "start_of_step":
            return inf
        # In a scheme that bears every step, and with the rows that fit one.
        return self.unsampled.at_step(self.longest_step_s, "midpoint").trial().stability_bound_s

    @property
    def unsampled(self) -> Self:
        """The scenario that may have any step, as nothing says how far apart its rows are."""
        return replace(self, run=replace(self.run, output_every_s=None))

    def at_step(self, step_s: StepLength, magnetic_torque: MagneticTorque | None = None) -> Scenario:
        """Return the scenario with another step.

        Parameters
        ----------
        step_s
            Step, s, or ``"auto"``.
        magnetic_torque
            Another time in the step for the torque, too; as it is if None.

        Raises
        ------
        InputError
            A step that is refused.
        """
        model = self.model if magnetic_torque is None else replace(self.model, magnetic_torque=magnetic_torque)
        return replace(self, run=replace(self.run, step_s=step_s), model=model)

    def check(self) -> None:
        """Refuse what only the parts together show; a step that is still to be chosen is not among it.

        Raises
        ------
        InputError
            As `trial` does.
        """
        if self.run.step_s != AUTO:
            self.trial()
            return
        # The scheme that bears every step.
        effective = self.effective()
        unsampled = replace(effective, run=replace(effective.run, output_every_s=None))
        unsampled.at_step(effective.longest_step_s, "midpoint").trial()

    def trial(self) -> _core.Trial:
        """Return the native trial of the effective scenario.

        Raises
        ------
        InputError
            What only the parts together show, such as a step beyond the stability bound of ``start_of_step``.
        """
        return native_trial(self.effective())


def _checked_effects(value: object) -> tuple[Effect, ...]:
    if value == ():
        return ()
    # The effects edit scenarios, so their package imports this module.
    from .effects.base import Effect

    def effect(key: str, entry: object) -> Effect:
        if not isinstance(entry, Effect):
            raise InputError(key, show(entry), "an Effect")
        return entry

    return sequence("effects", value, "a list of effects", effect)


def _effects_from(value: object) -> tuple[Effect, ...]:
    from .effects.catalogue import effects_from_tables

    return effects_from_tables(value)
