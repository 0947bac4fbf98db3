"""`diagnose`: where model and measurement part, which effect causes it, and how far the gap shrinks with it added."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, replace
from math import log, pi
from time import perf_counter

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from ..check import thread_count
from ..dataset import Dataset
from ..effects.base import Effect
from ..effects.catalogue import CATALOGUE, get
from ..effects.parameter import FORM_SHARE
from ..errors import InputError, show
from ..progress import OnPhase, phases
from ..version import __version__
from .diagnosis import Diagnosis
from .fitting.fitter import Fitter
from .fitting.sandwich import MOST_FACTOR
from .gap.comparison import Comparison
from .gap.job import Job
from .gap.loss import robust_cost
from .gap.predictive import failings, is_right
from .gap.simulator import Simulator
from .how_far.followed import LEAST_FOLLOWED, followed
from .how_far.held_out import HeldOut, folds, held_out, is_foretold, shrink
from .how_far.overlay import overlays
from .result import EffectEstimate, Failing, HeatMap, Interval, NextTrial, RankedHypothesis, Region, TrialFloor, Verdict
from .what.attribute import LAPSE, PRIOR, REFUSED, Attribution, attribute, seen_from_the_best
from .what.contender import Contender
from .what.estimate import intervals
from .what.height_zero import with_height_zero
from .what.margins import SECOND
from .what.own_noise import lead_around
from .what.tracked_point import with_tracked_point
from .what.verdict import judge, refused, ties
from .what_next.next_trial import in_one_step, next_trials
from .what_next.posterior import samples
from .where.localise import localise
from .where.wrench import missing_wrench
from .where.wrench_maps import wrench_regions

__all__ = ["diagnose"]

Floats = NDArray[np.float64]

# Hypotheses whose gap is measured on trials left out, and how probable they must be (the best is always measured).
_MEASURED, _PROBABLE = 3, 0.02
# Hypotheses that a next trial is sought for, of what does not explain the gap fewer, and draws of each.
_RIVALS, _PARTIAL_RIVALS, _SAMPLES = 6, 3, 24
# What a rival weighs at least in the information of a trial: tied by likelihood alone, it may be next to improbable.
_LEAST_WEIGHT = 0.02
# ln of the odds against an effect that is ruled out: those against what has failed the predictive test.
_RULED_OUT = -log(REFUSED)


def diagnose(
    dataset: Dataset,
    *,
    effects: Sequence[str] | None = None,
    jobs: int | None = None,
    seed: int = 0,
    progress: bool | OnPhase = False,
) -> Diagnosis:
    """Diagnose the gap between a lab's measurements and its nominal model.

    Parameters
    ----------
    dataset
        What the lab measured and what it believes.
    effects
        Names of the effects that are considered; the whole catalogue if None.
    jobs
        Threads, all by default. The result does not depend on it.
    seed
        Of everything that is drawn: the same for the same seed.
    progress
        True for a progress bar with the phase's name, or a callback that is told the phase, how much of it is done, and
        of how much.

    Returns
    -------
    Diagnosis
        With its parts as attributes.

    Raises
    ------
    InputError
        An effect or a number that is refused, or a dataset in which nothing was measured.
    EffectError
        An effect of a user's own that fails.
    SimulationError
        The native module gave up.
    """
    if not isinstance(dataset, Dataset):
        raise InputError("dataset", show(dataset), "a Dataset, as tumblers.dataset.load returns it")
    kinds = _kinds(effects)
    if jobs is not None:
        thread_count("jobs", jobs)
    if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
        raise InputError("seed", show(seed), "a whole number of at least 0")
    start = perf_counter()
    # The sums of the linear algebra depend on its threads, and what follows from them would.
    with threadpool_limits(1), phases(progress) as tell:
        read = with_tracked_point(dataset, kinds, jobs or 0, tell)
        tell("simulating the nominal model", 0, 1)
        comparison = Comparison(read, Simulator(read, jobs or 0))
        if comparison.count == 0:
            raise InputError(
                "trial",
                "no measurement in any trial: every frame is lost",
                "at least one measurement",
                dataset.directory,
            )
        attribution = attribute(comparison, kinds, tell, seed)
        free = with_height_zero(comparison, attribution)
        if free is not None:
            comparison = Comparison(free, Simulator(free, jobs or 0))
            attribution = attribute(comparison, kinds, tell, seed)
        return _Conclusion(dataset, comparison, attribution, seed, tell).diagnosis(start)


class _Conclusion:
    def __init__(
        self, dataset: Dataset, comparison: Comparison, attribution: Attribution, seed: int, tell: OnPhase
    ) -> None:
        self.dataset, self.comparison, self.attribution = dataset, comparison, attribution
        self.seed, self.tell = seed, tell
        self.fitter = Fitter(comparison)
        self.measured: dict[tuple[str, ...], HeldOut] = {}

    def held_out(self, contender: Contender) -> HeldOut:
        """Return what a contender says of trials left out, computed once."""
        if contender.names not in self.measured:
            self.measured[contender.names] = held_out(self.fitter, contender.fit)
        return self.measured[contender.names]

    def stands(self, contender: Contender) -> bool:
        """Return whether a contender stands on trials that its fit had not seen, and its own run follows the data."""
        return self.foretold(contender) and followed(self.fitter, contender) >= LEAST_FOLLOWED

    def foretold(self, contender: Contender) -> bool:
        """Return whether a contender stands on trials that its fit had not seen."""
        gap = shrink(self.fitter, self.held_out(contender), self.seed)
        nominal = self.held_out(self.attribution.nominal)
        return is_foretold(self.fitter, nominal, self.held_out(contender), gap, contender)

    def failings(self, chosen: Contender, nearer: float | None) -> tuple[Failing, ...]:
        """Return what keeps a contender from explaining the data, `nearer` being how much its own run follows them."""
        found = list(failings(self.comparison, chosen.residual, fitted=bool(chosen.names)))
        if chosen.names and not self.foretold(chosen):
            found.append(Failing("trials left out"))
        if nearer is not None and nearer < LEAST_FOLLOWED:
            found.append(Failing("the path"))
        return tuple(found)

    def measure(self) -> list[Contender]:
        """Return the likeliest contenders, what they say of trials left out being known."""
        considered = [
            c for k, c in enumerate(self.attribution.contenders[:_MEASURED]) if k == 0 or c.probability > _PROBABLE
        ]
        for k, contender in enumerate(considered):
            self.tell("trials left out", k, len(considered))
            self.held_out(contender)
        return considered

    def lead_by_what_stands(self) -> None:
        """Let that lead which stands on trials left out, of what evidence ties at the top.

        It has to stand against its own noise too, and to have been run in the others' steps; if not, all stays as it
        was.
        """
        before, measured, floors = self.attribution, self.measured, self.comparison.floors
        behind = refused(self.comparison, self.measure(), self.stands)
        if not behind:
            return
        self.attribution, self.measured = seen_from_the_best(self.fitter, before.refusing(behind)), {}
        best = self.measure()[0]
        held = self.comparison.simulator.resolves(best.effects) and is_right(self.comparison, best.residual)
        if not (held and self.stands(best)):
            self.attribution, self.measured, self.comparison.floors = before, measured, floors

    def diagnosis(self, start: float) -> Diagnosis:
        self.lead_by_what_stands()
        comparison, attribution, tell = self.comparison, self.attribution, self.tell
        nominal = self.held_out(attribution.nominal)
        best = attribution.contenders[0]
        gap = shrink(self.fitter, self.held_out(best), self.seed)
        verdict, chosen = judge(comparison, attribution, self.stands(best))
        if chosen is not best:
            gap = shrink(self.fitter, nominal, self.seed)
        if chosen.names:
            gap = replace(gap, followed=followed(self.fitter, chosen))
        failing = self.failings(chosen, gap.followed) if verdict == "unexplained" else ()
        tied = ties(comparison, attribution, chosen, lambda other: self._lead(chosen, other))

        estimates, shown = self._estimates(chosen, tied), overlays(self.fitter, nominal, self.held_out(chosen), chosen)
        # Not by evidence: the nominal model has the probability of what counts as it, too.
        by_probability = sorted(attribution.contenders, key=lambda contender: -contender.probability)
        ranking = tuple(self._ranked(contender) for contender in by_probability)
        floors = self._floors(chosen)
        proposed = self._next(chosen, tied, _PARTIAL_RIVALS if verdict == "unexplained" else _RIVALS, tell)
        tell("where the gap lies", 0, 2)
        regions, maps = self._where(chosen, verdict)
        # What is missing is seen against the noise around the nominal model, not around other hypotheses.
        comparison.take_noise_of(())
        still = comparison.residual(comparison.nominal_paths)
        wrench = None
        if verdict != "no_gap":
            tell("the missing wrench", 1, 2)
            wrench = missing_wrench(comparison, still, comparison.nominal_paths)
            if wrench is not None:
                regions = (*regions, *wrench_regions(wrench))
        else:
            regions = ()
        return Diagnosis(
            dataset=self.dataset,
            model=comparison.simulator.model,
            tracked_point=comparison.dataset.sensor.camera.tracked_point,
            z_origin_tolerance_m=comparison.dataset.sensor.height_tolerance_m,
            verdict=verdict,
            effects=estimates,
            chosen=chosen.effects,
            ranking=ranking,
            gap=gap,
            failings=failing,
            where=tuple(sorted(regions, key=lambda region: -region.share_of_gap)),
            next_trials=proposed,
            ruled_out=self._ruled_out(chosen, tied),
            heat_maps=maps,
            missing_wrench=wrench,
            overlays=shown,
            floors=floors,
            assumptions=_assumptions(self.dataset, comparison, attribution),
            seed=self.seed,
            seconds=perf_counter() - start,
            version=__version__,
        )

    def _lead(self, chosen: Contender, other: Contender) -> float:
        self.tell("against the noise around others", 0, 1)
        return lead_around(self.fitter, chosen, other)

    def _where(self, chosen: Contender, verdict: Verdict) -> tuple[tuple[Region, ...], tuple[HeatMap, ...]]:
        """Return where the nominal model parts from the data.

        How much of what may be wrong with the computed motion really is, and how far the nominal numbers are off, shows
        with the effects at work: the nominal model alone would hide its gap in either.
        """
        comparison = self.comparison
        shares = self.fitter.take_likeliest_noise(chosen.effects)
        paths = comparison.simulator.run([Job(i, chosen.effects) for i in self.fitter.trials])
        tolerance = comparison.residual(paths).tolerance
        comparison.take_noise_of((), shares=shares)
        bare = comparison.residual(comparison.nominal_paths, tolerance=tolerance)
        unexplained = verdict == "unexplained"
        return localise(comparison, bare, comparison.nominal_paths, unexplained, chosen.effects, self.tell)

    def _estimates(self, chosen: Contender, tied: dict[str, tuple[str, ...]]) -> tuple[EffectEstimate, ...]:
        found = intervals(self.fitter, self.attribution, chosen)
        made = []
        for name in chosen.names:
            mine: dict[str, Interval] = {key: interval for (effect, key), interval in found.items() if effect == name}
            share = sum(c.probability for c in self.attribution.contenders if name in c.names)
            made.append(EffectEstimate(name, min(share, 1.0), mine, tied.get(name, ())))
        # The likelier cause first.
        return tuple(sorted(made, key=lambda effect: -effect.probability))

    def _ranked(self, contender: Contender) -> RankedHypothesis:
        comparison = self.comparison
        left_out, shrunk = None, None
        if contender.names in self.measured:
            gap = shrink(self.fitter, self.measured[contender.names], self.seed)
            left_out, shrunk = gap.after, gap.shrink.estimate
        values = contender.residual.over(self.fitter.trials)
        return RankedHypothesis(
            effects=contender.names,
            probability=contender.probability,
            log_evidence=contender.log_evidence - self.attribution.nominal.log_evidence,
            gap=float(np.sqrt(robust_cost(values) / comparison.count)),
            held_out_gap=left_out,
            shrink=shrunk,
        )

    def _next(
        self, chosen: Contender, tied: dict[str, tuple[str, ...]], most: int, tell: OnPhase
    ) -> tuple[NextTrial, ...]:
        if not any(tied.values()):
            return ()
        rivals = [chosen]
        for contender in self.attribution.contenders:
            for name, others in tied.items():
                swapped = {*chosen.names} - {name}
                rival = any(set(contender.names) == swapped | {other} for other in others)
                if rival and contender not in rivals:
                    rivals.append(contender)
        rivals = rivals[:most]
        hypotheses = []
        for k, contender in enumerate(rivals):
            tell("the next trial", k, len(rivals) + 1)
            hypotheses.append((contender.names, samples(self.fitter, self.attribution, contender, _SAMPLES, self.seed)))
        tell("the next trial", len(rivals), len(rivals) + 1)
        weights = [max(contender.probability, _LEAST_WEIGHT) for contender in rivals]
        dataset = self.comparison.dataset
        simulator = in_one_step(dataset, hypotheses, self.comparison.simulator.threads)
        return next_trials(dataset, simulator, hypotheses, self.seed, weights)

    def _ruled_out(self, chosen: Contender, tied: dict[str, tuple[str, ...]]) -> dict[str, str]:
        """For each effect that is improbable, alone and beside another, the trial that speaks most against it alone."""
        out = {}
        named = {*chosen.names, *(other for others in tied.values() for other in others)}
        for contender in self.attribution.contenders:
            if len(contender.names) != 1 or contender.names[0] in named:
                continue
            if self.attribution.log_odds(chosen, contender.names[0]) < _RULED_OUT:
                continue
            against = [
                self.fitter.trial_cost(contender.residual, i) - self.fitter.trial_cost(chosen.residual, i)
                for i in self.fitter.trials
            ]
            worst = int(np.argmax(against))
            if against[worst] > 0.0:
                out[contender.names[0]] = self.comparison.dataset.trials[worst].id
        return out

    def _floors(self, chosen: Contender) -> tuple[TrialFloor, ...]:
        comparison = self.comparison
        ends = comparison.nuisances.at_tolerance(chosen.residual.local)
        steps = comparison.simulator.steps_of(chosen.effects)
        return tuple(
            TrialFloor(
                trial=reader.observed.id,
                step_s=steps[i],
                numerical_sigmas=floor.numerical_sigmas,
                tolerance_sigmas=floor.tolerance_sigmas,
                frames=reader.observed.frames,
                lost=reader.observed.lost,
                compared=comparison.sizes[i],
                at_tolerance=ends[i],
            )
            for i, (reader, floor) in enumerate(zip(comparison.readers, comparison.floors, strict=True))
        )


def _kinds(effects: Sequence[str] | None) -> list[type[Effect]]:
    if effects is None:
        return list(CATALOGUE.values())
    if isinstance(effects, str) or not effects:
        raise InputError("effects", show(effects), "a list of names of effects")
    chosen = {get(name) for name in effects}
    # However they were written, the answer is the same.
    return [kind for kind in CATALOGUE.values() if kind in chosen]


def _weight(dispersion: float) -> str:
    written = f"{dispersion:.3g}"
    return (
        "Every measured number counts for itself"
        if written == "1"
        else f"Every {written} measured numbers of a track count as one"
    )


def _assumptions(dataset: Dataset, comparison: Comparison, attribution: Attribution) -> tuple[str, ...]:
    simulator, sensor = comparison.simulator, comparison.dataset.sensor
    tried = sorted(c.names[0] for c in attribution.contenders if len(c.names) == 1)
    clock = "half a frame" if sensor.time_offset_s is None else f"{1e3 * sensor.time_offset_s:g} ms"
    known_to = asdict(dataset.tolerance)
    nominal = ", ".join(f"{name.replace('_', ' ')} {100.0 * share:g} %" for name, share in known_to.items())
    given = "magnetic_torque" in comparison.dataset.model_given
    stated = "as the dataset states" if given else "which the dataset leaves open"
    origin = f"{1e6 * sensor.origin_tolerance_m:g} µm"
    if sensor.height_tolerance_m > 0.0:
        origin += f", along z {1e6 * sensor.height_tolerance_m:g} µm"
    said = [
        f"The magnetic torque is taken by the scheme '{simulator.model.magnetic_torque}', {stated}.",
        "The robot starts at rest on the substrate, long axis along +y, when the field starts.",
        f"The sensor's nuisances are fitted in every hypothesis: clock within {clock}, origin within "
        f"{origin}, heading within {sensor.heading_tolerance_deg:g}°, scale within "
        f"{100.0 * sensor.scale_tolerance:g} %. Larger ones, but for z, are the effect camera_calibration, the same in "
        "all trials.",
        "A substrate that is tilted, rough or sticky is so alike under every trial's start. A friction that drifts "
        f"does so anew, and alike, in every trial, which is expected in {100.0 * FORM_SHARE:g} % of the cases.",
        f"The nominal numbers may be off by these standard deviations: {nominal}.",
        "What halving the step changes is part of the noise, around each hypothesis that counts for itself, and in "
        "each trial as much of it as makes the differences likeliest. One that comes near the best, and says the "
        "same against either's noise, may be held against the best's, and what is nearly as good is compared with the "
        "best by the mean over both.",
        "Data that were themselves computed in a coarse step"
        + ("" if given else " by the formats' own torque scheme")
        + " are no gap: the change to it is fitted in every hypothesis.",
        "A trial that a hypothesis cannot follow at all counts by its logarithm.",
        "A trial left out has its own clock and origin; the camera's heading and scale, the nominal numbers and the "
        "effects are fitted to the others.",
        f"{_weight(attribution.dispersion)} in probabilities and intervals.",
        f"Tried were {', '.join(tried)}." if tried else "No effect that was tried can be at work in these trials.",
        f"However strong the evidence, {100.0 * LAPSE:.0f} % of the probability belongs to all hypotheses alike; what "
        "may only say that nominal numbers are off within their tolerances gives its own to the nominal model.",
        f"A next trial is sought among the likeliest {_RIVALS} that are tied, {_PARTIAL_RIVALS} where none of them "
        "explains the gap.",
        f"Before anything is fitted, {100.0 * PRIOR[0]:g} % for no gap, {100.0 * PRIOR[1]:g} % for one effect (half of "
        "it where one alone is tried), "
        f"{100.0 * PRIOR[2]:g} % for two; no more than two are tried. A nominal model that fails the predictive test "
        f"counts {REFUSED:g} of that where something is likelier by as much.",
        f"A second effect must add a factor e^{SECOND:g} of evidence: one in another form than ours looks like two.",
        "Evidence is Laplace's approximation; a parameter costs no more than a unit information prior says, however "
        "sharply the data know it.",
        "Intervals are 90 % likelihood ratios along the ridge of the posterior, whose deviation counts up to "
        f"{MOST_FACTOR:g} times where trials pull in different directions or the fit stopped short, and what "
        "multiplies a nominal number, or adds to a nominal force, is known no better than that.",
    ]
    if dataset.sensor.tracked_point is None:
        said.append(
            "Positions are taken to be of the body's centre of mass: the sensor does not say, and so an offset of the "
            "mass explains them alone, and clearly better than if they are of the centre of the shape."
            if sensor.tracked_point == "centre_of_mass"
            else "Positions are taken to be of the centre of the body's shape, for the sensor does not say."
        )
    if dataset.sensor.z_origin_tolerance_m is None and any(comparison.heights):
        said.append(
            "Heights are taken to be measured from a zero of their own in each trial, not from the substrate: the data "
            "clearly ask for it, and the sensor does not say."
            if sensor.height_tolerance_m > 0.0
            else "Heights are taken to be measured from the substrate, for the sensor does not say."
        )
    if attribution.refused:
        names = ", ".join(" + ".join(effects) for effects in attribution.refused)
        said.append(
            f"What evidence ranks first as nearly alike, and trials left out refuse, or its own run, which comes no "
            f"nearer to the data, counts {REFUSED:g} of that beside one of which neither does: {names}."
        )
    tracks = [trial.track for trial in comparison.dataset.trials if trial.track is not None]
    observed = [reader.observed for reader in comparison.readers]
    if any(one.frames - one.lost > len(one.time_s) and not one.slid_m for one in observed):
        said.append("Of long tracks, frames at even distances are compared; the others add next to nothing.")
    if any(one.slid_m for one in observed):
        said.append(
            "Of a robot that slides without a field, half of its way is compared, and that it slides as an outcome: "
            "where it catches again is up to the spot."
        )
    if any(one.heading_turn < 2.0 * pi for one in observed):
        why = "as the sensor says" if dataset.sensor.heading_of else "for all lie within half a turn"
        said.append(f"Headings are taken to be of an axis of which nobody knows which end is which, {why}.")
    if any(np.isnan(column).any() for track in tracks for column in track.channels.values()):
        said.append(
            "Lost frames, and frames after the robot has left the view, are not compared: it is not at rest then."
        )
    if not folds(Fitter(comparison)):
        said.append(
            "With one measured trial none can be left out: the gap is that of the fit itself, and proves nothing."
        )
    return tuple(said)
