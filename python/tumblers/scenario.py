"""`Scenario`: one simulated run, and its TOML format ``tumblers-scenario/1``."""

from __future__ import annotations

from dataclasses import dataclass
from dataclasses import field as attribute
from math import radians
from os import PathLike
from pathlib import Path
from typing import Any, Self

from . import _core
from .atomic import write_files
from .core_errors import core_error
from .effect import refuse_effects
from .errors import InputError, show, unreadable
from .field import Field, RotatingField, TableField, field_from_table, field_to_table
from .initial import Initial
from .model import Model
from .robot import Robot
from .run import Run
from .section import as_section, known_keys, read_section, write_section
from .substrate import Substrate
from .toml import parse_toml

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
}
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
        The model's switches and the state at the start.

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

    def __post_init__(self) -> None:
        for name, kind in _PARTS.items():
            if not isinstance(getattr(self, name), kind):
                raise InputError(name, show(getattr(self, name)), f"a {name.capitalize()}")
        if isinstance(self.field, TableField):
            self.field.covers(self.run.duration_s)
        if isinstance(self.field, RotatingField):
            longest = 1.0 / (_STEPS_PER_CYCLE * self.field.frequency_Hz)
            if self.run.step_s > longest * (1.0 + 1e-9):
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
        known_keys("", table, [*_REQUIRED, "model", "initial", "effect"], _REQUIRED)
        refuse_effects(table.get("effect", []))
        scenario = cls(
            robot=Robot.from_table(table["robot"]),
            substrate=read_section(Substrate, "substrate", table["substrate"]),
            field=field_from_table(table["field"], Path(directory)),
            run=read_section(Run, "run", table["run"]),
            model=read_section(Model, "model", table.get("model", {})),
            initial=read_section(Initial, "initial", table.get("initial", {})),
        )
        scenario.trial()
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
        if self.initial != Initial():
            parts["initial"] = as_section(self.initial)
        return "\n".join([f'format = "{FORMAT}"\n', *(write_section(name, part) for name, part in parts.items())])

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

    def trial(self) -> _core.Trial:
        """Return the native trial.

        Raises
        ------
        InputError
            What only the parts together show, such as a step beyond the stability bound of ``start_of_step``.
        """
        robot, substrate, run = self.robot, self.substrate, self.run
        body = robot.body()
        try:
            return _core.Trial(
                body=body,
                mass_kg=robot.total_mass_kg,
                magnetic_moment_A_m2=robot.magnetic_moment_A_m2,
                friction_coefficient=substrate.friction_coefficient,
                friction_ellipsoid=substrate.friction_ellipsoid,
                adhesion_N_per_m2=substrate.adhesion_N_per_m2,
                electrostatic_force_N=substrate.electrostatic_force_N,
                line_contact_width_m=substrate.line_contact_width_m,
                field=self.field.core(),
                incline_rad=radians(run.incline_deg),
                gravity_m_per_s2=run.gravity_m_per_s2,
                duration_s=run.duration_s,
                step_s=run.step_s,
                magnetic_torque=self.model.magnetic_torque,
                adhesion_acts_at=self.model.adhesion_acts_at,
                adhesion_enters=self.model.adhesion_enters,
                position_m=self.initial.position_m,
                orientation=self.initial.orientation,
                linear_velocity_m_per_s=self.initial.linear_velocity_m_per_s,
                angular_velocity_rad_per_s=self.initial.angular_velocity_rad_per_s,
            )
        except InputError:
            raise
        except ValueError as error:
            raise core_error(error) from None
