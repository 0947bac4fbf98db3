"""Bodies: mass properties, size, and what of a face touches."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

from tumblers import Curved, Robot, Run, Scenario, Substrate, _core, drive, reference
from tumblers.reference.rotation import aligning

from .case import Case
from .difference import REQUIRED, full_residual
from .robots import ROBOTS
from .solution import core_step, core_unknowns, reference_problem
from .twin import Twin, reference_body

DRAFTS_DEG = (0.0, 1.0, 4.0, 10.0)
# A large draft leaves nothing of the flat cuboid and of the end faces of the curved body.
MOST_DRAFT_DEG = {"cuboid": 4.0, "curved": 4.0, "hull": 0.0, "ellipsoid": 0.0}
DOWN = np.array([0.0, 0.0, -1.0])

robots = pytest.mark.parametrize("name", ROBOTS)


def drafts(robot: Robot) -> list[Robot]:
    """Return the robot with every draft that its shape takes."""
    most = MOST_DRAFT_DEG.get(robot.shape.kind, np.inf)
    return [robot.with_draft(draft) for draft in DRAFTS_DEG if draft <= most]


@robots
def test_mass_properties(name: str) -> None:
    for robot in drafts(ROBOTS[name]):
        core, other = robot.body(), reference_body(robot)
        assert core.volume_m3 == pytest.approx(other.volume, rel=1e-12)
        inertia = other.inertia_per_mass
        np.testing.assert_allclose(core.unit_inertia_m2, inertia, rtol=1e-11, atol=1e-12 * inertia.max())
        # The reference samples the arcs of a curved body every 0.3°.
        assert core.size_m == pytest.approx(other.radius, rel=1e-5 if robot.shape.kind == "curved" else 1e-12)


def laid_on(robot: Robot, face: int, gap: float) -> Case:
    """Return the body at rest with one face level, `gap` (m) above the plane."""
    scenario = Scenario(
        robot=replace(robot, magnetization_A_per_m=0.0),
        substrate=Substrate(friction_coefficient=0.3),
        field=drive(0.01, 1.0),
        run=Run(duration_s=5e-4, step_s=5e-4),
    )
    twin = Twin.of(scenario)
    body = twin.reference.body
    normal = body.surfaces[face].gradient(np.zeros(3))
    quaternion = np.roll(Rotation.from_matrix(aligning(normal, DOWN)).as_quat(), 1)
    lowest = body.lowest_height(reference.State(np.zeros(3), quaternion).rotation)
    state = reference.State(np.array([0.0, 0.0, gap - lowest]), quaternion)
    return Case(f"draft {robot.draft_deg}°, face {face}, gap {gap}", twin, state, 0.0, 0.0, np.zeros(3))


def faces(robot: Robot) -> list[int]:
    return [min(cell.surfaces) for cell in reference_body(robot).cells if cell.kind == "face"]


def reference_step(case: Case) -> reference.StepSolution:
    return reference.step(case.twin.reference, case.state, case.time, case.adhesion_force, case.patch_centroid)


@robots
@pytest.mark.parametrize("gap", [0.0, 1e-6])
def test_patch(name: str, gap: float) -> None:
    """What touches when the body lies on a face, or comes down on it."""
    wrong = []
    for robot in drafts(ROBOTS[name]):
        for face in faces(robot):
            case = laid_on(robot, face, gap)
            other, found, problem = reference_step(case), core_step(case), reference_problem(case)
            if other.residual > REQUIRED:
                continue
            error = full_residual(problem, core_unknowns(problem, found))
            if error > REQUIRED:
                wrong.append(f"{case.name}: residual {error:.1e}")
            if found["contact_mode"] != other.mode:
                wrong.append(f"{case.name}: contact {found['contact_mode']}, expected {other.mode}")
            elif found["area_m2"] != pytest.approx(other.next_patch.area, rel=1e-9, abs=0.0):
                wrong.append(f"{case.name}: area {found['area_m2']:.6e}, expected {other.next_patch.area:.6e}")
    assert not wrong, "\n".join(wrong)


def end_face_area(shape: Curved, draft_deg: float) -> float:
    """Return the area of an end face of a curved body by quadrature over its width.

    At inset `s = (x + W/2) tan φ` the end line runs from the chord to the cone, which it meets in a conic.
    """
    alpha, slope = np.radians(shape.half_angle_deg), np.tan(np.radians(draft_deg))

    def length(x: float) -> float:
        inset = (x + 0.5 * shape.width_m) * slope
        outer = np.sqrt((shape.outer_radius_m - inset) ** 2 - inset**2)
        z = shape.inner_radius_m * np.cos(alpha) + inset
        y = (z * np.sin(alpha) - inset) / np.cos(alpha)
        return float(outer - (y * np.sin(alpha) + z * np.cos(alpha)))

    half = 0.5 * shape.width_m
    area, _ = quad(length, -half, half, epsabs=0.0, epsrel=1e-12)
    return float(area * np.hypot(1.0, slope))


@pytest.mark.parametrize("draft_deg", [0.0, 1.0, 2.0, 4.0])
@pytest.mark.parametrize("side", ["core", "reference"])
def test_end_face_of_curved(side: str, draft_deg: float) -> None:
    robot = ROBOTS["curved"].with_draft(draft_deg)
    assert isinstance(robot.shape, Curved)
    case = laid_on(robot, 1, 0.0)
    body = case.twin.reference.body
    if side == "core":
        # A field and a mass do not matter to what touches, and the face is too short to stand on otherwise.
        found = resting_area(robot, case)
    else:
        (found,) = (cell.area for cell in body.cells if cell.surfaces == {1})
    assert found == pytest.approx(end_face_area(robot.shape, draft_deg), rel=1e-9)


def resting_area(robot: Robot, case: Case) -> float:
    """Return the core's area of the face that the body lies on, from the adhesion of a run's first patch."""
    scenario = replace(
        case.twin.scenario,
        substrate=Substrate(friction_coefficient=0.3, adhesion_N_per_m2=1.0),
        initial=replace(
            case.twin.scenario.initial,
            position_m=tuple(case.state.position),
            orientation=tuple(case.state.quaternion),
        ),
    )
    return float(_core.simulate(scenario.trial(), 1)["adhesion_force_N"][0])


@robots
def test_resting_area(name: str) -> None:
    """The patch that a run starts with, on every face."""
    wrong = []
    for robot in drafts(ROBOTS[name]):
        areas: list[tuple[float, float]] = []
        for face in faces(robot):
            case = laid_on(robot, face, 0.0)
            patch = reference.patch_at(case.twin.reference.body, case.state.position, case.state.rotation)
            areas.append((resting_area(robot, case), patch.area))
            if areas[-1][0] != pytest.approx(areas[-1][1], rel=1e-9, abs=0.0):
                wrong.append(f"{case.name}: area {areas[-1][0]:.6e}, expected {areas[-1][1]:.6e}")
        if name.startswith("spiked_ends"):
            # The ends of the bar, the sides and the spikes' outer faces are real; the top and the bottom are of air.
            assert sorted(area > 0.0 for _, area in areas) == [False] * 2 + [True] * 8
    assert not wrong, "\n".join(wrong)
