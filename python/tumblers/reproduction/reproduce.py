"""`reproduce`: the results of the paper, run again."""

from __future__ import annotations

from collections.abc import Sequence

from ..check import thread_count
from ..errors import InputError, show
from ..progress import OnProgress, native_call
from .examine import examine, most_runs
from .paper_result import PaperResult
from .reproduction import Reproduction
from .results import RESULTS

__all__ = ["NUMBERS", "chosen", "reproduce"]

NUMBERS = tuple(result.number for result in RESULTS)


def chosen(only: Sequence[int] | None) -> list[PaperResult]:
    """Return the results of some numbers, in the paper's order.

    Parameters
    ----------
    only
        Numbers of the results, 1 to 10; all of them if None.

    Raises
    ------
    InputError
        A number that is none of the results', or none at all.
    """
    if only is None:
        return list(RESULTS)
    for number in only:
        if number not in NUMBERS:
            raise InputError("only", show(number), f"numbers of results, {NUMBERS[0]} to {NUMBERS[-1]}")
    if not only:
        raise InputError("only", "an empty list", "at least one number of a result")
    return [result for result in RESULTS if result.number in only]


def reproduce(
    only: Sequence[int] | None = None, *, jobs: int | None = None, progress: bool | OnProgress = False
) -> Reproduction:
    """Run results of the paper and set our numbers beside the paper's.

    Parameters
    ----------
    only
        Numbers of the results, 1 to 10; all by default.
    jobs
        Number of threads, all by default. Nothing depends on it.
    progress
        True for a progress bar over all runs, or a callback that is told how many are done.

    Raises
    ------
    InputError
        A number that is none of the results', or a number of threads that is refused.
    SimulationError
        The native module gave up.
    """
    results = chosen(only)
    threads = 0 if jobs is None else thread_count("jobs", jobs)
    examined, before = [], 0
    with native_call("runs", sum(most_runs(result) for result in results), progress) as on_progress:
        for result in results:

            def report(done: int, before: int = before) -> None:
                if on_progress is not None:
                    on_progress(before + done)

            examined.append(examine(result, threads, report))
            before += most_runs(result)
    return Reproduction(tuple(examined))
