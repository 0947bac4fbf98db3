"""How far what a diagnosis points out overlaps what a cause affects."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from .records import Record
from .share import Share, share_of

__all__ = ["CLEAR", "all_trials", "halves", "overlap", "pointed_out", "regions"]

# From which strength on, sigma, a cause is clear enough to be looked for.
CLEAR = 3.0


def pointed_out(record: Record) -> set[str]:
    """Return the trials that a diagnosis points out."""
    where = [] if record.diagnosis is None else record.diagnosis["where"]
    return {entry["value"] for entry in where if entry["axis"] == "trial"}


def all_trials(record: Record) -> set[str]:
    """Return all trials of a dataset."""
    return set(record.answer.strength_by_trial)


def overlap(record: Record, pointed: set[str]) -> float | None:
    """Return what both share of the trials pointed out or affected, where a part of the trials is affected."""
    affected = set(record.answer.affected_trials)
    if record.diagnosis is None or not affected or affected == all_trials(record):
        return None
    if record.answer.strength_sigma < CLEAR:
        return None
    return len(affected & pointed) / len(affected | pointed)


def halves(overlaps: Mapping[str, float]) -> Share:
    """Return how many overlaps are a half or more."""
    return share_of([overlap >= 0.5 for overlap in overlaps.values()])


def regions(records: Sequence[Record]) -> dict[str, Share]:
    """Return by axis how many regions in which a clear cause acts are overlapped by half or more."""
    found: dict[str, list[bool]] = {}
    for record in records:
        if record.diagnosis is None or record.answer.strength_sigma < CLEAR:
            continue
        for axis, (low, high) in record.answer.where.items():
            said = [
                (entry["low"], entry["high"])
                for entry in record.diagnosis["where"]
                if entry["axis"] == axis and entry.get("low") is not None and entry.get("high") is not None
            ]
            # A region across the cycle's end goes on beyond 360 degrees.
            turns = (-360.0, 0.0, 360.0) if axis == "cycle_phase_deg" else (0.0,)
            true = [(low + turn, high + turn) for turn in turns]
            found.setdefault(axis, []).append(any(_shared(one, region) >= 0.5 for one in true for region in said))
    return {axis: share_of(hits) for axis, hits in sorted(found.items())}


def _shared(first: tuple[float, float], second: tuple[float, float]) -> float:
    """Return intersection over union of two intervals: a region that covers everything points nowhere."""
    both = min(first[1], second[1]) - max(first[0], second[0])
    union = max(first[1], second[1]) - min(first[0], second[0])
    return max(both, 0.0) / union if union > 0.0 else 1.0
