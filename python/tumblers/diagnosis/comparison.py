"""`Comparison`: model against measurement, in units of the noise, with the sensor's nuisances fitted.

For given paths the nuisances minimise

```text
Σ_t w_t |W (y - m(τ, o, ψ, s)) - D η|² + Σ (τ/σ_τ)² + |o/σ_o|² + (ψ/σ_ψ)² + (s/σ_s)² + |η|²
```

within the sensor's tolerances, by Gauss and Newton's method: the clock and the origin of each trial for itself, the
camera's heading and scale and the nominal numbers' being off (η, in their tolerances; D in `Floor.tolerance`) over all
trials that count. A trial t that the paths are far from counts less, `w_t` = 1/(1 + mean square/κ). What remains
depends on the hypothesis alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import radians

import numpy as np
from numpy.typing import NDArray

from ..dataset import Dataset
from ..effects.base import Effect
from .floor import SHARED, Floor, Sensitivity, build_floors, choose_steps, measure_sensitivity
from .loss import robust_cost
from .observed import observe
from .pose import Path
from .reading import Reader
from .simulator import Job, Simulator
from .stretch import Stretch

__all__ = ["FAR", "Comparison", "Residual"]

Floats = NDArray[np.float64]

_ITERATIONS = 3
# Shares of a clock's tolerance that are tried first, and what a frame counts at most then, in sigmas.
_CLOCKS = np.linspace(-0.9, 0.9, 7)
_OUTLIER = 6.0
# A nominal number is not off by more than so many tolerances.
_MOST_OFF = 3.0
# A trial's track whose mean square is beyond this counts by its logarithm.
FAR = 3.0
# What the model itself gets wrong lasts about so long, and joins so many neighbouring numbers of a track at most.
_ALIKE_S, _MOST_ALIKE = 0.16, 8.0
# What a trial counts that the model cannot run at all, in sigmas.
_NOT_RUN = 30.0
# A tolerance is two standard deviations; a clock's offset is uniform within it.
_ORIGIN_SIGMA, _CAMERA_SIGMA, _CLOCK_SIGMA = 0.5, 0.5, 3.0**-0.5


@dataclass(frozen=True, eq=False)
class Residual:
    """How wrong a model is.

    Attributes
    ----------
    trials
        By trial, the whitened differences, shape (n_i,): channel after channel, then the outcomes.
    prior
        Scaled nuisances of the trials and of the camera: what their being off costs.
    local
        Clock (s) and origin (m) by trial, shape (trials, 3).
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
    local_sigmas
        Standard deviations of each trial's clock (s) and origin (m), shape (trials, 3).
    shared_sigmas
        Of the camera's heading (rad) and scale, and of the nominal numbers' tolerances (1), shape (2 + `SHARED`,).
    """

    def __init__(self, dataset: Dataset, simulator: Simulator) -> None:
        self.dataset = dataset
        self.simulator = simulator
        self.readers = tuple(
            Reader.of(observed, simulator.nominal(i), dataset.trials[i].duration_s)
            for i, observed in enumerate(observe(dataset))
        )
        choose_steps(simulator, self.readers)
        self.nominal_paths: list[Path | None]
        self.floors: tuple[Floor, ...]
        self._known: dict[tuple[Effect, ...], list[Sensitivity]]
        self._nominal_log_determinant: float
        self._start()
        self._bounds, self.local_sigmas = self._tolerances()
        sensor = dataset.sensor
        camera = np.array([radians(sensor.heading_tolerance_deg), sensor.scale_tolerance])
        # A step is no coarser than the longest, and no finer than ours.
        most = np.concatenate([camera, np.full(SHARED - 1, _MOST_OFF)])
        self._shared_low, self._shared_high = np.append(-most, 0.0), np.append(most, 1.0)
        self.shared_sigmas = np.concatenate([np.maximum(_CAMERA_SIGMA * camera, 1e-12), np.ones(SHARED)])

    def _start(self) -> None:
        """Take the nominal model's paths and noise."""
        self.nominal_paths = self.simulator.run([Job(i) for i in range(len(self.readers))])
        self._known = {}
        self.take_noise_of(())
        self._nominal_log_determinant = sum(floor.log_determinant for floor in self.floors)

    def _tolerances(self) -> tuple[Floats, Floats]:
        sensor = self.dataset.sensor
        bounds = np.empty((len(self.readers), 3))
        for i, reader in enumerate(self.readers):
            clock = 0.5 * reader.observed.frame_interval_s if sensor.time_offset_s is None else sensor.time_offset_s
            bounds[i] = clock, sensor.origin_tolerance_m, sensor.origin_tolerance_m
        sigmas = bounds * np.array([_CLOCK_SIGMA, _ORIGIN_SIGMA, _ORIGIN_SIGMA])
        return bounds, np.maximum(sigmas, 1e-12)

    def halve_steps_for(self, effects: tuple[Effect, ...]) -> bool:
        """Halve the steps that are too long for a hypothesis, and return whether there were any.

        Where there were, the noise is the nominal model's again, and older residuals do not compare any more.

        Parameters
        ----------
        effects
            The hypothesis.
        """
        if not choose_steps(self.simulator, self.readers, effects):
            return False
        self._start()
        return True

    def take_noise_of(self, effects: tuple[Effect, ...], shares: Sequence[float] | None = None) -> None:
        """Let the noise be what moves the paths around a hypothesis; residuals compare by `log_determinant` too.

        Parameters
        ----------
        effects
            The hypothesis, none for the nominal model.
        shares
            By trial, how much of what moves the paths counts; all of it if None.
        """
        if effects not in self._known:
            self._known[effects] = measure_sensitivity(self.simulator, self.readers, effects)
        self.floors = build_floors(self.readers, self._known[effects], shares)

    @property
    def log_determinant(self) -> float:
        """Ln det of the noise's covariance over that of the nominal model's."""
        return sum(floor.log_determinant for floor in self.floors) - self._nominal_log_determinant

    @property
    def count(self) -> int:
        """Number of numbers that were measured."""
        return sum(self.sizes)

    @property
    def alike(self) -> float:
        """How many neighbouring numbers of the tracks count as one: those of 0.16 s, up to eight."""
        tracked = [i for i, reader in enumerate(self.readers) if len(reader.observed.time_s)]
        if not tracked:
            return 1.0
        intervals = [self.readers[i].observed.frame_interval_s for i in tracked]
        found = [min(max(_ALIKE_S / interval, 1.0), _MOST_ALIKE) if interval > 0.0 else 1.0 for interval in intervals]
        return float(np.average(found, weights=[max(self.sizes[i], 1) for i in tracked]))

    @property
    def sizes(self) -> tuple[int, ...]:
        """Number of numbers that were measured in each trial."""
        return tuple(floor.size for floor in self.floors)

    def weight(self, trial: int, values: Floats) -> float:
        """Return how much a trial's track counts: less where the model is far from it (`Fitter`'s objective).

        Parameters
        ----------
        trial
            Its place in the dataset.
        values
            Its whitened differences, shape (n_i,).
        """
        count = self.floors[trial].tracked
        return _weight(values[:count], count)

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
            Trials from which the camera's heading and scale are fitted; all if None.
        fit_nuisances
            False to take the sensor as perfect.
        share
            Of each trial's time that counts; what is later, and outcomes where it is less than 1, has no difference.
        tolerance
            How far the nominal numbers are off, shape (`SHARED`,); fitted if None.
        """
        count = len(self.readers)
        stretches = self._stretches(share)
        local, shared = np.zeros((count, 3)), np.zeros(2 + SHARED)
        held = tolerance is not None
        if tolerance is not None:
            shared[2:] = tolerance
        train = range(count) if train is None else train
        if fit_nuisances:
            local[:, 0] = [self._clock(i, path, stretches[i]) for i, path in enumerate(paths)]
            for _ in range(_ITERATIONS):
                local, shared = self._improved(paths, local, shared, set(train), stretches, held)
        trials = tuple(
            self._whitened(stretch, path, local[i], shared)
            for i, (stretch, path) in enumerate(zip(stretches, paths, strict=True))
        )
        prior = np.concatenate([(local / self.local_sigmas).ravel(), shared / self.shared_sigmas])
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
        shared = np.concatenate([nuisances.camera, nuisances.tolerance])
        stretches = self._stretches(1.0)
        trials = tuple(
            self._whitened(stretch, path, nuisances.local[i], shared)
            for i, (stretch, path) in enumerate(zip(stretches, paths, strict=True))
        )
        return replace(nuisances, trials=trials)

    def raw(self, trial: int, path: Path, local: Floats, camera: Floats) -> dict[str, Floats]:
        """Return `measured - model` of a trial by channel, m or rad, NaN where lost, for given nuisances."""
        return self.readers[trial].differences(path, local, camera)

    def _stretches(self, share: float) -> list[Stretch]:
        """Return what of each trial is compared."""
        each = zip(self.readers, self.floors, self._bounds[:, 0], strict=True)
        if share >= 1.0:
            return [Stretch.whole(reader, floor) for reader, floor, _ in each]
        return [Stretch.beginning(reader, floor, share * reader.duration_s - bound) for reader, floor, bound in each]

    def _whitened(self, stretch: Stretch, path: Path | None, local: Floats, shared: Floats) -> Floats:
        if path is None:
            return np.full(len(stretch.counts), _NOT_RUN)
        return stretch.whitened(path, local, shared)

    def _clock(self, trial: int, path: Path | None, stretch: Stretch) -> float:
        """Return the best of some offsets of a trial's clock: a body that snaps over makes several minima."""
        floor, reader, bound = stretch.floor, stretch.reader, self._bounds[trial, 0]
        if path is None or not len(reader.observed.time_s) or bound == 0.0:
            return 0.0
        clocks = bound * _CLOCKS
        losses = (clocks / self.local_sigmas[trial, 0]) ** 2
        differences = reader.differences_by_clock(path, clocks)
        for name, kept in floor.valid.items():
            values = floor.whiten[name] @ differences[name][:, kept].T
            if name in ("x", "y") and len(values):
                # What a shift of the origin cannot explain.
                shift = floor.whiten[name].sum(axis=1)
                weight = (self.local_sigmas[trial, 1]) ** -2
                values = values - np.outer(shift, shift @ values) / (shift @ shift + weight)
            losses += np.sum(np.minimum(values**2, _OUTLIER**2), axis=0)
        return float(clocks[np.argmin(losses)])

    def _improved(
        self,
        paths: Sequence[Path | None],
        local: Floats,
        shared: Floats,
        train: set[int],
        stretches: Sequence[Stretch],
        held: bool,
    ) -> tuple[Floats, Floats]:
        shared_weight = 1.0 / self.shared_sigmas**2
        normal, right = np.diag(shared_weight), -shared_weight * shared
        if held:
            right[2:] = 0.0
        blocks: dict[int, tuple[Floats, Floats, Floats]] = {}
        for i, path in enumerate(paths):
            if path is None:
                continue
            floor, reader = stretches[i].floor, stretches[i].reader
            table = np.empty((0, 6))
            if len(reader.observed.time_s):
                found = reader.linearised(path, local[i], shared[:2])
                table = np.concatenate([floor.whiten[name] @ found[name][kept] for name, kept in floor.valid.items()])
            outcomes = stretches[i].outcomes(path, shared[:2])
            table = np.vstack([table, np.column_stack([np.zeros((len(outcomes), 5)), outcomes])])
            a, r = table[:, :3], table[:, 5] - floor.tolerance @ shared[2:]
            g = np.hstack([table[:, 3:5], np.zeros_like(floor.tolerance) if held else -floor.tolerance])
            # One trial that the model cannot follow must not turn the camera of all.
            counted = np.sqrt(_weight(r[: floor.tracked], self.floors[i].tracked))
            a, g, r = counted * a, counted * g, counted * r
            weight = 1.0 / self.local_sigmas[i] ** 2
            inverse = np.linalg.inv(a.T @ a + np.diag(weight))
            by_shared, own = a.T @ g, a.T @ r + weight * local[i]
            blocks[i] = np.asarray(inverse, dtype=np.float64), by_shared, own
            if i in train:
                normal += g.T @ g - by_shared.T @ inverse @ by_shared
                right -= g.T @ r - by_shared.T @ inverse @ own
        change = np.linalg.solve(normal, right)
        shared = np.clip(shared + change, self._shared_low, self._shared_high)
        local = local.copy()
        for i, (inverse, by_shared, own) in blocks.items():
            local[i] = np.clip(local[i] - inverse @ (own + by_shared @ change), -self._bounds[i], self._bounds[i])
        return local, shared


def _weight(track: Floats, count: int) -> float:
    """Return how much a track of so many numbers counts, whose differences are given so far as they are compared."""
    return 1.0 / (1.0 + robust_cost(track) / (FAR * count)) if count else 1.0
