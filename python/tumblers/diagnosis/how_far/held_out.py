"""`shrink`: how far the gap shrinks on trials that no fit has seen.

The trials are dealt into folds, alike conditions to different folds; each fold is left out once, and what all trials
share is fitted to the others: the effects' parameters, the camera's heading and scale, and how far the nominal numbers
are off. A clock and an origin are a trial's own, and are fitted to it within their tolerances. With ρ of `robust_cost`
a gap is `√(Σρ/n)`. Whitened differences have unit variance where noise alone is at work, but for outcomes of yes or no,
of which a right model leaves nothing: the noise floor is `√(m/n)` of m other numbers.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...field import RotatingField, StaticField
from ..fitting.fit import Fit
from ..fitting.fitter import Fitter
from ..fitting.hypothesis import PRIOR_SIGMA
from ..gap.comparison import Residual
from ..gap.floor import SHARED
from ..gap.job import Job
from ..gap.loss import robust_cost
from ..result import Gap, Interval
from ..what.contender import Contender
from ..what.margins import CLEAR

__all__ = ["HeldOut", "folds", "held_out", "is_foretold", "shrink"]

Floats = NDArray[np.float64]

_FOLDS = 4
_EVALUATIONS = 3
_RESAMPLES = 400
# A right model's mean square on trials that no fit has seen, above the noise's, and how much worse than nominal it may
# be there.
_FORETOLD, _NO_WORSE = 0.5, 1.02
# A track that holds more than this share of what speaks for an effect is its only witness.
_ALONE = 0.95


@dataclass(frozen=True, eq=False)
class HeldOut:
    """What a hypothesis says of trials that it was not fitted to.

    Attributes
    ----------
    residuals
        By trial, from the fit that had not seen it.
    points
        The parameters u of that fit, by trial; None for the nominal model.
    """

    residuals: tuple[Residual, ...]
    points: tuple[Floats | None, ...]

    def costs(self) -> Floats:
        """Return Σρ by trial."""
        return np.array([robust_cost(residual.trials[i]) for i, residual in enumerate(self.residuals)])


def folds(fitter: Fitter) -> list[tuple[int, ...]]:
    """Return the trials that are left out together, alike conditions apart; none of a single trial.

    Parameters
    ----------
    fitter
        Of the dataset.
    """
    trials = fitter.comparison.dataset.trials
    measured = [i for i in fitter.trials if fitter.comparison.sizes[i]]
    if len(measured) < 2:
        return []

    def condition(i: int) -> tuple[object, ...]:
        field = trials[i].field
        rate = field.frequency_Hz if isinstance(field, RotatingField) else 0.0
        strength = field.strength_T if isinstance(field, RotatingField | StaticField) else 0.0
        return field.kind, trials[i].incline_deg, rate, strength, i

    order = sorted(measured, key=condition)
    count = min(_FOLDS, len(order))
    return [tuple(sorted(order[first::count])) for first in range(count)]


def held_out(fitter: Fitter, fit: Fit | None, tolerance: Floats | None = None) -> HeldOut:
    """Return what a hypothesis says of every trial when that trial is left out of its fit.

    Parameters
    ----------
    fitter
        Of the dataset.
    fit
        Of the hypothesis, to all trials; None for the nominal model.
    tolerance
        How far the nominal numbers are off, shape (`SHARED`,); fitted to the others if None.
    """
    residuals: dict[int, Residual] = {}
    points: dict[int, Floats | None] = {}
    for left_out in folds(fitter) or [()]:
        train = tuple(i for i in fitter.trials if i not in left_out)
        point = None
        if fit is not None:
            point = _refitted(fitter, fit, train) if left_out else fit.point
            paths = fitter.comparison.simulator.run([Job(i, fit.hypothesis.effects(point)) for i in fitter.trials])
        else:
            paths = list(fitter.comparison.nominal_paths)
        residual = fitter.comparison.residual(paths, train, tolerance=tolerance)
        for i in left_out or fitter.trials:
            residuals[i], points[i] = residual, point
    # A trial without numbers is no worse anywhere.
    anywhere = next(iter(residuals))
    return HeldOut(
        tuple(residuals.get(i, residuals[anywhere]) for i in fitter.trials),
        tuple(points.get(i, points[anywhere]) for i in fitter.trials),
    )


def _refitted(fitter: Fitter, fit: Fit, train: tuple[int, ...]) -> Floats:
    """Return the parameters u that some trials ask for, shape (p,): a fit that starts from what they know of them.

    Where they leave a parameter free, a fit from the point that all trials chose would stay there. It starts from

    ```text
    (JᵀJ + 1/σ_u²)⁻¹ JᵀJ u
    ```

    with the derivatives J of their differences, the nuisances fitted to them alone: what they hold stays, what they do
    not is neutral. Only where the point of all trials follows these much better does the fit start there: a search of
    these would have found it, too.
    """
    there = fitter.fit(fit.hypothesis, fit.point, train, evaluations=1, steps=fit.steps)
    information = there.jacobian.T @ there.jacobian
    start = np.linalg.solve(information + np.eye(len(fit.point)) / PRIOR_SIGMA**2, information @ fit.point)
    cost, point = fitter.descend(fit.hypothesis, np.asarray(start, dtype=np.float64), train, _EVALUATIONS)
    if there.cost < cost - fitter.comparison.objective_of(CLEAR):
        _, point = fitter.descend(fit.hypothesis, fit.point, train, _EVALUATIONS)
    return point


def is_foretold(fitter: Fitter, nominal: HeldOut, chosen: HeldOut, gap: Gap, best: Contender) -> bool:
    """Whether a hypothesis stands on trials that its fit had not seen; not so where no trial can be left out.

    Where the trial that shows the effect is left out, nothing can foretell it, and past a threshold a small error is a
    long way: then it is enough to be no worse than the nominal model in the objective, whose logarithm bounds a trial.
    Not so where a single track holds all that speaks for the effect: nothing that was measured could speak against it.

    Parameters
    ----------
    fitter
        Of the dataset.
    nominal, chosen
        Of the nominal model and of the hypothesis.
    gap
        Of both.
    best
        The hypothesis, fitted to all trials.
    """
    if not gap.held_out_trials:
        return False
    if gap.after**2 - gap.noise_floor**2 <= _FORETOLD:
        return True
    before = [fitter.trial_cost(nominal.residuals[i], i) for i in fitter.trials]
    gains = np.array([max(cost - fitter.trial_cost(best.residual, i), 0.0) for i, cost in enumerate(before)])
    most = int(np.argmax(gains))
    alone = gains[most] > _ALONE * gains.sum() and len(fitter.comparison.readers[most].observed.time_s) > 0
    after = sum(fitter.trial_cost(residual, i) for i, residual in enumerate(chosen.residuals))
    return not alone and after <= _NO_WORSE * sum(before)


def shrink(fitter: Fitter, chosen: HeldOut, seed: int = 0) -> Gap:
    """Return the gap before, with the sensor's nuisances fitted, and with the effects, on trials left out.

    Parameters
    ----------
    fitter
        Of the dataset.
    chosen
        Of the hypothesis with the effects.
    seed
        Of the bootstrap over trials.
    """
    comparison = fitter.comparison
    perfect = comparison.residual(comparison.nominal_paths, fit_nuisances=False)
    counted = list(fitter.trials)
    # The sensor alone, with the nominal numbers as the lab states them.
    sensor = held_out(fitter, None, np.zeros(SHARED))
    costs = np.array([[robust_cost(perfect.trials[i]) for i in counted], sensor.costs(), chosen.costs()])
    sizes = np.array([comparison.sizes[i] for i in counted], dtype=np.float64)
    before, nuisances, after = np.sqrt(costs.sum(axis=1) / max(sizes.sum(), 1.0))
    draws = np.random.default_rng(seed).integers(0, len(counted), (_RESAMPLES, len(counted)))
    drawn = np.sqrt(costs[:, draws].sum(axis=2) / np.maximum(sizes[draws].sum(axis=1), 1.0))
    noisy = np.array([comparison.floors[i].noisy for i in counted], dtype=np.float64)
    floor = float(np.sqrt(noisy.sum() / max(sizes.sum(), 1.0)))
    floors = np.sqrt(noisy[draws].sum(axis=1) / np.maximum(sizes[draws].sum(axis=1), 1.0))
    low, high = np.quantile(_shrunk(drawn[0], drawn[2], floors), [0.05, 0.95])
    # Of what was not measured there is no gap.
    by_trial = np.sqrt(np.divide(costs, sizes, out=np.full_like(costs, np.nan), where=sizes > 0.0))
    ids = [comparison.dataset.trials[i].id for i in counted]
    left_out = [comparison.dataset.trials[i].id for fold in folds(fitter) for i in fold]
    estimate = float(_shrunk(np.array(before), np.array(after), np.array(floor)))
    return Gap(
        noise_floor=floor,
        before=float(before),
        after_nuisance_only=float(nuisances),
        after=float(after),
        shrink=Interval(estimate, min(float(low), estimate), max(float(high), estimate)),
        held_out_trials=tuple(name for name in ids if name in left_out),
        by_trial={name: (float(a), float(b), float(c)) for name, (a, b, c) in zip(ids, by_trial.T, strict=True)},
    )


def _shrunk(before: Floats, after: Floats, floor: Floats) -> Floats:
    gap = before - floor
    share = np.where(gap > 0.0, 1.0 - (after - floor) / np.maximum(gap, 1e-12), 0.0)
    return np.clip(share, 0.0, 1.0)
