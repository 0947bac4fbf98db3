"""Magnetic fields `B(t)` (docs/model.md, "Loads").

Equations::

    rotating   B(t) = B [b0 cos ωt + ρ (a × b0) sin(ωt + δ)],   ω = 2π f
    static     B(t) = B d
    table      linear between the rows, constant outside them
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np

from .array import Array
from .rotation import cross


@dataclass(frozen=True, eq=False)
class RotatingField:
    """Field that turns about `axis`, on a circle unless its phases differ; the defaults roll a robot towards +y.

    Parameters
    ----------
    strength : float
        `B` [T].
    frequency : float
        `f` [Hz].
    axis, initial_direction : Array, shape (3,)
        Unit vectors `a` and `b0`, substrate frame.
    ratio, phase : float
        `ρ` [-] and `δ` [rad].
    """

    strength: float
    frequency: float
    axis: Array = field(default_factory=lambda: np.array([-1.0, 0.0, 0.0]))
    initial_direction: Array = field(default_factory=lambda: np.array([0.0, 1.0, 0.0]))
    ratio: float = 1.0
    phase: float = 0.0

    def at(self, time: float) -> Array:
        """`B(t)` [T], shape (3,), substrate frame, at `time` [s]."""
        angle = 2.0 * math.pi * self.frequency * time
        b0 = self.initial_direction
        second = self.ratio * math.sin(angle + self.phase) * cross(self.axis, b0)
        return np.asarray(self.strength * (math.cos(angle) * b0 + second))


@dataclass(frozen=True, eq=False)
class StaticField:
    """Constant field `flux_density` [T], shape (3,), substrate frame."""

    flux_density: Array

    def at(self, time: float) -> Array:  # noqa: ARG002, RUF100
        """`B(t)` [T], shape (3,), substrate frame, at `time` [s]."""
        return self.flux_density


@dataclass(frozen=True, eq=False)
class TableField:
    """Field sampled at `times`, shape (n,) [s], as `flux_density`, shape (n, 3) [T], substrate frame."""

    times: Array
    flux_density: Array

    def at(self, time: float) -> Array:
        """`B(t)` [T], shape (3,), substrate frame, at `time` [s]."""
        return np.array([np.interp(time, self.times, self.flux_density[:, i]) for i in range(3)])


@dataclass(frozen=True, eq=False)
class TurnedField:
    """`field` in a frame to which `rotation`, shape (3, 3), turns from the substrate's."""

    field: Field
    rotation: Array

    def at(self, time: float) -> Array:
        """`B(t)` [T], shape (3,), in that frame, at `time` [s]."""
        return np.asarray(self.rotation @ self.field.at(time))


Field: TypeAlias = RotatingField | StaticField | TableField | TurnedField
