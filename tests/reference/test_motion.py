"""Steps and runs against closed forms."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from tumblers.reference import ContactMode, State, StaticField, Trial, cuboid, ellipsoid, run, speed, step

U = 1e-6
LEVEL = np.array([1.0, 0.0, 0.0, 0.0])
BLOCK = cuboid(800 * U, 400 * U, 100 * U)


def resting(trial: Trial, velocity: tuple[float, float, float], spin: tuple[float, float, float]) -> State:
    """Flat on the plane, moving."""
    return replace(trial.resting_state(), velocity=np.array(velocity), angular_velocity=np.array(spin))


def test_free_flight() -> None:
    """`v = v0 + g t`, `q = q0 + Σ h v` of the semi-implicit step; a sphere keeps its spin."""
    trial = Trial(ellipsoid([1e-4] * 3), 1e-8, incline_rad=0.3, duration=0.01, electrostatic_force=2e-8)
    start = State(np.array([0.0, 0.0, 5e-3]), LEVEL, np.array([0.01, 0.02, 0.1]), np.array([30.0, -20.0, 10.0]))
    result = run(trial, start)
    n, h = 20, trial.step
    g = np.array([0.0, -9.8 * math.sin(0.3), -9.8 * math.cos(0.3) - 2.0])
    np.testing.assert_allclose(result.states[-1].velocity, start.velocity + n * h * g, atol=1e-14)
    expected = start.position + n * h * start.velocity + h * h * n * (n + 1) / 2.0 * g
    np.testing.assert_allclose(result.states[-1].position, expected, atol=1e-15)
    np.testing.assert_allclose(result.states[-1].angular_velocity, start.angular_velocity, atol=1e-10)
    assert all(s.mode is ContactMode.AIRBORNE and s.p_n == 0.0 for s in result.steps)


@pytest.mark.parametrize(("mu", "slides"), [(0.2, True), (0.45, True), (0.47, False), (0.8, False)])
def test_block_on_incline(mu: float, slides: bool) -> None:
    """At 25° (tan = 0.466) the acceleration is `g (sin φ - μ cos φ)` down the slope, or nothing moves."""
    angle = math.radians(25.0)
    trial = Trial(BLOCK, 3.78e-8, mu=mu, incline_rad=angle, duration=0.01)
    result = run(trial)
    expected = -9.8 * (math.sin(angle) - mu * math.cos(angle)) * 0.01 if slides else 0.0
    assert result.states[-1].velocity[1] == pytest.approx(expected, abs=1e-10)
    np.testing.assert_allclose(result.states[-1].angular_velocity, 0.0, atol=1e-7)
    assert max(s.residual for s in result.steps) <= 1e-10
    assert {s.mode for s in result.steps} == {ContactMode.SURFACE}


@pytest.mark.parametrize("e", [(1.0, 1.0, 1e-4), (1.0, 0.6, 2e-4), (0.5, 1.0, 1e-3)])
def test_sliding_and_spinning(e: tuple[float, float, float]) -> None:
    """`dv_i = -μ g e_i² v_i/σ`, `dω = -μ m g e_r² ω/(I σ)`, `σ = |E u|`, for a block too flat for its ECP to move."""
    trial = Trial(cuboid(800 * U, 400 * U, 1e-3 * U), 3.78e-8, mu=0.3, ellipsoid=np.array(e), step=1e-7)
    v, w = np.array([0.03, 0.05]), 80.0
    found = step(trial, resting(trial, (v[0], v[1], 0.0), (0.0, 0.0, w)), 0.0)
    sigma = math.sqrt((e[0] * v[0]) ** 2 + (e[1] * v[1]) ** 2 + (e[2] * w) ** 2)
    inertia = trial.body.inertia_per_mass[2, 2]
    change = (found.V - np.array([v[0], v[1], 0.0, 0.0, 0.0, w])) / trial.step
    push = -0.3 * 9.8 / sigma
    # Friction follows the slip at the end of the step, another by a share of the order of μ g h/σ <= 1.4e-4; a residual
    # of 1e-10 leaves a share of 1e-10 |v|/(μ g h) = 2e-5.
    np.testing.assert_allclose(change[:2], push * np.array(e[:2]) ** 2 * v, rtol=2e-4)
    assert change[5] == pytest.approx(push * e[2] ** 2 * w / inertia, rel=2e-4)
    assert found.sigma == pytest.approx(sigma, rel=2e-4)
    assert found.mode is ContactMode.SURFACE


@pytest.mark.parametrize("acts_at", ["ecp", "patch_centroid"])
@pytest.mark.parametrize(("part", "mode"), [(0.99, ContactMode.SURFACE), (1.01, ContactMode.LINE)])
def test_tip_over_threshold(paper_cuboid: Trial, acts_at: str, part: float, mode: ContactMode) -> None:
    """A vertical field lifts the end at `M B = (m g + F_elect) L/2`, plus `C A L/2` with adhesion over the patch."""
    adhesion = 1.19 * 800 * 400 * U * U
    load = 3.78e-8 * 9.8 + 6.54e-7 + (adhesion if acts_at == "patch_centroid" else 0.0)
    strength = part * load * 400 * U / paper_cuboid.moment[1]
    trial = replace(
        paper_cuboid,
        field=StaticField(np.array([0.0, 0.0, strength])),
        torque_time="start_of_step",
        adhesion_acts_at=acts_at,
    )
    start = trial.resting_state()
    force, centroid = trial.adhesion_at(start)
    assert force == pytest.approx(adhesion)
    found = step(trial, start, 0.0, force, centroid)
    assert found.residual <= 1e-10
    assert found.mode is mode


def test_ball_comes_to_roll() -> None:
    """A ball set down spinning at ω0 rolls in the end at `v = 2/7 ω0 R`."""
    radius, w = 1e-4, 100.0
    trial = Trial(ellipsoid([radius] * 3), 1e-8, mu=0.3, duration=2e-3, step=2e-5)
    result = run(trial, resting(trial, (0.0, 0.0, 0.0), (-w, 0.0, 0.0)))
    end = result.states[-1]
    assert end.velocity[1] == pytest.approx(2.0 / 7.0 * w * radius, rel=1e-9)
    assert end.angular_velocity[0] == pytest.approx(-end.velocity[1] / radius, rel=1e-9)
    assert result.steps[0].sigma > 0.0
    assert result.steps[-1].sigma == 0.0


def test_ball_rolls_down() -> None:
    """Without slip the acceleration down the slope is `5/7 g sin φ`."""
    trial = Trial(ellipsoid([1e-4] * 3), 1e-8, mu=0.9, incline_rad=0.2, duration=5e-3)
    end = run(trial).states[-1]
    assert end.velocity[1] == pytest.approx(-5.0 / 7.0 * 9.8 * math.sin(0.2) * 5e-3, rel=1e-9)


def test_no_slip_speed(paper_cuboid: Trial) -> None:
    """One turn of the field moves the cuboid by its perimeter: `2 (L + H) f`."""
    result = run(replace(paper_cuboid, duration=0.2))
    assert speed(result) == pytest.approx(2.0 * 900 * U * 5.0, rel=5e-3)
    assert max(s.residual for s in result.steps) <= 1e-10
    assert max(abs(p[0]) for p in result.positions) < 1e-12
    # 3.8e-7 N on L x W, nothing on edges: the paper's adhesion trace.
    forces = {float(f"{s.next_patch.force(1.19, 0.0):.1e}") for s in result.steps}
    assert {3.8e-7, 4.8e-8, 0.0} >= forces >= {3.8e-7, 0.0}


def test_friction_only_dissipates(paper_cuboid: Trial) -> None:
    """Kinetic energy of a sliding, spinning block never rises, and it comes to rest and stays."""
    trial = replace(paper_cuboid, moment=np.zeros(3), duration=0.02)
    result = run(trial, resting(trial, (0.02, 0.1, 0.0), (0.0, 0.0, 100.0)))
    inertia = trial.body.inertia_per_mass[2, 2]
    energy = [float(s.velocity @ s.velocity) + inertia * float(s.angular_velocity[2]) ** 2 for s in result.states]
    assert all(later <= earlier + 1e-18 for earlier, later in pairwise(energy))
    assert energy[-1] < 1e-16


@pytest.mark.parametrize("when", ["start_of_step", "end_of_step", "midpoint"])
def test_torque_times_agree_for_small_steps(paper_cuboid: Trial, when: str) -> None:
    """All three converge to one motion; the torque at the end is off by 4.5e-4, in proportion to the step."""
    trial = replace(paper_cuboid, torque_time=when, step=4e-5, duration=5e-3)
    reference = replace(paper_cuboid, torque_time="midpoint", step=2e-5, duration=5e-3)
    end = run(reference).states[-1].quaternion
    assert abs(end[1]) > 0.005  # it has moved by more than the tolerance
    np.testing.assert_allclose(run(trial).states[-1].quaternion, end, rtol=0.0, atol=6e-4)
