"""The noise floor: what sensor noise, the model's own numerical error and the nominal numbers' tolerance leave open.

The differences of one channel of one trial, at times t, count as drawn from

```text
Σ = σ² 1 + α² d dᵀ + β² diag(d̂²) + (d̄²/T) min(t_i, t_j) + γ² Σ_p diag(d̂_p²)
```

σ is the sensor's noise, d the change of the path when the step is halved, d̂ its greatest size at this frame and its
neighbours (when the body snaps over, a little too early or late is a large difference for a frame), d̄ its root mean
square (a path that has been knocked off its course stays off it: a random walk), T the trial's time, and d_p the change
with each nominal number moved by its tolerance; α = 2, β = 1, γ = 0.3. Multiplied by the inverse of the Cholesky factor
of Σ, differences are plain numbers of unit variance; where the walk dominates they are the displacements from frame to
frame, so that a stride, not a place, is compared.

What the tolerances change alike in all trials is left to the fit: `d_p`, whitened, are the columns of nuisances with
unit variance. So is the change to the longest step and, where the lab leaves it open, to the formats' own torque
scheme: numbers that were themselves computed, in whatever step, are not taken for physics.

A strong effect can make a motion chaotic that was not, or end a chaos. Each hypothesis that counts therefore has its
own Σ, with the changes around itself, and pays for it: a likelihood has ln det Σ beside the squares, so that nothing is
explained by being vague; how much of the changes is needed in a trial, a share of 1 or less, its differences say
(`Objective.take_likeliest_noise`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dtrtri
from scipy.ndimage import maximum_filter1d

from ...effects.base import Effect
from .job import Edit, Job
from .nominal_number import NUMBERS, moved_by
from .pose import Path
from .reading import BORDERS, Reader
from .simulator import SHORTEST_STEP_S, Simulator

__all__ = [
    "MOST_OFF",
    "SHARED",
    "Floor",
    "Sensitivity",
    "build_floor",
    "choose_steps",
    "measure_sensitivity",
]

Floats = NDArray[np.float64]
_NO_CAMERA = np.zeros(2)

# Nuisances that all trials share beside the camera's: the tolerances, and the step.
SHARED = len(NUMBERS) + 1
# A nominal number is not off by more than so many of its tolerances.
MOST_OFF = 3.0
# The step is halved until this moves the path by less, in noise sigmas.
_GOOD_ENOUGH = 0.7
_FINEST_S = SHORTEST_STEP_S * (1.0 + 1e-9)
# The error of a scheme of first order is twice what halving the step shows.
_ALPHA = 2.0
# What of a change is not foretold for a single frame: of the step's, of a tolerance's. With these, not with more, the
# true effects of datasets whose truth was known were likeliest, and their mean square below 1.
_STEP_SPREAD, _TOLERANCE_SPREAD = 1.0, 0.3


@dataclass(frozen=True, eq=False)
class Floor:
    """The noise of one trial.

    Attributes
    ----------
    whiten
        By channel, the inverse Cholesky factor of Σ over the frames that were not lost, shape (k, k).
    valid
        By channel, which frames were not lost, shape (n,).
    outcome_scale
        By kind of outcome, what its scaled difference is multiplied by, at most 1.
    tolerance
        Whitened change of the differences with each nominal number moved by its tolerance, and in the longest step,
        channels then outcomes, shape (k, `SHARED`).
    log_determinant, outcome_log_determinant
        ln det of the covariances of all channels, and of all outcomes.
    numerical_sigmas
        Change when the step is halved, in noise sigmas: root mean square along the path, or an outcome's if more.
    tolerance_sigmas
        The same for the nominal numbers' tolerances together.
    """

    whiten: dict[str, Floats]
    valid: dict[str, NDArray[np.bool_]]
    outcome_scale: dict[str, float]
    tolerance: Floats
    log_determinant: float
    outcome_log_determinant: float
    numerical_sigmas: float
    tolerance_sigmas: float

    @cached_property
    def tracked(self) -> int:
        """Number of numbers that were measured along the track."""
        return sum(int(kept.sum()) for kept in self.valid.values())

    @cached_property
    def size(self) -> int:
        """Number of numbers that were measured, outcomes with them."""
        return self.tracked + len(self.outcome_scale)

    @cached_property
    def noisy(self) -> int:
        """Number of numbers that noise moves: all but outcomes of yes or no."""
        return self.size - len(BORDERS.keys() & self.outcome_scale.keys())

    def counts(self, frames: int) -> NDArray[np.bool_]:
        """Return which of all numbers were measured in the first frames, shape (k,); outcomes are of the whole.

        Parameters
        ----------
        frames
            How many.
        """
        parts = [(np.arange(len(kept)) < frames)[kept] for kept in self.valid.values()]
        return np.concatenate([*parts, np.zeros(len(self.outcome_scale), dtype=bool)])

    def deviation(self, channel: str) -> Floats:
        """Return the root of Σ's diagonal along a channel, m or rad, shape (n,), NaN where lost.

        Parameters
        ----------
        channel
            One that was measured.
        """
        root = np.asarray(np.linalg.inv(self.whiten[channel]), dtype=np.float64)
        return self._along(channel, np.sqrt(np.sum(root**2, axis=1)))

    def shift(self, channel: str, tolerance: Floats) -> Floats:
        """Return how far nominal numbers and a step that are off move a channel, m or rad, shape (n,), NaN where lost.

        Parameters
        ----------
        channel
            One that was measured.
        tolerance
            How far each is off, as of a residual, shape (`SHARED`,).
        """
        before = 0
        for name, kept in self.valid.items():
            if name == channel:
                break
            before += int(kept.sum())
        rows = self.tolerance[before : before + int(self.valid[channel].sum())]
        # Σ = L Lᵀ, and L⁻¹ is what whitens.
        moved = np.linalg.solve(self.whiten[channel], rows @ tolerance)
        return self._along(channel, np.asarray(moved, dtype=np.float64))

    def _along(self, channel: str, values: Floats) -> Floats:
        out = np.full(len(self.valid[channel]), np.nan)
        out[self.valid[channel]] = values
        return out

    def beginning(self, frames: int) -> Floor:
        """Return the noise of the first frames, without outcomes; what sums a trial up stays that of all of it.

        Parameters
        ----------
        frames
            How many.
        """
        valid = {name: kept[:frames] for name, kept in self.valid.items()} if frames else {}
        found = {name: int(kept.sum()) for name, kept in valid.items()}
        whiten = {name: self.whiten[name][:count, :count] for name, count in found.items()}
        tolerance = self.tolerance[self.counts(frames)]
        return replace(self, whiten=whiten, valid=valid, outcome_scale={}, tolerance=tolerance)


@dataclass(frozen=True, eq=False)
class Sensitivity:
    """What moves the path of one trial that should not, around one hypothesis.

    Attributes
    ----------
    numerical, numerical_terms
        Change of the differences by channel, m or rad, and of the outcomes' terms, when the step is halved.
    tolerances, tolerance_terms
        The same with each nominal number moved by its tolerance.
    coarse, coarse_terms
        The same in the longest step and the scheme of `Simulator.coarse`.
    """

    numerical: dict[str, Floats]
    numerical_terms: dict[str, float]
    coarse: dict[str, Floats]
    coarse_terms: dict[str, float]
    tolerances: list[dict[str, Floats]]
    tolerance_terms: list[dict[str, float]]


def choose_steps(simulator: Simulator, readers: tuple[Reader, ...], effects: tuple[Effect, ...] = ()) -> bool:
    """Halve the steps that a hypothesis is not run in, or in which that shows, and return whether there was any.

    Parameters
    ----------
    simulator
        Whose steps are halved, as long as they are above `SHORTEST_STEP_S`.
    readers
        Of the dataset's trials.
    effects
        The hypothesis around which it is looked at.
    """
    changed = simulator.shorten_steps_for(effects)
    waiting = [i for i in range(len(readers)) if simulator.step_s[i] > _FINEST_S]
    while waiting:
        paths = simulator.run([Job(i, effects) for i in waiting] + [Job(i, effects, divisor=2) for i in waiting])
        pairs = zip(waiting, paths[: len(waiting)], paths[len(waiting) :], strict=True)
        coarse = [i for i, path, halved in pairs if _distance(readers[i], path, halved) > _GOOD_ENOUGH]
        for i in coarse:
            simulator.step_s[i] *= 0.5
        changed = changed or bool(coarse)
        waiting = [i for i in coarse if simulator.step_s[i] > _FINEST_S]
    return changed


def measure_sensitivity(
    simulator: Simulator, readers: tuple[Reader, ...], effects: tuple[Effect, ...] = ()
) -> list[Sensitivity]:
    """Return what moves the paths that should not, by trial.

    Parameters
    ----------
    simulator, readers
        Of the dataset.
    effects
        The hypothesis around which it is measured.
    """
    trials = range(len(readers))
    jobs = [Job(i, effects, divisor=divisor) for divisor in (1, 2) for i in trials]
    # A small change of a number is seen in twice the step as well. So it is around what asks for a shorter step, as a
    # compliance: in that alone its determinant would be another than the nominal model's, and be a credit for the step.
    edits = (
        simulator.coarse,
        simulator.twice,
        *(_in_twice(simulator, edit) for edit in moved_by(simulator.dataset.tolerance)),
    )
    jobs += [Job(i, effects, edit=edit) for i in trials for edit in edits]
    paths = simulator.run(jobs)
    count, first = len(edits), 2 * len(readers)
    out = []
    for i, reader in enumerate(readers):
        here, halved = paths[i], paths[len(readers) + i]
        coarse, doubled, *moved = paths[first + count * i : first + count * (i + 1)]
        out.append(
            Sensitivity(
                _change(reader, here, halved),
                _outcome_change(reader, here, halved),
                _change(reader, here, coarse),
                _outcome_change(reader, here, coarse),
                [_change(reader, doubled, other) for other in moved],
                [_outcome_change(reader, doubled, other) for other in moved],
            )
        )
    return out


def _in_twice(simulator: Simulator, edit: Edit) -> Edit:
    return lambda scenario: edit(simulator.twice(scenario))


def _change(reader: Reader, path: Path | None, other: Path | None) -> dict[str, Floats]:
    if path is None or other is None:
        return {}
    return reader.change(path, other)


def _outcome_change(reader: Reader, path: Path | None, other: Path | None) -> dict[str, float]:
    if path is None or other is None:
        return {}
    before, after = reader.outcome_terms(path, _NO_CAMERA), reader.outcome_terms(other, _NO_CAMERA)
    return {name: before[name] - after[name] for name in before}


def _rms(reader: Reader, change: Mapping[str, Floats]) -> float:
    # Where a channel is lost it has no change.
    scaled = [values[reader.observed.found(name)] / reader.observed.noise[name] for name, values in change.items()]
    return float(np.sqrt(np.mean(np.concatenate(scaled) ** 2))) if scaled else 0.0


def _size(reader: Reader, change: Mapping[str, Floats], terms: Mapping[str, float]) -> float:
    """Return a change in noise sigmas: root mean square along the track, or an outcome's where it is more."""
    return max([_rms(reader, change), *(abs(term) for term in terms.values())])


