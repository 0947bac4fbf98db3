"""What a reader of a diagnosis should not overlook."""

from __future__ import annotations

from math import isfinite

from ...dataset import likely_slips
from ...effects.catalogue import CATALOGUE
from ...effects.parameter import Nuisance
from ..diagnosis import Diagnosis
from ..plausible import neutral_values, plausible_ranges, turning_keys
from ..quantity import percent, sigmas
from ..result import RankedHypothesis
from ..what.tolerated import is_tolerated
from .phrase import meaning_of, title_of

__all__ = ["cautions"]

_FEW_TRIALS = 3
_UNSURE = 0.8
# Share of the range within which an estimate counts as being at its end.
_AT_END = 0.01
_MANY_LOST = 0.5
# Share of the catalogue below which what was tried is a choice of the user's, and not what can be at work at all.
_PART = 0.5
# What the tolerances leave open of an outcome, in its noise: beyond so much it hardly counts.
_MUCH_OPEN = 5.0
# What a lab calls a nuisance that is none of the origin in the picture.
_SLIPS: dict[Nuisance, str] = {"clock": "clock", "origin z": "zero of z"}


def cautions(diagnosis: Diagnosis) -> tuple[str, ...]:
    """Return sentences on what weakens a diagnosis, none where nothing does.

    Parameters
    ----------
    diagnosis
        What `diagnose` returned.
    """
    return (*likely_slips(diagnosis.dataset), *_of_effects(diagnosis), *_of_trials(diagnosis))


def _of_effects(diagnosis: Diagnosis) -> list[str]:
    said = []
    for effect in diagnosis.effects:
        if effect.probability < _UNSURE:
            said.append(
                f"{title_of(effect.name)} has a probability of {percent(effect.probability)} only: see the ranking."
            )
        ranges, neutral = plausible_ranges(diagnosis, effect.name), neutral_values(effect.name)
        turning = turning_keys(effect.name)
        for key, interval in effect.parameters.items():
            # An angle that turns on has no end.
            if key in turning:
                continue
            low, high = ranges.get(key, (-float("inf"), float("inf")))
            margin = _AT_END * (high - low)
            ends = ((low, interval.estimate - low), (high, high - interval.estimate))
            # A range can end at the neutral value: what is near that is weak, and not at an end.
            at_end = isfinite(margin) and any(off < margin and end != neutral[key] for end, off in ends)
            if at_end and not interval.low <= neutral[key] <= interval.high:
                said.append(
                    f"{meaning_of(effect.name, key)} is at the end of its plausible range: the true cause may be "
                    "another one that looks similar."
                )
        if is_tolerated([one for one in diagnosis.chosen if one.name == effect.name], diagnosis.dataset):
            said.append(
                f"{title_of(effect.name)} says no more than that a nominal number is off by what its tolerance allows: "
                "measure that number first."
            )
        if effect.name == "camera_calibration":
            said.append("a camera that is off is a gap of the measurement: calibrate it before any physics is added.")
    tried = sum(len(ranked.effects) == 1 for ranked in diagnosis.ranking)
    if diagnosis.verdict == "explained" and tried < _PART * len(CATALOGUE):
        said.append(
            f"only {tried} of the {len(CATALOGUE)} effects of the catalogue {'was' if tried == 1 else 'were'} tried: "
            "another may explain the gap as well."
        )
    likeliest = diagnosis.ranking[0]
    if diagnosis.verdict == "no_gap" and likeliest.effects:
        names = " with ".join(title_of(name) for name in likeliest.effects)
        said.append(
            f"{names} has a probability of {percent(likeliest.probability)}, but the nominal model follows the data to "
            "within noise too: less noise or other trials would tell."
        )
    if diagnosis.verdict != "no_gap" and diagnosis.dataset.substrate.adhesion_N_per_m2 == 0.0:
        said.append(
            "the substrate is stated without adhesion, and what multiplies it (adhesion coefficient, line contact "
            "adhesion) cannot be tried: where the robot may stick, state adhesion_N_per_m2."
        )
    if (closing := _pair_that_would(diagnosis)) is not None:
        pair = " with ".join(map(title_of, closing.effects))
        said.append(
            f"{pair} would leave {sigmas(closing.gap)} σ where they are fitted "
            f"(probability {percent(closing.probability)}): two effects have to be clearly likelier than one, for what "
            "acts in a form of its own looks like two."
        )
    if diagnosis.verdict == "unexplained" and diagnosis.effects:
        said.append("the partial cause may be wrong altogether: it only follows the data better than the others.")
    return said


def _pair_that_would(diagnosis: Diagnosis) -> RankedHypothesis | None:
    """Return the likeliest pair that would leave little enough over all trials, where one effect leaves too much."""
    allowed = next((failing.allowed for failing in diagnosis.failings if failing.test == "all trials"), None)
    if allowed is None or len(diagnosis.effects) != 1:
        return None
    pairs = (ranked for ranked in diagnosis.ranking if len(ranked.effects) > 1 and ranked.probability > 0.0)
    return next((pair for pair in pairs if pair.gap**2 <= allowed), None)


def _of_trials(diagnosis: Diagnosis) -> list[str]:
    said = []
    trials = diagnosis.dataset.trials
    if len(trials) < _FEW_TRIALS:
        count = "one trial" if len(trials) == 1 else f"{len(trials)} trials"
        said.append(f"{count} can hardly show that an effect carries over to others.")
    if all(trial.track is None for trial in trials):
        said.append("there are no tracks: outcomes alone leave many effects possible.")
    lost = [f.trial for f in diagnosis.floors if f.frames > 0 and f.lost > _MANY_LOST * f.frames]
    if lost:
        said.append(f"more than half of the frames are lost in {', '.join(lost)}.")
    if diagnosis.z_origin_tolerance_m and diagnosis.dataset.sensor.z_origin_tolerance_m is None:
        said.append(
            "heights were taken to be from a zero of their own in each trial: the data ask for it, the sensor does not "
            "say. That hides what raises the robot all along. State z_origin_tolerance_m, 0 if z is from the substrate."
        )
    empty = [f.trial for f in diagnosis.floors if f.compared == 0]
    if empty:
        said.append(f"nothing could be compared in {', '.join(empty)}.")
    # Where all is followed to within noise, it does not matter which end noise took it to.
    off = [f.trial for f in diagnosis.floors if f.at_tolerance] if diagnosis.verdict != "no_gap" else []
    if off:
        names = sorted({_SLIPS.get(name, "origin") for f in diagnosis.floors for name in f.at_tolerance})
        said.append(
            f"the {' and the '.join(names)} of {', '.join(off)} had to be taken to the end of what [sensor] allows: is "
            "time zero the field's start, the origin the robot's start, and z zero on the substrate, in each of them? "
            "A zero that is off in one trial and not in another looks like physics."
        )
    rough = [f.trial for f in diagnosis.floors if f.numerical_sigmas > 1.0]
    if rough:
        said.append(f"the simulation's own error is above the noise in {', '.join(rough)}, and counted as noise there.")
    open_ = [f.trial for f in diagnosis.floors if f.frames == 0 and f.tolerance_sigmas > _MUCH_OPEN]
    if open_:
        said.append(
            f"the nominal numbers' tolerances alone move the outcome of {', '.join(open_)} by more than {_MUCH_OPEN:g} "
            "times its noise: it counts little."
        )
    return said
