"""Whole short runs, step by step, and what they are summed up in."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tumblers import Model, Scenario, _core, drive, preset_scenario, reference
from tumblers.model import MagneticTorque

from .case import TORQUES
from .twin import Twin

# Over ℓ, and of a unit quaternion: every step is solved to about 1e-13, and the contact damps what is left.
POSE = 1e-8

torques = pytest.mark.parametrize("torque", TORQUES)


def scenario(name: str, torque: MagneticTorque) -> Scenario:
    model = Model(magnetic_torque=torque)
    match name:
        case "cuboid on paper":
            return preset_scenario("cuboid_on_paper", duration_s=0.1, model=model)
        case "spiked, drafted":
            # The explicit torque at 5·10⁻⁴ s is at the edge of its stability and throws this robot off the substrate;
            # where it comes down, one step has two solutions, in the air and in contact.
            step = 2e-4 if torque == "start_of_step" else 5e-4
            base = preset_scenario("spiked", duration_s=0.05, step_s=step, model=model)
            return replace(base, robot=base.robot.with_draft(4.0).with_magnetization(10.0, 0.0))
        case "spiked ends":
            return preset_scenario("four_shapes_spiked_ends", duration_s=0.05, model=model)
        case "spiked ends, half size":
            return preset_scenario("spiked_ends", duration_s=0.05, model=model)
        case "curved":
            return preset_scenario("four_shapes_curved", duration_s=0.05, model=model)
        case "curved, drafted, uphill":
            base = preset_scenario("four_shapes_curved", duration_s=0.05, incline_deg=10.0, model=model)
            return replace(base, robot=base.robot.with_draft(2.0))
    raise KeyError(name)


def runs(of: Scenario) -> tuple[Twin, Any, reference.Run]:
    twin = Twin.of(of)
    return twin, _core.simulate(twin.core, 1), reference.run(twin.reference)


@torques
@pytest.mark.parametrize(
    "name",
    [
        "cuboid on paper",
        "spiked, drafted",
        "spiked ends",
        "spiked ends, half size",
        "curved",
        "curved, drafted, uphill",
    ],
)
def test_every_step(name: str, torque: MagneticTorque) -> None:
    """The pose after every step, what touches then, and the adhesion during it."""
    twin, core, other = runs(scenario(name, torque))
    trial = twin.reference
    assert core["unconverged_steps"] == 0
    np.testing.assert_allclose(core["time_s"], other.times, rtol=1e-12)
    np.testing.assert_allclose(core["position_m"], other.positions, rtol=0.0, atol=POSE * trial.body.radius)
    np.testing.assert_allclose(core["orientation"], other.quaternions, rtol=0.0, atol=POSE)
    assert core["contact_mode"][1:].tolist() == [step.mode for step in other.steps]
    patches = [step.next_patch.force(trial.adhesion_coefficient, trial.line_width) for step in other.steps]
    adhesion = [trial.adhesion_at(other.states[0])[0], *patches[:-1]]
    np.testing.assert_allclose(core["adhesion_force_N"][1:], adhesion, rtol=1e-9)
    normal = np.array([step.p_n for step in other.steps]) / trial.step
    np.testing.assert_allclose(core["normal_force_N"][1:], normal, rtol=0.0, atol=POSE * normal.max())


@pytest.mark.parametrize("frequency_Hz", [10.0, 11.3])
def test_metrics(frequency_Hz: float) -> None:
    """Speed, and drift and twist after one cycle, which ends with a step or within one."""
    base = preset_scenario("spiked", drive=drive(0.02, frequency_Hz), duration_s=0.11)
    _, core, other = runs(replace(base, robot=base.robot.with_draft(4.0).with_magnetization(10.0, 90.0)))
    # The core interpolates the orientation by a chord, the reference along the arc: θ³ of the step's turn apart.
    turn = np.abs(np.diff(other.quaternions, axis=0)).max()
    assert core["speed_m_per_s"] == pytest.approx(reference.speed(other), rel=1e-8)
    assert core["drift_m"] == pytest.approx(reference.drift(other, frequency_Hz), rel=1e-7)
    assert core["twist_rad"] == pytest.approx(reference.cycle_twist(other, frequency_Hz), abs=turn**3 + POSE)
    assert abs(core["twist_rad"]) > 1e-3


@pytest.mark.parametrize(
    ("rate_per_s", "point_m"), [(5.0, (0.0, 0.0, 0.0)), (100.0, (0.0, 0.0, 0.0)), (100.0, (2e-5, 1.5e-4, -6e-5))]
)
def test_what_a_guide_makes_of_a_run(rate_per_s: float, point_m: tuple[float, float, float]) -> None:
    """At each frame the reference is moved by (1 - e^(-γ (t_k - t_(k-1)))) of the way to where the point was seen."""
    twin = Twin.of(preset_scenario("cuboid_on_paper", duration_s=0.1))
    trial = twin.reference
    # The third is at the end of a step.
    times, places = np.array([0.0102, 0.0261, 0.04, 0.0707]), np.array([3e-4, -2e-4, 6e-4, 5e-4])
    (core,) = _core.rollouts([twin.core.guided(times, places, point_m, rate_per_s)], [1])
    state, step = trial.resting_state(), trial.step
    force, centroid = trial.adhesion_at(state)

    def seen(state: reference.State) -> float:
        return float((state.position + state.rotation @ np.array(point_m))[1])

    positions, drawn = [state.position], []
    for i in range(round(trial.duration / step)):
        end, shift = reference.step(trial, state, i * step, force, centroid).state, 0.0
        for k in range(1, len(times)):
            if i * step < times[k] <= (i + 1) * step:
                there = np.interp(times[k], [i * step, (i + 1) * step], [seen(state), seen(end)])
                shift = -np.expm1(-rate_per_s * (times[k] - times[k - 1])) * (places[k] - there)
                drawn.append(k)
        state = replace(end, position=end.position + np.array([0.0, shift, 0.0]))
        force, centroid = trial.adhesion_at(state)
        positions.append(state.position)
    assert drawn == [1, 2, 3]
    np.testing.assert_allclose(core["position_m"], positions, rtol=0.0, atol=POSE * trial.body.radius)
    (free,) = _core.rollouts([twin.core], [1])
    assert np.abs(core["position_m"] - free["position_m"]).max() > 1e-5


def test_what_takes_over_from_a_trial_for_a_while() -> None:
    """A step is the other trial's where it begins within an interlude, and so is the adhesion that it feels."""
    base = preset_scenario("cuboid_on_paper", duration_s=0.1)
    substrate = replace(base.substrate, adhesion_N_per_m2=20.0, electrostatic_force_N=1e-6)
    one, other = Twin.of(base), Twin.of(replace(base, substrate=substrate, field=drive(0.006, 10.0)))
    # Within a step, at its start, and to the end.
    h = one.reference.step
    edges = (20.4 * h, 75.0 * h, 140.0 * h)
    (core,) = _core.rollouts([one.core.with_interlude(other.core, edges)], [1])

    def at(step: int) -> reference.Trial:
        within = 21 <= step < 75 or step >= 140
        return (other if within else one).reference

    state = one.reference.resting_state()
    positions, quaternions = [state.position], [state.quaternion]
    force, centroid = at(0).adhesion_at(state)
    for i in range(round(one.reference.duration / h)):
        state = reference.step(at(i), state, i * h, force, centroid).state
        force, centroid = at(i + 1).adhesion_at(state)
        positions.append(state.position)
        quaternions.append(state.quaternion)
    np.testing.assert_allclose(core["position_m"], positions, rtol=0.0, atol=POSE * one.reference.body.radius)
    np.testing.assert_allclose(core["orientation"], quaternions, rtol=0.0, atol=POSE)
    for alone in _core.rollouts([one.core, other.core], [1, 1]):
        assert np.abs(core["position_m"] - alone["position_m"]).max() > 1e-5
