"""What is concluded of a gap once every hypothesis is fitted: the verdict, and each part of a diagnosis."""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter

import numpy as np

from ..dataset import Dataset
from ..progress import OnPhase
from ..version import __version__
from .assumptions import assumptions
from .diagnosis import Diagnosis
from .fitting.fitter import Fitter
from .gap.comparison import Comparison
from .gap.job import Job
from .gap.loss import robust_cost
from .gap.predictive import failings, is_explained
from .how_far.followed import LEAST_FOLLOWED, followed
from .how_far.held_out import HeldOut, held_out, is_foretold, shrink
from .how_far.overlay import overlays
from .result import EffectEstimate, Failing, HeatMap, Interval, NextTrial, RankedHypothesis, Region, TrialFloor, Verdict
from .what.attribute import Attribution, seen_from_the_best
from .what.contender import Contender
from .what.estimate import intervals
from .what.own_noise import lead_around
from .what.ruled_out import ruled_out
from .what.verdict import judge, refused, ties
from .what_next.next_trial import in_one_step, next_trials
from .what_next.posterior import samples
from .what_next.rivals import rivals
from .where.localise import localise
from .where.wrench import missing_wrench
from .where.wrench_maps import wrench_regions

__all__ = ["Conclusion"]

# Hypotheses whose gap is measured on trials left out, and how probable they must be (the best is always measured).
_MEASURED, _PROBABLE = 3, 0.02
# Draws of each hypothesis that a next trial is sought for.
_SAMPLES = 24
# What a rival weighs at least in the information of a trial: tied by likelihood alone, it may be next to improbable.
_LEAST_WEIGHT = 0.02


class Conclusion:
    """What every hypothesis fitted to a dataset leads to.

    Parameters
    ----------
    dataset
        As the lab gave it.
    comparison
        Of what the sensor is read as, with the noise around the best hypothesis.
    attribution
        Every hypothesis, fitted.
    seed
        Of what is drawn.
    tell
        Is told of progress.
    """

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
        held = self.comparison.simulator.resolves(best.effects) and is_explained(self.comparison, best.residual)
        if not (held and self.stands(best)):
            self.attribution, self.measured, self.comparison.floors = before, measured, floors

    def diagnosis(self, start: float) -> Diagnosis:
        """Return the diagnosis that was begun at `start`, in seconds of `perf_counter`."""
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
        proposed = self._next(chosen, tied, verdict)
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
            ruled_out=ruled_out(self.fitter, attribution, chosen, tied),
            heat_maps=maps,
            missing_wrench=wrench,
            overlays=shown,
            floors=floors,
            assumptions=assumptions(self.dataset, comparison, attribution),
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

    def _next(self, chosen: Contender, tied: dict[str, tuple[str, ...]], verdict: Verdict) -> tuple[NextTrial, ...]:
        between = rivals(self.attribution, chosen, tied, verdict)
        if len(between) < 2:
            return ()
        hypotheses = []
        for k, contender in enumerate(between):
            self.tell("the next trial", k, len(between) + 1)
            hypotheses.append((contender.names, samples(self.fitter, self.attribution, contender, _SAMPLES, self.seed)))
        self.tell("the next trial", len(between), len(between) + 1)
        weights = [max(contender.probability, _LEAST_WEIGHT) for contender in between]
        dataset = self.comparison.dataset
        simulator = in_one_step(dataset, hypotheses, self.comparison.simulator.threads)
        return next_trials(dataset, simulator, hypotheses, self.seed, weights)

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
