"""`LabTrial`: one trial of a lab and what was seen of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..check import number
from ..errors import InputError, show
from ..field import Field, RotatingField, TableField
from ..model import Model
from ..run import Run
from ..scenario import Scenario
from .outcome import Outcome
from .sensor import HALF_A_FRAME, Sensor
from .track import Track

if TYPE_CHECKING:
    from .dataset import Dataset

__all__ = ["LabTrial"]

# A clock that is off by half a frame moves the first frame before the start and the last one beyond the end; this much
# is never too much.
_SLACK_S = 5e-3
# By which a row that is half a frame outside as decimals have it may be farther as floats do.
_ROUNDING = 1e-9


@dataclass(frozen=True, kw_only=True, slots=True)
class LabTrial:
    """One trial: its conditions and its observations.

    The robot starts at rest on the substrate, long axis along +y; time zero is the field's start.

    Attributes
    ----------
    id
        Its name, unlike that of every other trial of the dataset.
    field
        The magnetic field.
    duration_s
        Time of the trial, s.
    incline_deg
        Slope of the substrate along +y, degrees.
    gravity_m_per_s2
        g, m/s².
    track, outcome
        What was seen, frame by frame and as a whole: at least one of them.

    Raises
    ------
    InputError
        A number that is refused, a tabulated field that does not cover the trial, no observation, or an angle at rest
        in a rotating field.
    """

    id: str
    field: Field
    duration_s: float
    incline_deg: float = 0.0
    gravity_m_per_s2: float = 9.8
    track: Track | None = None
    outcome: Outcome | None = None

    def __post_init__(self) -> None:
        def put(name: str, value: float) -> None:
            object.__setattr__(self, name, value)

        # A name goes to terminals, reports and file names.
        if not isinstance(self.id, str) or not self.id.strip() or not self.id.isprintable():
            raise InputError("trial.id", show(self.id), "a name of printable characters")
        if not isinstance(self.field, Field):
            raise InputError("trial.field", show(self.field), "a Field")
        put("duration_s", number("trial.duration_s", self.duration_s, above=0.0))
        put("incline_deg", number("trial.incline_deg", self.incline_deg, above=-90.0, below=90.0))
        put("gravity_m_per_s2", number("trial.gravity_m_per_s2", self.gravity_m_per_s2, least=0.0))
        if isinstance(self.field, TableField):
            self.field.covers(self.duration_s)
        if self.track is not None and not isinstance(self.track, Track):
            raise InputError("trial.track", show(self.track), "a Track")
        if self.outcome is not None and not isinstance(self.outcome, Outcome):
            raise InputError("trial.outcome", show(self.outcome), "an Outcome")
        if self.track is None and self.outcome is None:
            raise InputError("trial.track", "neither a track nor an outcome", "at least one of them")
        if self.outcome is not None and self.outcome.tilt_deg is not None and isinstance(self.field, RotatingField):
            expected = "a static field or a table, in which the robot comes to rest"
            raise InputError("trial.outcome.tilt_deg", f"{show(self.outcome.tilt_deg)} in a rotating field", expected)

    def covers_track(self, key: str, sensor: Sensor, time_of: Callable[[int], str] | None = None) -> None:
        """Refuse a track with rows outside the trial by more than the clock may be off.

        Parameters
        ----------
        key
            What the track is called in the error.
        sensor
            Whose clock it is. Half a frame and 5 ms are never too much; a frame lasts no longer than the trial.
        time_of
            What to call a row in the error, by its number; by its time if None.

        Raises
        ------
        InputError
            A row that is too early or too late.
        """
        if self.track is None or not self.track.time_s.size:
            return
        interval = self.track.frame_interval_s if self.track.time_s.size > 1 else 0.0
        # Rows that are far outside are far apart, too: they do not excuse themselves.
        frame = min(sensor.frame_s(interval), self.duration_s)
        slack = max(_SLACK_S, sensor.time_offset_s or 0.0, HALF_A_FRAME * frame)
        for row in (0, self.track.time_s.size - 1):
            time = float(self.track.time_s[row])
            if max(-time, time - self.duration_s) > slack * (1.0 + _ROUNDING):
                expected = f"times from 0 s to duration_s, {self.duration_s:g} s, give or take {1e3 * slack:.3g} ms"
                raise InputError(key, f"a row at {time:g} s" if time_of is None else time_of(row), expected)

    def scenario(
        self, dataset: Dataset, step_s: float, *, model: Model | None = None, output_every_s: float | None = None
    ) -> Scenario:
        """Return the nominal run of this trial: what the lab believes that it should have seen.

        Parameters
        ----------
        dataset
            Where the robot, the substrate and the model come from.
        step_s
            Step, s.
        model
            Switches in place of the dataset's.
        output_every_s
            Time between two rows of the result, s; every step if None.

        Raises
        ------
        InputError
            A step that this trial's field or duration does not allow.
        """
        return Scenario(
            robot=dataset.robot,
            substrate=dataset.substrate,
            field=self.field,
            run=Run(
                duration_s=self.duration_s,
                step_s=step_s,
                incline_deg=self.incline_deg,
                output_every_s=output_every_s,
                gravity_m_per_s2=self.gravity_m_per_s2,
            ),
            model=dataset.model if model is None else model,
            camera=dataset.sensor.camera,
        )
