"""Whether a hypothesis stands on trials that its fit had not seen."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import log

import numpy as np
import pytest
from numpy.typing import NDArray

from tumblers import diagnose
from tumblers.dataset import Outcome
from tumblers.diagnosis.conclusion import Conclusion
from tumblers.diagnosis.fitting.fitter import Fitter
from tumblers.diagnosis.fitting.hypothesis import Hypothesis
from tumblers.diagnosis.gap.comparison import Comparison, Residual
from tumblers.diagnosis.gap.floor import SHARED
from tumblers.diagnosis.gap.pose import Path
from tumblers.diagnosis.gap.simulator import Simulator
from tumblers.diagnosis.how_far.held_out import HeldOut, folds, held_out, is_foretold, shrink
from tumblers.diagnosis.what.attribute import REFUSED
from tumblers.diagnosis.what.contender import Contender, of_fit
from tumblers.effects.friction_coefficient import FrictionCoefficient
from tumblers.presets import drive

from .lab import LYING, OFF, UPWARDS, measure, plan, without

Floats = NDArray[np.float64]

NO_CLIMB = Outcome(climbs=False)


def fitter_of(trials: int) -> Fitter:
    """Return the fitter of a few trials that take no time: what is said of them is made up."""
    names = [f"t{k}" for k in range(trials)]
    dataset = measure(plan([(name, UPWARDS, 0.0) for name in names], duration_s=0.1))
    return Fitter(Comparison(dataset, Simulator(dataset, 1)))


def wrong_by(fitter: Fitter, sigmas: Sequence[float]) -> HeldOut:
    """Return what a hypothesis says that is wrong by so much throughout each trial left out."""
    residual = fitter.comparison.residual(fitter.comparison.nominal_paths)
    for values, size in zip(residual.trials, sigmas, strict=True):
        values[:] = size
    return HeldOut((residual,) * len(sigmas), (None,) * len(sigmas))


def foretold(nominal: Sequence[float], chosen: Sequence[float], fitted: Sequence[float] | None = None) -> bool:
    fitter = fitter_of(len(nominal))
    before, after = wrong_by(fitter, nominal), wrong_by(fitter, chosen)
    gap = shrink(fitter, after)
    # None of it is beyond where the loss is square.
    assert gap.after**2 == pytest.approx(np.mean(np.square(chosen)))
    # Where it is fitted it is right, if nothing else is said.
    best = wrong_by(fitter, fitted if fitted is not None else [0.0] * len(nominal)).residuals[0]
    return is_foretold(fitter, before, after, gap, Contender(("an_effect",), None, best, 0.0))


@pytest.mark.parametrize(("size", "expected"), [(0.9, True), (1.2, True), (1.25, False), (3.9, False)])
def test_what_leaves_little_on_trials_left_out_is_foretold_even_if_it_is_worse_than_nominal(
    size: float, expected: bool
) -> None:
    assert foretold([0.5, 0.5], [size, size]) == expected


# The objective at 3 sigmas goes up by 3.6 % with a tenth of a sigma, and may by 2 %.
@pytest.mark.parametrize(("size", "expected"), [(2.0, True), (3.0, True), (3.03, True), (3.1, False), (3.9, False)])
def test_what_leaves_much_is_foretold_only_if_it_is_no_worse_than_nominal(size: float, expected: bool) -> None:
    assert foretold([3.0, 3.0], [size, size]) == expected


def test_one_trial_that_nothing_could_foretell_does_not_speak_against_what_foretells_the_others() -> None:
    nominal, chosen = [2.0, 2.0, 2.0], [1.0, 1.0, 3.9]
    # In squares alone it would: the objective has a logarithm.
    assert sum(np.square(chosen)) > 1.02 * sum(np.square(nominal))
    assert foretold(nominal, chosen)
    assert not foretold(nominal, [2.0, 2.0, 3.9])


def test_what_a_single_track_shows_is_not_foretold_by_others_in_which_nothing_happens() -> None:
    # Left out, the track is as far off as before; the others, in which nothing happens, cannot speak against it.
    assert not foretold([3.9, 0.5, 0.5], [3.9, 0.5, 0.5], fitted=[0.5, 0.5, 0.5])
    assert foretold([3.9, 3.9, 0.5], [3.9, 3.9, 0.5], fitted=[0.5, 0.5, 0.5])


def climbs_noted(count: int) -> Fitter:
    """Return the fitter of trials of which it was noted that the robot climbs, and nothing else."""
    dataset = plan([(f"t{k}", drive(0.010, 5.0), 0.0) for k in range(count)], duration_s=0.2)
    return Fitter(Comparison(dataset, Simulator(dataset, 1)))


def test_of_climbs_alone_a_right_model_leaves_nothing() -> None:
    fitter = climbs_noted(11)
    # One of them is not foretold by a model that is right of the others, as a lapse has it.
    wrong = wrong_by(fitter, [3.0] + [0.0] * 10)
    gap = shrink(fitter, wrong)
    assert gap.noise_floor == 0.0
    assert gap.after == pytest.approx(np.sqrt(9.0 / 11.0))
    # The nominal model is right of all of them: nothing was to be shrunk, and this is worse.
    assert gap.before < 0.1
    assert gap.shrink.estimate == 0.0
    best = wrong_by(fitter, [0.0] * 11).residuals[0]
    right = wrong_by(fitter, [0.0] * 11)
    assert not is_foretold(fitter, right, wrong, gap, Contender(("an_effect",), None, best, 0.0))
    assert is_foretold(fitter, wrong, right, shrink(fitter, right), Contender(("an_effect",), None, best, 0.0))


def test_a_contradicted_climb_that_is_foretold_with_the_effect_is_a_gap_that_is_closed() -> None:
    dataset = plan([(f"t{k}", drive(0.010, 5.0), 0.0) for k in range(10)], duration_s=0.2)
    dataset = replace(dataset, trials=(*dataset.trials, replace(dataset.trials[0], id="not", outcome=NO_CLIMB)))
    fitter = Fitter(Comparison(dataset, Simulator(dataset, 1)))
    gap = shrink(fitter, wrong_by(fitter, [0.0] * 11))
    # Less than 1, which noise would leave of 11 numbers that it moves.
    assert 0.8 < gap.before < 1.0
    assert (gap.after, gap.shrink.estimate) == (0.0, 1.0)


def test_climbs_beside_tracks_lower_the_floor_by_their_share() -> None:
    tracks = measure(plan([("a", UPWARDS, 0.0), ("b", UPWARDS, 0.0)], duration_s=0.1))
    noted = plan([("c", drive(0.010, 5.0), 0.0)], duration_s=0.2)
    dataset = replace(tracks, trials=(*tracks.trials, *noted.trials))
    fitter = Fitter(Comparison(dataset, Simulator(dataset, 1)))
    a, b, _ = fitter.comparison.sizes
    gap = shrink(fitter, wrong_by(fitter, [1.0, 1.0, 0.0]))
    assert gap.noise_floor == pytest.approx(np.sqrt((a + b) / (a + b + 1)))
    # Noise alone is left: no more is to be shrunk.
    assert gap.after == pytest.approx(gap.noise_floor)


def test_a_trial_without_numbers_is_not_left_out() -> None:
    dataset = measure(plan([(name, UPWARDS, 0.0) for name in ("a", "b", "c")], duration_s=0.1))
    dataset = without(dataset, "b", slice(0, None))
    fitter = Fitter(Comparison(dataset, Simulator(dataset, 1)))
    assert sorted(i for fold in folds(fitter) for i in fold) == [0, 2]


@pytest.mark.parametrize("size", [0.1, 3.0])
def test_where_no_trial_can_be_left_out_nothing_is_foretold(size: float) -> None:
    assert not foretold([3.0], [size])


def test_what_all_trials_share_is_not_fitted_to_a_trial_that_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    fitter, fitted = lying_and_still()
    residual, calls = Comparison.residual, []

    def noted(
        self: Comparison,
        paths: Sequence[Path | None],
        train: Sequence[int] | None = None,
        fit_nuisances: bool = True,
        tolerance: Floats | None = None,
    ) -> Residual:
        calls.append((train, fit_nuisances, None if tolerance is None else tolerance.tolist()))
        return residual(self, paths, train, fit_nuisances, tolerance=tolerance)

    monkeypatch.setattr(Comparison, "residual", noted)
    left_out = held_out(fitter, fitted.fit)
    assert calls == [((0,), True, None), ((1,), True, None)]
    calls.clear()
    # The gap of the sensor alone is that of the numbers that the lab states.
    shrink(fitter, left_out)
    stated = [0.0] * SHARED
    assert calls == [(None, False, None), ((0,), True, stated), ((1,), True, stated)]


def lying_and_still() -> tuple[Fitter, Contender]:
    """Return the fit of a friction that only the first of two trials shows: a body on a slope, and one on the level."""
    dataset = measure(plan([*LYING, ("still", OFF, 0.0)], duration_s=0.3), (FrictionCoefficient(factor=0.5),))
    fitter = Fitter(Comparison(dataset, Simulator(dataset, 1)))
    hypothesis = Hypothesis.of(FrictionCoefficient, [fitter.comparison.simulator.nominal(i) for i in fitter.trials])
    there = (np.array([0.5, 0.0]) - hypothesis.neutral) / hypothesis.scale
    fitted = of_fit(fitter, fitter.fit(hypothesis, there))
    assert abs(fitted.point[0]) > 0.1
    return fitter, fitted


def test_what_the_other_trials_do_not_know_is_neutral_where_one_is_left_out() -> None:
    fitter, fitted = lying_and_still()
    without_lying, without_still = held_out(fitter, fitted.fit).points
    assert without_lying is not None
    assert without_still is not None
    # A fit ends near the least of its objective, which is neutral there.
    assert abs(without_lying[0]) < 0.02 * abs(fitted.point[0])
    assert without_still[0] == pytest.approx(fitted.point[0], rel=0.01)


def test_a_fit_without_a_trial_starts_from_what_the_others_know(monkeypatch: pytest.MonkeyPatch) -> None:
    # From the point that all trials chose, least squares may not leave it, though the others do not speak for it.
    fitter, fitted = lying_and_still()
    starts: dict[tuple[int, ...], list[float]] = {}

    def noted(name: str) -> Callable[..., object]:
        way = getattr(Fitter, name)

        def call(
            self: Fitter, hypothesis: Hypothesis, start: Floats, train: tuple[int, ...], *rest: int, **more: object
        ) -> object:
            starts.setdefault(train, []).append(float(start[0]))
            return way(self, hypothesis, start, train, *rest, **more)

        return call

    for name in ("fit", "descend"):
        monkeypatch.setattr(Fitter, name, noted(name))
    held_out(fitter, fitted.fit)
    # First the derivatives are taken, where all trials have put it.
    there = fitted.point[0]
    assert starts[(1,)] == [there, pytest.approx(0.0, abs=1e-6)]
    assert starts[(0,)] == [there, pytest.approx(there, rel=0.01)]


def test_what_trials_left_out_refuse_is_named_after_a_tied_one(monkeypatch: pytest.MonkeyPatch) -> None:
    # On slopes along y alone, less friction and less friction along y are the same.
    slopes = [("s30", drive(0.020, 2.0), 30.0), ("f5", drive(0.010, 5.0), 0.0)]
    dataset = measure(plan(slopes, duration_s=0.3), (FrictionCoefficient(factor=0.8),))
    names = ["friction_coefficient", "friction_anisotropy"]
    before = diagnose(dataset, effects=names, jobs=1)
    first = before.ranking[0].effects
    (other,) = {*names} - {*first}
    monkeypatch.setattr(Conclusion, "stands", lambda self, contender: contender.names != first)
    after = diagnose(dataset, effects=names, jobs=1)
    assert [effect.name for effect in after.effects] == [other]
    assert after.ranking[0].effects == (other,)
    assert after.ranking[1].log_evidence == pytest.approx(before.ranking[0].log_evidence + log(REFUSED), abs=1e-6)
    assert any("refuse" in said for said in after.assumptions)
    monkeypatch.setattr(Conclusion, "stands", lambda self, contender: False)
    assert diagnose(dataset, effects=names, jobs=1).ranking[0].effects == first
