"""How fast a run is shown: its film's speed, its frames, and the rows of the run that they show."""

from __future__ import annotations

from dataclasses import dataclass
from math import floor, log10
from typing import Self

import numpy as np
from numpy.typing import NDArray

from ..check import number
from .scene import Scene

__all__ = ["FRAMES_PER_SECOND", "Film"]

# A GIF counts in hundredths of a second: 20 frames a second are exact.
FRAMES_PER_SECOND = 20
# A turn of the field is seen in so many frames at least, or it would seem to jump, or to turn the other way.
_FRAMES_PER_CYCLE = 16
_CYCLE_S, _LONGEST_S = 2.0, 12.0
_MOST_FRAMES = 600


@dataclass(frozen=True, slots=True, eq=False)
class Film:
    """The film of a run.

    Attributes
    ----------
    speed
        Time of the run over time of the film.
    rows
        Row of the run in every frame, shape (frames,).
    """

    speed: float
    rows: NDArray[np.int64]

    @classmethod
    def of(cls, scene: Scene, speed: float | None = None) -> Self:
        """Return the film of a run.

        Parameters
        ----------
        scene
            The run.
        speed
            Time of the run over time of the film. If None one of 1, 2, 5 times a power of ten at which a turn of the
            field takes 2 s; faster where the film would take longer than 12 s, but never so fast that a turn has
            fewer than 16 frames. A film ends after 600 frames.

        Raises
        ------
        InputError
            A speed that is not above 0.
        """
        speed = _speed(scene) if speed is None else number("speed", speed, above=0.0)
        step = speed / FRAMES_PER_SECOND
        frames = min(floor(scene.duration_s / step * (1.0 + 1e-9)) + 1, _MOST_FRAMES)
        times = np.minimum(scene.time_s[0] + step * np.arange(max(frames, 2)), scene.time_s[-1])
        return cls(speed, scene.rows(times))


def _speed(scene: Scene) -> float:
    shortest = scene.duration_s / _LONGEST_S
    if scene.period_s is None:
        return _round_up(shortest)
    fastest = scene.period_s * FRAMES_PER_SECOND / _FRAMES_PER_CYCLE
    return min(max(_round_up(shortest), _round_down(scene.period_s / _CYCLE_S)), _round_down(fastest))


def _round_down(value: float) -> float:
    power = 10.0 ** floor(log10(value) + 1e-9)
    return float(max(step for step in (1.0, 2.0, 5.0) if step * power <= value * (1.0 + 1e-9)) * power)


def _round_up(value: float) -> float:
    power = 10.0 ** floor(log10(value) + 1e-9)
    return float(min(step for step in (1.0, 2.0, 5.0, 10.0) if step * power >= value * (1.0 - 1e-9)) * power)
