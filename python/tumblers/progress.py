"""Native calls: a progress bar on standard error, and errors of this package's own tree."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from .errors import SimulationError, TumblersError

__all__ = ["OnProgress", "native_call"]

OnProgress = Callable[[int], None]


@contextmanager
def native_call(words: str, total: int, progress: bool | OnProgress) -> Iterator[OnProgress | None]:
    """Give the callback that a native call reports to.

    Parameters
    ----------
    words, total
        What is counted, and how many there are.
    progress
        True for a bar (where standard error is a terminal), False for none, or a callback of one's own, whose
        exceptions come through as they are.

    Raises
    ------
    SimulationError
        The native call failed.
    """
    own: list[BaseException] = []
    try:
        if callable(progress):
            yield _remembering(progress, own)
        elif progress:
            with _bar(words, total) as on_progress:
                yield on_progress
        else:
            yield None
    except TumblersError:
        raise
    except (ArithmeticError, RuntimeError, ValueError) as error:
        if error in own:
            raise
        raise SimulationError(" ".join(str(error).split())) from error


def _remembering(callback: OnProgress, raised: list[BaseException]) -> OnProgress:
    def report(done: int) -> None:
        try:
            callback(done)
        except BaseException as error:
            raised.append(error)
            raise

    return report


@contextmanager
def _bar(words: str, total: int) -> Iterator[OnProgress]:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task(words, total=total)
        yield lambda done: bar.update(task, completed=done)
