"""The fit of the sensor's nuisances in plain NumPy, written from its equations: what the native one must agree with.

What a channel reads, and its derivatives, are those of `reading.py`, which is plain NumPy already.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.loss import weight_of
from tumblers.diagnosis.gap.pose import Path
from tumblers.diagnosis.gap.stretch import Stretch

Floats = NDArray[np.float64]

# Shares of a clock's tolerance that are tried first, and what a frame counts at most then, in sigmas.
CLOCKS, OUTLIER = (-0.9, -0.6, -0.3, 0.0, 0.3, 0.6, 0.9), 6.0
# The farthest that they are apart, s, and how many times as many there are at most.
FARTHEST_APART, MOST_SETS = 5e-3, 9
ITERATIONS = 3


@dataclass(frozen=True, eq=False)
class PlainFit:
    """The nuisances of one run of all trials, and how wrong it is with them.

    Attributes
    ----------
    comparison
        With the tolerances.
    paths
        By trial.
    stretches
        What of each trial is compared.
    """

    comparison: Comparison
    paths: Sequence[Path | None]
    stretches: Sequence[Stretch]

    def residual(self, train: Sequence[int], tolerance: Floats | None) -> tuple[list[Floats | None], Floats, Floats]:
        """Return the whitened differences by trial, clocks and origins (trials, 4), and what all trials share."""
        nuisances = self.comparison.nuisances
        local, shared = np.zeros_like(nuisances.local_sigmas), np.zeros_like(nuisances.shared_sigmas)
        if tolerance is not None:
            shared[2:] = tolerance
        local[:, 0] = [self._clock(i) for i in range(len(self.paths))]
        for _ in range(ITERATIONS):
            local, shared = self._improved(local, shared, train, held=tolerance is not None)
        return self.whitened(local, shared), local, shared

    def whitened(self, local: Floats, shared: Floats) -> list[Floats | None]:
        """Return the whitened differences by trial, 0 for what is not compared, None where there is no path."""
        out: list[Floats | None] = []
        for i, (path, stretch) in enumerate(zip(self.paths, self.stretches, strict=True)):
            values = np.zeros(len(stretch.counts))
            if path is not None:
                values[stretch.counts] = self._whitened(i, local[i], shared)
            out.append(None if path is None else values)
        return out

    def _outcomes(self, trial: int, camera: Floats) -> Floats:
        path = self.paths[trial]
        assert path is not None
        terms = self.stretches[trial].reader.outcome_terms(path, camera)
        return np.array([terms[name] * scale for name, scale in self.stretches[trial].floor.outcome_scale.items()])

    def _whitened(self, trial: int, local: Floats, shared: Floats) -> Floats:
        path, floor = self.paths[trial], self.stretches[trial].floor
        assert path is not None
        wrong = self.stretches[trial].reader.differences(path, local, shared[:2])
        parts = [floor.whiten[name] @ wrong[name][kept] for name, kept in floor.valid.items()]
        return np.concatenate([*parts, self._outcomes(trial, shared[:2])]) - floor.tolerance @ shared[2:]

    def _clock(self, trial: int) -> float:
        bound = self.comparison.nuisances.local_bounds[trial, 0]
        if self.paths[trial] is None or bound == 0.0 or not len(self.stretches[trial].reader.observed.time_s):
            return 0.0
        sets = int(np.clip(np.ceil(0.3 * bound / FARTHEST_APART), 1, MOST_SETS)) | 1
        aside = 0.3 * (np.arange(sets) - 0.5 * (sets - 1)) / sets
        clocks = bound * np.add.outer(aside, CLOCKS).ravel()
        best = clocks[np.argmin([self._clock_loss(trial, clock) for clock in clocks])]
        if sets > 1:
            near = np.clip(best + 0.3 * bound / sets * np.array(CLOCKS), -bound, bound)
            best = near[np.argmin([self._clock_loss(trial, clock) for clock in near])]
        return float(best)

    def _clock_loss(self, trial: int, clock: float) -> float:
        reader, floor, path = self.stretches[trial].reader, self.stretches[trial].floor, self.paths[trial]
        assert path is not None
        sigmas = self.comparison.nuisances.local_sigmas[trial]
        loss = (clock / sigmas[0]) ** 2
        wrong = reader.differences(path, np.array([clock, 0.0, 0.0, 0.0]), np.zeros(2))
        for name, kept in floor.valid.items():
            values = floor.whiten[name] @ wrong[name][kept]
            if name in ("x", "y", "z"):
                # What a shift of the origin cannot explain.
                shift = floor.whiten[name].sum(axis=1)
                values = values - shift * (shift @ values) / (shift @ shift + sigmas[1 + "xyz".index(name)] ** -2)
            loss += float(np.sum(np.minimum(values**2, OUTLIER**2)))
        return loss

    def _rows(self, trial: int, local: Floats, shared: Floats, held: bool) -> Floats:
        """Return the derivatives by the trial's nuisances, by what all share, and the differences, shape (n, k)."""
        path, floor = self.paths[trial], self.stretches[trial].floor
        assert path is not None
        found = self.stretches[trial].reader.linearised(path, local, shared[:2])
        table = np.concatenate(
            [np.empty((0, 7)), *(floor.whiten[name] @ found[name][kept] for name, kept in floor.valid.items())]
        )
        outcomes = self._outcomes(trial, shared[:2])
        table = np.vstack([table, np.column_stack([np.zeros((len(outcomes), 6)), outcomes])])
        numbers = np.zeros_like(floor.tolerance) if held else -floor.tolerance
        return np.column_stack([table[:, :6], numbers, table[:, 6] - floor.tolerance @ shared[2:]])

    def _improved(self, local: Floats, shared: Floats, train: Sequence[int], held: bool) -> tuple[Floats, Floats]:
        """Return a step of Gauss and Newton's method in all nuisances at once, the least within their bounds."""
        nuisances = self.comparison.nuisances
        tables = {}
        for i, path in enumerate(self.paths):
            if path is not None:
                floor, whole = self.stretches[i].floor, self.comparison.floors[i].tracked
                rows = self._rows(i, local[i], shared, held)
                weights = np.full(len(rows), weight_of(rows[: floor.tracked, -1], whole))
                weights[floor.tracked :] = nuisances.outcome_weight
                tables[i] = np.sqrt(weights)[:, None] * rows
        count = len(shared)
        free = np.arange(count) < (2 if held else count)
        low, high = (np.where(free, bound - shared, 0.0) for bound in nuisances.shared_bounds)
        prior = np.diag(1.0 / nuisances.shared_sigmas)
        together = [i for i in tables if i in train]
        moved = np.zeros_like(local)
        # By columns: what is shared and free, then four of each trial.
        matrix = [np.hstack([prior, np.zeros((count, 4 * len(together)))])]
        side = [-shared / nuisances.shared_sigmas]
        for k, i in enumerate(together):
            block = np.zeros((len(tables[i]) + 4, count + 4 * len(together)))
            block[:-4, :count] = tables[i][:, 4:-1]
            block[:-4, count + 4 * k : count + 4 * (k + 1)] = tables[i][:, :4]
            block[-4:, count + 4 * k : count + 4 * (k + 1)] = np.diag(1.0 / nuisances.local_sigmas[i])
            matrix.append(block)
            side += [-tables[i][:, -1], -local[i] / nuisances.local_sigmas[i]]
        bounds = [nuisances.local_bounds[i] for i in together]
        lows = np.concatenate([low, *(-most - local[i] for i, most in zip(together, bounds, strict=True))])
        highs = np.concatenate([high, *(most - local[i] for i, most in zip(together, bounds, strict=True))])
        found = least(np.vstack(matrix), np.concatenate(side), lows, highs)
        change = found[:count]
        for k, i in enumerate(together):
            moved[i] = found[count + 4 * k : count + 4 * (k + 1)]
        for i, table in tables.items():
            if i not in train:
                own = np.vstack([table[:, :4], np.diag(1.0 / nuisances.local_sigmas[i])])
                wrong = np.concatenate([-table[:, -1] - table[:, 4:-1] @ change, -local[i] / nuisances.local_sigmas[i]])
                most = nuisances.local_bounds[i]
                moved[i] = least(own, wrong, -most - local[i], most - local[i])
        return local + moved, shared + change


def least(matrix: Floats, side: Floats, low: Floats, high: Floats) -> Floats:
    """Return the least squares within bounds, what has no room left out."""
    out = np.where(low < high, 0.0, low)
    free = low < high
    # Columns of one length: an active set of unlike units is judged by rounding.
    length = np.linalg.norm(matrix[:, free], axis=0)
    rest = side - matrix[:, ~free] @ out[~free]
    found = lsq_linear(
        matrix[:, free] / length, rest, (low[free] * length, high[free] * length), method="bvls", tol=1e-14
    )
    out[free] = found.x / length
    return out
