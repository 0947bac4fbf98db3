"""`Fitter`: the parameters of a hypothesis by least squares, from several starts.

The objective is

```text
Σ_t κ n_t ln(1 + Σ ρ(r)/(κ n_t)) + n_c Σ ρ(outcomes) + Σ (nuisance/σ)² + Σ (u/0.5)²,   ρ Huber's, quadratic to 4 sigmas
```

over the whitened differences r of the n_t numbers of each track that is fitted, the sensor's nuisances at their optimum
for every point; where a beginning alone is compared, n_t is still of the whole track. In what is concluded n_c numbers
of a track count as one (`Comparison.alike`) and an outcome for itself: it has the weight of as many. The logarithm is
what is left of a trial's likelihood when its noise may be any multiple of the floor: past a threshold, or where motion
is chaotic, a trial can be far from the best of models, and must not decide alone. Least squares see it as a weight of
the trial, `1/(1 + mean square/κ)`, taken at the start and once more on the way. The derivatives are finite differences,
all of them one native batch.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from ..effects.base import Effect
from .comparison import Comparison, Residual
from .hypothesis import PRIOR_SIGMA, Hypothesis
from .loss import FAR, HUBER, robust_cost
from .pose import Path
from .simulator import Job

__all__ = ["Fit", "Fitter"]

Floats = NDArray[np.float64]

# Of the changes around a hypothesis, what may count as noise.
_SHARES = (1.0, 0.5, 0.25, 0.1)
# How often the shares are chosen, first with the nuisances that belong to all alike, then to the last choice.
_MIXED = 3
# How often the trials' weights are taken anew, and the change of one that asks for it.
_WEIGHINGS, _REWEIGHED = 2, 1.3
# A derivative's step changes the differences by about this much (root mean square), within these bounds; the first one
# where nothing is known yet.
_CHANGE, _LEAST_STEP, _MOST_STEP, _FIRST_STEP = 0.3, 1e-3, 5e-2, 1e-2
# Derivatives of a step that is off by more than this factor are taken again.
_RESTEPPED = 3.0
# A guess that is nearer to a start than this, as a share of the way, is no other start.
_NEAR = 0.15
# A guess is simulated where it promises so much of the cost; the first effects' parameters move no farther than this.
_PROMISE, _FARTHEST = 4.0, 0.3


@dataclass(frozen=True, eq=False)
class Fit:
    """A hypothesis at its best.

    Attributes
    ----------
    hypothesis
        What was fitted.
    point
        The parameters as u, shape (p,).
    residual
        How wrong it still is, over all trials.
    cost
        The objective there.
    jacobian
        Derivatives of the fitted differences and the nuisances' terms by u, shape (n, p), Huber's weights in them.
    steps
        Of u, by which these were taken, shape (p,): with the same the same paths serve against another noise.
    """

    hypothesis: Hypothesis
    point: Floats
    residual: Residual
    cost: float
    jacobian: Floats
    steps: Floats

    def information(self, dispersion: float) -> Floats:
        """Return the inverse of `covariance`, shape (p, p)."""
        return self.jacobian.T @ self.jacobian / dispersion + np.eye(len(self.point)) / PRIOR_SIGMA**2

    def covariance(self, dispersion: float) -> Floats:
        """Return the posterior covariance of u by Laplace's Gaussian, shape (p, p).

        Parameters
        ----------
        dispersion
            How many numbers count as one.
        """
        return np.asarray(np.linalg.inv(self.information(dispersion)), dtype=np.float64)


class _Moved(NamedTuple):
    """Points beside one, and how wrong the hypothesis is there."""

    steps: Floats
    signed: Floats
    points: list[Floats]
    residuals: list[Residual]


class Fitter:
    """Fits hypotheses to a dataset.

    Parameters
    ----------
    comparison
        The dataset, ready to be compared.
    """

    def __init__(self, comparison: Comparison) -> None:
        self.comparison = comparison
        self.trials = tuple(range(len(comparison.readers)))

    def residuals(
        self, hypothesis: Hypothesis, points: Sequence[Floats], train: Sequence[int] | None = None, share: float = 1.0
    ) -> list[Residual]:
        """Return how wrong a hypothesis is at each of some points: one native batch.

        Parameters
        ----------
        hypothesis, points
            What is simulated.
        train
            Trials that are simulated and from which the camera is fitted; all if None. The others count as not run.
        share
            Of each trial's time that counts.
        """
        chosen = self.trials if train is None else tuple(train)
        jobs = []
        for point in points:
            effects = hypothesis.effects(point)
            jobs += [Job(i, effects, share=share) for i in chosen]
        paths = self.comparison.simulator.run(jobs)
        runs = []
        for k in range(len(points)):
            row: list[Path | None] = [None for _ in self.trials]
            for i, path in zip(chosen, paths[k * len(chosen) : (k + 1) * len(chosen)], strict=True):
                row[i] = path
            runs.append(row)
        return self.comparison.residuals(runs, chosen, share=share)

    def cost(self, residual: Residual, point: Floats, train: Sequence[int] | None = None) -> float:
        """Return the objective."""
        chosen = self.trials if train is None else train
        prior = float(np.sum(residual.prior**2) + np.sum((point / PRIOR_SIGMA) ** 2))
        return sum(self.trial_cost(residual, i) for i in chosen) + prior

    def nominal(self) -> tuple[Residual, float]:
        """Return how wrong the nominal model is against the noise of the moment, and its objective."""
        residual = self.comparison.residual(self.comparison.nominal_paths)
        return residual, self.cost(residual, np.zeros(1))

    def again(self, fit: Fit) -> Fit:
        """Return a fit as it is against the noise of the moment, its derivatives as they were.

        Parameters
        ----------
        fit
            Found against any noise.
        """
        residual = self.residuals(fit.hypothesis, [fit.point])[0]
        return replace(fit, residual=residual, cost=self.cost(residual, fit.point))

    def trial_cost(self, residual: Residual, trial: int) -> float:
        """Return what one trial adds to the objective."""
        values = residual.trials[trial]
        track = self.comparison.floors[trial].tracked
        far = FAR * max(track, 1)
        outcomes = self.comparison.alike * robust_cost(values[track:])
        return far * float(np.log1p(robust_cost(values[:track]) / far)) + outcomes

    def take_likeliest_noise(
        self, effects: tuple[Effect, ...], around: tuple[Effect, ...] | None = None
    ) -> tuple[float, ...]:
        """Take the noise around a hypothesis, in each trial as much of it as makes the differences likeliest.

        What halving the step or moving a nominal number changes bounds what may be wrong; how much is, the data know.

        Parameters
        ----------
        effects
            The hypothesis; none for the nominal model.
        around
            The hypothesis around which the noise is measured; the same if None.

        Returns
        -------
        tuple
            By trial, how much of it is taken.
        """
        comparison = self.comparison
        around = effects if around is None else around
        paths = comparison.simulator.run([Job(i, effects) for i in self.trials])
        known = []
        for share in _SHARES:
            comparison.take_noise_of(around, shares=[share] * len(self.trials))
            known.append(comparison.floors)

        def likeliest(mixed: Residual | None) -> tuple[int, ...]:
            totals = []
            for floors in known:
                comparison.floors = floors
                residual = comparison.residual(paths) if mixed is None else comparison.held(paths, mixed)
                determinants = map(comparison.log_determinant_of, floors)
                totals.append([self.trial_cost(residual, i) + d for i, d in enumerate(determinants)])
            return tuple(np.argmin(np.array(totals), axis=0).tolist())

        def take(chosen: tuple[int, ...]) -> None:
            comparison.floors = tuple(known[k][i] for i, k in enumerate(chosen))

        # A trial's share moves the nuisances of all: first all have the same, then the others have theirs.
        chosen = best = likeliest(None)
        least = inf
        for _ in range(_MIXED):
            take(chosen)
            mixed = comparison.residual(paths)
            total = self.cost(mixed, np.zeros(1)) + comparison.log_determinant
            if total >= least:
                break
            best, least = chosen, total
            chosen = likeliest(mixed)
        take(best)
        return tuple(_SHARES[k] for k in best)

    def weights(self, residual: Residual, chosen: Sequence[int]) -> Floats:
        """Return the square roots of the weights of the trials' numbers in the objective, shape (n,).

        Parameters
        ----------
        residual
            How wrong a hypothesis is.
        chosen
            The trials.
        """
        rows = []
        for i in chosen:
            row = np.full(len(residual.trials[i]), np.sqrt(self.comparison.alike))
            row[: self.comparison.floors[i].tracked] = np.sqrt(self.comparison.weight(i, residual.trials[i]))
            rows.append(row)
        return np.concatenate(rows) if rows else np.empty(0)

    def scan(
        self, hypotheses: Sequence[Hypothesis], base: Sequence[Floats], still: Residual, slopes: Floats | None = None
    ) -> list[list[tuple[float, Floats]]]:
        """Return the points from which each hypothesis is best fitted, with their objective, the best first.

        Every start is simulated; then, as if the differences were linear, the best point on the way to each start and
        the best combination of all of them, where that promises something.

        Parameters
        ----------
        hypotheses
            What will be fitted.
        base
            For each the point to which its starts are added: zero, or the fit of its first effects.
        still
            How wrong each is at its base: the same for all.
        slopes
            Derivatives of the differences by the first effects' parameters at the base, shape (n, q).
        """
        starts = [[np.clip(b + s, h.low, h.high) for s in h.starts] for h, b in zip(hypotheses, base, strict=True)]
        # One hypothesis after another: long tracks of all at once would fill the memory.
        found = [self.residuals(h, points) for h, points in zip(hypotheses, starts, strict=True)]
        weights = self.weights(still, self.trials)
        here = weights * still.over(self.trials)
        first = np.empty((len(here), 0)) if slopes is None else slopes[: len(here)]
        tried: list[list[tuple[float, int, Floats]]] = []
        guesses: list[list[Floats]] = []
        for h, b, points, residuals in zip(hypotheses, base, starts, found, strict=True):
            tried.append([(self.cost(still, b), 0, b)])
            tried[-1] += [(self.cost(r, p), 1 + n, p) for n, (r, p) in enumerate(zip(residuals, points, strict=True))]
            changes = [weights * r.over(self.trials) - here for r in residuals]
            columns = [[k] for k in range(len(points))]
            if len(points) > 1 and len(b) - first.shape[1] > 1:
                columns.append(list(range(len(points))))
            mine: list[tuple[float, Floats]] = []
            for chosen in columns:
                table = np.column_stack([first, *(changes[k] for k in chosen)])
                gram = table.T @ table
                shares = np.linalg.solve(gram + (1e-6 * np.trace(gram) + 1e-12) * np.eye(len(gram)), -table.T @ here)
                step = np.concatenate([shares[: first.shape[1]], np.zeros(len(b) - first.shape[1])])
                step = np.clip(step, -_FARTHEST, _FARTHEST)
                for share, k in zip(shares[first.shape[1] :], chosen, strict=True):
                    step = step + np.clip(share, -_FARTHEST, 3.0) * (points[k] - b)
                near = len(chosen) == 1 and not first.shape[1] and abs(shares[0] - 1.0) < _NEAR
                promise = float(here @ here - np.sum((here + table @ shares) ** 2))
                if promise > _PROMISE and not near:
                    mine.append((-promise, np.clip(b + step, h.low, h.high)))
            # With other effects at work already, one guess each is looked at.
            mine.sort(key=lambda guess: guess[0])
            guesses.append([guess for _, guess in (mine[:1] if first.shape[1] else mine)])
        for h, those, points in zip(hypotheses, tried, guesses, strict=True):
            count, residuals = len(those), self.residuals(h, points)
            those += [(self.cost(r, p), count + n, p) for n, (r, p) in enumerate(zip(residuals, points, strict=True))]
        return [[(cost, p) for cost, _, p in sorted(those, key=lambda entry: entry[:2])] for those in tried]

    def fit(
        self,
        hypothesis: Hypothesis,
        start: Floats,
        train: Sequence[int] | None = None,
        evaluations: int = 8,
        share: float = 1.0,
        steps: Floats | None = None,
    ) -> Fit:
        """Return the best point near a start.

        Parameters
        ----------
        hypothesis
            What is fitted.
        start
            A point u, shape (p,).
        train
            Trials that are fitted; all if None.
        evaluations
            At most so many trial points.
        share
            Of each trial's time that counts.
        steps
            Of the first derivatives, shape (p,): those of an earlier fit.
        """
        chosen = self.trials if train is None else tuple(train)
        descent = _Descent(self, hypothesis, start, chosen, share, steps)
        return descent.fit(descent.end(evaluations))

    def descend(
        self,
        hypothesis: Hypothesis,
        start: Floats,
        train: Sequence[int] | None = None,
        evaluations: int = 8,
        share: float = 1.0,
    ) -> tuple[float, Floats]:
        """Return the objective and the point where `fit` would end, without the derivatives there.

        Parameters
        ----------
        hypothesis, start, train, evaluations, share
            As in `fit`.
        """
        chosen = self.trials if train is None else tuple(train)
        descent = _Descent(self, hypothesis, start, chosen, share)
        point = descent.end(evaluations)
        return descent.cost(point), point


class _Descent:
    """Least squares from one start, which meets some points several times."""

    def __init__(
        self,
        fitter: Fitter,
        hypothesis: Hypothesis,
        start: Floats,
        chosen: tuple[int, ...],
        share: float,
        steps: Floats | None = None,
    ) -> None:
        self.fitter, self.hypothesis, self.chosen, self.share = fitter, hypothesis, chosen, share
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
        self.weights = fitter.weights(still, chosen)
        # Huber's loss turns at the same difference for an outcome, whatever its weight.
        self.limits = HUBER * np.maximum(np.concatenate([self.weights, np.ones(still.prior.size + len(start))]), 1.0)

    def at(self, point: Floats) -> Residual:
        """Return how wrong the hypothesis is at a point."""
        key = point.tobytes()
        if key not in self._known:
            self._known[key] = self.fitter.residuals(self.hypothesis, [point], self.chosen, self.share)[0]
        return self._known[key]

    def cost(self, point: Floats) -> float:
        """Return the objective at a point."""
        return self.fitter.cost(self.at(point), point, self.chosen)

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
            found = self.fitter.residuals(self.hypothesis, points, self.chosen, self.share)
            self._moved[key] = _Moved(steps, signed, points, found)
        by = self._moved[key]
        columns = [(self.rows(r, p) - here) / h for r, p, h in zip(by.residuals, by.points, by.signed, strict=True)]
        slope = np.array([np.sqrt(np.mean(column[: -len(point)] ** 2)) for column in columns])
        self.steps = np.clip(_CHANGE / np.maximum(slope, 1e-12), _LEAST_STEP, _MOST_STEP)
        return np.column_stack(columns)

    def end(self, evaluations: int) -> Floats:
        """Return where least squares end, in so many trial points at most."""
        point = self.start
        for weighing in range(_WEIGHINGS):
            result = least_squares(
                lambda point: self.rows(self.at(point), point),
                point,
                jac=self.jacobian,
                bounds=self.bounds,
                loss=self.loss,
                max_nfev=evaluations if weighing == 0 else max(evaluations // 2, 2),
                ftol=1e-3,
                xtol=1e-4,
                gtol=1e-3,
            )
            if self.cost(result.x) <= self.cost(point):
                point = result.x
            before, self.weights = self.weights, self.fitter.weights(self.at(point), self.chosen)
            change = np.max(np.abs(np.log(self.weights / before)), initial=0.0)
            if change < np.log(_REWEIGHED):
                break
        return point

    def fit(self, point: Floats) -> Fit:
        """Return the fit that ends at a point, with the derivatives there."""
        residual = self.at(point)
        fitted = np.concatenate([self.weights * residual.over(self.chosen), residual.prior])
        robust = np.minimum(1.0, self.limits[: len(fitted)] / np.maximum(np.abs(fitted), 1e-12)) ** 0.5
        slopes = self.jacobian(point)[: len(fitted)] * robust[:, None]
        steps = self._moved[point.tobytes()].steps
        return Fit(self.hypothesis, point, residual, self.cost(point), slopes, steps)
