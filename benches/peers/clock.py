"""Times of alternating repetitions, and their ratios."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from statistics import median

__all__ = ["Contestant", "Ratio", "Sample", "alternate", "microseconds", "ratio"]


@dataclass(frozen=True)
class Contestant:
    """What is timed: a call without an interpreter in its loop, and how many steps it makes."""

    run: Callable[[], object]
    steps: int


@dataclass(frozen=True)
class Sample:
    """Time of one step in one repetition.

    Attributes
    ----------
    cpu_us
        Of the process, all its threads, µs.
    wall_us
        Of the clock on the wall, µs.
    """

    cpu_us: float
    wall_us: float


@dataclass(frozen=True)
class Ratio:
    """Our steps per second over theirs: the median of the repetitions' ratios, and their extremes."""

    median: float
    least: float
    greatest: float


def alternate(
    contestants: Mapping[str, Contestant], repetitions: int, tell: Callable[[], None]
) -> dict[str, list[Sample]]:
    """Time contestants in turn, every other repetition in the opposite order, after a round that does not count.

    Parameters
    ----------
    contestants
        By name.
    repetitions
        How many times each.
    tell
        Called after each repetition.
    """
    samples: dict[str, list[Sample]] = {name: [] for name in contestants}
    for contestant in contestants.values():
        contestant.run()
    for repetition in range(repetitions):
        order = list(contestants) if repetition % 2 == 0 else list(contestants)[::-1]
        for name in order:
            contestant = contestants[name]
            cpu, wall = time.process_time(), time.perf_counter()
            contestant.run()
            cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
            samples[name].append(Sample(1e6 * cpu / contestant.steps, 1e6 * wall / contestant.steps))
        tell()
    return samples


def _times(samples: list[Sample], wall: bool) -> list[float]:
    return [sample.wall_us if wall else sample.cpu_us for sample in samples]


def microseconds(samples: list[Sample], wall: bool = False) -> float:
    """Return the median time of a step, µs."""
    return median(_times(samples, wall))


def ratio(ours: list[Sample], theirs: list[Sample], wall: bool = False) -> Ratio:
    """Return our steps per second over theirs, repetition by repetition.

    Parameters
    ----------
    ours, theirs
        Samples of the same repetitions.
    wall
        Whether the clock on the wall counts, and not the processor's.
    """
    ratios = [b / a for a, b in zip(_times(ours, wall), _times(theirs, wall), strict=True)]
    return Ratio(median(ratios), min(ratios), max(ratios))
