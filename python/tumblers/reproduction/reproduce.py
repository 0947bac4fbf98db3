"""`reproduce`: the results of the paper, run again."""

from __future__ import annotations

from collections.abc import Sequence

from ..errors import InputError, show
from ..progress import OnProgress, native_call
from .examine import examine, most_runs
from .reproduction import Reproduction
from .results import RESULTS

__all__ = ["NUMBERS", "reproduce"]

NUMBERS = tuple(result.number for result in RESULTS)


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
    if only is not None:
        for number in only:
            if number not in NUMBERS:
                raise InputError("only", show(number), f"numbers of results, {NUMBERS[0]} to {NUMBERS[-1]}")
        if not only:
            raise InputError("only", "an empty list", "at least one number of a result")
    if jobs is not None and (isinstance(jobs, bool) or not isinstance(jobs, int) or jobs < 1):
        raise InputError("jobs", show(jobs), "a whole number of at least 1")
    chosen = [result for result in RESULTS if only is None or result.number in only]
    examined, before = [], 0
    with native_call("runs", sum(most_runs(result) for result in chosen), progress) as on_progress:
        for result in chosen:

            def report(done: int, before: int = before) -> None:
                if on_progress is not None:
                    on_progress(before + done)

            examined.append(examine(result, jobs or 0, report))
            before += most_runs(result)
    return Reproduction(tuple(examined))
