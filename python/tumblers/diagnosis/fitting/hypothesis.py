"""`Hypothesis`: a set of effects as a point in numbers of order one."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...effects.base import Effect
from ...effects.parameter import Nuisance
from ...errors import EffectError, InputError
from ...scenario import Scenario

__all__ = ["PRIOR_SIGMA", "Hypothesis"]

Floats = NDArray[np.float64]

# A coordinate is expected within about twice this share of its range around neutral.
PRIOR_SIGMA = 0.5
# How far beside a coordinate is.
_BESIDE = 1e-6


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """Some effects, and the ranges of their parameters.

    A coordinate c of a fit counts as `u = (c - neutral) / scale`, with the farther end of its range at `|u| = 1`; what
    the coordinates are, an effect says (`Effect.to_fit`).

    Attributes
    ----------
    kinds
        The effects' classes.
    neutral, scale
        Of every coordinate, shape (p,).
    low, high
        Bounds of u, shape (p,).
    starts
        Points u from which a fit may start, shape (k, p).
    close
        More of them, for a search from the beginnings of the trials.
    ranges
        Plausible range of every parameter, shape (p, 2).
    """

    kinds: tuple[type[Effect], ...]
    neutral: Floats
    scale: Floats
    low: Floats
    high: Floats
    starts: Floats
    close: Floats
    ranges: Floats

    @classmethod
    def of(cls, kind: type[Effect], scenarios: Sequence[Scenario]) -> Hypothesis:
        """Return the hypothesis of one effect, over what is plausible in any of the scenarios.

        What changes none of them, as a factor of a friction that is zero, has no starts.

        Raises
        ------
        EffectError
            An effect of a user's own whose ranges or starts fail, or that no scenario takes from any of its starts.
        """
        neutral = np.array(kind.to_fit([p.neutral for p in kind.parameters]))
        low, high = neutral.copy(), neutral.copy()
        widest = np.array([(p.neutral, p.neutral) for p in kind.parameters])
        points: dict[tuple[float, ...], None] = {}
        close: dict[tuple[float, ...], None] = {}
        for scenario in scenarios:
            said = _Said.of(kind, scenario)
            low, high = np.minimum(low, said.fit_ranges[:, 0]), np.maximum(high, said.fit_ranges[:, 1])
            own = said.ranges
            widest = np.column_stack([np.minimum(widest[:, 0], own[:, 0]), np.maximum(widest[:, 1], own[:, 1])])
            points |= dict.fromkeys(said.starts)
            close |= dict.fromkeys(said.close)
        if not _is_tried(kind, scenarios):
            points, close = {}, {}
        scale = np.maximum(np.maximum(high - neutral, neutral - low), 1e-300)
        starts, closer = (
            np.array([(np.array(point) - neutral) / scale for point in those]).reshape(-1, len(neutral))
            for those in (points, close)
        )
        return cls((kind,), neutral, scale, (low - neutral) / scale, (high - neutral) / scale, starts, closer, widest)

    def __add__(self, other: Hypothesis) -> Hypothesis:
        """Both sets of effects; only `other` has starts, from this one's neutral point."""
        joined = {
            name: np.concatenate([getattr(self, name), getattr(other, name)])
            for name in ("neutral", "scale", "low", "high", "ranges")
        }
        starts, close = (np.hstack([np.zeros((len(s), len(self.neutral))), s]) for s in (other.starts, other.close))
        return Hypothesis(self.kinds + other.kinds, starts=starts, close=close, **joined)

    @property
    def free(self) -> int:
        """How many coordinates have a range."""
        return int(np.sum(self.high > self.low))

    @property
    def strengths(self) -> int:
        """How many coordinates with a range are no parameter of an effect's form."""
        form = [p.form for kind in self.kinds for p in kind.parameters]
        return int(np.sum((self.high > self.low) & ~np.array(form)))

    @property
    def ends(self) -> list[Floats]:
        """Points u at either end of the range of each coordinate that has one there, the others neutral."""
        units = np.eye(len(self.neutral))
        return [end * unit for side in (self.low, self.high) for end, unit in zip(side, units, strict=True) if end]

    def without(self, nuisances: Collection[Nuisance]) -> Hypothesis:
        """Return the hypothesis with the parameters at neutral that do what these nuisances do within their tolerances.

        Parameters
        ----------
        nuisances
            Of the sensor.
        """
        return self.held(np.array([p.beyond in nuisances for kind in self.kinds for p in kind.parameters]))

    def held(self, those: NDArray[np.bool_]) -> Hypothesis:
        """Return the hypothesis with some parameters at neutral.

        Parameters
        ----------
        those
            Whether a coordinate is held, shape (p,).
        """
        if not those.any():
            return self
        low, high = np.where(those, 0.0, self.low), np.where(those, 0.0, self.high)
        starts, close = (np.where(those, 0.0, points) for points in (self.starts, self.close))
        starts, close = (points[np.any(points != 0.0, axis=1)] for points in (starts, close))
        return replace(self, low=low, high=high, starts=starts, close=close)

    def rests(self, point: Floats) -> NDArray[np.bool_]:
        """Return the free coordinates beside which no value changes, shape (p,): they mean the same for a while.

        Parameters
        ----------
        point
            As u, shape (p,).
        """
        # Towards the inside of the range.
        signed = np.where(point + _BESIDE > self.high, -_BESIDE, _BESIDE)
        here = self.values(point)
        same = [bool(np.all(self.values(beside) == here)) for beside in point + np.diag(signed)]
        return np.array(same) & (self.low < self.high) & (self.low <= point) & (point <= self.high)

    def at_work(self, acting: Collection[int]) -> list[bool]:
        """Return which effects change something with some coordinates at an end of their range, the others neutral.

        Parameters
        ----------
        acting
            The coordinates.
        """
        ends = np.where(self.high > 0.0, self.high, self.low)
        point = np.where(np.isin(np.arange(len(ends)), list(acting)), ends, 0.0)
        return [not effect.is_neutral() for effect in self.effects(point)]

    def weakened(self, point: Floats, share: float) -> Floats:
        """Return a point at which the effects are a share as strong, shape (p,).

        What does nothing while the rest is neutral stays: a wavelength, an exponent.

        Parameters
        ----------
        point
            As u, shape (p,).
        share
            Of the way from neutral.
        """
        acts = [any(self.at_work([j])) for j in range(len(point))]
        return np.where(acts, share * point, point)

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
        coordinates = (self.neutral + self.scale * clipped).tolist()
        values: list[float] = []
        for kind in self.kinds:
            values += kind.from_fit(coordinates[len(values) : len(values) + len(kind.parameters)])
        # Rounding may carry the end of a range beyond what is possible.
        return np.clip(values, self.ranges[:, 0], self.ranges[:, 1])


