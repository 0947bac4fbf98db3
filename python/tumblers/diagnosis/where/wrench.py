"""The missing wrench: the generalized force that the nominal model lacks to follow the data.

A force and a torque w, substrate frame, constant over each of some windows of a trial, or the same in a quarter of
every cycle (`Pieces`), are added to the nominal run. With the whitened differences r, their derivatives J by w and the
sensor's nuisances n (columns N), it minimises

```text
|r + J w + N n|² + Σ (w/s)² + Σ (n/σ_n)²,      s = 0.3 (weight + F_elect) for forces, 0.3 m B for torques
```

with Huber's weights, by two steps of Gauss and Newton's method; the derivatives are central differences, all in one
native batch. What the friction of a contact swallows moves nothing: there the standard deviation stays that of the
prior, and the wrench is unknown, not zero.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...field import RotatingField
from ..gap.comparison import Comparison, Residual
from ..gap.job import Job
from ..gap.loss import HUBER
from ..gap.pose import Path
from ..result import MissingWrench
from .cells import MODES
from .remainder import left_by, nuisance_columns, nuisances_present
from .seen_along import seen_along
from .wrench_maps import mapped
from .wrench_means import Windows
from .wrench_pieces import HALF_A_CYCLE, Pieces, along, at_rest, within_cycles
from .wrench_trial import (
    added,
    derivative_steps,
    end_s,
    prior_sigma,
)

__all__ = ["missing_wrench"]

Floats = NDArray[np.float64]

_ITERATIONS = 2
# Shares of a Gauss-Newton step that are tried.
_SHARES = (1.0, 0.5, 0.2)
# Bounds of the work: trials, windows of one, windows of all, and steps of all derivatives.
_MOST_TRIALS, _MOST_WINDOWS, _MOST_IN_ALL = 12, 12, 48
_MOST_STEPS = 1_500_000
_WINDOWS_AT_REST = 4
# Frames that end before so many steps have passed say nothing of what is missing.
_LEAST_STEPS = 2


@dataclass(frozen=True, eq=False)
class _State:
    """A trial with some wrench.

    Attributes
    ----------
    wrench, values, path
        The wrench by window, N and N m, shape (k, 6), the whitened differences, shape (n,), and the path.
    error
        Mean square of the differences that the derivatives did not foretell.
    """

    wrench: Floats
    values: Floats
    path: Path
    error: float = 0.0


def missing_wrench(
    comparison: Comparison, residual: Residual, paths: Sequence[Path | None], most_windows: int = _MOST_IN_ALL
) -> MissingWrench | None:
    """Return the generalized force that is missing along the tracked trials.

    Parameters
    ----------
    comparison
        The dataset, ready to be compared.
    residual
        How wrong the nominal model is, the sensor's nuisances fitted.
    paths
        The nominal model's.
    most_windows
        Bound of the work: windows along all trials together. Trials with a smaller gap than others go without.

    Returns
    -------
    MissingWrench or None
        None where no trial has a track that the model can be compared with.

    Raises
    ------
    SimulationError
        The native module gave up.
    """
    trials = _chosen(comparison, residual, paths, most_windows)
    if not trials:
        return None
    windows = {i: _along(comparison, i, most) for i, most in _shared(comparison, trials, most_windows).items()}
    found = _estimated(comparison, residual, paths, windows)
    most_steps = _MOST_STEPS / len(trials)
    quick = {i: within for i in trials if (within := _within_cycles(comparison, i, windows[i], most_steps)) is not None}
    in_cycle = dict(zip(quick, _estimated(comparison, residual, paths, quick), strict=True))
    phased = [in_cycle.get(i, mine) for i, mine in zip(windows, found, strict=True)]
    return mapped(comparison.dataset, found, phased)


def _estimated(
    comparison: Comparison, residual: Residual, paths: Sequence[Path | None], pieces: dict[int, Pieces]
) -> list[Windows]:
    """Return the wrench of each trial's windows."""
    prior = {i: prior_sigma(comparison.simulator.nominal(i)) for i in pieces}
    states = {}
    for i, mine in pieces.items():
        path = paths[i]
        assert path is not None
        states[i] = _State(np.zeros((mine.count, 6)), residual.trials[i], path)
    slopes = _slopes(comparison, residual, states, pieces, prior)
    for _ in range(_ITERATIONS):
        states = _improved(comparison, residual, states, pieces, prior, slopes)
    return [_windows(comparison, residual, i, states[i], paths[i], pieces[i], prior[i], slopes[i]) for i in pieces]


