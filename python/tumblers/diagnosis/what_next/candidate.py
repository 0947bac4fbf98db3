"""`Candidate`: a trial that a lab could make, within the ranges of those that it made where they show any."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields, replace
from itertools import pairwise
from math import cos, radians, sin
from typing import Any

import numpy as np

from ...check import Vector
from ...dataset import Dataset, LabTrial
from ...field import RotatingField, StaticField, field_to_table
from ...scenario import Scenario
from ..gap.simulator import longest_step_s

__all__ = ["Candidate", "candidates", "turned"]

# Degrees by which a slope may exceed the steepest that was used.
_STEEPER = (5.0, 10.0)
_STEEPEST_DEG = 80.0
_FINEST_DEG = 2.5
# One frequency alone shows no range: then it is multiplied by these, up to what coils commonly do.
_FASTER = (3.0, 10.0)
_FASTEST_HZ = 10.0
# Cycles that a trial lasts at least, and its least time, s; but no longer than the longest that was made.
_CYCLES, _LEAST_S = 2.0, 1.0
_MOST_FREQUENCIES, _MOST_INCLINES, _MOST_STRENGTHS, _MOST_STATIC = 5, 10, 3, 8
# Degrees by which a rotating field is turned about the normal; an axis is another one beyond so many (their cosine).
_TURNS_DEG = (45.0, 90.0)
_SAME_AXIS = cos(radians(10.0))


@dataclass(frozen=True, kw_only=True, slots=True)
class Candidate:
    """Conditions of a trial.

    Attributes
    ----------
    field
        Rotating or static.
    incline_deg
        Slope along +y, degrees.
    duration_s
        Time, s.
    outside
        In what it leaves the ranges of the trials so far: ``frequency``, ``field strength``, ``slope``,
        ``static field``, or ``direction``.
    """

    field: RotatingField | StaticField
    incline_deg: float
    duration_s: float
    outside: tuple[str, ...] = ()

    @property
    def kind(self) -> str:
        """What sort of test it is; two of one kind would show much the same."""
        if isinstance(self.field, StaticField):
            return "static tilt"
        return "slope" if self.incline_deg != 0.0 else f"run {self.field.rotation_axis}"

    def steeper_and_flatter(self, others: Sequence[Candidate]) -> tuple[Candidate, ...]:
        """Return this trial on slopes between its own and the next ones, to half a degree.

        Parameters
        ----------
        others
            Trials among whose slopes the next ones are looked for.
        """
        slopes = {other.incline_deg for other in others}
        low = max((s for s in slopes if s < self.incline_deg), default=self.incline_deg)
        high = min((s for s in slopes if s > self.incline_deg), default=self.incline_deg)
        between = [end + share * (self.incline_deg - end) for end in (low, high) for share in (0.25, 0.5, 0.75)]
        found = sorted({round(2.0 * slope) / 2.0 for slope in between} - slopes)
        used = [
            other.incline_deg
            for other in others
            if "slope" not in other.outside and type(other.field) is type(self.field)
        ]
        return tuple(
            replace(self, incline_deg=slope, outside=self._on(min(used) <= slope <= max(used) if used else False))
            for slope in found
        )

    def _on(self, used: bool) -> tuple[str, ...]:
        """Return `outside` on a slope within what was used, or not."""
        others = tuple(name for name in self.outside if name != "slope")
        return others if used else (*others, "slope")

    def edit(self, scenario: Scenario) -> Scenario:
        """Return a scenario under these conditions, its step no longer than they allow.

        Parameters
        ----------
        scenario
            Of any trial of the same robot.
        """
        run = replace(
            scenario.run,
            duration_s=self.duration_s,
            step_s=min(scenario.run.fixed_step_s, self.duration_s),
            incline_deg=self.incline_deg,
            output_every_s=None,
        )
        here = replace(scenario, field=self.field, run=run)
        return here.at_step(min(run.fixed_step_s, longest_step_s(here)))

    def table(self) -> dict[str, Any]:
        """Return the keys of a dataset's ``[[trial]]``; a field's keys at their defaults are left out."""
        defaults = {f.name: f.default for f in fields(self.field)}
        field = {
            key: list(value) if isinstance(value, tuple) else value
            for key, value in field_to_table(self.field).items()
            if key not in defaults or value != defaults[key]
        }
        return {"incline_deg": self.incline_deg, "duration_s": self.duration_s, "field": field}


@dataclass(frozen=True, slots=True)
class _Ranges:
    """The field strength, frequency and slope from the least to the greatest of some trials."""

    strength_T: tuple[float, float]
    frequency_Hz: tuple[float, float]
    incline_deg: tuple[float, float]

    @classmethod
    def of(cls, trials: Sequence[LabTrial]) -> _Ranges:
        strengths, frequencies = [], []
        for trial in trials:
            assert isinstance(trial.field, RotatingField | StaticField)
            strengths.append(trial.field.strength_T)
            frequencies.append(trial.field.frequency_Hz if isinstance(trial.field, RotatingField) else 0.0)
        slopes = [trial.incline_deg for trial in trials]
        return cls(*((min(values), max(values)) for values in (strengths, frequencies, slopes)))

    def left(self, strength_T: float, frequency_Hz: float, incline_deg: float) -> tuple[str, ...]:
        """Return the names of the ranges that are left."""
        pairs = (
            ("frequency", frequency_Hz, self.frequency_Hz),
            ("field strength", strength_T, self.strength_T),
            ("slope", incline_deg, self.incline_deg),
        )
        return tuple(name for name, value, (low, high) in pairs if not low <= value <= high)


def candidates(dataset: Dataset, most: int) -> tuple[Candidate, ...]:
    """Return trials within the ranges of a lab: a grid, thinned evenly to a greatest number.

    Parameters
    ----------
    dataset
        What the lab did.
    most
        So many at most.
    """
    rolled = [t for t in dataset.trials if isinstance(t.field, RotatingField)]
    tilted = [t for t in dataset.trials if isinstance(t.field, StaticField)]
    rotating = [t.field for t in rolled if isinstance(t.field, RotatingField)]
    static = [t.field for t in tilted if isinstance(t.field, StaticField)]
    longest = max(t.duration_s for t in dataset.trials)
    runs: list[Candidate] = []
    tilts: list[Candidate] = []
    if rotating:
        ranges = _Ranges.of(rolled)
        axes = {(f.rotation_axis, f.initial_direction): f for f in rotating}
        inclines = _inclines(t.incline_deg for t in rolled)
        used = sorted({f.strength_T for f in rotating})
        # Coils that give one strength also give half of it.
        strengths = _some(used if len(used) > 1 else [_rounded(0.5 * used[0]), *used], _MOST_STRENGTHS)
        for frequency in _frequencies(rotating):
            for strength in strengths:
                for axis in axes.values():
                    field = replace(axis, frequency_Hz=frequency, strength_T=strength)
                    time = round(min(longest, max(_LEAST_S, _CYCLES / frequency)), 3)
                    runs += [
                        Candidate(
                            field=field,
                            incline_deg=slope,
                            duration_s=time,
                            outside=ranges.left(strength, frequency, slope),
                        )
                        for slope in inclines
                    ]
    still = round(min(longest, _LEAST_S), 3)
    for direction in dict.fromkeys(f.direction for f in static) or {(0.0, 0.0, 1.0): None}:
        used = sorted({f.strength_T for f in static if f.direction == direction})
        if used:
            between = [0.5 * (a + b) for a, b in pairwise(used)]
            levels = _some(sorted([*used, *(_rounded(level) for level in between)]), _MOST_STATIC)
            outside = _Ranges.of(tilted).left(used[0], 0.0, 0.0)
        else:
            least = min((f.strength_T for f in rotating), default=0.0)
            levels = [_rounded(float(share * least)) for share in np.linspace(0.1, 1.0, _MOST_STATIC)]
            outside = ("static field",)
        tilts += [
            Candidate(
                field=StaticField(strength_T=level, direction=direction),
                incline_deg=0.0,
                duration_s=still,
                outside=outside,
            )
            for level in levels
            if level > 0.0
        ]
    # What the lab can do as it is comes before the rest, where not all can be looked at.
    inside = [run for run in runs if not run.outside]
    room = max(1, most - len(tilts))
    kept = _some(inside, max(room // 2, room - (len(runs) - len(inside))))
    beyond = _some([run for run in runs if run.outside], max(room - len(kept), 0))
    return tuple([*kept, *beyond, *tilts][:most])


def turned(dataset: Dataset, most: int) -> tuple[Candidate, ...]:
    """Return runs of `candidates` with the field turned about the normal, thinned evenly to a greatest number.

    They roll the robot obliquely and across: what acts along y and what acts along x part there.

    Parameters
    ----------
    dataset
        What the lab did.
    most
        So many at most.
    """
    used = [t.field.rotation_axis for t in dataset.trials if isinstance(t.field, RotatingField)]
    found = []
    for run in candidates(dataset, 2 * most):
        for turn in _TURNS_DEG:
            if run.outside or not isinstance(run.field, RotatingField):
                continue
            axis, start = (_about_the_normal(v, turn) for v in (run.field.rotation_axis, run.field.initial_direction))
            if all(abs(float(np.dot(axis, other))) < _SAME_AXIS for other in used):
                field = replace(run.field, rotation_axis=axis, initial_direction=start)
                found.append(replace(run, field=field, outside=("direction",)))
    return tuple(_some(found, most))


def _about_the_normal(vector: Vector, turn_deg: float) -> Vector:
    c, s, (x, y, z) = cos(radians(turn_deg)), sin(radians(turn_deg)), vector
    # Without what rounding leaves of a right angle's cosine.
    return round(c * x - s * y, 12) + 0.0, round(s * x + c * y, 12) + 0.0, z


def _frequencies(fields: list[RotatingField]) -> list[float]:
    used = sorted({f.frequency_Hz for f in fields})
    if len(used) == 1:
        return [used[0], *(_rounded(used[0] * more) for more in _FASTER if used[0] * more <= _FASTEST_HZ)]
    between = [(a * b) ** 0.5 for a, b in pairwise(used)]
    return _some(sorted([*used, *(_rounded(f) for f in between)]), _MOST_FREQUENCIES)


def _inclines(values: Iterable[float]) -> list[float]:
    """Return the level, the slopes that were used, a little more than the steepest, and slopes between steep ones.

    Robots that roll on the level alike part where they begin to slide.
    """
    found = sorted({0.0, *values})
    steep = 0.5 * found[-1]
    if found[-1] > 0.0:
        found += [round(found[-1] + more, 2) for more in _STEEPER if found[-1] + more <= _STEEPEST_DEG]
    found = _some(found, _MOST_INCLINES)
    while len(found) < _MOST_INCLINES:
        gap, low = max(((b - a, a) for a, b in pairwise(found) if a >= steep), default=(0.0, 0.0))
        if gap < _FINEST_DEG:
            break
        found = sorted([*found, round(low + 0.5 * gap, 1)])
    return found


def _some(values: list[Any], most: int) -> list[Any]:
    """Values spread evenly over a list, with its ends."""
    if len(values) <= most:
        return values
    return [values[int(k)] for k in np.unique(np.linspace(0, len(values) - 1, most).round())]


def _rounded(value: float) -> float:
    return float(f"{value:.3g}")
