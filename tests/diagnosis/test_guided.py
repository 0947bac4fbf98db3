"""Fits from runs that are drawn to where the robot was seen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tumblers.diagnosis.fitting.fitter import Fitter
from tumblers.diagnosis.fitting.hypothesis import Hypothesis
from tumblers.diagnosis.gap import predictive
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.job import Job
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.what import guided
from tumblers.diagnosis.what import search as searches
from tumblers.diagnosis.what.contender import Contender
from tumblers.diagnosis.what.guided import _Cloud, _spread, found_again
from tumblers.diagnosis.what.own_noise import settled_at
from tumblers.diagnosis.what.search import Search
from tumblers.effects.friction_coefficient import FrictionCoefficient
from tumblers.effects.magnetization_misalignment import MagnetizationMisalignment
from tumblers.effects.magnetization_strength import MagnetizationStrength
from tumblers.effects.surface_roughness import SurfaceRoughness

from .lab import NOTHING, PLANS, measure, plan, quiet

TRUTH = SurfaceRoughness(wavelength_m=1.5e-3, cosine_m=(0.0, 1e-6, 4e-6), sine_m=(0.0, -4e-6, -2e-6))


def lab() -> tuple[Fitter, Hypothesis]:
    dataset = measure(plan(PLANS[:2], duration_s=1.2), (TRUTH,))
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    (hypothesis,) = Search(fitter, [SurfaceRoughness], quiet, 0).possible
    return fitter, hypothesis


def point_of(effect: SurfaceRoughness, hypothesis: Hypothesis) -> Any:
    return (np.array(effect.to_fit(effect.vector())) - hypothesis.neutral) / hypothesis.scale


def test_a_wavelength_that_is_off_by_a_tenth_is_found_by_runs_that_are_drawn_to_the_tracks(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fitter, hypothesis = lab()
    off = replace(TRUTH, wavelength_m=1.1 * TRUTH.wavelength_m)
    stuck = settled_at(fitter, hypothesis, point_of(off, hypothesis), evaluations=8)
    right = settled_at(fitter, hypothesis, point_of(TRUTH, hypothesis), evaluations=8)
    told: list[tuple[int, int]] = []
    rates: list[float | None] = []
    run = fitter.comparison.simulator.run

    def spied(jobs: Sequence[Job]) -> Any:
        rates.extend({None if job.nudge is None else job.nudge.rate_per_s for job in jobs})
        return run(jobs)

    monkeypatch.setattr(fitter.comparison.simulator, "run", spied)
    # Of more than 32 bits.
    other, found = found_again(fitter, [stuck, stuck], [1], 2**40, lambda _, done, total: told.append((done, total)))
    assert other is stuck
    # Drawn faster, then slower, then not at all.
    drawn = [rate for rate in rates if rate is not None]
    assert drawn == sorted(drawn, reverse=True)
    assert set(drawn) == {20.0, 5.0}
    assert rates[-1] is None
    assert told[0] == (0, 60)
    assert (59, 60) in told
    (effect,) = found.effects
    assert isinstance(effect, SurfaceRoughness)
    assert effect.wavelength_m == pytest.approx(TRUTH.wavelength_m, rel=0.003)
    # From where it was stuck to within a twentieth of the way.
    assert found.total < right.total + 0.05 * (stuck.total - right.total)


def test_what_leaves_a_gap_even_where_it_is_drawn_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    fitter, hypothesis = lab()
    off = replace(TRUTH, wavelength_m=1.1 * TRUTH.wavelength_m)
    stuck = settled_at(fitter, hypothesis, point_of(off, hypothesis), evaluations=1)
    told: list[int] = []
    monkeypatch.setattr(guided, "_RATES", ((20.0, 1, 1.0), (5.0, 1, 0.6), (0.0, 1, 0.4)))
    # Less than any gap, and more than every one.
    for wanting, clouds in ((0.0, 1), (1e9, 3)):
        monkeypatch.setattr(predictive, "_WANTING", wanting)
        told.clear()
        (found,) = found_again(
            fitter, [stuck], [0], 0, lambda phase, done, _: told.extend([done] * ("clouds" in phase))
        )
        assert told == list(range(clouds))
        assert (found is stuck) == (clouds == 1)


def test_what_one_has_found_of_a_relief_is_right_for_another_too(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whichever of two was searched with luck, and first or last."""
    fitter, relief = lab()
    (strength,) = Search(fitter, [MagnetizationStrength], quiet, 0).possible
    off = replace(TRUTH, wavelength_m=1.1 * TRUTH.wavelength_m)
    stuck, right = (point_of(effect, relief) for effect in (off, TRUTH))
    alone = settled_at(fitter, relief, stuck, evaluations=2)
    pair = settled_at(fitter, strength + relief, np.concatenate([[0.0], stuck]), evaluations=2)
    lucky = settled_at(fitter, relief, right, evaluations=2)
    starts: list[float] = []

    rated: list[int] = []

    def by_clouds(_fitter: Any, contender: Contender, rates: Sequence[Any], *_rest: Any) -> Contender:
        starts.append(contender.total)
        rated.append(len(rates))
        return lucky if len(contender.names) == 1 else pair

    monkeypatch.setattr(guided, "_by_clouds", by_clouds)
    monkeypatch.setattr(guided, "is_wanting", lambda *_: True)
    for order in ([0, 1], [1, 0]):
        starts.clear()
        made = found_again(fitter, [alone, pair], order, 0, quiet)
        assert made[0].total <= lucky.total
        # As likely but for the second effect, which does nothing.
        assert made[1].total == pytest.approx(lucky.total, abs=0.05 * (pair.total - lucky.total))
        # What is searched later starts with what was found before.
        near = lucky.total + 0.05 * (pair.total - lucky.total)
        assert [start < near for start in starts] == ([False, True] if order[0] == 0 else [False, False])
    # And is near then, where something was found: runs of its own are enough.
    assert rated == [3, 1, 3, 3]
    # What leaves no gap is not searched around again.
    monkeypatch.setattr(guided, "is_wanting", lambda *_: False)
    starts.clear()
    made = found_again(fitter, [alone, pair], [0, 1], 0, quiet)
    assert starts == [alone.total]
    assert made[1].total == pytest.approx(lucky.total, abs=0.05 * (pair.total - lucky.total))


