"""`Comparison`: model against measurement, in units of the noise, with the sensor's nuisances fitted."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from ... import _core
from ...dataset import Dataset
from ...effects.base import Effect
from .built_floors import BuiltFloors
from .floor import Floor, Sensitivity, choose_steps, measure_sensitivity
from .job import Job
from .loss import weight_of
from .nuisances import Fitted, NuisanceFit
from .observed import observe
from .pose import Path
from .reading import Reader
from .simulator import Simulator
from .stretch import Stretch

__all__ = ["Comparison", "Residual"]

Floats = NDArray[np.float64]

# What the model itself gets wrong lasts about so long, and joins so many neighbouring numbers of a track at most.
_ALIKE_S, _MOST_ALIKE = 0.16, 8.0
# What a trial counts that the model cannot run at all, in sigmas.
_NOT_RUN = 30.0
# By how much ln of the likelihood of tracks moves within a 90 % interval with the point at which the noise is measured.
_ROUGH = 3.0


@dataclass(frozen=True, eq=False)
class Residual:
    """How wrong a model is.

    Attributes
    ----------
    trials
        By trial, the whitened differences, shape (n_i,): channel after channel, then the outcomes.
    prior
        Scaled nuisances of the trials, of the camera and of the nominal numbers: what their being off costs.
    local
        Clock (s) and origin (x, y, z in m) by trial, shape (trials, 4).
    camera
        Heading (rad) and scale, shape (2,).
    tolerance
        How far each nominal number is off, in its tolerance, and the step, shape (`SHARED`,).
    """

    trials: tuple[Floats, ...]
    prior: Floats
    local: Floats
    camera: Floats
    tolerance: Floats

    def over(self, chosen: Sequence[int]) -> Floats:
        """Return the whitened differences of some trials, one after another."""
        return np.concatenate([self.trials[i] for i in chosen]) if len(chosen) else np.empty(0)


class Comparison:
    """A dataset, ready to be compared with paths.

    Parameters
    ----------
    dataset
        What the lab measured.
    simulator
        Of the same dataset; its steps are chosen here.

    Attributes
    ----------
    readers, floors, nominal_paths
        By trial.
    nuisances
        The fit of the sensor's nuisances.
    step_credits
        What is known of `step_credit`, by the steps of all trials, s.
    nominal_log_determinant
        Ln det of the covariance of the noise around the nominal model, an outcome counting as in the objective.
    """

    def __init__(self, dataset: Dataset, simulator: Simulator) -> None:
        self.dataset = dataset
        self.simulator = simulator
        self.readers = tuple(
            Reader.of(observed, simulator.nominal(i), dataset.trials[i].duration_s)
            for i, observed in enumerate(observe(dataset))
        )
        choose_steps(simulator, self.readers)
        self._longer = False
        self._built = BuiltFloors()
        self.nominal_paths: list[Path | None]
        self.floors: tuple[Floor, ...]
        self._known: dict[tuple[Effect, ...], list[Sensitivity]]
        self.nominal_log_determinant: float
        self._start()
        self.nuisances = NuisanceFit(dataset.sensor, self.readers, self.alike, simulator.threads)
        # A floor serves many comparisons: its native half is made once, and goes with it.
        self._natives: WeakKeyDictionary[Floor, _core.Measured] = WeakKeyDictionary()

    def _start(self) -> None:
        """Take the nominal model's paths and noise."""
        self.step_credits: dict[tuple[float, ...], float] = {}
        self._run_nominal()
        self.take_noise_of(())
        self.nominal_log_determinant = sum(map(self.log_determinant_of, self.floors))

    def _run_nominal(self) -> None:
        self.nominal_paths = self.simulator.run([Job(i) for i in range(len(self.readers))])
        self._known = {}

    def halve_steps_for(self, effects: tuple[Effect, ...]) -> bool:
        """Halve the steps that are too long for a hypothesis, and return whether there were any.

        In longer steps (`in_longer_steps`) only those are that it is not run in.

        Where there were, the noise is the nominal model's again, and older residuals do not compare any more.

        Parameters
        ----------
        effects
            The hypothesis.
        """
        if self._longer:
            changed = self.simulator.shorten_steps_for(effects)
        else:
            changed = choose_steps(self.simulator, self.readers, effects)
        if not changed:
            return False
        self._start()
        return True

    @contextmanager
    def restored(self) -> Iterator[None]:
        """Restore steps, noise and nominal paths at the end; objectives inside compare with those outside."""
        steps, known, floors, paths = list(self.simulator.step_s), self._known, self.floors, self.nominal_paths
        try:
            yield
        finally:
            self.simulator.step_s = steps
            self._known, self.floors, self.nominal_paths = known, floors, paths

    @contextmanager
    def in_longer_steps(self) -> Iterator[None]:
        """Run all in twice the steps, none longer than the longest; at the end all is as it was.

        The noise inside is that of the longer steps: what they get wrong speaks for nothing there either. Objectives
        inside do not compare with those outside.
        """
        known, determinant = self.step_credits, self.nominal_log_determinant
        with self.restored():
            self._longer = True
            self.simulator.lengthen_steps()
            self._start()
            try:
                yield
            finally:
                self._longer = False
                self.step_credits, self.nominal_log_determinant = known, determinant

    def take_steps_of(self, effects: tuple[Effect, ...]) -> None:
        """Run the nominal model in the steps that a hypothesis is run in.

        Parameters
        ----------
        effects
            The hypothesis.
        """
        self.simulator.shorten_steps_for(effects)
        self._run_nominal()

    def take_noise_of(self, effects: tuple[Effect, ...], shares: Sequence[float] | None = None) -> None:
        """Let the noise be what moves the paths around a hypothesis; residuals compare by `log_determinant` too.

        Parameters
        ----------
        effects
            The hypothesis, none for the nominal model.
        shares
            By trial, how much of what moves the paths counts; all of it if None.
        """
        # What is neutral moves nothing.
        effects = tuple(effect for effect in effects if not effect.is_neutral())
        if effects not in self._known:
            self._known[effects] = measure_sensitivity(self.simulator, self.readers, effects)
        self.floors = self._built.of(self.readers, self._known[effects], shares)

    @property
    def log_determinant(self) -> float:
        """Ln det of the noise's covariance over that of the nominal model's."""
        return sum(map(self.log_determinant_of, self.floors)) - self.nominal_log_determinant

    def log_determinant_of(self, floor: Floor) -> float:
        """Return ln det of the noise of a trial, an outcome counting as in the objective.

        Parameters
        ----------
        floor
            The noise.
        """
        return floor.log_determinant + self.alike * floor.outcome_log_determinant

    @property
    def count(self) -> int:
        """Number of numbers that were measured."""
        return sum(self.sizes)

    @cached_property
    def heights(self) -> tuple[int, ...]:
        """By trial, how many heights were measured."""
        return tuple(int(np.isfinite(r.observed.values.get("z", np.empty(0))).sum()) for r in self.readers)

    @cached_property
    def alike(self) -> float:
        """How many neighbouring numbers of the tracks count as one: those of 0.16 s, up to eight.

        Outcomes are few, and neighbours of none: each counts for as many in the objective, which is divided by it where
        hypotheses are compared.
        """
        tracked = [i for i, reader in enumerate(self.readers) if len(reader.observed.time_s)]
        if not tracked:
            return 1.0
        intervals = [self.readers[i].observed.compared_interval_s for i in tracked]
        found = [min(max(_ALIKE_S / interval, 1.0), _MOST_ALIKE) if interval > 0.0 else 1.0 for interval in intervals]
        return float(np.average(found, weights=[max(self.sizes[i], 1) for i in tracked]))

    def objective_of(self, ln: float) -> float:
        """Return what so much of ln of a likelihood counts in the objective, or in a contender's total.

        Parameters
        ----------
        ln
            Where noise explains what is left; where even the best leaves more, the dispersion divides the objective
            by that too.
        """
        return 2.0 * self.alike * ln

    @property
    def rough(self) -> float:
        """By how much ln of a likelihood may be off: not at all where there are outcomes alone."""
        return _ROUGH if any(floor.tracked for floor in self.floors) else 0.0

    @property
    def weighed(self) -> tuple[float, ...]:
        """For how many numbers of a track each trial counts in the objective."""
        return tuple(floor.tracked + self.alike * len(floor.outcome_scale) for floor in self.floors)

    @property
    def independent(self) -> float:
        """For how many independent numbers all that was measured counts: neighbours of a track as one."""
        return sum(self.weighed) / self.alike

    @property
    def sizes(self) -> tuple[int, ...]:
        """Number of numbers that were measured in each trial."""
        return tuple(floor.size for floor in self.floors)

    def weight(self, trial: int, values: Floats) -> float:
        """Return how much a trial's track counts: less where the model is far from it (`Objective`).

        Parameters
        ----------
        trial
            Its place in the dataset.
        values
            Its whitened differences, shape (n_i,).
        """
        count = self.floors[trial].tracked
        return weight_of(values[:count], count)

    def labels(self, trial: int) -> list[tuple[str, Floats]]:
        """Return the channels (and outcomes) of a trial's differences and the times of each, s, in their order.

        Parameters
        ----------
        trial
            Its place in the dataset.
        """
        floor, reader = self.floors[trial], self.readers[trial]
        labels = [(name, reader.observed.time_s[kept]) for name, kept in floor.valid.items()]
        return labels + [(name, np.full(1, reader.duration_s)) for name in floor.outcome_scale]

    def residual(
        self,
        paths: Sequence[Path | None],
        train: Sequence[int] | None = None,
        fit_nuisances: bool = True,
        share: float = 1.0,
        tolerance: Floats | None = None,
    ) -> Residual:
        """Return how wrong a model is.

        Parameters
        ----------
        paths
            The model's, one for each trial.
        train
            Trials from which what all share is fitted, the camera's and the nominal numbers'; all if None.
        fit_nuisances
            False to take the sensor as perfect.
        share
            Of each trial's time that counts; what is later, and outcomes where it is less than 1, has no difference.
        tolerance
            How far the nominal numbers are off, shape (`SHARED`,); fitted if None.
        """
        return self.residuals([paths], train, fit_nuisances, share, tolerance)[0]

    def residuals(
        self,
        runs: Sequence[Sequence[Path | None]],
        train: Sequence[int] | None = None,
        fit_nuisances: bool = True,
        share: float = 1.0,
        tolerance: Floats | None = None,
    ) -> list[Residual]:
        """Return how wrong a model is in each of some runs of all trials: one native batch.

        Parameters
        ----------
        runs
            The model's paths, for each run one for each trial.
        train, fit_nuisances, share, tolerance
            As in `residual`.
        """
        stretches = self._stretches(share)
        counted = range(len(self.readers)) if train is None else train
        found = self.nuisances.fitted(runs, stretches, counted, tolerance, fit_nuisances)
        return [self._found(fitted, stretches) for fitted in found]

    def residual_of_beginnings(
        self, paths: Sequence[Path | None], last_s: Sequence[float], tolerance: Floats
    ) -> Residual:
        """Return how wrong a model is all along with the sensor's nuisances fitted to the beginnings.

        Parameters
        ----------
        paths
            The model's, one for each trial.
        last_s
            Time of the last frame at most that they are fitted to, s, of each trial.
        tolerance
            How far the nominal numbers are off, shape (`SHARED`,).
        """
        each = zip(self.readers, self.floors, last_s, strict=True)
        stretches = [Stretch.beginning(reader, floor, last) for reader, floor, last in each]
        (fitted,) = self.nuisances.fitted([paths], stretches, range(len(stretches)), tolerance)
        return self.held(paths, self._found(fitted, stretches))

    def _found(self, fitted: Fitted, stretches: Sequence[Stretch]) -> Residual:
        """Return fitted nuisances with what they leave, and what they cost."""
        local, shared, nuisances = fitted.local, fitted.shared, self.nuisances
        prior = np.concatenate([(local / nuisances.local_sigmas).ravel(), shared / nuisances.shared_sigmas])
        trials = tuple(
            np.full(len(stretch.counts), _NOT_RUN) if values is None else values
            for stretch, values in zip(stretches, fitted.wrong, strict=True)
        )
        return Residual(trials, prior, local, shared[:2], shared[2:])

    def held(self, paths: Sequence[Path | None], nuisances: Residual) -> Residual:
        """Return how wrong a model is with all nuisances held where they were found against another noise.

        Parameters
        ----------
        paths
            The model's, one for each trial.
        nuisances
            Of the same or another model.
        """
        trials = tuple(
            np.full(self.sizes[i], _NOT_RUN) if path is None else self.differences(i, path, nuisances)
            for i, path in enumerate(paths)
        )
        return replace(nuisances, trials=trials)

    def differences(self, trial: int, path: Path, nuisances: Residual) -> Floats:
        """Return the whitened differences of a trial with all nuisances held, shape (n_i,).

        Parameters
        ----------
        trial
            Its place in the dataset.
        path
            The model's.
        nuisances
            Of the same or another model.
        """
        shared = np.concatenate([nuisances.camera, nuisances.tolerance])
        return self._all_of(trial).whitened(path, nuisances.local[trial], shared)

    def _stretches(self, share: float) -> list[Stretch]:
        """Return what of each trial is compared."""
        if share >= 1.0:
            return [self._all_of(trial) for trial in range(len(self.readers))]
        each = zip(self.readers, self.floors, self.nuisances.local_bounds[:, 0], strict=True)
        return [Stretch.beginning(reader, floor, share * reader.duration_s - bound) for reader, floor, bound in each]

    def _all_of(self, trial: int) -> Stretch:
        reader, floor = self.readers[trial], self.floors[trial]
        stretch = Stretch.whole(reader, floor, self._natives.get(floor))
        self._natives[floor] = stretch.native
        return stretch
