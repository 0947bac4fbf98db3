"""`Simulator`: a dataset's trials under hypotheses, as batches of native rollouts."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil, inf
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ... import _core
from ...camera import Camera
from ...core_errors import core_error
from ...dataset import Dataset
from ...effects.base import Effect
from ...errors import InputError, TumblersError, show
from ...field import RotatingField, TableField
from ...model import RELEASED_TORQUE, Model
from ...progress import native_call
from ...scenario import Scenario
from .guide import Guide
from .job import Job
from .pose import Path

__all__ = ["LONGEST_STEP_S", "SHORTEST_STEP_S", "Simulator", "longest_step_s", "rows_per_s"]

# Rows of a path: no farther apart than this, and so many in a cycle of the field.
_LONGEST_INTERVAL_S = 2e-3
_ROWS_PER_CYCLE = 60
# The step that is tried first, where a cycle of the field has so many at least; and what is not halved any more.
LONGEST_STEP_S, SHORTEST_STEP_S = 5.0e-4, 1.25e-4
_STEPS_PER_CYCLE = 100
# Of the bound of a scheme that has one, so that a torque of up to four times the nominal one can be run too.
_STABLE = 0.5

# Time by which runs are made longer for a camera whose clock is late, s.
_PIECE_S = 0.1
# Poses that one run of all trials may have: some dozen runs are in memory at once.
_MOST_ROWS = 500_000
# Bytes of paths that are kept: a fit often comes back to a point, and the search to a fit.
_MOST_KEPT = 512_000_000

Floats = NDArray[np.float64]


class _Drawn(NamedTuple):
    """To the track of which trial, seen through which cameras, a run is drawn, and how fast, 1/s."""

    trial: int
    cameras: tuple[Camera, ...]
    rate_per_s: float


class _Other(NamedTuple):
    """A scenario that takes over between some times, s."""

    scenario: Scenario
    edges_s: tuple[float, ...]


@dataclass(frozen=True)
class _Run:
    """What moves: a scenario under a perfect camera, on its own or drawn to a track, and what takes over from it."""

    scenario: Scenario
    drawn: _Drawn | None
    other: _Other | None

    def __hash__(self) -> int:
        return self._hash

    # It is looked up several times, and has a scenario's many numbers.
    @cached_property
    def _hash(self) -> int:
        return hash((self.scenario, self.drawn, self.other))


class Simulator:
    """Simulates the trials of a dataset.

    Parameters
    ----------
    dataset
        What the lab believes, and its trials.
    threads
        Threads of a batch, all if 0. The results do not depend on it.

    Attributes
    ----------
    guides
        By trial, to what its runs may be drawn.
    """

    def __init__(self, dataset: Dataset, threads: int = 0) -> None:
        self.dataset = dataset
        self.threads = threads
        # The lab that does not say how the torque is taken gets the scheme of second order.
        stated = "magnetic_torque" in dataset.model_given
        self.model: Model = dataset.model if stated else replace(dataset.model, magnetic_torque="midpoint")
        self._check()
        self.step_s = self._longest_s()
        self._nominal: dict[tuple[int, float], Scenario] = {}
        self.guides = [Guide.of(trial) for trial in dataset.trials]
        self._known: OrderedDict[_Run, Path | None] = OrderedDict()
        self._kept = 0

    def _longest_s(self) -> list[float]:
        """Return the steps that are tried first, s, by trial."""
        lab = self.dataset
        return [longest_step_s(t.scenario(lab, longest_in(t.field), model=self.model)) for t in lab.trials]

    def _check(self) -> None:
        """Refuse trials that are no longer than a step, or that would take days and fill the memory."""
        trials, sensor = self.dataset.trials, self.dataset.sensor
        for i, trial in enumerate(trials):
            step = longest_in(trial.field)
            if trial.duration_s < 2.0 * step:
                expected = f"at least two steps of the simulation, {2.0 * step:g} s (trial {show(trial.id)})"
                raise InputError(f"trial[{i}].duration_s", f"{trial.duration_s:g} s", expected)
        longest = max(trial.duration_s for trial in trials)
        offset = sensor.clock_tolerance_s(0.0)
        if offset > longest:
            expected = f"no more than the longest trial, {longest:g} s"
            if sensor.time_offset_s is not None:
                raise InputError("sensor.time_offset_s", f"{offset:g} s", expected)
            found = f"{sensor.frames_per_second:g}, half a frame of which is {offset:g} s"
            raise InputError("sensor.frames_per_second", found, expected)
        lasts = [_lengthened_s(t.field, t.duration_s, self._late_s(i)) for i, t in enumerate(trials)]
        # Floats: a product that is past them is too long as well.
        rows = np.floor([time * rows_per_s(trial.field) for time, trial in zip(lasts, trials, strict=True)])
        if rows.sum() > _MOST_ROWS:
            most = int(np.argmax(rows))
            trial, more = trials[most], lasts[most] - trials[most].duration_s
            cycles = f" at {trial.field.frequency_Hz:g} Hz" if isinstance(trial.field, RotatingField) else ""
            found = f"{trial.duration_s:g} s{cycles} and {more:.3g} s for its clock, which make {rows[most]:.10g} poses"
            expected = f"at most {_MOST_ROWS} in all trials, one each 2 ms and 60 in a cycle (trial {show(trial.id)})"
            raise InputError(f"trial[{most}].duration_s", f"{found} of {rows.sum():.10g}", expected)

    def nominal(self, trial: int, divisor: int = 1) -> Scenario:
        """Return the scenario of what the lab believes, long enough for a clock that is off by its tolerance.

        Parameters
        ----------
        trial
            The trial's place in the dataset.
        divisor
            By how much the trial's step is divided.
        """
        key = (trial, self.step_s[trial] / divisor)
        if key not in self._nominal:
            lab = self.dataset.trials[trial]
            scenario = lab.scenario(self.dataset, key[1], model=self.model)
            self._nominal[key] = _longer(scenario, self._late_s(trial))
        return self._nominal[key]

    def _late_s(self, trial: int) -> float:
        """Return by how much a nominal run is longer than its trial, s."""
        track = self.dataset.trials[trial].track
        interval = track.frame_interval_s if track is not None and track.time_s.size > 1 else 0.0
        return max(interval, self.dataset.sensor.clock_tolerance_s(interval)) + _LONGEST_INTERVAL_S

    def scenario(self, job: Job) -> Scenario:
        """Return the scenario of a job with its effects at work, and none left to apply.

        Parameters
        ----------
        job
            The trial and the effects.

        Raises
        ------
        InputError
            An effect that cannot be added to this trial.
        """
        beside = () if job.interlude is None else job.interlude.effects
        scenario = self.nominal(job.trial, job.divisor * self._finer(job.trial, (*job.effects, *beside)))
        if job.edit is not None:
            scenario = job.edit(scenario)
        for effect in job.effects:
            scenario = effect.edit(scenario)
        if job.share < 1.0:
            shorter = max(job.share * scenario.run.duration_s, 2.0 * _LONGEST_INTERVAL_S)
            scenario = replace(scenario, run=replace(scenario.run, duration_s=shorter))
        late = scenario.camera.time_offset_s
        if late > 0.0:
            # In even pieces, so that a clock that is fitted does not ask for another run at every step.
            scenario = _longer(scenario, _PIECE_S * ceil(late / _PIECE_S))
        return scenario

    def coarse(self, scenario: Scenario) -> Scenario:
        """Return a scenario in the longest step, and where the lab leaves the scheme open in the formats' own.

        Parameters
        ----------
        scenario
            Any of this dataset's.
        """
        scheme = self.model.magnetic_torque if "magnetic_torque" in self.dataset.model_given else RELEASED_TORQUE
        scenario = replace(scenario, model=replace(scenario.model, magnetic_torque=scheme))
        return scenario.at_step(longest_step_s(scenario))

    def twice(self, scenario: Scenario) -> Scenario:
        """Return a scenario in twice its step, but no longer than the longest.

        Parameters
        ----------
        scenario
            Any of this dataset's.
        """
        step = min(2.0 * scenario.run.fixed_step_s, longest_step_s(scenario))
        return scenario.at_step(step)

    def lengthen_steps(self) -> None:
        """Take twice the steps, but none that is longer than the longest."""
        self.step_s = [min(2.0 * step, most) for step, most in zip(self.step_s, self._longest_s(), strict=True)]

    def take_longest_steps(self) -> None:
        """Take the steps that are tried first."""
        self.step_s = self._longest_s()

    def shorten_steps_for(self, effects: Sequence[Effect]) -> bool:
        """Take the steps that effects are run in for the nominal model too, and return whether any changed.

        Parameters
        ----------
        effects
            A hypothesis. Against a nominal model in longer steps, the smaller numerical error would speak for it.
        """
        before, self.step_s = self.step_s, self.steps_of(effects)
        return self.step_s != before

    def steps_of(self, effects: Sequence[Effect]) -> list[float]:
        """Return the steps that effects are run in, s, by trial.

        Parameters
        ----------
        effects
            A hypothesis.
        """
        return [step / self._finer(i, effects) for i, step in enumerate(self.step_s)]

    def resolves(self, effects: Sequence[Effect]) -> bool:
        """Return whether effects are run in the steps of the nominal model.

        Parameters
        ----------
        effects
            A hypothesis.
        """
        return self.steps_of(effects) == self.step_s

    def _finer(self, trial: int, effects: Sequence[Effect]) -> int:
        """Return by how much a trial's step is too long for effects."""
        longest = min((effect.resolving_step_s for effect in effects), default=inf)
        finer = 1
        while self.step_s[trial] / finer > longest:
            finer *= 2
        return finer

    def run(self, jobs: Sequence[Job]) -> list[Path | None]:
        """Return the path of each job as the camera sees it; None where the model cannot be run.

        Parameters
        ----------
        jobs
            What to simulate.

        Raises
        ------
        SimulationError
            The native module gave up.
        """
        scenarios = [self._possible(job) for job in jobs]
        # A camera changes what is seen, not what moves.
        moving = [None if s is None else self._run_of(s, job) for s, job in zip(scenarios, jobs, strict=True)]
        asked = dict.fromkeys(run for run in moving if run is not None)
        new = [run for run in asked if run not in self._known]
        for run in asked:
            # What is asked for again and again, as the best is, must not be the first to go.
            if run in self._known:
                self._known.move_to_end(run)
        trials: list[_core.Trial] = []
        runnable: list[_Run] = []
        for run in new:
            with suppress(TumblersError):
                trials.append(self._native(run))
                runnable.append(run)
        every = [_rows_every(run.scenario) for run in runnable]
        with native_call("rollouts", len(trials), progress=False) as on_progress:
            # Poses are all that is asked for. What spins faster than its steps show has left every view, and is slow.
            results = _core.rollouts(trials, every, self.threads, on_progress, while_resolved=True, verified=False)
        for run, result, rows in zip(runnable, results, every, strict=True):
            self._known[run] = path = self._path(run.scenario, result, rows)
            self._kept += _size(path)
        paths = [
            None if seen is None or moved is None else _seen(self._known.get(moved), seen.camera)
            for seen, moved in zip(scenarios, moving, strict=True)
        ]
        while self._kept > _MOST_KEPT and len(self._known) > 1:
            self._kept -= _size(self._known.popitem(last=False)[1])
        return paths

    def _run_of(self, scenario: Scenario, job: Job) -> _Run | None:
        drawn = None
        if job.nudge is not None and self.guides[job.trial] is not None:
            drawn = _Drawn(job.trial, (scenario.camera, job.nudge.sensor), job.nudge.rate_per_s)
        other = None
        if job.interlude is not None:
            effects, edges = job.interlude
            beside = self._possible(replace(job, effects=(*job.effects, *effects), interlude=None))
            if beside is None:
                return None
            other = _Other(_unseen(beside), edges)
        return _Run(_unseen(scenario), drawn, other)

    def _native(self, run: _Run) -> _core.Trial:
        trial, drawn = run.scenario.trial(), run.drawn
        if run.other is not None:
            try:
                trial = trial.with_interlude(run.other.scenario.trial(), run.other.edges_s)
            except ValueError as error:
                raise core_error(error) from None
        guide = None if drawn is None else self.guides[drawn.trial]
        places = None if drawn is None or guide is None else guide.behind(drawn.cameras)
        if drawn is None or places is None:
            return trial
        tracked = run.scenario.camera.tracked_m(run.scenario.robot.center_of_mass_m)
        return trial.guided(*places, tracked, drawn.rate_per_s)

    def _possible(self, job: Job) -> Scenario | None:
        with suppress(InputError):
            return self.scenario(job)
        return None

    def _path(self, scenario: Scenario, rollout: _core._Rollout, every: int) -> Path | None:
        """Return what moved as a perfect camera sees it."""
        if rollout["error"] is not None:
            return None
        # The last row may be off the even times; a robot that left all bounds has fewer.
        rows = min(scenario.run.steps // every + 1, len(rollout["time_s"]))
        if rows < 2:
            return None
        position = rollout["position_m"][:rows]
        orientation = rollout["orientation"][:rows]
        position = scenario.camera.tracked_position(position, orientation, scenario.robot.center_of_mass_m)
        return Path(
            interval_s=every * scenario.run.fixed_step_s,
            poses=np.hstack([position, orientation]),
            contact_mode=rollout["contact_mode"][:rows],
        )


def _unseen(scenario: Scenario) -> Scenario:
    camera = scenario.camera
    return scenario if camera == camera.perfect else replace(scenario, camera=camera.perfect)


def _seen(path: Path | None, camera: Camera) -> Path | None:
    """Return a path as a camera sees it."""
    if path is None or camera == camera.perfect:
        return path
    return Path(
        interval_s=path.interval_s,
        poses=np.hstack([camera.seen_position(path.position_m), camera.seen_orientation(path.orientation)]),
        contact_mode=path.contact_mode,
        clock_s=camera.time_offset_s,
    )


def _longer(scenario: Scenario, time_s: float) -> Scenario:
    """Return a scenario that goes on for a time, at most to the end of its field's table."""
    duration = _lengthened_s(scenario.field, scenario.run.duration_s, time_s)
    return replace(scenario, run=replace(scenario.run, duration_s=duration))


def _lengthened_s(field: object, duration_s: float, time_s: float) -> float:
    if isinstance(field, TableField):
        return max(min(duration_s + time_s, field.time_s[-1]), duration_s)
    return duration_s + time_s


def _size(path: Path | None) -> int:
    return 0 if path is None else path.poses.nbytes + path.contact_mode.nbytes


def longest_in(field: object) -> float:
    """Return the step that is tried first in a field, s, if the scheme is stable in it."""
    longest = LONGEST_STEP_S
    if isinstance(field, RotatingField):
        longest = min(longest, 1.0 / (_STEPS_PER_CYCLE * field.frequency_Hz))
    return longest


def longest_step_s(scenario: Scenario) -> float:
    """Return the step that is tried first, s: `longest_in` its field, halved to well within what is stable."""
    longest, bound = longest_in(scenario.field), scenario.stability_bound_s
    while longest > _STABLE * bound:
        longest *= 0.5
    return longest


def rows_per_s(field: object) -> float:
    """Return how many rows a path has in a field, 1/s."""
    least = 1.0 / _LONGEST_INTERVAL_S
    return max(least, _ROWS_PER_CYCLE * field.frequency_Hz) if isinstance(field, RotatingField) else least


def _rows_every(scenario: Scenario) -> int:
    longest = 1.0 / rows_per_s(scenario.field)
    return max(1, min(int(longest / scenario.run.fixed_step_s + 1e-9), scenario.run.steps))
