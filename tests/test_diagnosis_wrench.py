from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tumblers.dataset import Dataset, LabTrial, Outcome, Sensor, Track
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.job import Job
from tumblers.diagnosis.gap.pose import body_axis, tilt_of
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.result import MissingWrench
from tumblers.diagnosis.where.wrench import missing_wrench
from tumblers.diagnosis.where.wrench_maps import mapped, wrench_regions
from tumblers.diagnosis.where.wrench_means import Windows
from tumblers.diagnosis.where.wrench_pieces import along, at_rest, within_cycles
from tumblers.field import TableField
from tumblers.model import Model
from tumblers.presets import ROBOTS, SUBSTRATES, drive
from tumblers.scenario import Scenario
from tumblers.surroundings import Surroundings

# A sixth of the weight with F_elect: at 10 and 12 Hz the robot hops, and is pushed on while it is in the air.
PUSH_N = 1e-7


def lab(push_N: float, seed: int, frequencies: tuple[float, ...] = (1.0, 10.0, 12.0)) -> Dataset:
    def pushed(scenario: Scenario) -> Scenario:
        return replace(scenario, surroundings=Surroundings(force_N=(0.0, push_N, 0.0)))

    rng = np.random.default_rng(seed)
    empty = Dataset(
        title="toy",
        robot=ROBOTS["cuboid"].value,
        substrate=SUBSTRATES["paper"].value,
        model=Model(magnetic_torque="midpoint"),
        sensor=Sensor(position_noise_m=3e-6, angle_noise_deg=1.0),
        trials=tuple(
            LabTrial(id=f"f{f:g}", field=drive(0.010, f), duration_s=0.8, outcome=Outcome(climbs=True))
            for f in frequencies
        ),
    )
    simulator = Simulator(empty, 1)
    simulator.step_s = [1.5e-4] * len(frequencies)
    trials = []
    for path, trial in zip(
        simulator.run([Job(i, edit=pushed) for i in range(len(frequencies))]), empty.trials, strict=True
    ):
        assert path is not None
        time = np.arange(0.0, trial.duration_s - 0.01, 1.0 / 60.0)
        place, turned = path.at(time)
        seen = dict(zip(("x_m", "y_m", "z_m"), place.T + rng.normal(0.0, 3e-6, (3, len(time))), strict=True))
        seen["tilt_deg"] = np.degrees(tilt_of(body_axis(turned))) + rng.normal(0.0, 1.0, len(time))
        trials.append(replace(trial, outcome=None, track=Track(time_s=time, channels=seen)))
    return replace(empty, trials=tuple(trials))


def found(dataset: Dataset) -> MissingWrench:
    comparison = Comparison(dataset, Simulator(dataset, 1))
    paths = comparison.nominal_paths
    missing = missing_wrench(comparison, comparison.residual(paths), paths, most_windows=18)
    assert missing is not None
    return missing


def test_a_push_is_recovered_where_the_robot_hops() -> None:
    missing = found(lab(PUSH_N, 1))
    estimates = [(m.wrench[1], m.sigma[1]) for label, m in missing.by_frequency.items() if label in ("10 Hz", "12 Hz")]
    assert len(estimates) == 2
    weights = np.array([s**-2 for _, s in estimates])
    mean = float(weights @ [m for m, _ in estimates] / weights.sum())
    sigma = float(weights.sum() ** -0.5)
    assert abs(mean - PUSH_N) < 3.0 * sigma
    assert mean > 4.0 * sigma
    regions = wrench_regions(missing)
    assert (regions[0].axis, regions[0].value) == ("missing_force", "y")
    assert regions[0].share_of_gap > 0.5
    # Which way, and how much.
    assert regions[0].missing is not None
    push, unsure = regions[0].missing
    assert abs(push - PUSH_N) < 3.0 * unsure
    assert regions[0].sigmas == pytest.approx(push / unsure)


@pytest.mark.parametrize("seed", [2, 3])
def test_no_gap_gives_no_wrench(seed: int) -> None:
    missing = found(lab(0.0, seed))
    assert np.mean(np.abs(missing.wrench) < 2.5 * missing.sigma) > 0.97
    assert wrench_regions(missing) == ()


def test_a_force_that_friction_swallows_stays_unknown() -> None:
    missing = found(lab(0.0, 4, (1.0,)))
    assert (missing.sigma <= missing.prior_sigma * (1.0 + 1e-9)).all()
    # A torque about the substrate's normal turns nothing while friction locks the spin.
    assert (missing.sigma[:, 5] > 0.5 * missing.prior_sigma[:, 5]).any()


