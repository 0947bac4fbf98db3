"""`Run`: the incline, the time and the step."""

from __future__ import annotations

from dataclasses import dataclass

from .check import number
from .errors import InputError, show

__all__ = ["Run"]

_WHOLE = 1e-6


@dataclass(frozen=True, kw_only=True, slots=True)
class Run:
    """How long and where a robot runs.

    Attributes
    ----------
    duration_s, step_s
        Time of the run and of one step, s.
    incline_deg
        Slope of the substrate along +y, degrees.
    output_every_s
        Time between two rows of the result, a multiple of the step, s; every step if None.
    gravity_m_per_s2
        g, m/s².

    Raises
    ------
    InputError
        A number that is refused.
    """

    duration_s: float
    step_s: float
    incline_deg: float = 0.0
    output_every_s: float | None = None
    gravity_m_per_s2: float = 9.8

    def __post_init__(self) -> None:
        def put(name: str, value: float) -> None:
            object.__setattr__(self, name, value)

        put("duration_s", number("run.duration_s", self.duration_s, above=0.0))
        put("step_s", number("run.step_s", self.step_s, above=0.0))
        put("incline_deg", number("run.incline_deg", self.incline_deg, above=-90.0, below=90.0))
        put("gravity_m_per_s2", number("run.gravity_m_per_s2", self.gravity_m_per_s2, least=0.0))
        if self.output_every_s is not None:
            put("output_every_s", number("run.output_every_s", self.output_every_s, above=0.0))
            ratio = self.output_every_s / self.step_s
            if ratio > 1e15 or round(ratio) < 1 or abs(ratio - round(ratio)) > _WHOLE * ratio:
                raise InputError("run.output_every_s", show(self.output_every_s), f"a multiple of step_s {self.step_s}")

    @property
    def output_every(self) -> int:
        """Number of steps between two rows of the result."""
        return 1 if self.output_every_s is None else round(self.output_every_s / self.step_s)
