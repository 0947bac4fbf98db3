"""`score`: how well diagnoses met the truth."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from math import inf
from os import PathLike
from pathlib import Path
from statistics import mean, median
from typing import Any

from ..effects.catalogue import get
from ..errors import InputError, TumblersError
from .forms import law_of
from .jitter import Jitter
from .law import EffectLaw
from .overlap import CLEAR, all_trials, halves, overlap, pointed_out, regions
from .records import Record, read_records
from .repeated import TRIALS, Repeated
from .share import Share, share_of, together
from .ties import Tie, difference_sigma, effect_of, nearest_sigma

__all__ = ["CORES", "Criterion", "Scores", "TieCheck", "score", "score_records"]

FORMAT = "tumblers-blind-scores/2"
STRENGTH_BINS = ((0.0, 1.0), (1.0, 3.0), (3.0, 10.0), (10.0, inf))
PROBABILITY_BINS = ((0.0, 0.2), (0.2, 0.4), (0.4, 0.6), (0.6, 0.8), (0.8, 1.0))
# An effect named for another one is a tie where what it says differs from the true world by less than the noise, or
# from the true effect in the catalogue's form, after the sensor's tolerances and what the lab's numbers may be off have
# taken what they can of that.
TIE_SIGMA = 1.0
# Of a diagnosis, at most, and on how many cores.
CORES, _SLOWEST_S = 4, 180.0
# Whether a cause acts as the catalogue has it.
_FORMS = {"the catalogue's form": True, "another form": False}

TieCheck = Callable[[Record], Tie]


@dataclass(frozen=True, kw_only=True, slots=True)
class Criterion:
    """A number that has to be within bounds.

    Attributes
    ----------
    words
        What is measured.
    value
        What was found; None where there was nothing to measure.
    low, high
        The bounds.
    count
        Over how many.
    """

    words: str
    value: float | None
    low: float
    high: float
    count: int

    @property
    def met(self) -> bool | None:
        """Whether it is met; None where there was nothing to measure."""
        return None if self.value is None else self.low <= self.value <= self.high


@dataclass(frozen=True, kw_only=True, slots=True)
class Scores:
    """How well diagnoses met the truth.

    Attributes
    ----------
    seed, versions, datasets, diagnosed
        What was scored.
    drawn
        How many datasets there are, with those that have not been tried.
    confusion
        Truth (an effect, ``none``, ``outside``) to what was named first (an effect or the verdict) to a number, for
        datasets with at most one cause.
    by_strength
        Strength's bin, sigma, to how many single effects were named first.
    verdicts
        Kind of truth to verdict to a number.
    beside
        Whether the answers tell what each of two causes shows where the other is at work.
    explained
        How many of those that are ``explained`` name all that was at work and nothing else.
    tied_by_effect
        How many of the true ties of one effect are of its effect in the catalogue's form, and not of its own form.
    both_or_tied
        Of how many with two effects both are named, or one in a true tie with what is named in its place.
    reliability
        Stated probability's bin to (mean probability, share that was right, number).
    calibration_error
        Expected calibration error over these bins.
    coverage_by_effect
        Effect to how many of its parameters were inside their 90 % interval.
    overlaps, everywhere
        Dataset to the overlap of the trials that were pointed out with those affected; and with all trials, what would
        be found if every one were pointed out.
    regions
        Axis to how many regions in which a cause acts were overlapped, intersection over union, by half or more.
    shrinks
        Form to the medians of what refitting the sensor alone shrinks, of the shrink with the effects, and of what the
        effects shrink of what the sensor leaves.
    seconds_mean, seconds_longest, threads
        Time of a diagnosis, s, and the most threads that one had.
    repeated
        Those that were diagnosed again with nothing beside them.
    criteria
        What has to hold.
    rows
        One line per dataset.
    """

    seed: int
    versions: tuple[str, ...]
    datasets: int
    diagnosed: int
    confusion: Mapping[str, Mapping[str, int]]
    by_strength: Mapping[str, Share]
    verdicts: Mapping[str, Mapping[str, int]]
    beside: bool
    explained: Share
    tied_by_effect: int
    both_or_tied: Share
    reliability: Mapping[str, tuple[float, float, int]]
    calibration_error: float | None
    coverage_by_effect: Mapping[str, Share]
    overlaps: Mapping[str, float]
    everywhere: Mapping[str, float]
    shrinks: Mapping[str, tuple[float | None, float | None, float | None]]
    regions: Mapping[str, Share]
    seconds_mean: float | None
    seconds_longest: float | None
    threads: int
    repeated: tuple[Repeated, ...]
    criteria: tuple[Criterion, ...]
    rows: tuple[Mapping[str, Any], ...]
    drawn: int

    def to_json(self) -> str:
        """Return the scores as JSON."""
        table = asdict(self)
        for criterion, entry in zip(self.criteria, table["criteria"], strict=True):
            entry["met"] = criterion.met
            entry["high"] = None if criterion.high == inf else criterion.high
        return json.dumps({"format": FORMAT, **table}, indent=1, allow_nan=False) + "\n"


def score(directory: str | PathLike[str], answers: str | PathLike[str]) -> Scores:
    """Check every seal of a folder, and score its diagnoses.

    Parameters
    ----------
    directory
        The folder of datasets and diagnoses.
    answers
        The file with the answers.

    Raises
    ------
    InputError
        A file that is refused, or an answer that is not the sealed one.
    """
    seed, drawn = read_records(directory, answers)
    # A diagnosis that failed counts as wrong, one that has not been tried does not count.
    records = [record for record in drawn if record.diagnosis is not None or record.version is not None]
    if not records:
        raise InputError(
            "DIR", "no dataset that was diagnosed", "at least one: `tumblers blind run` comes first", directory
        )
    folder = Path(directory)
    scores = score_records(records, seed, lambda record: _tie_sigma(folder / record.dataset, record))
    return replace(scores, drawn=len(drawn))


def score_records(records: Sequence[Record], seed: int, tie: TieCheck) -> Scores:
    """Score records.

    Parameters
    ----------
    records
        Truths beside diagnoses.
    seed
        What the datasets were drawn from.
    tie
        Returns by how many sigma what was named in a record differs from the truth on its trials.
    """
    kinds = {kind: [r for r in records if r.answer.kind == kind] for kind in ("none", "one", "two", "outside")}
    clear = [r for r in kinds["one"] if r.answer.strength_sigma >= CLEAR]
    first = [_named_first(r) for r in clear]
    ties = [None if hit else _true_tie(r, tie) for hit, r in zip(first, clear, strict=True)]
    tied = [hit or found is not None for hit, found in zip(first, ties, strict=True)]
    reliability, calibration_error = _calibration(records)
    coverage = _coverage(records)
    covered = together(coverage.values())
    overlaps = {r.dataset: found for r in records if (found := overlap(r, pointed_out(r))) is not None}
    everywhere = {r.dataset: found for r in records if (found := overlap(r, all_trials(r))) is not None}
    by_axis = regions(records)
    shrinks = {form: _shrinks([r for r in clear if r.same_form == same]) for form, same in _FORMS.items()}
    seconds = [r.seconds for r in records if r.seconds is not None]
    repeated = [r.repeated for r in records if r.repeated is not None]
    same = [again.same for again in repeated]

    def criterion(words: str, share: Share, low: float, high: float = 1.0) -> Criterion:
        return Criterion(words=words, value=share.share, low=low, high=high, count=share.count)

    def middle(form: str, low: float) -> Criterion:
        count = sum(r.same_form == _FORMS[form] and _shrink(r) is not None for r in clear)
        return Criterion(words=f"median shrink, {form}", value=shrinks[form][1], low=low, high=1.0, count=count)

    criteria = (
        Criterion(words="datasets", value=float(len(records)), low=100.0, high=inf, count=len(records)),
        criterion("one effect of 3 sigma or more: named first", share_of(first), 0.90),
        criterion("one effect of 3 sigma or more: named first or truly tied", share_of(tied), 0.97),
        criterion("two effects: both named", share_of([_both_named(r) for r in kinds["two"]]), 0.70),
        criterion("no effect: no_gap", share_of([r.verdict == "no_gap" for r in kinds["none"]]), 0.95),
        criterion(
            "outside the catalogue: unexplained", share_of([r.verdict == "unexplained" for r in kinds["outside"]]), 0.85
        ),
        criterion("parameters inside their 90 % interval", covered, 0.80, 0.97),
        Criterion(
            words="expected calibration error",
            value=calibration_error,
            low=0.0,
            high=0.1,
            count=sum(count for _, _, count in reliability.values()),
        ),
        middle("the catalogue's form", 0.9),
        middle("another form", 0.7),
        criterion("where: affected trials overlapped by half or more", halves(overlaps), 0.80),
        criterion("where: regions of other axes overlapped by half or more", together(by_axis.values()), 0.80),
        _time(repeated),
        criterion("diagnosed again: the same answer", share_of(same), 1.0),
    )
    return Scores(
        seed=seed,
        versions=tuple(sorted({r.version for r in records if r.version is not None})),
        datasets=len(records),
        diagnosed=sum(r.diagnosis is not None for r in records),
        confusion=_confusion(records),
        by_strength={
            _bin_name(low, high): share_of(
                [_named_first(r) for r in kinds["one"] if low <= r.answer.strength_sigma < high]
            )
            for low, high in STRENGTH_BINS
        },
        verdicts={kind: _tally(r.verdict for r in of_kind) for kind, of_kind in kinds.items()},
        beside=any(cause.beside_sigma is not None for record in records for cause in record.answer.effects),
        tied_by_effect=sum(found is not None and found.world >= TIE_SIGMA for found in ties),
        both_or_tied=share_of([_both_named(r) or _true_tie(r, tie) is not None for r in kinds["two"]]),
        explained=share_of([set(r.named) == set(r.truth) for r in records if r.verdict == "explained"]),
        reliability=reliability,
        calibration_error=calibration_error,
        coverage_by_effect=coverage,
        overlaps=overlaps,
        everywhere=everywhere,
        shrinks=shrinks,
        regions=by_axis,
        seconds_mean=mean(seconds) if seconds else None,
        seconds_longest=max(seconds) if seconds else None,
        threads=max((r.threads for r in records), default=1),
        repeated=tuple(repeated),
        criteria=criteria,
        rows=tuple(_row(r) for r in records),
        drawn=len(records),
    )


def _tally(words: Any) -> dict[str, int]:
    found: dict[str, int] = {}
    for word in words:
        found[word] = found.get(word, 0) + 1
    return dict(sorted(found.items()))


def _bin_name(low: float, high: float) -> str:
    return f">={low:g}" if high == inf else f"{low:g}-{high:g}"


def _named_first(record: Record) -> bool:
    return record.named[:1] == record.truth[:1]


def _both_named(record: Record) -> bool:
    return set(record.truth) <= set(record.named)


def _true_tie(record: Record, tie: TieCheck) -> Tie | None:
    """Return the tie where the diagnosis says itself that it cannot tell, and simulation bears it out.

    Of one effect the first that is named is in its place, of two the one that was not at work.
    """
    if record.diagnosis is None or not record.named:
        return None
    effects = record.diagnosis["effects"]
    if len(record.truth) == 1:
        missed, instead = set(record.truth), effects[:1]
    else:
        missed, instead = set(record.truth) - set(record.named), [e for e in effects if e["name"] not in record.truth]
    if len(missed) != 1 or len(instead) != 1 or not missed <= set(instead[0].get("confounded_with", ())):
        return None
    found = tie(record)
    return found if min(found) < TIE_SIGMA else None


def _tie_sigma(folder: Path, record: Record) -> Tie:
    assert record.diagnosis is not None
    truth = [law_of(effect_of(e.name, e.parameters), e.form, e.form_seed) for e in record.answer.effects]
    try:
        chosen = [
            EffectLaw(effect_of(e["name"], {key: p["estimate"] for key, p in e["parameters"].items()}))
            for e in record.diagnosis["effects"]
        ]
    except TumblersError:
        return Tie(inf)
    # Estimates follow the world, whose numbers are off from the nominal ones: the truth is seen there.
    world = difference_sigma(folder, truth, chosen, Jitter.of_table(record.answer.jitter))
    if world < TIE_SIGMA or len(record.answer.effects) > 1 or record.same_form:
        return Tie(world)
    (cause,) = record.answer.effects
    return Tie(world, nearest_sigma(folder, effect_of(cause.name, cause.parameters), chosen))


def _time(repeated: Sequence[Repeated]) -> Criterion:
    """Return what has to hold of the slowest of up to `TRIALS` trials.

    On `CORES` where that is known of all, else where they ran.
    """
    timed = [again for again in repeated if again.is_timed]
    there = [seconds for again in timed if (seconds := again.seconds_on(CORES)) is not None]
    words, took = f"longest of the slowest of up to {TRIALS} trials again, alone", there
    if len(there) < len(timed):
        took = [again.seconds for again in timed]
    elif any(again.seconds not in there for again in timed):
        words += f", on {CORES} cores by Amdahl's law"
    elif there:
        words += f", on {CORES} cores"
    return Criterion(words=f"{words}, s", value=max(took, default=None), low=0.0, high=_SLOWEST_S, count=len(timed))


def _confusion(records: Sequence[Record]) -> dict[str, dict[str, int]]:
    table: dict[str, list[str]] = {}
    for record in records:
        if record.answer.kind == "two":
            continue
        truth = record.truth[0] if record.answer.kind == "one" else record.answer.kind
        said = record.named[0] if record.named and record.verdict == "explained" else record.verdict
        table.setdefault(truth, []).append(said)
    return {truth: _tally(said) for truth, said in sorted(table.items())}


def _calibration(records: Sequence[Record]) -> tuple[dict[str, tuple[float, float, int]], float | None]:
    """Return the reliability of the best hypothesis's probability, where the catalogue holds the truth and it shows."""
    stated: list[tuple[float, bool]] = []
    for record in records:
        seen = record.answer.kind == "none" or record.answer.strength_sigma >= 1.0
        if record.diagnosis is None or record.answer.kind == "outside" or not seen:
            continue
        ranking = record.diagnosis.get("ranking") or []
        if ranking:
            stated.append((float(ranking[0]["probability"]), set(ranking[0]["effects"]) == set(record.truth)))
    table: dict[str, tuple[float, float, int]] = {}
    error = 0.0
    for low, high in PROBABILITY_BINS:
        inside = [(p, right) for p, right in stated if low <= p < high or (high == 1.0 and p == 1.0)]
        if inside:
            said, right = mean(p for p, _ in inside), mean(float(right) for _, right in inside)
            table[f"{low:g}-{high:g}"] = (said, right, len(inside))
            error += len(inside) / len(stated) * abs(said - right)
    return table, error if stated else None


