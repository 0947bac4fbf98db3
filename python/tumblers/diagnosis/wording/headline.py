"""The verdict of a diagnosis in one sentence."""

from __future__ import annotations

from math import isfinite

from ...field import RotatingField
from ..diagnosis import Diagnosis
from ..how_far.followed import LEAST_FOLLOWED
from ..quantity import percent, sigmas
from ..result import Gap
from .phrase import Phrase, phrase_of, title_of

__all__ = ["CLOSED", "ONE_PERCENT", "gap_words", "headline", "nearer_words", "only_uncertain"]

# Below this share of the gap an effect is not foretold by trials that were fitted without it.
_FORETOLD = 0.05
# A gap that is no more than so much above what noise gives is closed, sigmas.
CLOSED = 0.2
# Where less than this share of the gap is left once the sensor's nuisances are fitted, that is what effects are about.
_SLIPS = 0.1
# And where it is less than this, that they are about that alone is said.
_MOSTLY = 0.9
# What is tied and no likelier than this is not told as if it were known.
_LIKELIER_THAN_NOT = 0.5
# The interval of a shrink that ends below this would read from 1 to 1 %.
ONE_PERCENT = 0.015


def headline(diagnosis: Diagnosis) -> str:
    """Return the verdict in one sentence."""
    gap = diagnosis.gap
    floor = f"noise alone gives {gap_words(gap.noise_floor)}"
    if diagnosis.verdict == "no_gap":
        left = gap_words(gap.after)
        if gap.noise_floor == 0.0:
            return f"No gap: the nominal model contradicts no outcome (near the border of one, if at all: {left})."
        return f"No gap: the nominal model explains the data to within noise ({left}, {floor})."
    phrases = [phrase_of(effect, diagnosis.dataset) for effect in diagnosis.effects]
    if diagnosis.verdict == "explained" and phrases:
        return _capital(_of_causes(diagnosis, phrases))
    tried = sum(len(hypothesis.effects) == 1 for hypothesis in diagnosis.ranking)
    none = (
        f"none of the {tried} effects that were tried closes it" if tried > 1 else "no effect that was tried closes it"
    )
    refitted = f"{gap_words(gap.after_nuisance_only)} with the sensor refitted, "
    # Where the sensor takes next to nothing, or more is left with it, that would only be one more number.
    sensor = gap.before - gap.after_nuisance_only > CLOSED
    left = f"the gap is {gap_words(gap.before)} ({refitted if sensor else ''}{floor})"
    if not phrases:
        return f"Unexplained: {left}, and {none}."
    partial = " and ".join(f"{phrase.cause}, {phrase.amount.rstrip(',')}" for phrase in phrases)
    fitted = _fitted(diagnosis)
    if nearer := only_uncertain(diagnosis):
        return (
            f"Unexplained: {left}. It would be within what the computed motion is uncertain by if {partial}; but the "
            f"simulated robot itself comes {nearer} to the measured one."
        )
    if {failing.test for failing in diagnosis.failings} == {"trials left out"} and fitted < gap.noise_floor + CLOSED:
        return (
            f"Unexplained: {left}. It would close, to {gap_words(fitted)}, if {partial}; but too few trials show it to "
            "hold that against another."
        )
    return (
        f"Unexplained: {left}, and {none}. The best partial cause is that {partial}; "
        f"with it, {gap_words(gap.after)} are left."
    )


