"""`Hypothesis`: a set of effects as a point in numbers of order one."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..effects.base import Effect
from ..scenario import Scenario

__all__ = ["PRIOR_SIGMA", "Hypothesis"]

Floats = NDArray[np.float64]

# A parameter is expected within about twice this share of its range around neutral.
PRIOR_SIGMA = 0.5


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """Some effects, and the ranges of their parameters.

    A parameter v counts as `u = (v - neutral) / scale`, with the farther end of its range at `|u| = 1`.

    Attributes
    ----------
    kinds
        The effects' classes.
    neutral, scale
        Of every parameter, shape (p,).
    low, high
        Bounds of u, shape (p,).
    starts
        Points u from which a fit may start, shape (k, p).
    """

    kinds: tuple[type[Effect], ...]
    neutral: Floats
    scale: Floats
    low: Floats
    high: Floats
    starts: Floats

    @classmethod
    def of(cls, kind: type[Effect], scenarios: Iterable[Scenario]) -> Hypothesis:
        """Return the hypothesis of one effect, over what is plausible in any of the scenarios."""
        neutral = np.array([p.neutral for p in kind.parameters])
        low, high = neutral.copy(), neutral.copy()
        points: dict[tuple[float, ...], None] = {}
        for scenario in scenarios:
            ranges = np.array(kind.ranges(scenario))
            low, high = np.minimum(low, ranges[:, 0]), np.maximum(high, ranges[:, 1])
            points |= dict.fromkeys(kind.starts(scenario))
        scale = np.maximum(np.maximum(high - neutral, neutral - low), 1e-300)
        starts = np.array([(np.array(point) - neutral) / scale for point in points]).reshape(-1, len(neutral))
        return cls((kind,), neutral, scale, (low - neutral) / scale, (high - neutral) / scale, starts)

    def __add__(self, other: Hypothesis) -> Hypothesis:
        """Both sets of effects; only `other` has starts, from this one's neutral point."""
        joined = {
            name: np.concatenate([getattr(self, name), getattr(other, name)])
            for name in ("neutral", "scale", "low", "high")
        }
        starts = np.hstack([np.zeros((len(other.starts), len(self.neutral))), other.starts])
        return Hypothesis(self.kinds + other.kinds, starts=starts, **joined)

    @property
    def names(self) -> tuple[str, ...]:
        """The effects' names."""
        return tuple(kind.name for kind in self.kinds)

    @property
    def keys(self) -> tuple[tuple[str, str], ...]:
        """Effect and key of every parameter."""
        return tuple((kind.name, parameter.key) for kind in self.kinds for parameter in kind.parameters)

    def effects(self, point: Sequence[float] | Floats) -> tuple[Effect, ...]:
        """Return the effects at a point u, shape (p,)."""
        values = self.values(point)
        made, first = [], 0
        for kind in self.kinds:
            count = len(kind.parameters)
            made.append(kind.from_vector([float(v) for v in values[first : first + count]]))
            first += count
        return tuple(made)

    def values(self, point: Sequence[float] | Floats) -> Floats:
        """Return the parameters' values at a point u, shape (p,)."""
        clipped = np.clip(np.asarray(point, dtype=np.float64), self.low, self.high)
        return self.neutral + self.scale * clipped