def _coverage(records: Sequence[Record]) -> dict[str, Share]:
    """Return how many parameters of rightly named effects, in the catalogue's form, are inside their interval."""
    found: dict[str, list[bool]] = {}
    for record in records:
        if record.diagnosis is None or not record.same_form or record.answer.kind not in ("one", "two"):
            continue
        named = {effect["name"]: effect["parameters"] for effect in record.diagnosis["effects"]}
        if set(named) != set(record.truth):
            continue
        for effect in record.answer.effects:
            for parameter in get(effect.name).parameters:
                key = parameter.key
                if key in effect.parameters and key in named[effect.name]:
                    inside = _inside(float(effect.parameters[key]), named[effect.name][key], parameter.turns)
                    found.setdefault(effect.name, []).append(inside)
    return {name: share_of(hits) for name, hits in sorted(found.items())}


def _inside(truth: float, interval: Mapping[str, float | None], turns: bool) -> bool:
    # An end that is no number is open.
    low = -inf if interval["low"] is None else interval["low"]
    high = inf if interval["high"] is None else interval["high"]
    return any(low <= truth + turn <= high for turn in ((-360.0, 0.0, 360.0) if turns else (0.0,)))


def _shrink(record: Record) -> float | None:
    if record.diagnosis is None:
        return None
    shrink = record.diagnosis["gap"].get("shrink")
    return None if not shrink or shrink.get("estimate") is None else float(shrink["estimate"])


