"""`NuisanceFit`: the sensor's nuisances, and how far the nominal numbers are off, at their best for given paths.

They minimise

```text
Σ_t w_t |W (y - m(τ, o, ψ, s)) - D η|² + n_c |outcomes - D η|² + Σ (τ/σ_τ)² + |o/σ_o|² + (ψ/σ_ψ)² + (s/σ_s)² + |η|²
```

within the sensor's tolerances, by Gauss and Newton's method: the clock and the origin of each trial for itself, the
camera's heading and scale and the nominal numbers' being off (η, in their tolerances; D in `Floor.tolerance`) over all
trials that count. A trial t that the paths are far from counts less, `w_t` = 1/(1 + mean square/κ); an outcome counts
as n_c numbers of a track (`Comparison.alike`). What remains depends on the hypothesis alone. It is native
(`crates/sensing`).
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, radians
from typing import NamedTuple, get_args

import numpy as np
from numpy.typing import NDArray

from ... import _core
from ...dataset import Sensor
from ...effects.parameter import Nuisance
from ...progress import native_call
from .floor import MOST_OFF, SHARED
from .pose import Path
from .reading import Reader
from .stretch import Stretch

__all__ = ["Fitted", "NuisanceFit"]

Floats = NDArray[np.float64]

# A nuisance is at its end beyond this share of its tolerance.
_AT_END = 0.99
# From this share of its tolerance on a nuisance has been moved by what was measured.
_TELLS = 1e-3
# A mean over trials that is farther from zero than so many of its standard deviations is no chance. A choice: of a
# hundred sensors within their tolerances one or two have such a clock, where the nominal model is right.
_NO_CHANCE = 2.5
# A tolerance is two standard deviations; a clock's offset is uniform within it.
_ORIGIN_SIGMA, _CAMERA_SIGMA, _CLOCK_SIGMA = 0.5, 0.5, 3.0**-0.5


class Fitted(NamedTuple):
    """Nuisances at their best for one run of all trials.

    Attributes
    ----------
    local
        Clock (s) and origin (x, y, z in m) by trial, shape (trials, 4).
    shared
        The camera's heading (rad) and scale, and how far the nominal numbers are off, shape (2 + `SHARED`,).
    wrong
        By trial, the whitened differences, 0 for what is not compared; None where the model cannot be run.
    """

    local: Floats
    shared: Floats
    wrong: tuple[Floats | None, ...]


class NuisanceFit:
    """Fits the nuisances of a dataset's sensor.

    Parameters
    ----------
    sensor
        With its tolerances.
    readers
        By trial.
    outcome_weight
        For how many numbers of a track an outcome counts.
    threads
        Of a batch, all if 0. The results do not depend on it.

    Attributes
    ----------
    tracked
        Which trials have tracks, shape (trials,).
    local_bounds
        Tolerances of each trial's clock (s) and origin (m), shape (trials, 4).
    local_sigmas
        Standard deviations of the same.
    shared_bounds
        Least and greatest heading (rad) and scale of the camera, and being off of the nominal numbers (1).
    shared_sigmas
        Standard deviations of the same.
    """

    def __init__(self, sensor: Sensor, readers: Sequence[Reader], outcome_weight: float, threads: int = 0) -> None:
        self.outcome_weight, self.threads = outcome_weight, threads
        self.tracked = np.array([len(reader.observed.time_s) > 0 for reader in readers], dtype=np.bool_)
        self.local_bounds = np.empty((len(readers), len(get_args(Nuisance))))
        for i, reader in enumerate(readers):
            clock = sensor.clock_tolerance_s(reader.observed.frame_interval_s)
            along = sensor.origin_tolerance_m
            self.local_bounds[i] = clock, along, along, sensor.height_tolerance_m
        sigmas = self.local_bounds * np.array([_CLOCK_SIGMA, _ORIGIN_SIGMA, _ORIGIN_SIGMA, _ORIGIN_SIGMA])
        self.local_sigmas = np.maximum(sigmas, 1e-12)
        camera = np.array([radians(sensor.heading_tolerance_deg), sensor.scale_tolerance])
        # A step is no coarser than the longest, and no finer than ours.
        most = np.concatenate([camera, np.full(SHARED - 1, MOST_OFF)])
        self.shared_bounds = np.append(-most, 0.0), np.append(most, 1.0)
        self.shared_sigmas = np.concatenate([np.maximum(_CAMERA_SIGMA * camera, 1e-12), np.ones(SHARED)])

    def enough(self, local: Floats) -> set[Nuisance]:
        """Return the nuisances of the trials whose tolerances are enough.

        They are not where most trials are at an end, nor where one is and all together are off to one side: what is
        off by as much in every trial brings only those to an end whose own share adds to it. Of a single trial they
        always are: nothing else tells a late clock from a slow robot.

        Parameters
        ----------
        local
            Clock (s) and origin (m) by trial as they were fitted, shape (trials, 4).
        """
        # At either one: where the truth is far, a motion that repeats has its best now at this end, now at that.
        ends = self._at_end(local)[self.tracked].sum(axis=0)
        # A robot at rest says nothing of the clock, which stays where it was.
        tells = (np.abs(local) > _TELLS * self.local_bounds)[self.tracked] | (self.local_bounds == 0.0)[self.tracked]
        told = tells.sum(axis=0)
        # The sum of what n trials ask for is off by chance by √n standard deviations.
        off = np.abs(np.sum(np.where(tells, (local / self.local_sigmas)[self.tracked], 0.0), axis=0))
        aside = (ends > 0) & (told > 1) & (off > _NO_CHANCE * np.sqrt(told))
        most = ends > np.maximum(0.5 * told, 1.0)
        return {name for name, lacking in zip(get_args(Nuisance), most | aside, strict=True) if not lacking}

    def at_tolerance(self, local: Floats) -> list[tuple[Nuisance, ...]]:
        """Return by trial the nuisances that were fitted to the end of their tolerances.

        Parameters
        ----------
        local
            Clock (s) and origin (m) by trial, shape (trials, 4).
        """
        ends = self._at_end(local) & self.tracked[:, None] & (self.local_bounds > 0.0)
        return [tuple(name for name, end in zip(get_args(Nuisance), row, strict=True) if end) for row in ends]

    def _at_end(self, local: Floats) -> NDArray[np.bool_]:
        return np.asarray(np.abs(local) >= _AT_END * self.local_bounds)

    def tolerance(self, nuisance: Nuisance) -> float:
        """Return the greatest tolerance of a nuisance over the trials, s or m; infinite without tracks.

        Parameters
        ----------
        nuisance
            Its name.
        """
        bounds = self.local_bounds[self.tracked, get_args(Nuisance).index(nuisance)]
        return float(np.max(bounds)) if len(bounds) else inf

    def fitted(
        self,
        runs: Sequence[Sequence[Path | None]],
        stretches: Sequence[Stretch],
        train: Sequence[int],
        tolerance: Floats | None = None,
        fit: bool = True,
    ) -> list[Fitted]:
        """Return the nuisances at their best for each of some runs of all trials, one native batch.

        Parameters
        ----------
        runs
            The model's paths, for each run one for each trial.
        stretches
            What of each trial is compared.
        train
            Trials from which what all share is fitted.
        tolerance
            How far the nominal numbers are off, shape (`SHARED`,); fitted if None.
        fit
            False to take the sensor as perfect.

        Raises
        ------
        SimulationError
            The native module gave up.
        """
        counted = set(train)
        with native_call("comparisons", len(runs), progress=False):
            found = _core.compare(
                [stretch.native for stretch in stretches],
                [[stretch.seen(path) for stretch, path in zip(stretches, paths, strict=True)] for paths in runs],
                self.local_bounds.tolist(),
                self.local_sigmas.tolist(),
                (*(bound.tolist() for bound in self.shared_bounds), self.shared_sigmas.tolist()),
                [i in counted for i in range(len(stretches))],
                self.outcome_weight,
                held=None if tolerance is None else tolerance.tolist(),
                fit=fit,
                threads=self.threads,
            )
        return [
            Fitted(
                local,
                shared,
                tuple(
                    None if values is None else stretch.over_all(values)
                    for stretch, values in zip(stretches, wrong, strict=True)
                ),
            )
            for local, shared, wrong in found
        ]
