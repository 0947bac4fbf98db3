"""`Contender`: a hypothesis at its best, with what speaks for it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...effects.base import Effect
from ..fitting.fit import Fit
from ..fitting.fitter import Fitter
from ..gap.comparison import Comparison, Residual
from .margins import SECOND
from .step_credit import step_credit

__all__ = [
    "Contender",
    "likeliest",
    "likeliest_first",
    "of_fit",
    "of_nominal",
    "parsimonious_total",
    "whole_log_likelihood",
]

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Contender:
    """A hypothesis with its evidence.

    Attributes
    ----------
    names
        Its effects; none for the nominal model.
    fit
        None for the nominal model.
    residual
        How wrong it is over all trials.
    cost
        The objective against one noise: that around itself, that of the moment at which it was fitted, or that around
        the best (`against_the_best`).
    log_determinant
        ln det of that noise's covariance over that of the nominal model's.
    step_credit
        What the shorter steps that it is run in take off the objective by themselves: it is added again.
    settled
        Whether its derivatives are of a fit against the noise around itself; not of one that the best's was lent to.
    lent
        Whether the noise is that around the best, and it is near by its own too.
    offset
        What the total has beside that: so it is behind the best by the mean over both noises, and as far as before
        ahead of what is not compared so (`by_both_noises`).
    log_likelihood
        What of ln Z the fit makes: minus half the total, over the dispersion.
    log_evidence
        ln Z, the prior included.
    probability
        Over all contenders.
    merged
        Whether it counts as the nominal model, which has its probability.
    """

    names: tuple[str, ...]
    fit: Fit | None
    residual: Residual
    cost: float
    log_determinant: float = 0.0
    step_credit: float = 0.0
    settled: bool = False
    lent: bool = False
    offset: float = 0.0
    log_likelihood: float = 0.0
    log_evidence: float = 0.0
    probability: float = 0.0
    merged: bool = False

    @property
    def point(self) -> Floats:
        """The parameters u, shape (p,)."""
        return np.empty(0) if self.fit is None else self.fit.point

    @property
    def free(self) -> int:
        """How many parameters were fitted."""
        return 0 if self.fit is None else self.fit.hypothesis.free

    @property
    def total(self) -> float:
        """What contenders are compared by: twice the dispersion times -ln likelihood, but for what is the same for all.

        What is said in ln, as `CLEAR` or `OPEN`, counts as `Comparison.objective_of` has it.
        """
        return self.cost + self.log_determinant + self.step_credit + self.offset

    @property
    def effects(self) -> tuple[Effect, ...]:
        """The effects at their best."""
        return () if self.fit is None else self.fit.hypothesis.effects(self.fit.point)


def of_fit(fitter: Fitter, fit: Fit) -> Contender:
    """Return the contender of a fit against the noise of the moment."""
    log_determinant = fitter.comparison.log_determinant
    credit = step_credit(fitter, fit.hypothesis.effects(fit.point))
    return Contender(fit.hypothesis.names, fit, fit.residual, fit.cost, log_determinant, credit)


def of_nominal(fitter: Fitter) -> Contender:
    """Return the nominal model as a contender, against the noise of the moment."""
    residual, cost = fitter.nominal()
    return Contender((), None, residual, cost, fitter.comparison.log_determinant)


def likeliest_first(contenders: Iterable[Contender]) -> list[Contender]:
    """Return contenders by their likelihood, of equals the one that came first first."""
    return sorted(contenders, key=_total)


def likeliest(contenders: Iterable[Contender]) -> Contender:
    """Return the likeliest of some contenders, the first of equals."""
    return min(contenders, key=_total)


def parsimonious_total(contender: Contender, comparison: Comparison) -> float:
    """Return a contender's total with what a second effect has to take off it (`SECOND`).

    Parameters
    ----------
    contender
        Of one or two effects.
    comparison
        The dataset.
    """
    return contender.total + comparison.objective_of(SECOND) * (len(contender.names) - 1)


def whole_log_likelihood(contender: Contender, comparison: Comparison) -> float:
    """Return ln of a contender's likelihood, with what a total leaves out: it compares with another comparison's.

    Parameters
    ----------
    contender
        Any.
    comparison
        The one that it was made in.
    """
    return -(contender.total + comparison.nominal_log_determinant) / comparison.objective_of(1.0)


def _total(contender: Contender) -> float:
    return contender.total
