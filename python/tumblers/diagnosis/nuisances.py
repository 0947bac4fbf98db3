"""`NuisanceFit`: the sensor's nuisances, and how far the nominal numbers are off, at their best for given paths.

They minimise

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
from math import radians

import numpy as np
from numpy.typing import NDArray

from ..dataset import Sensor
from .floor import SHARED
from .loss import weight_of
from .pose import Path
from .reading import Reader
from .stretch import Stretch

__all__ = ["NuisanceFit"]

Floats = NDArray[np.float64]

_ITERATIONS = 3
# Shares of a clock's tolerance that are tried first, and what a frame counts at most then, in sigmas.
_CLOCKS = np.linspace(-0.9, 0.9, 7)
_OUTLIER = 6.0
# A nominal number is not off by more than so many tolerances.
_MOST_OFF = 3.0
# A tolerance is two standard deviations; a clock's offset is uniform within it.
_ORIGIN_SIGMA, _CAMERA_SIGMA, _CLOCK_SIGMA = 0.5, 0.5, 3.0**-0.5


class NuisanceFit:
    """Fits the nuisances of a dataset's sensor.

    Parameters
    ----------
    sensor
        With its tolerances.
    readers
        By trial.

    Attributes
    ----------
    local_bounds
        Tolerances of each trial's clock (s) and origin (m), shape (trials, 3).
    local_sigmas
        Standard deviations of the same.
    shared_sigmas
        Of the camera's heading (rad) and scale, and of the nominal numbers' tolerances (1), shape (2 + `SHARED`,).
    """

    def __init__(self, sensor: Sensor, readers: Sequence[Reader]) -> None:
        self.local_bounds = np.empty((len(readers), 3))
        for i, reader in enumerate(readers):
            clock = 0.5 * reader.observed.frame_interval_s if sensor.time_offset_s is None else sensor.time_offset_s
            self.local_bounds[i] = clock, sensor.origin_tolerance_m, sensor.origin_tolerance_m
        sigmas = self.local_bounds * np.array([_CLOCK_SIGMA, _ORIGIN_SIGMA, _ORIGIN_SIGMA])
        self.local_sigmas = np.maximum(sigmas, 1e-12)
        camera = np.array([radians(sensor.heading_tolerance_deg), sensor.scale_tolerance])
        # A step is no coarser than the longest, and no finer than ours.
        most = np.concatenate([camera, np.full(SHARED - 1, _MOST_OFF)])
        self._shared_low, self._shared_high = np.append(-most, 0.0), np.append(most, 1.0)
        self.shared_sigmas = np.concatenate([np.maximum(_CAMERA_SIGMA * camera, 1e-12), np.ones(SHARED)])

    def perfect(self, tolerance: Floats | None = None) -> tuple[Floats, Floats]:
        """Return the nuisances of a perfect sensor, in the shapes of `fitted`.

        Parameters
        ----------
        tolerance
            How far the nominal numbers are off, shape (`SHARED`,); not at all if None.
        """
        shared = np.zeros(2 + SHARED)
        if tolerance is not None:
            shared[2:] = tolerance
        return np.zeros_like(self.local_sigmas), shared

    def fitted(
        self,
        paths: Sequence[Path | None],
        stretches: Sequence[Stretch],
        tracked: Sequence[int],
        train: Sequence[int],
        tolerance: Floats | None = None,
    ) -> tuple[Floats, Floats]:
        """Return the clock (s) and origin (m) by trial, shape (trials, 3), and what all share, shape (2 + `SHARED`,).

        Parameters
        ----------
        paths
            The model's, one for each trial.
        stretches
            What of each trial is compared.
        tracked
            By trial, how many numbers were measured along its whole track.
        train
            Trials from which what all share is fitted.
        tolerance
            How far the nominal numbers are off, shape (`SHARED`,); fitted if None.
        """
        local, shared = self.perfect(tolerance)
        held = tolerance is not None
        local[:, 0] = [self._clock(i, path, stretches[i]) for i, path in enumerate(paths)]
        for _ in range(_ITERATIONS):
            local, shared = self._improved(paths, local, shared, stretches, tracked, set(train), held)
        return local, shared

    def _clock(self, trial: int, path: Path | None, stretch: Stretch) -> float:
        """Return the best of some offsets of a trial's clock: a body that snaps over makes several minima."""
        floor, reader, bound = stretch.floor, stretch.reader, self.local_bounds[trial, 0]
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
        stretches: Sequence[Stretch],
        tracked: Sequence[int],
        train: set[int],
        held: bool,
    ) -> tuple[Floats, Floats]:
        shared_weight = 1.0 / self.shared_sigmas**2
        normal, right = np.diag(shared_weight), -shared_weight * shared
        if held:
            right[2:] = 0.0
        count = len(shared)
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
            # By the trial's own, by what all share, and what is left: one product has all of the normal equations.
            rows = np.empty((len(table), 3 + count + 1))
            rows[:, :5], rows[:, 5:-1] = table[:, :5], 0.0 if held else -floor.tolerance
            rows[:, -1] = table[:, 5] - floor.tolerance @ shared[2:]
            # One trial that the model cannot follow must not turn the camera of all.
            products = weight_of(rows[: floor.tracked, -1], tracked[i]) * (rows.T @ rows)
            weight = 1.0 / self.local_sigmas[i] ** 2
            inverse = np.linalg.inv(products[:3, :3] + np.diag(weight))
            by_shared, own = products[:3, 3:-1], products[:3, -1] + weight * local[i]
            blocks[i] = np.asarray(inverse, dtype=np.float64), by_shared, own
            if i in train:
                normal += products[3:-1, 3:-1] - by_shared.T @ inverse @ by_shared
                right -= products[3:-1, -1] - by_shared.T @ inverse @ own
        change = np.linalg.solve(normal, right)
        shared = np.clip(shared + change, self._shared_low, self._shared_high)
        local = local.copy()
        for i, (inverse, by_shared, own) in blocks.items():
            local[i] = np.clip(
                local[i] - inverse @ (own + by_shared @ change), -self.local_bounds[i], self.local_bounds[i]
            )
        return local, shared