def _chosen(comparison: Comparison, residual: Residual, paths: Sequence[Path | None], most_windows: int) -> list[int]:
    """Return the tracked trials that are off most, in the dataset's order."""
    tracked = [
        i
        for i, path in enumerate(paths)
        if path is not None
        and any(k.any() for k in comparison.floors[i].valid.values())
        and end_s(comparison, i) >= _LEAST_STEPS * comparison.simulator.nominal(i).run.fixed_step_s
    ]
    off = {i: float(np.mean(np.minimum(residual.trials[i] ** 2, HUBER**2))) for i in tracked}
    most = max(1, min(_MOST_TRIALS, most_windows // _WINDOWS_AT_REST))
    return sorted(sorted(tracked, key=lambda i: -off[i])[:most])


def _shared(comparison: Comparison, trials: Sequence[int], most_windows: int) -> dict[int, int]:
    """Return how many windows each trial gets at most: as many as the others, or fewer where its run is long."""
    each = max(1, most_windows // len(trials))
    steps = {i: comparison.simulator.nominal(i).run.steps for i in trials}
    share = _MOST_STEPS / len(trials) / (2 * 6 * each)
    return {i: max(2, min(each, int(each * share / steps[i]))) for i in trials}


def _along(comparison: Comparison, trial: int, most: int) -> Pieces:
    field, end, count = comparison.dataset.trials[trial].field, end_s(comparison, trial), min(most, _MOST_WINDOWS)
    if not isinstance(field, RotatingField):
        return at_rest(end, min(count, _WINDOWS_AT_REST))
    return along(field.frequency_Hz, end, count)


def _within_cycles(comparison: Comparison, trial: int, windows: Pieces, most_steps: float) -> Pieces | None:
    """Return the quarters of the cycle where windows along the run do not tell them, else None.

    None as well of a run of less than a cycle, and of one that has too many steps.
    """
    field, end = comparison.dataset.trials[trial].field, end_s(comparison, trial)
    if not isinstance(field, RotatingField) or field.frequency_Hz * end < 1.0:
        return None
    found = within_cycles(field.frequency_Hz, end)
    told = (windows.edges[1] - windows.edges[0]) * field.frequency_Hz <= HALF_A_CYCLE
    steps = 2 * 6 * found.count * comparison.simulator.nominal(trial).run.steps
    return None if told or steps > most_steps else found


def _slopes(
    comparison: Comparison,
    residual: Residual,
    states: dict[int, _State],
    pieces: dict[int, Pieces],
    prior: dict[int, Floats],
) -> dict[int, Floats]:
    """Return the derivatives of the differences by the wrenches in units of their priors, by trial, shape (n, 6 k).

    A column counts as far as what a step changes turns round with the step.
    """
    jobs = []
    steps = {i: derivative_steps(comparison.simulator.nominal(i)) for i in states}
    for i, state in states.items():
        for k in range(state.wrench.size):
            for sign in (1.0, -1.0):
                moved = state.wrench.copy().ravel()
                moved[k] += sign * steps[i][k % 6]
                jobs.append(Job(i, edit=added(pieces[i], moved.reshape(-1, 6))))
    found = iter(comparison.simulator.run(jobs))
    slopes = {}
    for i, state in states.items():
        columns = []
        for k in range(state.wrench.size):
            ends = [
                state.values if p is None else comparison.differences(i, p, residual)
                for p in (next(found), next(found))
            ]
            odd, even = 0.5 * (ends[0] - ends[1]), 0.5 * (ends[0] + ends[1]) - state.values
            turned, stays = float(odd @ odd), float(even @ even)
            share = turned / max(turned + stays, 1e-300)
            columns.append(odd * share * prior[i][k % 6] / steps[i][k % 6])
        slopes[i] = np.column_stack(columns)
    return slopes


def _information(state: _State, slopes: Floats, nuisances: Floats, present: Floats) -> tuple[Floats, Floats]:
    """Return JᵀJ and Jᵀr by the wrench, the nuisances taken out and Huber's weights in them."""
    weight = np.sqrt(np.minimum(1.0, HUBER / np.maximum(np.abs(state.values), 1e-12)))[:, None]
    j, n, r = slopes * weight, nuisances * weight, state.values * weight[:, 0]
    inverse = np.linalg.inv(n.T @ n + np.eye(n.shape[1]))
    return j.T @ j - j.T @ n @ inverse @ n.T @ j, j.T @ r - j.T @ n @ inverse @ (n.T @ r + present)


def _improved(
    comparison: Comparison,
    residual: Residual,
    states: dict[int, _State],
    pieces: dict[int, Pieces],
    prior: dict[int, Floats],
    slopes: dict[int, Floats],
) -> dict[int, _State]:
    """Return the states after one step of Gauss and Newton's method, no longer than is of use."""
    jobs: list[Job] = []
    tried: dict[int, list[tuple[float, Floats]]] = {}
    for i, state in states.items():
        here = (state.wrench / prior[i]).ravel()
        nuisances = nuisance_columns(comparison, residual, i, state.path)
        a, g = _information(state, slopes[i], nuisances, nuisances_present(comparison, residual, i))
        step: Floats = -np.linalg.solve(a + np.eye(len(a)), g + here).astype(np.float64)
        tried[i] = [(share, share * step) for share in _SHARES]
        jobs += [Job(i, edit=added(pieces[i], _moved(state, change, prior[i]))) for _, change in tried[i]]
    found = iter(comparison.simulator.run(jobs))
    out = {}
    for i, state in states.items():
        least, best, error = _cost(comparison, residual, i, state, prior[i]), state, 0.0
        for share, change in tried[i]:
            path = next(found)
            if path is None:
                error = max(error, HUBER**2)
                continue
            values = comparison.differences(i, path, residual)
            # The shortest step says how far the derivatives hold where no step is of use.
            wrong = float(np.mean(np.minimum(np.abs(values - state.values - slopes[i] @ change), HUBER) ** 2))
            moved = _State(_moved(state, change, prior[i]), values, path, wrong)
            cost = _cost(comparison, residual, i, moved, prior[i])
            if cost < least:
                least, best = cost, moved
            elif best is state:
                error = wrong / share**2
        out[i] = best if best is not state else replace(state, error=error)
    return out


def _moved(state: _State, change: Floats, prior: Floats) -> Floats:
    return np.asarray(state.wrench + change.reshape(-1, 6) * prior, dtype=np.float64)


def _cost(comparison: Comparison, residual: Residual, trial: int, state: _State, prior: Floats) -> float:
    """Return the objective, the nuisances at their best."""
    left = left_by(comparison, residual, trial, state.path, state.values)
    return left + float(np.sum((state.wrench / prior) ** 2))


def _windows(
    comparison: Comparison,
    residual: Residual,
    trial: int,
    state: _State,
    nominal: Path | None,
    pieces: Pieces,
    prior: Floats,
    slopes: Floats,
) -> Windows:
    assert nominal is not None
    nuisances = nuisance_columns(comparison, residual, trial, state.path)
    a, _ = _information(state, slopes, nuisances, nuisances_present(comparison, residual, trial))
    # A wrench that leaves a gap, or does not do what its derivatives foretell, is known less well than by noise alone.
    spread = max(1.0, float(np.mean(np.minimum(state.values**2, HUBER**2)))) + state.error
    scale = np.tile(prior, pieces.count)
    information = a / spread / np.outer(scale, scale)
    middle = 0.5 * (pieces.edges[1:] + pieces.edges[:-1])
    here, along = residual.local[trial], nominal.at(middle)[0][:, 1]
    place = seen_along(comparison.readers[trial].observed, here, middle - here[0] - nominal.clock_s, along)
    seen = np.zeros((pieces.count, len(MODES)))
    for window, (first, last) in zip(pieces.window, pairwise(pieces.edges), strict=True):
        seen[window] += np.bincount(nominal.mode_at(np.linspace(first, last, 20)), minlength=len(MODES))
    start, end = pieces.first
    return Windows(
        trial=trial,
        start_s=start,
        end_s=end,
        wrench=state.wrench,
        information=information,
        prior_sigma=prior,
        mode=tuple(MODES[k] for k in seen.argmax(axis=1)),
        place_y_m=np.array([float(np.mean(place[pieces.window == k])) for k in range(pieces.count)]),
    )
