"""The posterior predictive test: whether what a hypothesis leaves is no more than noise.

It holds the mean squared difference, over all trials and in the worst one, against what a right model gives: the floor
is made so that this is about 1 at most. An outcome stands for itself: the many numbers of a track beside it would hide
that it contradicts them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2

from ..result import Failing
from .comparison import Comparison, Residual
from .loss import huber, robust_cost
from .reading import BORDERS, reached

__all__ = [
    "MOST_EXPLAINED",
    "contradicted",
    "failings",
    "is_explained",
    "is_right",
    "is_wanting",
    "leaves_a_gap",
    "mean_square",
    "mean_squares",
]

# A right model's mean square over all of many numbers, and in its worst trial.
_RIGHT, _WORST = 1.25, 2.0
# What was fitted, against the noise around itself, leaves less where it is right: of datasets with a known truth 98 %
# did in the catalogue's form, 90 % in another, and about half of those with a cause that the catalogue has not.
MOST_EXPLAINED = 1.18
# Of few numbers noise alone leaves more than either; more than what is allowed instead it leaves once in a hundred
# datasets.
_SELDOM = 0.01
# A gap is left where the mean square stays above this against the likeliest noise.
_WANTING = 1.1
# Of few numbers noise alone leaves more than so much once in a thousand trials or outcomes: some hundred are looked at.
_RARE = 1e-3
# What a climb or a slide that was seen costs a model that stays where it is, within a fiftieth of the way: the smooth
# likelihood is for models near the border. A climb that was not seen costs as much at 0.18 of the way.
_HOLDS = {name: reached(0.02, True, border) ** 2 for name, border in BORDERS.items()}


def mean_squares(residual: Residual) -> NDArray[np.float64]:
    """Return Σρ/n of each trial, shape (trials,)."""
    return np.array([robust_cost(values) / max(len(values), 1) for values in residual.trials])


def mean_square(comparison: Comparison, residual: Residual) -> float:
    """Return Σρ/n over all trials."""
    return float(np.average(mean_squares(residual), weights=comparison.sizes))


def is_right(comparison: Comparison, residual: Residual) -> bool:
    """Whether a hypothesis passes the test."""
    return not failings(comparison, residual, fitted=False)


def is_explained(comparison: Comparison, residual: Residual) -> bool:
    """Whether effects that were fitted pass the test, and leave no more than right ones do."""
    return not failings(comparison, residual, fitted=True)


def failings(comparison: Comparison, residual: Residual, fitted: bool) -> tuple[Failing, ...]:
    """Return what a hypothesis fails of the test, nothing where it passes.

    Parameters
    ----------
    comparison
        The dataset.
    residual
        How wrong the hypothesis is.
    fitted
        Whether it is to leave no more than right effects that were fitted do.
    """
    ids = [trial.id for trial in comparison.dataset.trials]
    made = []
    left, allowed = mean_square(comparison, residual), _allowed(MOST_EXPLAINED if fitted else _RIGHT, comparison.count)
    if not left <= allowed:
        made.append(Failing("all trials", left=left, allowed=allowed))
    squares, worst = mean_squares(residual), _worst(np.asarray(comparison.sizes))
    made += [
        Failing("a trial", (ids[i],), float(squares[i]), float(worst[i])) for i in np.flatnonzero(~(squares <= worst))
    ]
    if (against := contradicted(comparison, residual)).any():
        made.append(Failing("an outcome", tuple(ids[i] for i in np.flatnonzero(against))))
    return tuple(made)


def contradicted(comparison: Comparison, residual: Residual) -> NDArray[np.bool_]:
    """Return in which trials a hypothesis says something else than an outcome that was noted, shape (trials,).

    Parameters
    ----------
    comparison
        The dataset.
    residual
        How wrong the hypothesis is.
    """
    most = float(_worst(np.array(1)))
    return np.array(
        [
            any(
                loss >= _HOLDS.get(name, most)
                for name, loss in zip(floor.outcome_scale, huber(values[floor.tracked :]), strict=True)
            )
            for values, floor in zip(residual.trials, comparison.floors, strict=True)
        ],
        dtype=np.bool_,
    )


def is_wanting(comparison: Comparison, residual: Residual) -> bool:
    """Whether a hypothesis leaves a gap that something else may close, even where it passes the test."""
    return mean_square(comparison, residual) > _WANTING


def leaves_a_gap(values: NDArray[np.float64]) -> bool:
    """Return whether some differences are more than likeliest noise.

    Parameters
    ----------
    values
        Whitened, shape (n,), n ≥ 1.
    """
    return robust_cost(values) / len(values) > _WANTING


def _allowed(many: float, count: int) -> float:
    """Return the most of a mean square: what is allowed of many numbers, or of few what noise seldom gives."""
    n = max(count, 1)
    return max(many, float(chi2.isf(_SELDOM, n)) / n)


def _worst(count: NDArray[np.int_]) -> NDArray[np.float64]:
    """Return the most that a right model leaves of so many numbers: in few, noise alone gives more."""
    n = np.maximum(count, 1)
    return np.asarray(np.maximum(_WORST * (1.0 + 2.0 * np.sqrt(2.0 / n)), chi2.isf(_RARE, n) / n))
