"""The same bits from run to run, on any number of threads, and from version to version (docs/trust.md)."""

from __future__ import annotations

import json
import math
import os
import platform
import subprocess
import sys
from collections.abc import Iterable, Iterator
from dataclasses import replace
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest

from tumblers import Robot, Scenario, simulate, sweep
from tumblers.presets import EXPERIMENTS, ROBOTS, preset_scenario
from tumblers.shape import Hull

GOLDEN = Path(__file__).with_name("golden.json")
RENEW = "python tests/trust/test_same_bits.py --renew"
# Where each robot runs: the first of the paper's experiments with it.
GROUNDS = {e.robot: (e.substrate, e.drive) for e in reversed(EXPERIMENTS.values())}
# From the start over the edges to the first landings, at 10 Hz more than a cycle.
DURATION_S = 0.15
# Without any symmetry: a hull's faces and edges are found in hash tables, whose order is another in each process.
HULL = Hull(
    vertices_m=tuple(
        (1e-4 * x, 1e-4 * y, 1e-4 * z)
        for x, y, z in [
            (-2, -3, -1),
            (2, -3.1, -1.1),
            (2.1, 3, -0.9),
            (-1.9, 3.2, -1),
            (0, 0.2, 1.5),
            (0.3, -2, 1),
            (0, 2, 1.1),
        ]
    )
)


def scenario(robot: str) -> Scenario:
    """Return a short run of a preset robot, or of the hull."""
    preset = "cuboid" if robot == "hull" else robot
    substrate, drive = GROUNDS[preset]
    found = preset_scenario(robot=preset, substrate=substrate, drive=drive, duration_s=DURATION_S)
    if robot != "hull":
        return found
    body = Robot(shape=HULL, density_kg_per_m3=2000.0, magnetization_A_per_m=15000.0)
    return replace(found, robot=body)


def digest(numbers: Iterable[float]) -> str:
    """Return the SHA-256 of numbers as little-endian float64."""
    return sha256(np.fromiter(numbers, dtype="<f8").tobytes()).hexdigest()


def hash_of(robot: str) -> str:
    """Return the hash of every number of every step of a robot's run."""
    run = simulate(scenario(robot))
    assert run.attrs["unconverged_steps"] == 0
    columns = [run["time"], *(run[name] for name in sorted(run.data_vars))]
    return digest(value for column in columns for value in column.values.astype("<f8").ravel())


def functions() -> str:
    """Return the hash of what this platform's C library says of the sines and cosines that such runs ask it for.

    The step itself adds, multiplies, divides and takes square roots, which IEEE 754 rounds alike everywhere. Beside
    them a field's phase, a slope and a robot's angles go through `sin`, `cos`, `tan`, `atan` and `hypot`, whose last
    bit is the C library's own.
    """

    def values() -> Iterator[float]:
        for hertz in (1.0, 5.0, 10.0):
            for step in range(round(DURATION_S / 5e-4) + 2):
                phase = math.tau * hertz * (step * 5e-4)
                yield from (math.sin(phase), math.cos(phase))
        for degrees in range(-89, 90):
            angle = math.radians(degrees)
            yield from (math.sin(angle), math.cos(angle), math.tan(angle), math.atan(angle), math.hypot(1.0, angle))

    return digest(values())


def in_another_process(robots: list[str]) -> list[str]:
    """Return the hashes that a fresh interpreter finds."""
    command = [sys.executable, __file__, *robots]
    # Another seed for Python's own hashes; the native module's hash tables have another in every process.
    environment = os.environ | {"PYTHONHASHSEED": "1"}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True, timeout=120)
    return done.stdout.split()


@pytest.mark.parametrize("robot", [*ROBOTS, "hull"])
def test_a_run_has_the_same_bits_when_it_is_run_again(robot: str) -> None:
    assert hash_of(robot) == hash_of(robot)


def test_a_run_has_the_same_bits_in_another_process() -> None:
    robots = ["hull", "spiked_pdms", "curved_su8"]
    assert in_another_process(robots) == [hash_of(robot) for robot in robots]


def test_a_sweep_has_the_same_bits_on_any_number_of_threads() -> None:
    common = replace(scenario("spiked_pdms"), run=replace(scenario("spiked_pdms").run, duration_s=0.02))
    cases = [(10.0, float(theta2)) for theta2 in range(0, 360, 40)]

    def bits(threads: int | None) -> list[bytes]:
        found = sweep(common, drafts_deg=[0.0, 4.0], magnetization=cases, threads=threads)
        return [found[name].values.tobytes() for name in sorted(found.data_vars) if name != "error"]

    one = bits(1)
    for threads in (2, 3, 8, None):
        assert bits(threads) == one


@pytest.mark.parametrize("robot", ROBOTS)
def test_a_run_has_the_bits_of_the_golden_hash(robot: str) -> None:
    golden = json.loads(GOLDEN.read_text())
    here = f"{platform.system()} {platform.machine()}"
    if here != golden["platform"]:
        pytest.skip(f"the hashes are those of {golden['platform']}, this is {here}, whose last bits may be others")
    if functions() != golden["functions"]:
        pytest.skip("this C library's sines and cosines have other last bits than the one of the golden hashes")
    found = hash_of(robot)
    assert found == golden["robots"][robot], (
        f"{robot} moves otherwise than it did. If that was meant: {RENEW}, and say in the commit what changed "
        "and by how much (docs/trust.md)"
    )


def test_every_robot_has_a_golden_hash_and_no_other() -> None:
    assert list(json.loads(GOLDEN.read_text())["robots"]) == list(ROBOTS)


def main(arguments: list[str]) -> None:
    """Print the hashes of robots, or renew the file of hashes."""
    if arguments != ["--renew"]:
        print(*(hash_of(robot) for robot in arguments))
        return
    golden = {
        "platform": f"{platform.system()} {platform.machine()}",
        "functions": functions(),
        "robots": {robot: hash_of(robot) for robot in ROBOTS},
    }
    GOLDEN.write_text(json.dumps(golden, indent=2) + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