def _of_causes(diagnosis: Diagnosis, phrases: list[Phrase]) -> str:
    """Return what explains the gap, as what is known, or where others do as well as one of those that may."""
    gap = diagnosis.gap
    causes = " and ".join(phrase.cause for phrase in phrases) + _scope(diagnosis)
    amounts = " and ".join(phrase.amount.rstrip(",") if len(phrases) > 1 else phrase.amount for phrase in phrases)
    together = ", together," if len(phrases) > 1 else ""
    one = len(phrases) == 1 and not phrases[0].plural
    if min(gap.shrink.estimate, _own(gap)) < _FORETOLD:
        does = (
            f"{'closes' if one else 'close'} the gap, from {gap_words(gap.after_nuisance_only)} to "
            f"{gap_words(_fitted(diagnosis))} where it is fitted; the trials that show it are too few for the "
            "others to foretell it."
        )
    else:
        does = f"{'explains' if one else 'explain'} {_explained(gap)}."
    tied = [name for effect in diagnosis.effects for name in effect.confounded_with]
    shares = [effect.probability for effect in diagnosis.effects]
    if tied and min(shares) < _LIKELIER_THAN_NOT:
        alike = "either of two" if len(tied) == 1 else f"any of {1 + len(tied)}"
        which = f"{alike} effects may be the cause" if len(phrases) == 1 else "other effects may be the causes"
        likely = f"{'probability' if len(shares) == 1 else 'probabilities'} {' and '.join(map(percent, shares))}"
        return f"{which}; if {causes} ({likely}), {amounts}{together} {does}"
    if not tied:
        return f"{causes}: {amounts}{together} {does}"
    # What is told first is the likelier one, and still one of several that would do.
    others = title_of(tied[0]) if len(tied) == 1 and one else "another effect"
    return f"{causes}: {amounts}{together} {does.rstrip('.')}; {others} would as well."


def gap_words(gap: float) -> str:
    """Return a gap with its unit, and that it was not measured where it was not."""
    return f"{sigmas(gap)} σ" if isfinite(gap) else "not measured"


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def _explained(gap: Gap) -> str:
    if not isfinite(gap.shrink.estimate):
        return "the gap, though no trial was left to check it on"
    left, whole = gap.after_nuisance_only - gap.noise_floor, gap.before - gap.noise_floor
    if left < _MOSTLY * whole:
        share = "" if left < _SLIPS * whole else f"{percent(_own(gap))} of "
        return (
            f"{share}what refitting the sensor leaves of the gap on trials not fitted, "
            f"{gap_words(gap.after_nuisance_only)} that become {gap_words(gap.after)}"
        )
    return f"{percent(gap.shrink.estimate)} of the gap on trials not fitted"


def _own(gap: Gap) -> float:
    """Return what the effects shrink of the gap that the refitted sensor leaves, 1 where it leaves none."""
    left = gap.after_nuisance_only - gap.noise_floor
    return 1.0 - max(gap.after - gap.noise_floor, 0.0) / left if left > 0.0 else 1.0


def only_uncertain(diagnosis: Diagnosis) -> str:
    """Return how much nearer the simulated robot comes where effects close the gap without that, else nothing."""
    gap = diagnosis.gap
    if gap.followed is None or gap.followed >= LEAST_FOLLOWED or _fitted(diagnosis) >= gap.noise_floor + CLOSED:
        return ""
    return nearer_words(gap.followed)


def nearer_words(followed: float) -> str:
    """Return how much nearer the simulated robot comes to the measured one where that is too little."""
    return f"only {percent(followed)} nearer" if followed >= ONE_PERCENT else "no nearer"


def _fitted(diagnosis: Diagnosis) -> float:
    """Return the gap that the chosen effects leave where they are fitted."""
    names = {effect.name for effect in diagnosis.effects}
    return next(ranked.gap for ranked in diagnosis.ranking if set(ranked.effects) == names)


def _scope(diagnosis: Diagnosis) -> str:
    """Return at which of the dataset's frequencies most of the gap is, where not at all of them."""
    regions = [region for region in diagnosis.where if region.axis == "frequency_Hz"]
    used = sorted({t.field.frequency_Hz for t in diagnosis.dataset.trials if isinstance(t.field, RotatingField)})
    camera = [effect.name for effect in diagnosis.effects] == ["camera_calibration"]
    if not regions or len(used) < 2 or camera or regions[0].low is None or regions[0].high is None:
        return ""
    low, high = regions[0].low, regions[0].high
    if low <= used[0] and high >= used[-1]:
        return ""
    if high >= used[-1]:
        return f", mostly seen from {low:.3g} Hz up"
    if low <= used[0]:
        return f", mostly seen up to {high:.3g} Hz"
    return f", mostly seen at {low:.3g} Hz" if low == high else f", mostly seen from {low:.3g} to {high:.3g} Hz"