class _Said(NamedTuple):
    """What an effect says of a scenario: ranges, shape (p, 2), and starts as coordinates of a fit."""

    ranges: Floats
    fit_ranges: Floats
    starts: list[tuple[float, ...]]
    close: list[tuple[float, ...]]

    @classmethod
    def of(cls, kind: type[Effect], scenario: Scenario) -> _Said:
        try:
            ranges, fit_ranges = (
                np.array(found(scenario), dtype=np.float64).reshape(len(kind.parameters), 2)
                for found in (kind.ranges, kind.fit_ranges)
            )
            starts, close = ([kind.to_fit(s) for s in found(scenario)] for found in (kind.starts, kind.close_starts))
        except EffectError:
            raise
        except Exception as error:
            raise EffectError(
                f"{kind.name}: its ranges or starts failed with {type(error).__name__}: {error}"
            ) from error
        return cls(ranges, fit_ranges, starts, close)


def _is_tried(kind: type[Effect], scenarios: Sequence[Scenario]) -> bool:
    """Return whether an effect changes any of the scenarios from any of its starts."""
    refused: InputError | None = None
    for scenario in scenarios:
        for start in kind.starts(scenario):
            # What cannot be added from here may be from another start.
            try:
                if kind.from_vector(start).edit(scenario) != scenario:
                    return True
            except InputError as error:
                refused = error
    # One of the catalogue has nothing to say of such a dataset; one of a user's own would be left out unnoticed.
    if refused is not None and kind.__module__.partition(".")[0] != __package__.partition(".")[0]:
        raise EffectError(f"{kind.name}: no trial takes it from any of its starts: {refused}") from refused
    return False
