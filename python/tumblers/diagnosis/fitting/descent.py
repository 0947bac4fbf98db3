"""`Descent`: least squares from one start down the objective.

They see a trial's logarithm as a weight of the trial, `1/(1 + mean square/κ)`, taken at the start and once more on the
way. The derivatives are finite differences, all of them one native batch.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from ..gap.comparison import Residual
from ..gap.loss import HUBER
from .fit import Fit
from .hypothesis import PRIOR_SIGMA, Hypothesis
from .objective import Objective
from .sandwich import Pulls

__all__ = ["Descent"]

Floats = NDArray[np.float64]

# How often the trials' weights are taken anew, and the change of one that asks for it.
_WEIGHINGS, _REWEIGHED = 2, 1.3
# A derivative's step changes the differences by about this much (root mean square), within these bounds; the first one
# where nothing is known yet.
_CHANGE, _LEAST_STEP, _MOST_STEP, _FIRST_STEP = 0.3, 1e-3, 5e-2, 1e-2
# Derivatives of a step that is off by more than this factor are taken again.
_RESTEPPED = 3.0
# Where it ends: a step gains less than this share of the objective, moves by less than this share of the point, or
# could gain no more than this slope says. A choice.
_SMALL_GAIN, _SMALL_STEP, _SMALL_SLOPE = 1e-3, 1e-4, 1e-3


class _Moved(NamedTuple):
    """Points beside one, and how wrong the hypothesis is there."""

    steps: Floats
    signed: Floats
    points: list[Floats]
    residuals: list[Residual]


class Descent:
    """One way down, which meets some points several times.

    Parameters
    ----------
    objective, hypothesis
        What is made least, by which parameters.
    start
        A point u, shape (p,).
    chosen
        Trials that are fitted.
    share
        Of each trial's time that counts.
    steps
        Of the first derivatives, shape (p,).
    """

    def __init__(
        self,
        objective: Objective,
        hypothesis: Hypothesis,
        start: Floats,
        chosen: tuple[int, ...],
        share: float,
        steps: Floats | None = None,
    ) -> None:
        self.objective, self.hypothesis, self.chosen, self.share = objective, hypothesis, chosen, share
        self.steps = np.full(len(start), _FIRST_STEP) if steps is None else steps.copy()
        self._known: dict[bytes, Residual] = {}
        self._moved: dict[bytes, _Moved] = {}
        inside = np.clip(start, hypothesis.low, hypothesis.high)
        fixed = hypothesis.high <= hypothesis.low
        low, high = np.where(fixed, -1e-9, hypothesis.low), np.where(fixed, 1e-9, hypothesis.high)
        margin = 1e-9 * (high - low)
        self.bounds = low, high
        self.start = np.clip(inside, low + margin, high - margin)
        still = self.at(self.start)
        self.weights = objective.weights(still, chosen)
        # Huber's loss turns at the same difference for an outcome, whatever its weight.
        self.limits = HUBER * np.maximum(np.concatenate([self.weights, np.ones(still.prior.size + len(start))]), 1.0)

    def at(self, point: Floats) -> Residual:
        """Return how wrong the hypothesis is at a point."""
        key = point.tobytes()
        if key not in self._known:
            self._known[key] = self.objective.residuals(self.hypothesis, [point], self.chosen, self.share)[0]
        return self._known[key]

    def cost(self, point: Floats) -> float:
        """Return the objective at a point."""
        return self.objective.cost(self.at(point), point, self.chosen)

    def rows(self, residual: Residual, point: Floats) -> Floats:
        """Return what least squares sees, by the trials' weights of the moment."""
        differences = self.weights * residual.over(self.chosen)
        return np.concatenate([differences, residual.prior, point / PRIOR_SIGMA])

    def loss(self, squares: Floats) -> Floats:
        """Return ρ, ρ' and ρ'' by the square of each row, shape (3, n)."""
        size = np.sqrt(np.maximum(squares, self.limits**2))
        far = squares > self.limits**2
        value = np.where(far, self.limits * (2.0 * size - self.limits), squares)
        slope = self.limits / size
        return np.array([value, np.where(far, slope, 1.0), np.where(far, -0.5 * slope / size**2, 0.0)])

    def jacobian(self, point: Floats) -> Floats:
        """Return the derivatives of `rows` at a point, shape (n, p)."""
        here, key, steps = self.rows(self.at(point), point), point.tobytes(), self.steps
        # The same point is asked for again with other weights, and at the end.
        if key not in self._moved or np.any(np.abs(np.log(steps / self._moved[key].steps)) > np.log(_RESTEPPED)):
            # Towards the inside of the range.
            signed = np.where(point + steps > self.hypothesis.high, -steps, steps)
            points = [point + signed[j] * np.eye(len(point))[j] for j in range(len(point))]
            found = self.objective.residuals(self.hypothesis, points, self.chosen, self.share)
            self._moved[key] = _Moved(steps, signed, points, found)
        by = self._moved[key]
        columns = [(self.rows(r, p) - here) / h for r, p, h in zip(by.residuals, by.points, by.signed, strict=True)]
        slope = np.array([np.sqrt(np.mean(column[: -len(point)] ** 2)) for column in columns])
        self.steps = np.clip(_CHANGE / np.maximum(slope, 1e-12), _LEAST_STEP, _MOST_STEP)
        return np.column_stack(columns)

    def end(self, evaluations: int) -> Floats:
        """Return where least squares end.

        Parameters
        ----------
        evaluations
            Trial points at most; where the trials' weights change by it, half as many, but two at least, follow once
            more. Of one, the point is the start and only the derivatives there are taken.
        """
        point = self.start
        for weighing in range(_WEIGHINGS):
            result = least_squares(
                lambda point: self.rows(self.at(point), point),
                point,
                jac=self.jacobian,
                bounds=self.bounds,
                loss=self.loss,
                max_nfev=evaluations if weighing == 0 else max(evaluations // 2, 2),
                ftol=_SMALL_GAIN,
                xtol=_SMALL_STEP,
                gtol=_SMALL_SLOPE,
            )
            if self.cost(result.x) <= self.cost(point):
                point = result.x
            before, self.weights = self.weights, self.objective.weights(self.at(point), self.chosen)
            change = np.max(np.abs(np.log(self.weights / before)), initial=0.0)
            if change < np.log(_REWEIGHED):
                break
        return point

    def fit(self, point: Floats) -> Fit:
        """Return the fit that ends at a point, with the derivatives there."""
        fitted, robust = self._fitted(point)
        slopes = self.jacobian(point)[: len(fitted)] * robust[:, None]
        steps = self._moved[point.tobytes()].steps
        return Fit(self.hypothesis, point, self.at(point), self.cost(point), slopes, steps)

    def pulls(self, fit: Fit, dispersion: float) -> Pulls:
        """Return what the trials say of a fit.

        The camera's heading and scale and the nominal numbers, which belong to all trials, are of the fit to all.

        Parameters
        ----------
        fit
            At a point of this descent.
        dispersion
            How many numbers count as one.
        """
        fitted, robust = self._fitted(fit.point)
        values = robust * fitted
        slope = fit.jacobian.T @ values + fit.point / PRIOR_SIGMA**2
        ends = np.cumsum([0, *(len(fit.residual.trials[i]) for i in self.chosen)]).tolist()
        own = fit.residual.local.shape[1]
        by_trial, slopes = [], []
        for k, trial in enumerate(self.chosen):
            nuisances = ends[-1] + own * trial + np.arange(own)
            rows = np.concatenate([np.arange(ends[k], ends[k + 1]), nuisances])
            by_trial.append(fit.jacobian[rows].T @ fit.jacobian[rows])
            slopes.append(fit.jacobian[rows].T @ values[rows])
        return Pulls(
            fit.information(dispersion),
            slope / dispersion,
            np.array(by_trial) / dispersion,
            np.array(slopes) / dispersion,
        )

    def _fitted(self, point: Floats) -> tuple[Floats, Floats]:
        """Return the fitted differences and the nuisances' terms at a point, and the roots of Huber's weights."""
        residual = self.at(point)
        fitted = np.concatenate([self.weights * residual.over(self.chosen), residual.prior])
        return fitted, np.minimum(1.0, self.limits[: len(fitted)] / np.maximum(np.abs(fitted), 1e-12)) ** 0.5
