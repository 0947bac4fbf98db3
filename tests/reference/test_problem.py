"""The solver, on random states, against the full problem's conditions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tumblers.reference import (
    RotatingField,
    State,
    StepProblem,
    Trial,
    Unknowns,
    ellipsoid,
    hull,
    residual,
    run,
    solve,
    spiked_ends,
    step,
)
from tumblers.reference.homotopy import approximations
from tumblers.reference.predictor import free_motion, predictions
from tumblers.reference.rotation import aligning, cayley, cayley_vector, matrix, step_quaternion

vectors = st.lists(st.floats(-3.0, 3.0), min_size=3, max_size=3).map(np.array)


def random_states(trial: Trial, count: int, fastest: float, seed: int) -> Iterator[State]:
    """Touching or nearly so, in any orientation, up to `fastest` m/s."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        quaternion = rng.normal(size=4)
        quaternion /= np.linalg.norm(quaternion)
        gap = float(rng.choice([0.0, 0.0, 10.0 ** rng.uniform(-9.0, -5.0)]))
        speed = fastest * 10.0 ** rng.uniform(-4.0, 0.0)
        height = gap - trial.body.lowest_height(matrix(quaternion))
        omega = speed / trial.body.radius * rng.normal(size=3)
        yield State(np.array([0.0, 0.0, height]), quaternion, speed * rng.normal(size=3), omega)


def shapes(trial: Trial) -> list[Trial]:
    """`trial` with a few other bodies of the same material."""
    rng = np.random.default_rng(5)
    bodies = [
        trial.body,
        spiked_ends(4e-4, 2e-4, 7.5e-5, 1e-4, 1e-4, np.radians(4.0)),
        hull(2e-4 * rng.normal(size=(12, 3))),
        ellipsoid([1e-4, 2e-4, 1.5e-4]),
    ]
    # The same material: a light body with the cuboid's moment would turn by more than a radian in a step.
    parts = [body.volume / trial.body.volume for body in bodies]
    return [
        replace(trial, body=body, mass=part * trial.mass, moment=part * trial.moment)
        for body, part in zip(bodies, parts, strict=True)
    ]


@pytest.mark.parametrize("enters", ["normal", "friction_only"])
@pytest.mark.parametrize("acts_at", ["ecp", "patch_centroid"])
@pytest.mark.parametrize("when", ["start_of_step", "end_of_step", "midpoint"])
def test_random_states(paper_cuboid: Trial, enters: str, acts_at: str, when: str) -> None:
    """Solved to 1e-10, no penetration, friction in its ellipsoid and against the slip, no pull at a distance."""
    base = replace(
        paper_cuboid,
        adhesion_enters=enters,
        adhesion_acts_at=acts_at,
        torque_time=when,
        field=RotatingField(0.01, 10.0),
    )
    for i, trial in enumerate(shapes(base)):
        for j, state in enumerate(random_states(trial, 5, 0.05, 10 * i)):
            force = 2e-8 * (j % 2)
            found = step(trial, state, 0.013 * j, force, np.array([1e-4, 0.0, 0.0]))
            problem = StepProblem(trial, state, 0.013 * j, force, np.array([1e-4, 0.0, 0.0]))
            assert found.residual <= 1e-10
            lowest = found.state.position[2] + trial.body.lowest_height(found.state.rotation)
            assert lowest >= -1e-9 * trial.body.radius
            assert found.p_n * max(lowest, 0.0) <= 1e-9 * trial.body.radius * abs(found.p_n)
            bound = trial.mu * problem.bound(found.p_n)
            assert float(np.linalg.norm(found.p / trial.ellipsoid)) <= bound * (1.0 + 1e-8) + 1e-20
            r = found.a1 - found.state.position
            spin = np.cross(found.V[3:], r)
            u = np.array([found.V[0] + spin[0], found.V[1] + spin[1], found.V[5]])
            assert float(found.p @ u) == pytest.approx(-bound * found.sigma, rel=1e-6, abs=1e-9 * bound)


