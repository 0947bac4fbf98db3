"""Means of the missing wrench over some of its windows.

The mean over a group of windows is the one wrench u that acts in all of them, while every other window keeps its own.
With the information A of the data about a trial's windows, their estimate w, and S the matrix that puts u into the
group's windows,

```text
Λ = Σ [SᵀAS - SᵀAR (RᵀAR + P)⁻¹ RᵀAS] + P,      u = Λ⁻¹ Σ [Sᵀ - SᵀAR (RᵀAR + P)⁻¹ Rᵀ] (A + P) w
```

R takes the other windows of the trial, P is the prior's information, and the sums are over trials. Windows that can
hardly be told apart, for a push now and a push later do the same, are thus known well together.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..result import WrenchMean

__all__ = ["Windows", "means"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Windows:
    """The windows of one trial, k of them.

    Attributes
    ----------
    trial
        Its place in the dataset.
    start_s, end_s
        Of each window, shape (k,).
    wrench
        The estimate, N and N m, shape (k, 6).
    information
        Inverse covariance of the windows' wrenches by the data alone, shape (6 k, 6 k).
    prior_sigma
        Shape (6,).
    mode
        Contact mode for most of each window.
    place_y_m
        Place along y in the middle of each window, m, shape (k,).
    """

    trial: int
    start_s: Floats
    end_s: Floats
    wrench: Floats
    information: Floats
    prior_sigma: Floats
    mode: tuple[str, ...]
    place_y_m: Floats

    @property
    def sigma(self) -> Floats:
        """Standard deviations, shape (k, 6)."""
        scale = np.tile(self.prior_sigma, len(self.start_s))
        covariance = np.linalg.inv(self.information * np.outer(scale, scale) + np.eye(len(scale)))
        return np.asarray((np.sqrt(np.diag(covariance)) * scale).reshape(-1, 6), dtype=np.float64)


def means(windows: Sequence[Windows], groups: Mapping[str, Sequence[Sequence[int]]]) -> dict[str, WrenchMean]:
    """Return the mean wrench over groups of windows.

    Parameters
    ----------
    windows
        By trial.
    groups
        Label to the windows of each trial that count; groups without any are left out.
    """
    out = {}
    for label, members in groups.items():
        if not any(members):
            continue
        scale = np.max([w.prior_sigma for w, mine in zip(windows, members, strict=True) if mine], axis=0)
        precision, pull = np.eye(6), np.zeros(6)
        for w, mine in zip(windows, members, strict=True):
            if mine:
                a, b = _about(w, list(mine), scale)
                precision += a
                pull += b
        covariance = np.linalg.inv(precision)
        out[label] = WrenchMean(covariance @ pull * scale, np.sqrt(np.diag(covariance)) * scale, scale)
    return out


def _about(windows: Windows, mine: list[int], scale: Floats) -> tuple[Floats, Floats]:
    """Return a trial's information about the wrench of a group, in units of `scale`, and that times the wrench."""
    count = len(windows.start_s)
    units = np.tile(scale, count)
    information = windows.information * np.outer(units, units)
    estimate = windows.wrench.ravel() / units
    chosen = np.zeros((count, 6, 6))
    chosen[mine] = np.eye(6)
    s = chosen.reshape(6 * count, 6)
    rest = np.setdiff1d(np.arange(count), mine)
    r = np.eye(6 * count)[:, (6 * rest[:, None] + np.arange(6)).ravel()]
    prior = np.diag(np.tile(scale / windows.prior_sigma, count) ** 2)
    others = np.linalg.solve(r.T @ (information + prior) @ r, r.T)
    projection = s.T - s.T @ information @ r @ others
    return projection @ information @ s, projection @ (information + prior) @ estimate