@pytest.mark.parametrize(("wanting", "drawn"), [(True, [3, 3]), (False, [3])])
def test_where_the_first_clouds_lead_nowhere_the_next_is_drawn_too_if_a_gap_is_left(
    wanting: bool, drawn: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    fitter, relief = lab()
    stuck = settled_at(fitter, relief, point_of(TRUTH, relief), evaluations=1)
    rated: list[int] = []

    def by_clouds(_fitter: Any, _contender: Any, rates: Sequence[Any], *_rest: Any) -> None:
        rated.append(len(rates))

    monkeypatch.setattr(guided, "_by_clouds", by_clouds)
    monkeypatch.setattr(guided, "is_wanting", lambda *_: wanting)
    found_again(fitter, [stuck, stuck], [0, 1], 0, quiet)
    assert rated == drawn


@pytest.mark.parametrize(
    ("better", "clouds"),
    [((12, 12, 12), 30 + 15 + 15), ((12, 13, 12), 30 + 12 + 15), ((1, 13, 13), 30 + 12 + 12), ((13, 1, 1), 12)],
)
def test_a_rate_whose_first_clouds_find_nothing_better_ends_and_all_do_with_the_first(
    better: tuple[int, int, int], clouds: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    fitter, hypothesis = lab()
    off = replace(TRUTH, wavelength_m=1.1 * TRUTH.wavelength_m)
    stuck = settled_at(fitter, hypothesis, point_of(off, hypothesis))
    moved: list[_Cloud] = []

    def move(cloud: _Cloud) -> bool:
        moved.append(cloud)
        rate = len(dict.fromkeys(map(id, moved))) - 1
        return moved.count(cloud) == better[rate]

    monkeypatch.setattr(_Cloud, "move", move)
    monkeypatch.setattr(_Cloud, "is_wanting", lambda _: False)
    (found,) = found_again(fitter, [stuck], [0], 0, quiet)
    assert len(moved) == clouds
    assert better[0] <= 12 or found is stuck


def test_a_cloud_at_the_end_of_a_range_stays_within_it() -> None:
    """Its bounds are divided by its widths, and what is asked for multiplied: rounding may carry it beyond."""
    fitter, hypothesis = lab()
    low = np.where(hypothesis.low < 0.0, hypothesis.low, 0.0)
    asked: list[Any] = []

    class Corner(Fitter):
        def residuals(self, _hypothesis: Any, points: Any, **_more: Any) -> Any:
            asked.extend(points)
            return [NOTHING for _ in points]

        def cost(self, _residual: Any, point: Any, *_rest: Any) -> float:
            return float(np.sum(point - low))

    corner = Corner(fitter.comparison)
    for share in (1.0, 0.3, 0.7, 1.0 / 3.0):
        start = share * low
        for _ in range(2):
            cloud = _Cloud(corner, hypothesis, start, _spread(hypothesis, start), 0.0, 0)
            for _ in range(30):
                cloud.move()
            start = cloud.best
    assert all(np.all(point >= hypothesis.low) and np.all(point <= hypothesis.high) for point in asked)


def test_no_width_of_a_cloud_is_nothing_where_an_angle_is() -> None:
    dataset = measure(plan(PLANS[:1]), ())
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    (hypothesis,) = Search(fitter, [MagnetizationMisalignment], quiet, 0).possible
    for point in ([0.0, 0.0], [0.2, 0.0], [0.2, 1e-9]):
        assert np.all(_spread(hypothesis, np.array(point)) >= 1e-3)
    (relief,) = Search(fitter, [SurfaceRoughness], quiet, 0).possible
    # As far from its neutral value as it is from nothing.
    nothing = -relief.neutral / relief.scale
    assert np.all(_spread(relief, nothing) >= 1e-3)


def test_what_has_one_parameter_alone_has_no_cloud() -> None:
    dataset = measure(plan(PLANS[:1]), ())
    fitter = Fitter(Comparison(dataset, Simulator(dataset)))
    (hypothesis,) = Search(fitter, [MagnetizationStrength], quiet, 0).possible
    alone = settled_at(fitter, hypothesis, np.zeros(1))
    assert alone.free == 1
    assert found_again(fitter, [alone], [0], 0, quiet) == [alone]


@pytest.mark.parametrize(
    ("names", "wanting", "asked"),
    [
        (("surface_roughness",), True, [0, 2]),
        (("surface_roughness",), False, None),
        # What leads has no relief.
        (("friction_coefficient",), True, None),
    ],
)
def test_only_where_a_relief_leads_and_a_gap_is_left_it_is_searched_again(
    names: tuple[str, ...], wanting: bool, asked: list[int] | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    dataset = measure(plan(PLANS[:1]), ())
    search = Search(Fitter(Comparison(dataset, Simulator(dataset))), [FrictionCoefficient, SurfaceRoughness], quiet, 0)
    those = [names, ("friction_coefficient",), ("friction_coefficient", "surface_roughness")]
    made = [Contender(each, None, NOTHING, 10.0 * k) for k, each in enumerate(those)]
    told: list[list[int]] = []

    def again(_fitter: Any, contenders: list[Contender], which: list[int], *_rest: Any) -> list[Contender]:
        told.append(which)
        return contenders

    monkeypatch.setattr(searches, "found_again", again)
    monkeypatch.setattr(searches, "is_wanting", lambda *_: wanting)
    assert search._guided(made) == made
    assert told == ([] if asked is None else [asked])
