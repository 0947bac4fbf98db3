"""Our steps per second and our contact against MuJoCo's: ``python benches/against_mujoco.py [--json F] [--page P]``."""

from __future__ import annotations

import sys

from peers.command import Peer, run


def main() -> int:
    """Run the command, and return its exit code."""
    return run(sys.argv[1:], Peer("mujoco", "mujoco", "mujoco", "peers.mujoco_comparison", "peers.mujoco_page"))


if __name__ == "__main__":
    sys.exit(main())
