"""The paper's 592 cases of manufacturing errors, on one thread and on all."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from statistics import median

from tumblers.grid import PAPER_DRAFTS_DEG, PAPER_MAGNETIZATION_DEG

from .case import Case
from .clock import alternate
from .ours import Health, swept

__all__ = ["Grid", "timed_grid"]


@dataclass(frozen=True)
class Grid:
    """Time of all cases of one robot.

    Attributes
    ----------
    robot
        Its name.
    cases, steps
        How many cases, and steps of each.
    threads
        How many all are.
    one_thread_s, all_threads_s
        Median time on the wall, s.
    efficiency
        One thread's time on the wall over `threads` times that of all: the median of the repetitions.
    processor_efficiency
        The same of the processor's times, which wait for nobody: what is lost to the threads themselves.
    """

    robot: str
    cases: int
    steps: int
    threads: int
    one_thread_s: float
    all_threads_s: float
    efficiency: float
    processor_efficiency: float


def timed_grid(case: Case, threads: int, repetitions: int, health: Health, tell: Callable[[], None]) -> Grid:
    """Time the paper's grid of a robot.

    Parameters
    ----------
    case
        The robot without errors.
    threads
        How many all are.
    repetitions
        How many.
    health
        Told of every run.
    tell
        Called after each.
    """
    robot = case.scenario.robot
    cases = [
        Case(case.name, replace(case.scenario, robot=robot.with_draft(draft).with_magnetization(*angles)))
        for draft in PAPER_DRAFTS_DEG
        for angles in PAPER_MAGNETIZATION_DEG
    ]
    contestants = {"one": swept(cases, 1, 1, health), "all": swept(cases, 1, threads, health)}
    samples = alternate(contestants, repetitions, tell)
    pairs = list(zip(samples["one"], samples["all"], strict=True))
    whole = contestants["one"].steps * 1e-6
    return Grid(
        case.name,
        len(cases),
        case.steps,
        threads,
        whole * median(one.wall_us for one, _ in pairs),
        whole * median(every.wall_us for _, every in pairs),
        median(one.wall_us / (threads * every.wall_us) for one, every in pairs),
        median(one.cpu_us / every.cpu_us for one, every in pairs),
    )
