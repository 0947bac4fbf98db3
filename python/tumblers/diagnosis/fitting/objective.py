"""`Objective`: how wrong a hypothesis is over all trials, in one number.

The objective is

```text
Σ_t κ n_t ln(1 + Σ ρ(r)/(κ n_t)) + n_c Σ ρ(outcomes) + Σ (nuisance/σ)² + Σ (u/0.5)²,   ρ Huber's, quadratic to 4 sigmas
```

over the whitened differences r of the n_t numbers of each track that is fitted, the sensor's nuisances at their optimum
for every point; where a beginning alone is compared, n_t is still of the whole track. In what is concluded n_c numbers
of a track count as one (`Comparison.alike`) and an outcome for itself: it has the weight of as many. The logarithm is
what is left of a trial's likelihood when its noise may be any multiple of the floor: past a threshold, or where motion
is chaotic, a trial can be far from the best of models, and must not decide alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import inf

import numpy as np
from numpy.typing import NDArray

from ...effects.base import Effect
from ..gap.comparison import Comparison, Residual
from ..gap.guide import Nudge
from ..gap.job import Job
from ..gap.loss import FAR, robust_cost
from ..gap.pose import Path
from .fit import Fit
from .hypothesis import PRIOR_SIGMA, Hypothesis

__all__ = ["Objective"]

Floats = NDArray[np.float64]

# Of the changes around a hypothesis, what may count as noise.
_SHARES = (1.0, 0.5, 0.25, 0.1)
# How often the shares are chosen, first with the nuisances that belong to all alike, then to the last choice.
_MIXED = 3


class Objective:
    """Says of hypotheses how wrong they are about a dataset.

    Parameters
    ----------
    comparison
        The dataset, ready to be compared.
    """

    def __init__(self, comparison: Comparison) -> None:
        self.comparison = comparison
        self.trials = tuple(range(len(comparison.readers)))

    def residuals(
        self,
        hypothesis: Hypothesis,
        points: Sequence[Floats],
        train: Sequence[int] | None = None,
        share: float = 1.0,
        nudges: Sequence[Nudge] | None = None,
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
        nudges
            By trial, how the runs are drawn to where the robot was seen; they are on their own if None.
        """
        chosen = self.trials if train is None else tuple(train)
        jobs = []
        for point in points:
            effects = hypothesis.effects(point)
            jobs += [Job(i, effects, share=share, nudge=None if nudges is None else nudges[i]) for i in chosen]
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
