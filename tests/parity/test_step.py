"""One step from random states: the core's solution in the reference's rows, and against the reference's solution."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from tumblers import reference
from tumblers.model import MagneticTorque

from .case import TORQUES, cases
from .difference import REQUIRED, differences, full_residual, same_motion
from .robots import ROBOTS
from .solution import core_step, core_unknowns, reference_problem

STATES = 20
# Contact with friction, and a torque at the end of a step, can have several solutions. Of 4320 states (120 a group)
# one had another solution in the core than in the reference, each good to 1e-10. The reference solved them all.
OTHER_SOLUTIONS = 1
UNSOLVED = 1
# A step that turns the body farther than this does not count as converged.
MOST_TURN = 2.0

torques = pytest.mark.parametrize("torque", TORQUES)
robots = pytest.mark.parametrize("robot", ROBOTS)


@torques
@robots
def test_random_states(robot: str, torque: MagneticTorque) -> None:
    wrong, others, unsolved = [], [], []
    for case in cases(robot, torque, STATES):
        problem, found = reference_problem(case), core_step(case)
        z = core_unknowns(problem, found)
        error = full_residual(problem, z)
        if error > REQUIRED or abs(found["residual"] - error) > REQUIRED:
            wrong.append(f"{case.name}: residual {error:.1e}, {found['residual']:.1e} by the core")
            continue
        if found["converged"] != (problem.h * float(np.linalg.norm(z.V[3:])) <= MOST_TURN):
            wrong.append(f"{case.name}: converged is {found['converged']}")
        other = reference.step(case.twin.reference, case.state, case.time, case.adhesion_force, case.patch_centroid)
        if other.residual > REQUIRED:
            unsolved.append(case.name)
            continue
        other_z = reference.Unknowns(
            other.V, other.a1, other.a2, other.p, other.l, other.l_plane, other.sigma, other.p_n, other.k
        )
        if not same_motion(problem, z, other_z):
            others.append(case.name)
            continue
        excess = differences(problem, z, other_z)
        if excess:
            wrong.append(f"{case.name}: {excess}")
        if found["contact_mode"] != other.mode:
            wrong.append(f"{case.name}: contact {found['contact_mode']}, expected {other.mode}")
    assert not wrong, "\n".join(wrong)
    assert len(others) <= OTHER_SOLUTIONS, others
    assert len(unsolved) <= UNSOLVED, unsolved


def test_every_kind_occurs() -> None:
    """The states above are not all alike."""
    seen: Counter[str] = Counter()
    for robot in ROBOTS:
        for torque in TORQUES:
            for case in cases(robot, torque, STATES):
                found = core_step(case)
                mode = reference.ContactMode(found["contact_mode"]).name.lower()
                regime = "" if mode == "airborne" else " slip" if found["sigma"] > 0.0 else " stick"
                substrate, model = case.twin.scenario.substrate, case.twin.scenario.model
                seen[mode + regime] += 1
                seen["lands"] += bool(case.name.split()[3].startswith("falling") and mode != "airborne")
                seen["spins"] += bool(abs(found["angular_velocity_rad_per_s"][2]) > 1.0 and mode != "airborne")
                if mode != "airborne":
                    seen[f"e_r {substrate.friction_ellipsoid[2]}"] += 1
                    seen[f"incline {'above 30°' if case.twin.scenario.run.incline_deg > 30.0 else 'to 30°'}"] += 1
                    if case.adhesion_force > 0.0:
                        seen[f"adhesion {model.adhesion_enters} {model.adhesion_acts_at}"] += 1
    least = {
        "airborne": 80,
        "point stick": 30,
        "point slip": 100,
        "line stick": 30,
        "line slip": 60,
        "surface stick": 15,
        "surface slip": 10,
        "lands": 30,
        "spins": 60,
        "e_r 0.1": 150,
        "e_r 0.0001": 150,
        "incline to 30°": 150,
        "incline above 30°": 100,
        "adhesion normal ecp": 15,
        "adhesion normal patch_centroid": 15,
        "adhesion friction_only ecp": 5,
        "adhesion friction_only patch_centroid": 5,
    }
    assert {name: seen[name] for name, number in least.items() if seen[name] < number} == {}