def test_windows_cover_the_tracks() -> None:
    missing = found(lab(0.0, 5))
    assert set(missing.trials) == {"f1", "f10", "f12"}
    for trial in set(missing.trials):
        mine = np.array([t == trial for t in missing.trials])
        assert missing.start_s[mine][0] == 0.0
        assert np.allclose(missing.start_s[mine][1:], missing.end_s[mine][:-1])
        assert missing.end_s[mine][-1] > 0.75
    assert missing.wrench.shape == missing.sigma.shape == (len(missing.trials), 6)
    assert set(missing.by_frequency) == {"1 Hz", "10 Hz", "12 Hz"}
    assert missing.by_mode
    assert missing.by_place
    assert missing.by_phase


@pytest.mark.parametrize("span_m", [0.0, 3e-6, 4e-4, 2e-2])
def test_every_window_has_its_place_however_short_the_way(span_m: float) -> None:
    dataset = lab(0.0, 5, (1.0,))
    count = 6
    place = np.linspace(0.0, span_m, count)
    window = Windows(
        trial=0,
        start_s=np.arange(count) * 0.1,
        end_s=np.arange(1, count + 1) * 0.1,
        mode=("point",) * count,
        place_y_m=place,
        wrench=np.ones((count, 6)),
        information=np.eye(6 * count),
        prior_sigma=np.ones(6),
    )
    by_place = mapped(dataset, [window], [window]).by_place
    assert len(by_place) == (1 if span_m == 0.0 else count)


def test_fast_trials_alone_have_their_phases_mapped() -> None:
    # Along the run a window is longer than half a cycle.
    missing = found(lab(PUSH_N, 1, (10.0, 12.0)))
    cycles = (missing.end_s - missing.start_s) * np.where(np.array(missing.trials) == "f10", 10.0, 12.0)
    assert np.all(cycles[:-1] > 0.5)
    # Of each quarter of the cycle there is one wrench.
    assert list(missing.by_phase) == ["0–90°", "90–180°", "180–270°", "270–360°"]
    force, sigma = (
        np.array([getattr(mean, name)[1] for mean in missing.by_phase.values()]) for name in ("wrench", "sigma")
    )
    assert np.all(np.abs(force - PUSH_N) < 3.0 * sigma)
    # Where the robot hops a push shows, so that none at all would be refused above; else friction swallows it.
    assert 3.0 * sigma.min() < PUSH_N
    assert sigma.max() > 0.6 * missing.prior_sigma[0, 1]


@pytest.mark.parametrize(("end_s", "most"), [(1.0, 4), (0.37, 12), (2.0, 48)])
def test_pieces_cover_the_run(end_s: float, most: int) -> None:
    windows, cycle = along(5.0, end_s, most), within_cycles(5.0, end_s)
    assert windows.count == len(windows.window) <= most
    assert cycle.count == 4
    for pieces in (windows, cycle, at_rest(end_s, 3)):
        assert (pieces.edges[0], pieces.edges[-1]) == (0.0, end_s)
        assert np.all(np.diff(pieces.edges) > 0.0)
        rows = np.array(pieces.rows(np.arange(6.0 * pieces.count).reshape(-1, 6)))
        assert np.array_equal(rows[:-1, 0], 6.0 * pieces.window)
        assert not rows[-1].any()
    # The same part of every cycle.
    phase = (0.5 * (cycle.edges[1:] + cycle.edges[:-1])[:-1] * 5.0) % 1.0
    assert np.array_equal((4.0 * phase).astype(int), cycle.window[:-1])


def test_outcomes_alone_have_no_wrench() -> None:
    dataset = lab(0.0, 6, (1.0,))
    bare = replace(dataset, trials=tuple(replace(t, track=None, outcome=Outcome(climbs=True)) for t in dataset.trials))
    comparison = Comparison(bare, Simulator(bare, 1))
    paths = comparison.nominal_paths
    assert missing_wrench(comparison, comparison.residual(paths), paths) is None


def table_of(directions: list[tuple[float, float, float]]) -> TableField:
    return TableField(time_s=tuple(np.linspace(0.0, 1.0, len(directions)).tolist()), field_T=tuple(directions))


@pytest.mark.parametrize(
    ("field", "label"),
    [
        (table_of([(0.0, 0.0, 0.0), (0.0, 1e-4, 4e-3), (0.0, 0.0, 8e-3)]), "not rotating"),
        (
            table_of([(0.0, 0.01 * np.sin(a), 0.01 * np.cos(a)) for a in np.linspace(0.0, 12.0, 60)]),
            "turning otherwise",
        ),
    ],
)
def test_a_table_that_turns_is_not_one_that_does_not(field: TableField, label: str) -> None:
    dataset = lab(0.0, 5, (1.0,))
    window = Windows(
        trial=0,
        start_s=np.zeros(1),
        end_s=np.ones(1),
        mode=("point",),
        place_y_m=np.zeros(1),
        wrench=np.ones((1, 6)),
        information=np.eye(6),
        prior_sigma=np.ones(6),
    )
    trial = replace(dataset.trials[0], field=field, duration_s=1.0, track=None, outcome=Outcome(climbs=True))
    assert set(mapped(replace(dataset, trials=(trial,)), [window], [window]).by_frequency) == {label}
