"""`Fitter`: the parameters of hypotheses by least squares, from several starts."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..gap.comparison import Residual
from .descent import Descent
from .fit import Fit
from .hypothesis import Hypothesis
from .objective import Objective

__all__ = ["Fitter"]

Floats = NDArray[np.float64]

# A guess that is nearer to a start than this, as a share of the way, is no other start.
_NEAR = 0.15
# A guess is simulated where it promises so much, in ln; the first effects' parameters move no farther than this.
_PROMISE, _FARTHEST = 0.25, 0.3


class Fitter(Objective):
    """An objective with the ways down it."""

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
            `Fit.jacobian` of the first effects at the base, shape (at least n, q), its rows weighted as in that fit:
            near enough for guesses.
        """
        starts = [[np.clip(b + s, h.low, h.high) for s in h.starts] for h, b in zip(hypotheses, base, strict=True)]
        # One hypothesis after another: long tracks of all at once would fill the memory.
        found = [self.residuals(h, points) for h, points in zip(hypotheses, starts, strict=True)]
        weights = self.weights(still, self.trials)
        here = weights * still.over(self.trials)
        first = np.empty((len(here), 0)) if slopes is None else slopes[: len(here)]
        least = self.comparison.objective_of(_PROMISE)
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
                if promise > least and not near:
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
            As for `Descent.end`.
        share
            Of each trial's time that counts.
        steps
            Of the first derivatives, shape (p,): those of an earlier fit.
        """
        chosen = self.trials if train is None else tuple(train)
        descent = Descent(self, hypothesis, start, chosen, share, steps)
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
        descent = Descent(self, hypothesis, start, chosen, share)
        point = descent.end(evaluations)
        return descent.cost(point), point
