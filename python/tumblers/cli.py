"""``tumblers`` on the command line: what has to stand before anything heavy is imported."""

from __future__ import annotations

import os
import signal
import sys
from typing import NoReturn

__all__ = ["main"]

_INTERRUPTED = 130
_LINE = "tumblers: interrupted, nothing was written\n"


def _leave(*_: object) -> NoReturn:
    sys.stderr.write(_LINE)
    sys.stderr.flush()
    os._exit(_INTERRUPTED)


def main() -> NoReturn:
    """Run the command line: 0 done, 1 failed, 2 bad input, 130 interrupted; one line on standard error but for 0."""
    try:
        # Extension modules turn an exception in the middle of their import into one of their own: leave at once.
        asked = signal.getsignal(signal.SIGINT) is signal.default_int_handler
        if asked:
            signal.signal(signal.SIGINT, _leave)
        from .commands import run

        if asked:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        status = run()
    except KeyboardInterrupt:
        status = _INTERRUPTED
    if status == _INTERRUPTED:
        sys.stderr.write(_LINE)
    sys.exit(status)