def test_residual_sees_every_unknown(paper_cuboid: Trial) -> None:
    """A change of any one unknown of a sliding contact by one part in a thousand is seen."""
    state = replace(paper_cuboid.resting_state(), velocity=np.array([0.01, 0.02, 0.0]))
    problem = StepProblem(paper_cuboid, state, 0.0, 1e-7, np.zeros(3))
    z = solve(problem).unknowns
    assert residual(problem, z) <= 1e-12
    length = paper_cuboid.body.radius
    changed: list[Unknowns] = []
    for i in range(6):
        step_size = 1e-3 * np.abs(z.V[:3]).max() / (1.0 if i < 3 else length)
        changed.append(replace(z, V=z.V + step_size * np.eye(6)[i]))
    for i in range(3):
        changed.append(replace(z, a1=z.a1 + 1e-3 * length * np.eye(3)[i]))
        changed.append(replace(z, a2=z.a2 + 1e-3 * length * np.eye(3)[i]))
        changed.append(replace(z, p=z.p + 1e-3 * np.abs(z.p).max() * paper_cuboid.ellipsoid * np.eye(3)[i]))
    changed += [replace(z, l=z.l + 1e-3 * (np.arange(6) == i) * (length if i == z.k else 1.0)) for i in range(6)]
    changed += [replace(z, l_plane=1.001 * z.l_plane), replace(z, sigma=1.001 * z.sigma), replace(z, p_n=1.001 * z.p_n)]
    assert min(residual(problem, other) for other in changed) > 1e-7


def test_homotopy_finds_the_same(paper_cuboid: Trial) -> None:
    """The smoothed full problem, which knows of no active set, ends at the same velocity."""
    start = replace(paper_cuboid.resting_state(), velocity=np.array([0.01, 0.02, 0.0]))
    for trial, state in (
        (paper_cuboid, start),
        (replace(paper_cuboid, mu=0.9), next(random_states(paper_cuboid, 1, 0.01, 4))),
    ):
        problem = StepProblem(trial, state, 0.0)
        exact = solve(problem).unknowns
        guess = predictions(problem, free_motion(problem))[0].guess
        *_, smooth = approximations(problem, [guess])
        unit = np.array([1.0] * 3 + [trial.body.radius] * 3)
        size = float(np.linalg.norm(exact.V * unit))
        assert float(np.linalg.norm((smooth.V - exact.V) * unit)) < 1e-3 * size


def test_half_size_spiked_run(half_size: dict[str, Any]) -> None:
    """A short run of the drafted spiked robot, every step to 1e-10."""
    result = run(Trial(**half_size, duration=0.05))
    assert max(s.residual for s in result.steps) <= 1e-10
    assert result.positions[-1, 1] > 2e-5


def test_airborne_parallel_face_is_symmetric(paper_cuboid: Trial) -> None:
    """The closest point of a level face in the air is its middle; the gap is in `l_k`."""
    trial = replace(paper_cuboid, moment=np.zeros(3))
    rest = trial.resting_state()
    found = step(trial, replace(rest, position=rest.position + np.array([0.0, 0.0, 1e-4])), 0.0)
    assert found.residual <= 1e-12
    np.testing.assert_allclose(found.a1[:2], 0.0, atol=1e-18)
    assert found.l[found.k] == pytest.approx(found.a1[2])


def test_adhesion_at_the_closest_point_of_a_body_that_lifts_off(paper_cuboid: Trial) -> None:
    """The pull acts at a point that is lowest after the step, on the side of the last patch."""
    trial = replace(paper_cuboid, moment=np.zeros(3))
    rest = trial.resting_state()
    state = replace(rest, velocity=np.array([0.0, 0.0, 0.05]))
    patch = np.array([2e-4, 4e-4, 0.0])
    found = step(trial, state, 0.0, 1e-8, patch)
    assert found.residual <= 1e-10
    assert found.p_n == 0.0
    assert found.a1[2] > 0.0
    np.testing.assert_allclose(found.a1[:2], patch[:2], rtol=1e-2)


@given(vectors, vectors)
@settings(max_examples=50, deadline=None)
def test_quaternion_step_is_the_cayley_map(s: np.ndarray, axis: np.ndarray) -> None:
    """`Q⁺` and `R⁺` are the same rotation, and the Cayley vector comes back."""
    start = np.concatenate([[2.0], axis])
    start /= np.linalg.norm(start)
    omega, h = 2.0 * s / 5e-4, 5e-4
    np.testing.assert_allclose(matrix(step_quaternion(start, omega, h)), cayley(s) @ matrix(start), atol=1e-12)
    np.testing.assert_allclose(cayley_vector(cayley(s)), s, atol=1e-10)


@given(vectors.filter(lambda v: float(np.linalg.norm(v)) > 0.1))
@settings(max_examples=50, deadline=None)
def test_aligning(v: np.ndarray) -> None:
    """The smallest turn takes one direction to another, opposite ones included."""
    unit = v / np.linalg.norm(v)
    for target in (np.array([0.0, 0.0, -1.0]), -unit):
        np.testing.assert_allclose(aligning(unit, target) @ unit, target, atol=1e-5)
