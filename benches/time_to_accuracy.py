"""The step, and the time, that an accuracy takes: ``python benches/time_to_accuracy.py [--json F] [--page P]``."""

from __future__ import annotations

import sys

from peers.command import Measurement, run


def main() -> int:
    """Run the command, and return its exit code."""
    summary = "Find the longest step that keeps speed, drift and twist, and the time of a simulated second in it."
    return run(sys.argv[1:], Measurement(summary, None, None, "accuracy", "accuracy.comparison", "accuracy.page"))


if __name__ == "__main__":
    sys.exit(main())
