"""`Run`: the inclines, the time and the step."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil
from typing import Literal

from .check import number
from .errors import InputError, show

__all__ = ["AUTO", "MOST_STEPS", "Run", "StepLength"]

StepLength = float | Literal["auto"]

AUTO: Literal["auto"] = "auto"
MOST_STEPS = 1e9
_WHOLE = 1e-6
_ROUNDING = 1e-9
_ROW_BYTES = 250
_MOST_BYTES = 4_000_000_000


@dataclass(frozen=True, kw_only=True, slots=True)
class Run:
    """How long and where a robot runs.

    Attributes
    ----------
    duration_s
        Time of the run, s. One that is not a whole number of steps is covered in whole steps.
    step_s
        Time of one step, s; ``"auto"``, the default, for one that `tumblers.choose_step` chooses by an error estimate
        before the run.
    incline_deg
        Slope of the substrate along +y, degrees.
    side_incline_deg
        Slope of the substrate along +x, degrees.
    output_every_s
        Time between two rows of the result, a multiple of the step, s; every step if None. A step is chosen to fit it.
    gravity_m_per_s2
        g, m/s².

    Raises
    ------
    InputError
        A number that is refused.
    """

    duration_s: float
    step_s: StepLength = AUTO
    incline_deg: float = 0.0
    output_every_s: float | None = None
    gravity_m_per_s2: float = 9.8
    side_incline_deg: float = 0.0

    def __post_init__(self) -> None:
        def put(name: str, value: float) -> None:
            object.__setattr__(self, name, value)

        put("duration_s", number("run.duration_s", self.duration_s, above=0.0))
        for name in ("incline_deg", "side_incline_deg"):
            put(name, number(f"run.{name}", getattr(self, name), above=-90.0, below=90.0))
        put("gravity_m_per_s2", number("run.gravity_m_per_s2", self.gravity_m_per_s2, least=0.0))
        if self.output_every_s is not None:
            put("output_every_s", number("run.output_every_s", self.output_every_s, above=0.0))
        if isinstance(self.step_s, str):
            if self.step_s != AUTO:
                raise InputError("run.step_s", show(self.step_s), f"'{AUTO}' or a finite number greater than 0")
        else:
            put("step_s", number("run.step_s", self.step_s, above=0.0))
            self._check_step(self.fixed_step_s)
        if self.output_every_s is not None and self.output_every_s > self.duration_s:
            expected = f"at most duration_s, which is {self.duration_s:g}"
            raise InputError("run.output_every_s", show(self.output_every_s), expected)

    def _check_step(self, step_s: float) -> None:
        if step_s > self.duration_s:
            raise InputError("run.step_s", show(step_s), f"at most duration_s, which is {self.duration_s:g}")
        if self.duration_s / step_s > MOST_STEPS:
            found = f"{self.duration_s:g} s in steps of {step_s:g} s"
            raise InputError("run.duration_s", found, f"at most {MOST_STEPS:g} steps")
        if self.output_every_s is not None and self.output_every_s <= self.duration_s:
            every = self.output_every_s / step_s
            if round(every) < 1 or abs(every - round(every)) > _WHOLE * every:
                raise InputError("run.output_every_s", show(self.output_every_s), f"a multiple of step_s {step_s}")

    @property
    def fixed_step_s(self) -> float:
        """The step, s.

        Raises
        ------
        InputError
            A step that is still to be chosen.
        """
        if isinstance(self.step_s, str):
            raise InputError("run.step_s", show(self.step_s), "a number here: choose_step finds one")
        return self.step_s

    @property
    def steps(self) -> int:
        """Number of steps: the duration is covered in whole steps, and a rounding beyond its end is not another one."""
        return max(1, ceil(self.duration_s / self.fixed_step_s - _ROUNDING))

    @property
    def output_every(self) -> int:
        """Number of steps between two rows of the result."""
        return 1 if self.output_every_s is None else round(self.output_every_s / self.fixed_step_s)

    @property
    def rows(self) -> int:
        """Number of rows of the result: the start, every `output_every` steps, and the end."""
        return 1 + ceil(self.steps / self.output_every)

    def check_rows(self) -> None:
        """Refuse a run whose rows would not fit into memory, before it starts.

        Raises
        ------
        InputError
            More rows than 4 GB hold.
        """
        if self.rows * _ROW_BYTES > _MOST_BYTES:
            size = f"{self.rows} rows of about {_ROW_BYTES} bytes, {self.rows * _ROW_BYTES / 1e9:.3g} GB"
            raise InputError(
                "run.output_every_s", size, f"at most {_MOST_BYTES / 1e9:g} GB: set a larger output_every_s"
            )
