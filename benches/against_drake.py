"""Our steps per second and our contact against Drake's: ``python benches/against_drake.py [--json F] [--page P]``."""

from __future__ import annotations

import sys

from peers.command import Measurement, run


def main() -> int:
    """Run the command, and return its exit code."""
    summary = "Compare our steps per second and our contact with those of pydrake."
    return run(
        sys.argv[1:], Measurement(summary, "pydrake", "drake", "drake", "peers.drake_comparison", "peers.drake_page")
    )


if __name__ == "__main__":
    sys.exit(main())
