"""The noise that differences are held against: its determinant, and how much of it each trial takes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tumblers.dataset import Dataset, Outcome
from tumblers.diagnosis.fitting.fitter import Fitter
from tumblers.diagnosis.fitting.objective import _SHARES
from tumblers.diagnosis.gap import built_floors
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.floor import SHARED
from tumblers.diagnosis.gap.job import Job
from tumblers.diagnosis.gap.pose import Path
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.effects.base import Effect
from tumblers.effects.friction_coefficient import FrictionCoefficient
from tumblers.effects.magnetization_misalignment import MagnetizationMisalignment

from .lab import PLANS, measure, plan, without


def misaligned(degrees: float) -> tuple[Effect, ...]:
    return (MagnetizationMisalignment(theta1_deg=degrees),)


def compared(dataset: Dataset) -> Comparison:
    return Comparison(dataset, Simulator(dataset, 1))


def turned_in_the_plane(degrees: float) -> Path:
    """Return the path of a body that lies flat all along, turned by so much."""
    half = 0.5 * np.radians(degrees)
    still = np.tile([np.cos(half), 0.0, 0.0, np.sin(half)], (3, 1))
    return Path(1.0, np.hstack([np.zeros((3, 3)), still]), np.zeros(3, dtype=np.int8))


def with_outcomes() -> Dataset:
    """Return a short dataset with lost frames, and a speed that is better known than the model can compute it."""
    dataset = without(measure(plan(PLANS[:2], duration_s=0.3)), "f02", slice(5, 9))
    speed = Outcome(mean_speed_m_per_s=1e-3, sigma_m_per_s=1e-7)
    return replace(dataset, trials=tuple(replace(trial, outcome=speed) for trial in dataset.trials))


def test_the_determinant_is_that_of_the_covariances() -> None:
    for floor in compared(with_outcomes()).floors:
        expected = 0.0
        for whiten in floor.whiten.values():
            root = np.linalg.inv(whiten)
            sign, logarithm = np.linalg.slogdet(root @ root.T)
            assert sign == 1.0
            expected += logarithm
        outcomes = sum(np.log(1.0 / scale**2) for scale in floor.outcome_scale.values())
        # Or a wrong term of theirs would not be seen.
        assert outcomes > 1.0
        # Inverting an inverse costs some digits.
        assert floor.log_determinant == pytest.approx(expected, rel=1e-9)
        assert floor.outcome_log_determinant == pytest.approx(outcomes, rel=1e-12)


def test_the_deviation_is_the_root_of_the_covariances_diagonal() -> None:
    comparison = compared(with_outcomes())
    floor, seen = comparison.floors[0], comparison.readers[0].observed
    for name, whiten in floor.whiten.items():
        deviation, found = floor.deviation(name), seen.found(name)
        assert np.isnan(deviation).tolist() == (~found).tolist()
        covariance = np.linalg.inv(whiten.T @ whiten)
        assert_allclose(deviation[found] ** 2, np.diag(covariance), rtol=1e-6)
        # What the step and the tolerances leave open comes to the sensor's.
        assert np.all(deviation[found] >= seen.noise[name] * (1.0 - 1e-9))
    comparison.take_noise_of((), shares=[0.0, 0.0])
    alone = comparison.floors[0].deviation("x")
    assert_allclose(alone[seen.found("x")], seen.noise["x"], rtol=1e-9)


def test_numbers_that_are_off_move_a_path_by_what_the_residual_takes_for_them() -> None:
    comparison = compared(with_outcomes())
    paths = comparison.nominal_paths
    bare = np.zeros(SHARED)
    off = np.linspace(-1.0, 1.0, SHARED)
    residual = comparison.residual(paths, tolerance=bare)
    for i, floor in enumerate(comparison.floors):
        apart = residual.trials[i] - comparison.differences(i, paths[i], replace(residual, tolerance=off))
        moved = [floor.whiten[name] @ floor.shift(name, off)[kept] for name, kept in floor.valid.items()]
        assert_allclose(np.concatenate(moved), apart[: floor.tracked], rtol=1e-6, atol=1e-9)
        assert np.abs(apart[: floor.tracked]).max() > 0.1


def test_without_the_changes_the_determinant_is_that_of_the_sensor() -> None:
    comparison = compared(measure(plan(PLANS[:2], duration_s=0.3)))
    all_of_it = [floor.log_determinant for floor in comparison.floors]
    comparison.take_noise_of((), shares=[0.0, 1.0])
    first, second = comparison.floors
    noise = comparison.readers[0].observed.noise
    alone = sum(2.0 * kept.sum() * np.log(noise[name]) for name, kept in first.valid.items())
    assert first.log_determinant == pytest.approx(alone, rel=1e-12)
    # Changes only add to it, and a trial's share is its own.
    assert first.log_determinant < all_of_it[0]
    assert second.log_determinant == all_of_it[1]
    assert comparison.log_determinant == pytest.approx(alone - all_of_it[0], rel=1e-9)


# By trial, by how much the world's magnetization is turned: all, half or next to none of the noise is likeliest.
@pytest.mark.parametrize("degrees", [(0.0,), (3.0,), (10.0,), (0.0, 3.0), (0.0, 6.0), (10.0, 0.0)])
@pytest.mark.parametrize("around", [(), misaligned(2.0)])
def test_the_noise_that_is_taken_is_likelier_than_the_same_share_in_every_trial(
    degrees: tuple[float, ...], around: tuple[Effect, ...]
) -> None:
    planned = plan(PLANS[: len(degrees)], duration_s=0.4)
    worlds = [measure(planned, misaligned(angle) if angle else (), seed=1) for angle in degrees]
    dataset = replace(planned, trials=tuple(world.trials[i] for i, world in enumerate(worlds)))
    comparison = compared(dataset)
    fitter = Fitter(comparison)
    paths = comparison.simulator.run([Job(i, around) for i in fitter.trials])

    def total() -> float:
        return fitter.cost(comparison.residual(paths), np.zeros(1)) + comparison.log_determinant

    shares = fitter.take_likeliest_noise(around)
    taken = total()
    comparison.take_noise_of(around, shares=shares)
    assert total() == taken
    alike = []
    for share in _SHARES:
        comparison.take_noise_of(around, shares=[share] * len(fitter.trials))
        alike.append(total())
    # Equal only where the same share is best for all.
    assert taken <= min(alike) + 1e-9 * abs(taken)
    assert (taken == min(alike)) == (len(set(shares)) == 1)
    # It matters which.
    assert max(alike) > taken + 1.0


def test_a_floor_is_built_once_while_there_is_room(monkeypatch: pytest.MonkeyPatch) -> None:
    comparison = compared(with_outcomes())
    halved = [0.5] * len(comparison.readers)

    def taken(effects: tuple[Effect, ...] = (), shares: list[float] | None = None) -> list[int]:
        comparison.take_noise_of(effects, shares)
        # Kept alive, or an address may serve again.
        alive.append(comparison.floors)
        return [id(floor) for floor in comparison.floors]

    alive: list[object] = []
    first, other = taken(), taken(shares=halved)
    assert not set(first) & set(other)
    assert (taken(), taken(shares=halved)) == (first, other)
    # What is neutral moves nothing.
    assert taken((FrictionCoefficient(factor=1.0),)) == first
    assert not set(taken((FrictionCoefficient(factor=1.1),))) & set(first)
    monkeypatch.setattr(built_floors, "_MOST_KEPT", 0)
    determinant = comparison.log_determinant
    taken(shares=halved)
    assert not set(taken((FrictionCoefficient(factor=1.1),))) & set(first)
    assert comparison.log_determinant == determinant
    assert not set(taken()) & set(first)


@pytest.mark.parametrize("quaternions", [True, False])
def test_an_angle_that_is_half_a_turn_off_changes_by_as_little_as_any(quaternions: bool) -> None:
    (reader,) = compared(measure(plan(PLANS[:1], duration_s=0.3), quaternions=quaternions)).readers
    frames = len(reader.observed.time_s)
    straight = np.tile([1.0, 0.0, 0.0, 0.0], (frames, 1)) if quaternions else None
    values = {**reader.observed.values, "heading": np.zeros(frames)}
    reader = replace(reader, observed=replace(reader.observed, orientation=straight, values=values))
    if not quaternions:
        axis = replace(reader, observed=replace(reader.observed, heading_turn=np.pi))
        change = axis.change(turned_in_the_plane(89.5), turned_in_the_plane(90.5))
        assert_allclose(change["heading"], np.radians(1.0), rtol=1e-9)
    change = reader.change(turned_in_the_plane(179.5), turned_in_the_plane(180.5))
    assert_allclose(change["heading"], np.radians(1.0), rtol=1e-9)


def test_a_change_is_the_difference_of_what_is_wrong_where_no_angle_is_half_a_turn_off() -> None:
    comparison = compared(measure(plan(PLANS[:2], duration_s=0.3), quaternions=True))
    for reader, (path, other) in zip(
        comparison.readers,
        zip(*(comparison.simulator.run([Job(i, e) for i in range(2)]) for e in ((), misaligned(3.0))), strict=True),
        strict=True,
    ):
        assert path is not None
        assert other is not None
        before, after = (reader.differences(p, np.zeros(4), np.zeros(2)) for p in (path, other))
        for name, values in reader.change(path, other).items():
            assert_allclose(values, np.nan_to_num(before[name] - after[name]), rtol=1e-12, atol=1e-15)
