"""Progress on standard error, a bar or now and then a line, and native calls with errors of this package's own tree."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import monotonic
from typing import TYPE_CHECKING

from .errors import SimulationError, TumblersError

if TYPE_CHECKING:
    from rich.console import Console

__all__ = ["OnPhase", "OnProgress", "native_call", "phases"]

OnProgress = Callable[[int], None]
OnPhase = Callable[[str, int, int], None]

# A log gets a line this often, s.
_BETWEEN_LINES_S = 10.0


@contextmanager
def native_call(words: str, total: int, progress: bool | OnProgress) -> Iterator[OnProgress | None]:
    """Give the callback that a native call reports to.

    Parameters
    ----------
    words, total
        What is counted, and how many there are.
    progress
        True for a bar, or where standard error is no terminal a line every ten seconds; False for nothing; or a
        callback of one's own, whose exceptions come through as they are.

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
    if not console.is_terminal:
        # What is over before the first line is due needs none.
        tell = _lines(console)
        yield lambda done: tell(words, done, total)
        return
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task(words, total=total)
        yield lambda done: bar.update(task, completed=done)


@contextmanager
def phases(progress: bool | OnPhase) -> Iterator[OnPhase]:
    """Give the callback that a computation of several phases reports to.

    Parameters
    ----------
    progress
        True for a bar with the phase's name, or where standard error is no terminal a line every ten seconds; False for
        nothing; or a callback that is told the phase, how much of it is done, and of how much.
    """
    if callable(progress):
        yield progress
        return
    if not progress:
        yield lambda _phase, _done, _total: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    console = Console(stderr=True)
    if not console.is_terminal:
        yield _lines(console)
        return
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task("", total=1)
        yield lambda phase, done, total: bar.update(task, description=phase, completed=done, total=total)


def _lines(console: Console) -> OnPhase:
    """Return a callback that writes a plain line every ten seconds, with the time that has passed."""
    begun = monotonic()
    due = begun + _BETWEEN_LINES_S

    def tell(phase: str, done: int, total: int) -> None:
        nonlocal due
        now = monotonic()
        if now < due:
            return
        due = now + _BETWEEN_LINES_S
        console.file.write(f"tumblers: {phase} {done}/{total}, {now - begun:.0f} s\n")
        console.file.flush()

    return tell