def _distance(reader: Reader, path: Path | None, other: Path | None) -> float:
    """Return what half a step changes, in noise sigmas; without end where the trial runs in the half alone."""
    if path is None and other is not None:
        return inf
    return _size(reader, _change(reader, path, other), _outcome_change(reader, path, other))


def _around(change: Floats) -> Floats:
    """Return the greatest size of changes at each frame and its neighbours, shape (..., n)."""
    return np.asarray(maximum_filter1d(np.abs(change), 3))


def build_floor(reader: Reader, moved: Sensitivity, share: float) -> Floor:
    """Return the noise of a trial.

    Parameters
    ----------
    reader
        Of the trial.
    moved
        What moves the path that should not.
    share
        How much of these changes of a track counts as noise.
    """
    observed = reader.observed
    time = np.maximum(observed.time_s, 0.0)
    shared = (*moved.tolerances, moved.coarse)
    whiten: dict[str, Floats] = {}
    valid: dict[str, NDArray[np.bool_]] = {}
    columns: list[Floats] = []
    for name in observed.channels:
        valid[name] = found = observed.found(name)
        t = time[found]
        changes = np.array([change[name][found] if name in change else np.zeros(len(t)) for change in shared])
        variance = observed.noise[name] ** 2 + np.sum((share * _TOLERANCE_SPREAD * _around(changes[:-1])) ** 2, axis=0)
        covariance = np.zeros((len(t), len(t)))
        if len(t) and name in moved.numerical:
            d = share * moved.numerical[name][found]
            variance += (_STEP_SPREAD * _around(d)) ** 2
            covariance = _ALPHA**2 * np.outer(d, d) + np.mean(d**2) / reader.duration_s * np.minimum.outer(t, t)
        covariance[np.diag_indices(len(t))] += variance
        whiten[name] = dtrtri(np.linalg.cholesky(covariance), lower=1)[0] if len(t) else covariance
        columns.append(whiten[name] @ changes.T)
    scale = {}
    for term in reader.outcome_kinds:
        spread = (_ALPHA * moved.numerical_terms.get(term, 0.0)) ** 2
        # A change beyond the noise is a threshold that was crossed: no nuisance is linear there.
        spread += sum(max(change.get(term, 0.0) ** 2 - 1.0, 0.0) for change in moved.tolerance_terms)
        scale[term] = float(1.0 / np.sqrt(1.0 + spread))
    terms = (*moved.tolerance_terms, moved.coarse_terms)
    columns.append(np.array([[change.get(term, 0.0) * scale[term] for change in terms] for term in scale]))
    return Floor(
        whiten=whiten,
        valid=valid,
        outcome_scale=scale,
        tolerance=np.concatenate([block.reshape(-1, SHARED) for block in columns]),
        # Of the inverse Cholesky factors only the diagonals count.
        log_determinant=-2.0 * float(sum(np.sum(np.log(np.diag(w))) for w in whiten.values())),
        outcome_log_determinant=-2.0 * float(sum(np.log(value) for value in scale.values())),
        numerical_sigmas=_size(reader, moved.numerical, moved.numerical_terms),
        tolerance_sigmas=float(
            np.sqrt(
                sum(
                    _size(reader, change, terms) ** 2
                    for change, terms in zip(moved.tolerances, moved.tolerance_terms, strict=True)
                )
            )
        ),
    )