def _shrinks(records: Sequence[Record]) -> tuple[float | None, float | None, float | None]:
    """Return medians: of the shrink by the sensor alone, of the shrink, and of the shrink of what the sensor leaves."""
    gaps = [r.diagnosis["gap"] for r in records if r.diagnosis is not None and _shrink(r) is not None]

    def middle(start: str, end: str) -> float | None:
        # Nothing can be shrunk of what is no more than noise.
        ratios = [
            1.0 - (gap[end] - gap["noise_floor"]) / (gap[start] - gap["noise_floor"])
            for gap in gaps
            if gap[start] is not None and gap[end] is not None and gap[start] > gap["noise_floor"]
        ]
        return median(min(max(ratio, 0.0), 1.0) for ratio in ratios) if ratios else None

    stated = [s for r in records if (s := _shrink(r)) is not None]
    alone, beyond = middle("before", "after_nuisance_only"), middle("after_nuisance_only", "after")
    return alone, median(stated) if stated else None, beyond


def _row(record: Record) -> dict[str, Any]:
    return {
        "dataset": record.dataset,
        "kind": record.answer.kind,
        "truth": [f"{e.name} ({e.form})" if e.form != "catalogue" else e.name for e in record.answer.effects],
        "strength_sigma": round(record.answer.strength_sigma, 2),
        "verdict": record.verdict,
        "named": list(record.named),
        "shrink": _shrink(record),
        "seconds": None if record.seconds is None else round(record.seconds, 1),
    }
