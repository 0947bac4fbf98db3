"""What acts in a part of the data alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import inf
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tumblers.blind.law import Law, State
from tumblers.blind.outside import AmplifierDropout, FadingMagnet, PhaseJump, StickySpot
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.job import Interlude, Job
from tumblers.diagnosis.gap.pose import Path
from tumblers.diagnosis.gap.simulator import LONGEST_STEP_S
from tumblers.diagnosis.result import Region
from tumblers.diagnosis.where.acting import DRIVE, TURN, words_of
from tumblers.diagnosis.where.in_part import _best_part, _search, _stands_out, acts_in_part
from tumblers.diagnosis.where.localise import localise
from tumblers.diagnosis.where.part_axis import Tried, along_y, cycle, from_a_moment
from tumblers.diagnosis.where.part_runs import Runs
from tumblers.effects import get
from tumblers.effects.base import Effect
from tumblers.effects.electrostatic_force import ElectrostaticForce
from tumblers.presets import drive
from tumblers.scenario import Scenario

from .lab import measure, plan
from .test_onset import compared, filmed, shared

FILM = 120.0


def slow(*truth: Effect, law: Law | None = None, duration_s: float = 0.9) -> Comparison:
    planned = plan([("f2", drive(0.010, 2.0), 0.0)], duration_s=duration_s)
    if law is not None:
        return compared(filmed(planned, law, seed=2, frames_per_second=FILM))
    return compared(measure(planned, truth, seed=3, clock_frames=0.3))


def parts(comparison: Comparison) -> dict[str, Region]:
    """Return the parts that are told, by their axes."""
    paths = comparison.nominal_paths
    residual = comparison.residual(paths)
    # There is a gap.
    assert np.mean(residual.over(range(len(paths))) ** 2) > 4.0
    found = acts_in_part(comparison, residual, paths, [1.0 / len(paths)] * len(paths))
    return {region.axis: region for region in found}


def test_one_trial_tells_the_place_in_which_something_holds_the_robot() -> None:
    place = 1.2e-3, 2.4e-3
    comparison = slow(law=StickySpot(size=0.3, place_m=place))
    found = parts(comparison)["position_y_m"]
    # By half or more; a constant attraction is not quite what a spot does, which is to take more than a third.
    assert shared(found, *place) > 0.5
    assert found.share_of_gap > 0.33
    assert found.what is not None
    assert "attraction" in found.what
    # It is looked for only where no effect that acts all along explains the gap.
    paths = comparison.nominal_paths
    for unexplained in (False, True):
        regions, _ = localise(comparison, comparison.residual(paths), paths, unexplained)
        told = [(r.low, r.high, r.what) for r in regions if r.axis == "position_y_m"]
        assert ((found.low, found.high, found.what) in told) == unexplained


def test_parts_are_looked_for_in_the_longest_steps_which_are_then_as_before(monkeypatch: pytest.MonkeyPatch) -> None:
    comparison = slow(law=StickySpot(size=0.3, place_m=(1.2e-3, 2.4e-3)))
    simulator = comparison.simulator
    simulator.step_s = before = [0.25 * step for step in simulator.step_s]
    comparison._start()
    taken = set()
    run = simulator.run

    def spied(jobs: Sequence[Job]) -> list[Path | None]:
        taken.update(simulator.nominal(job.trial).run.fixed_step_s for job in jobs if job.interlude is not None)
        return run(jobs)

    monkeypatch.setattr(simulator, "run", spied)
    assert "position_y_m" in parts(comparison)
    assert taken == {LONGEST_STEP_S}
    assert simulator.step_s == before


def test_what_acts_all_along_is_run_in_the_steps_that_it_asks_for(monkeypatch: pytest.MonkeyPatch) -> None:
    comparison = slow(law=StickySpot(size=0.3, place_m=(1.2e-3, 2.4e-3)))
    simulator, effects = comparison.simulator, (ElectrostaticForce(added_force_N=1e-7),)
    simulator.step_s = before = [0.25 * step for step in simulator.step_s]
    comparison._start()
    taken = []
    run = simulator.run

    def spied(jobs: Sequence[Job]) -> list[Path | None]:
        taken.extend(list(simulator.step_s) for job in jobs if job.effects == effects)
        return run(jobs)

    monkeypatch.setattr(simulator, "run", spied)
    # Nothing is searched: it is seen before.
    monkeypatch.setattr("tumblers.diagnosis.where.in_part._parts", lambda *_: ())
    paths = comparison.nominal_paths
    assert not acts_in_part(comparison, comparison.residual(paths), paths, [1.0], effects)
    assert taken == [before]


def test_nothing_is_told_where_the_nominal_model_cannot_be_run_in_the_longest_steps(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    comparison = slow(law=StickySpot(size=0.3, place_m=(1.2e-3, 2.4e-3)))
    simulator, paths = comparison.simulator, comparison.nominal_paths
    run, asked = simulator.run, []

    def spied(jobs: Sequence[Job]) -> list[Path | None]:
        asked.extend(jobs)
        return run(jobs) if len(asked) == 1 else [None for _ in jobs]

    monkeypatch.setattr(simulator, "run", spied)
    assert acts_in_part(comparison, comparison.residual(paths), paths, [1.0]) == ()
    # Nor is anything searched.
    assert len(asked) == 2


def test_a_robot_that_is_never_seen_to_leave_a_place_tells_where_it_begins() -> None:
    place = 1.2e-3, 2.7e-3
    comparison = slow(law=StickySpot(size=1.0, place_m=place))
    y = comparison.readers[0].observed.values["y"]
    assert place[0] < np.nanmax(y) < place[1]
    found = parts(comparison)["position_y_m"]
    # Within half a body: the robot hops farther than that.
    assert found.low == pytest.approx(place[0], abs=4e-4)
    assert found.high is not None
    # No farther than it was seen.
    assert found.high < np.nanmax(y) + 1e-5


@pytest.mark.parametrize(
    ("entering", "left", "moment", "told"),
    [
        # A place in which the robot stays, of which much is left: clear of every moment, and not.
        (2, 400.0, 600.0, True),
        (2, 400.0, 450.0, False),
        # Of one trial a place in which it stays is what sets in at a moment.
        (1, 400.0, 600.0, False),
        # Nor is it told where it leaves too much, or is not clear of what acts all along.
        (2, 700.0, 2000.0, False),
        (2, 580.0, 2000.0, False),
        # So little is left that it may as well be a moment.
        (2, 150.0, 160.0, True),
        # No moment was tried that would be ruled out, or a moment is the best itself.
        (2, 400.0, -inf, False),
        (2, 400.0, 400.0, False),
    ],
)
def test_a_place_in_which_the_robot_stays_leaves_less_where_it_is_not_clear_of_every_moment(
    entering: int, left: float, moment: float, told: bool
) -> None:
    part = Tried((1e-3, 2e-3), DRIVE, 0.5, is_part=True)
    axis = SimpleNamespace(
        passage=lambda _: "stays", trials=range(3), edges=lambda trial, _: (0.5,) * (trial < entering)
    )
    runs: Any = SimpleNamespace(axis=axis, known={part: left}, clear=100.0, numbers=1e9)
    assert _stands_out(runs, part, nothing=1000.0, rest=650.0, moment=moment) == told


def test_a_field_that_falls_short_in_a_part_of_the_cycle_drives_less_there() -> None:
    # Across the cycle's end.
    phase, share = 0.85, 0.25
    planned = plan([(f"f{f:g}", drive(0.010, f), 0.0) for f in (2.0, 3.0, 5.0)], duration_s=0.8)
    law = AmplifierDropout(size=0.8, phase=phase, share=share)
    found = parts(compared(filmed(planned, law, seed=6, frames_per_second=FILM)))["cycle_phase_deg"]
    assert found.low is not None
    assert 0.0 <= found.low < 360.0
    assert shared(found, 360.0 * phase, 360.0 * (phase + share)) > 0.5
    assert found.what is not None
    factor, _, words = found.what.partition(" ")
    assert words == "times the magnetic torque"
    # A region that is off at its ends makes up for it, by less than the strengths that are tried first are apart.
    assert float(factor) == pytest.approx(0.2, abs=0.25)


def test_what_acts_all_along_acts_in_no_part() -> None:
    assert not parts(slow(get("magnetization_misalignment").from_vector((6.0, 20.0))))


@pytest.mark.parametrize("forwards", [-1.0, 1.0])
def test_one_trial_tells_the_moment_at_which_the_field_jumps_and_by_how_much(forwards: float) -> None:
    found = parts(slow(law=PhaseJump(size=0.2, time_s=0.35, forwards=forwards)))
    told = found.pop("time_s")
    # Neither of the cycle nor of the way.
    assert not found
    assert told.low == pytest.approx(0.35, abs=0.03)
    assert told.high == pytest.approx(0.9)
    assert told.what is not None
    the, field, angle, *way = told.what.split()
    assert (the, field) == ("the", "field")
    assert " ".join(way) == f"{'ahead of' if forwards > 0.0 else 'behind'} where it should be"
    # 0.2 of 150°.
    assert float(angle.removesuffix("°")) == pytest.approx(30.0, abs=5.0)


def test_what_fades_acts_in_no_part() -> None:
    assert not parts(slow(law=FadingMagnet(size=1.0)))


class FallsShort(Law):
    """From 0.45 s on the magnet has a fifth of its moment."""

    every = 8

    def piece(self, scenario: Scenario, time_s: float, state: State) -> Scenario:
        weaker = replace(scenario.robot, magnetization_A_per_m=0.2 * scenario.robot.magnetization_A_per_m)
        return scenario if time_s < 0.45 else replace(scenario, robot=weaker)


def test_one_trial_tells_the_moment_from_which_on_the_field_falls_short() -> None:
    found = parts(slow(law=FallsShort()))["time_s"]
    assert found.low == pytest.approx(0.45, abs=0.04)
    assert found.what is not None
    factor, _, words = found.what.partition(" ")
    assert words == "times the magnetic torque"
    assert float(factor) == pytest.approx(0.2, abs=0.15)


def test_what_sets_in_before_a_quarter_of_a_cycle_may_act_all_along() -> None:
    comparison = slow(get("viscous_drag").from_vector((0.03,)))
    axis = from_a_moment(comparison, [0], TURN)
    assert axis is not None
    # At 2 Hz, of 0.9 s.
    assert [axis.passage((low, 0.9)) for low in (0.1, 0.125, 0.13, 0.9)] == ["none", "none", "stays", "none"]
    assert {one.is_part for table in axis.first for one in table if one.ends is not None and one.ends[0] <= 0.125} == {
        False
    }
    assert axis.edges(0, (0.4, 0.9)) == (0.4,)
    # Only where it begins is moved.
    tried = next(one for table in axis.first for one in table if one.is_part)
    assert tried.ends is not None
    assert {one.ends[1] for one in axis.beside(tried, 0.5) if one.ends is not None} == {tried.ends[1]}
    assert all(low > 0.125 and high == tried.ends[1] for low, high in axis.elsewhere(tried.ends))
    shorter = slow(get("viscous_drag").from_vector((0.03,)), duration_s=0.12)
    assert from_a_moment(shorter, [0], TURN) is None
    # A field that falls short so early has driven the robot until then.
    other = from_a_moment(comparison, [0], DRIVE)
    assert other is not None
    assert [other.passage((low, 0.9)) for low in (0.0, 0.01, 0.9)] == ["none", "stays", "none"]
    assert {one.ends for table in other.first for one in table if not one.is_part} == {(0.0, 0.9)}


def test_either_end_of_a_region_is_tried_all_along_the_axis() -> None:
    axis = cycle(slow(get("viscous_drag").from_vector((0.03,))), [0])
    assert axis is not None
    # By halves of 30°, up to half a cycle.
    assert axis.elsewhere((30.0, 60.0)) == [
        *((60.0 - 15.0 * k, 60.0) if k < 5 else (420.0 - 15.0 * k, 420.0) for k in range(1, 13)),
        # But itself, which there is already.
        *((30.0, 30.0 + 15.0 * k) for k in range(1, 13) if k != 2),
    ]


def test_what_is_left_before_all_trials_were_run_is_clear_of_the_best() -> None:
    planned = plan([(f"f{f:g}", drive(0.010, f), 0.0) for f in (2.0, 3.0)], duration_s=0.6)
    comparison = compared(filmed(planned, AmplifierDropout(size=0.8, phase=0.3, share=0.2), seed=6))
    axis = cycle(comparison, [0, 1])
    assert axis is not None
    tried = [one for table in axis.first for one in table]
    residual = comparison.residual(comparison.nominal_paths)
    each, some = (Runs(comparison, residual, axis, inf, lambda *_: None, len(tried)) for _ in range(2))
    each.clear = inf
    every, left = np.array(each.cost(tried)), np.array(some.cost(tried))
    whole = left == every
    assert 0 < np.count_nonzero(~whole) < len(tried)
    assert each.whole == set(tried)
    assert some.whole == {one for one, all_run in zip(tried, whole, strict=True) if all_run}
    assert left.min() == every.min()
    # Of some of the trials.
    assert np.all(left[~whole] < every[~whole])
    assert np.all(left[~whole] > every.min() + some.clear)
    # Where something else leaves nothing, none is run in all trials, and none is told.
    hopeless = Runs(comparison, residual, axis, 0.0, lambda *_: None, len(tried))
    _search(hopeless)
    assert _best_part(hopeless) is None
    assert not hopeless.whole
    # But what a part has to leave less than is known.
    least, rivals = hopeless.least_rival(), [one for one in hopeless.known if not one.is_part]
    assert not any(one.is_part for one in hopeless.whole)
    assert least == min(each.cost(rivals))


def test_a_region_of_the_cycle_is_within_the_same_phases_of_eachcycle() -> None:
    comparison = slow(get("viscous_drag").from_vector((0.03,)))
    axis = cycle(comparison, [0])
    assert axis is not None
    # At 2 Hz; across the end of the cycle it begins before the run.
    assert axis.edges(0, (90.0, 180.0)) == pytest.approx([0.125, 0.25, 0.625, 0.75])
    assert axis.edges(0, (330.0, 420.0))[:4] == pytest.approx([-1.0 / 24.0, 1.0 / 12.0, 11.0 / 24.0, 7.0 / 12.0])
    assert axis.edges(0, (-30.0, 60.0)) == pytest.approx(axis.edges(0, (330.0, 420.0)))
    assert (axis.passage((0.0, 90.0)), axis.passage((0.0, 360.0))) == ("through", "none")


def test_a_trial_is_in_a_place_while_it_was_seen_there() -> None:
    comparison = slow(get("viscous_drag").from_vector((0.03,)))
    residual = comparison.residual(comparison.nominal_paths)
    (reader,) = comparison.readers
    time, y = reader.observed.time_s, np.array(reader.observed.values["y"])
    y[:] = residual.local[0, 2] + np.interp(time, [0.0, 0.4, 0.5, 0.9], [0.0, 2e-3, 1.5e-3, 3e-3])
    comparison.readers = (replace(reader, observed=replace(reader.observed, values={"y": y})),)
    axis = along_y(comparison, residual, comparison.nominal_paths, [0])
    assert axis is not None
    frame = float(np.max(np.diff(time)))
    # In, out again on the way on, back, and out.
    edges = axis.edges(0, (1.6e-3, 1.9e-3))
    assert edges == pytest.approx([0.32, 0.38, 0.42, 0.48, 0.527, 0.607], abs=frame)
    assert axis.edges(0, (-1e-3, 1e-3)) == pytest.approx([0.0, 0.2], abs=frame)
    assert axis.edges(0, (4e-3, 5e-3)) == ()
    ways = [axis.passage(ends) for ends in ((1.6e-3, 1.9e-3), (-1e-3, 1e-3), (2.5e-3, 4e-3), (4e-3, 5e-3))]
    assert ways == ["through", "none", "stays", "none"]


def test_a_trial_that_was_not_seen_along_y_tells_no_place() -> None:
    comparison = slow(get("viscous_drag").from_vector((0.03,)))
    residual = comparison.residual(comparison.nominal_paths)
    assert along_y(comparison, residual, [None], [0]) is None
    assert acts_in_part(comparison, residual, [None], [1.0]) == ()
    (reader,) = comparison.readers
    values = {name: seen for name, seen in reader.observed.values.items() if name != "y"}
    comparison.readers = (replace(reader, observed=replace(reader.observed, values=values)),)
    assert along_y(comparison, residual, comparison.nominal_paths, [0]) is None


@pytest.mark.parametrize(
    ("strength", "said"),
    [
        (26.2, "the field 26° ahead of where it should be"),
        (-135.0, "the field 140° behind where it should be"),
        (180.0, "the field 180° ahead of where it should be"),
        # By more than half a turn it is behind.
        (225.0, "the field 140° behind where it should be"),
        (3.77, "the field 3.8° ahead of where it should be"),
    ],
)
def test_a_field_that_is_ahead_is_said_in_degrees(strength: float, said: str) -> None:
    comparison = slow(get("viscous_drag").from_vector((0.03,)))
    assert words_of(TURN.effects(strength, comparison.simulator.nominal(0))) == said


def test_the_trial_with_most_of_the_gap_says_when_something_may_set_in() -> None:
    planned = plan([("f2", drive(0.010, 2.0), 0.0), ("f9", drive(0.010, 9.0), 0.0)], duration_s=0.6)
    comparison = compared(filmed(planned, PhaseJump(size=0.2, time_s=0.35, forwards=1.0), seed=6))
    both = comparison.dataset.trials
    longer = replace(comparison.dataset, trials=(*both, replace(both[1], id="long", duration_s=0.8)))
    comparison = compared(longer)
    slow_first, fast_first = (from_a_moment(comparison, trials, TURN) for trials in ([0, 1], [1, 0]))
    assert slow_first is not None
    assert fast_first is not None
    # A quarter of a cycle at 2 and at 9 Hz.
    assert [axis.passage((0.1, 0.8)) for axis in (slow_first, fast_first)] == ["none", "stays"]
    # It goes on in the trial that is not looked at.
    assert {one.ends[1] for table in slow_first.first for one in table if one.ends is not None} == {0.8}


def test_an_interlude_of_a_job_is_at_work_between_its_edges_alone() -> None:
    comparison = slow(get("viscous_drag").from_vector((0.03,)))
    held = (ElectrostaticForce(added_force_N=4e-6),)
    jobs = [
        Job(0),
        Job(0, held),
        Job(0, interlude=Interlude(held, (0.2, 0.5))),
        Job(0, interlude=Interlude(held, (0.0,))),
    ]
    alone, all_along, between, from_start = comparison.simulator.run(jobs)
    assert alone is not None
    assert all_along is not None
    assert between is not None
    assert from_start is not None
    np.testing.assert_array_equal(from_start.position_m, all_along.position_m)
    row = int(0.2 / alone.interval_s)
    np.testing.assert_array_equal(between.position_m[: row + 1], alone.position_m[: row + 1])
    assert np.abs(between.position_m - alone.position_m).max() > 1e-4
    # What is refused is not run, and the others are.
    refused = Interlude((ElectrostaticForce(added_force_N=-1.0),), (0.1,))
    assert [path is None for path in comparison.simulator.run([Job(0), Job(0, interlude=refused)])] == [False, True]
    # Bodies that differ cannot take over.
    other = Interlude((get("size_error").from_vector((1.03, 1.0)),), (0.2, 0.5))
    assert comparison.simulator.run([Job(0, interlude=other)]) == [None]
