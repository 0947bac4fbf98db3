"""Ctrl-C while matplotlib draws."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

__all__ = ["interrupt_between"]


@contextmanager
def interrupt_between() -> Iterator[Callable[[], None]]:
    """Hold Ctrl-C back and give the function that lets it through, to be called between two frames.

    In the middle of a frame matplotlib's native code may take the interrupt for an error of its own and report a
    bounding box that is not at fault.
    """
    if threading.current_thread() is not threading.main_thread():
        # Signals reach the main thread only.
        yield lambda: None
        return
    held: list[int] = []

    def hold(number: int, _frame: FrameType | None) -> None:
        held.append(number)

    before = signal.getsignal(signal.SIGINT)
    if before is None:
        # A handler that Python did not set cannot be put back.
        yield lambda: None
        return
    signal.signal(signal.SIGINT, hold)

    def let_through() -> None:
        if held:
            held.clear()
            signal.signal(signal.SIGINT, before)
            signal.raise_signal(signal.SIGINT)

    try:
        yield let_through
    finally:
        signal.signal(signal.SIGINT, before)
        if held:
            signal.raise_signal(signal.SIGINT)
