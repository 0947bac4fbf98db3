"""The nominal numbers that a lab may be off in."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from typing import Any

import pytest

from tumblers.dataset import Tolerance
from tumblers.diagnosis.gap.nominal_number import NUMBERS, moved_by
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.scenario import Scenario

from .lab import plan

# Of each number a share that no other has.
KNOWN_TO = Tolerance(**{name: 0.01 * (1 + i) for i, name in enumerate(NUMBERS)})


def _extent(scenario: Scenario, axis: int) -> float:
    corners: list[Any] = [row for face in scenario.robot.body().outline for row in face]
    return float(max(row[axis] for row in corners) - min(row[axis] for row in corners))


VALUES: dict[str, Callable[[Scenario], float]] = {
    "mass": lambda s: s.robot.total_mass_kg,
    "magnetization": lambda s: s.robot.magnetic_moment_A_m2[1],
    "field_strength": lambda s: s.field.strength_T,  # type: ignore[union-attr]
    "friction_coefficient": lambda s: s.substrate.friction_coefficient,
    "adhesion": lambda s: s.substrate.adhesion_N_per_m2,
    "electrostatic_force": lambda s: s.substrate.electrostatic_force_N,
    "length": lambda s: _extent(s, 1),
    "height": lambda s: _extent(s, 2),
}


@pytest.mark.parametrize("name", NUMBERS)
def test_each_number_is_moved_by_its_own_tolerance_and_no_other(name: str) -> None:
    nominal = Simulator(plan()).nominal(0)
    moved = dict(zip(NUMBERS, moved_by(KNOWN_TO), strict=True))[name](nominal)
    for other, value in VALUES.items():
        factor = 1.0 + asdict(KNOWN_TO)[name] if other == name else 1.0
        assert value(moved) == pytest.approx(factor * value(nominal), rel=1e-12), other
        assert value(nominal) > 0.0
