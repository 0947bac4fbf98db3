"""Our steps per second and our contact against MuJoCo's: ``python benches/against_mujoco.py [--json F] [--page P]``."""

from __future__ import annotations

import sys

from peers.command import Measurement, run


def main() -> int:
    """Run the command, and return its exit code."""
    summary = "Compare our steps per second and our contact with those of mujoco."
    return run(
        sys.argv[1:], Measurement(summary, "mujoco", "mujoco", "mujoco", "peers.mujoco_comparison", "peers.mujoco_page")
    )


if __name__ == "__main__":
    sys.exit(main())
