"""A diagnosis in plain words."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping, Sequence
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from ...effects.catalogue import CATALOGUE
from ..diagnosis import Diagnosis
from ..quantity import handy_unit, percent, rounded, sigmas, with_interval, with_sigma
from ..result import EffectEstimate, Failing, NextTrial, Region, WrenchMean
from ..where.wrench_maps import SIGNIFICANT
from .caution import cautions
from .condition import condition_of, condition_of_table
from .headline import CLOSED, ONE_PERCENT, gap_words, headline, nearer_words, only_uncertain
from .phrase import meaning_of, title_of, unit_of

__all__ = [
    "LEAVES",
    "NO_TRIAL",
    "observation_words",
    "points",
    "reason_words",
    "region_words",
    "set_words",
    "summary",
]

Floats = NDArray[np.float64]

# What is tied stays so.
NO_TRIAL = "of the trials that were simulated, none tells them apart, in this direction or another."

_WIDTH = 100
_LABEL = 13
# Share of the trials from which on they are counted rather than listed.
_SPREAD = 0.5
_MOST_REGIONS, _MOST_VALUES, _MOST_RULED_OUT, _MOST_FAILING = 3, 4, 6, 3
# Gaps below this are held against what is allowed, sigmas.
_FINELY = 10.0
# A trial that tells so many times as much is worth a lab's trouble.
_MUCH_MORE = 2.0
_WRENCH = (("force", "N", 0), ("torque", "N m", 3))
_MEASURED = ("time_s", "position_x_m", "position_y_m")
_END_SHARE = 0.2
_UNITS = {
    "time_s": "s",
    "frequency_Hz": "Hz",
    "field_strength_T": "T",
    "incline_deg": "degrees",
    "position_x_m": "m",
    "position_y_m": "m",
    "cycle_phase_deg": "degrees",
}
_AXES = {
    "trial": "trial",
    "time_s": "time",
    "frequency_Hz": "frequency",
    "field_strength_T": "field",
    "incline_deg": "slope",
    "position_x_m": "place x",
    "position_y_m": "place y",
    "cycle_phase_deg": "phase of the cycle",
    "contact_mode": "contact",
    "channel": "channel",
    "missing_force": "missing force along",
    "missing_torque": "missing torque about",
}
_PLACES = {
    "airborne": "in the air",
    "point": "in point contact",
    "line": "in line contact",
    "surface": "in surface contact",
    "not rotating": "in fields that do not rotate",
    "turning otherwise": "in fields from a table that turn",
}
_OBSERVATIONS = {
    "mean_speed_m_per_s": ("mean speed", "m/s"),
    "drift_m_per_s": ("drift along x", "m/s"),
    "tilt_deg": ("tilt", "degrees"),
}
_EVENTS = {
    "climbs": "climbs",
    "slides_away": "slides away, too fast for a speed to be noted,",
    "runs_away": "runs away, too fast for a speed to be noted,",
}


# Of these no speed is noted.
LEAVES = frozenset(_EVENTS) - {"climbs"}


def summary(diagnosis: Diagnosis) -> str:
    """Return a diagnosis in plain words for a terminal: the verdict, where, what, how far, ties, next, cautions.

    Parameters
    ----------
    diagnosis
        What `diagnose` returned.
    """
    lines = textwrap.wrap(headline(diagnosis), _WIDTH, break_on_hyphens=False)
    last = ""
    for label, text in (("verdict", _verdict(diagnosis)), *points(diagnosis)):
        start = f"  {label if label != last else '':{_LABEL}}"
        last = label
        lines += textwrap.wrap(
            text, _WIDTH, initial_indent=start, subsequent_indent=" " * len(start), break_on_hyphens=False
        )
    return "\n".join(lines)


def _verdict(diagnosis: Diagnosis) -> str:
    """Return the verdict as ``diagnosis.json`` has it, and whether something else would do as well."""
    tied = diagnosis.verdict == "explained" and any(effect.confounded_with for effect in diagnosis.effects)
    return f"{diagnosis.verdict}; what is tied would explain it as well" if tied else diagnosis.verdict


def points(diagnosis: Diagnosis, *, whole: bool = False) -> tuple[tuple[str, str], ...]:
    """Return what follows the verdict: labels and sentences, the most important first.

    Parameters
    ----------
    diagnosis
        What `diagnose` returned.
    whole
        Whether everything that is ruled out is named, as in the report, to which a terminal points for the rest.
    """
    said: list[tuple[str, str]] = [("why", text) for text in _failings(diagnosis)]
    where = _where(diagnosis)
    if where:
        said.append(("where", where))
    said += [("missing", text) for text in _missing(diagnosis)]
    said += [("what", _what(effect)) for effect in diagnosis.effects]
    said.append(("how far", _how_far(diagnosis)))
    said += [("tied", text) for text in _ties(diagnosis)]
    said += [("ruled out", text) for text in _ruled_out(diagnosis, None if whole else _MOST_RULED_OUT)]
    if diagnosis.next_trials:
        first, *others = diagnosis.next_trials
        nothing = "" if first.within_ranges else "none like those done so far tells them apart; beyond them "
        said += _next("next trial", nothing, first)
        telling = [
            t for t in others if not t.within_ranges and t.information_bits > _MUCH_MORE * first.information_bits
        ]
        # Beyond the ranges of the lab only where that is worth the trouble.
        for other in telling[:1]:
            said += _next("or", "", other)
    elif any(effect.confounded_with for effect in diagnosis.effects):
        said.append(("next trial", NO_TRIAL))
    said += [("caution", text) for text in cautions(diagnosis)]
    return tuple(said)


def set_words(names: tuple[str, ...]) -> str:
    """Return a hypothesis's effects in words."""
    return " + ".join(title_of(name) for name in names) if names else "the nominal model"


def region_words(region: Region) -> tuple[str, str]:
    """Return a region's axis and its extent in words: ``("frequency", "12 to 15 Hz")``."""
    axis = _AXES.get(region.axis, region.axis.replace("_", " "))
    if region.value is not None:
        return axis, region.value
    low, high = (np.nan if bound is None else bound for bound in (region.low, region.high))
    unit = _UNITS.get(region.axis, "")
    factor, written = handy_unit(max(abs(low), abs(high)), unit if region.axis != "time_s" else "")
    written = "s" if region.axis == "time_s" else written
    # Ends that were measured rather than set have more digits than they deserve.
    error = _END_SHARE * factor * (high - low) if region.axis in _MEASURED else None
    ends = list(dict.fromkeys(rounded(factor * bound, error) for bound in (low, high)))
    return axis, f"{' to '.join(ends)}{'' if written == '°' else ' '}{written}".rstrip()


def reason_words(why: str) -> str:
    """Return why a trial is proposed, effects by their titles and without the full stop."""
    for name in sorted(CATALOGUE, key=len, reverse=True):
        why = why.replace(name, title_of(name))
    return why.rstrip(".")


def observation_words(kind: str, mean: float, sigma: float) -> str:
    """Return what would be seen of a trial in words: ``mean speed 1.2 ± 0.1 mm/s``."""
    if kind in _EVENTS:
        return f"{_EVENTS[kind]} with {percent(mean)} probability"
    name, unit = _OBSERVATIONS.get(kind, (kind.replace("_", " "), ""))
    return f"{name} {with_sigma(mean, sigma, unit)}"


def _where(diagnosis: Diagnosis) -> str:
    by_axis: dict[str, list[Region]] = {}
    for region in diagnosis.where:
        if not region.axis.startswith("missing_"):
            by_axis.setdefault(region.axis, []).append(region)
    if not by_axis:
        return ""
    trials, measured = by_axis.get("trial", []), len(diagnosis.dataset.trials)
    spread = len(trials) > max(_SPREAD * measured, 1.0)
    if spread:
        del by_axis["trial"]
    # The share of an axis is what all its regions hold together.
    order = sorted(by_axis.values(), key=lambda regions: -sum(region.share_of_gap for region in regions))
    said = []
    if spread:
        most = max(trials, key=lambda region: region.share_of_gap)
        said.append(
            f"{len(trials)} of {measured} trials are off, {most.value} holds most ({percent(most.share_of_gap)})"
        )
    for regions in order[:_MOST_REGIONS]:
        words = [region_words(region) for region in regions[:_MOST_VALUES]]
        more = len(regions) - len(words)
        extent = ", ".join(extent for _, extent in words) + (f" and {more} more" if more else "")
        share = min(sum(region.share_of_gap for region in regions), 1.0)
        plural = "s" if len(regions) > 1 and words[0][0] in ("trial", "channel") else ""
        said.append(f"{percent(share)} of the gap at {words[0][0]}{plural} {extent}")
    return "; ".join(said) + "." + _in_parts(diagnosis)


def _in_parts(diagnosis: Diagnosis) -> str:
    """Return in which parts of the data alone something may act, and what: one of them, not all."""
    parts = []
    for region in diagnosis.where:
        if region.what is not None:
            axis, extent = region_words(region)
            # What sets in at a moment goes on to the end.
            there = f"from {extent.split(' ')[0]} s on" if region.axis == "time_s" else f"at {axis} {extent} alone"
            parts.append(f"{region.what} {there}, {percent(region.share_of_gap)} of the gap would be gone")
    return f" With {'; or, with '.join(parts)}." if parts else ""


def _failings(diagnosis: Diagnosis) -> Iterator[str]:
    """Return what keeps the best hypothesis from explaining the data."""
    best = "with the partial cause" if diagnosis.effects else "by the nominal model"
    off = [failing for failing in diagnosis.failings if failing.test == "a trial"]
    for failing in diagnosis.failings:
        if failing.test == "all trials":
            yield f"{_root(failing.left)} σ are left {best} over all trials, {_root(failing.allowed)} σ count as noise."
        elif failing.test == "a trial" and failing is off[0]:
            yield f"too much is left {best} in {_those(off)}."
        elif failing.test == "an outcome":
            yield f"the outcome of {', '.join(failing.trials)} is contradicted {best}."
        elif failing.test == "trials left out" and diagnosis.gap.held_out_trials:
            yield "trials that are left out of the fit are not foretold by the others."
        elif failing.test == "trials left out":
            yield "no trial could be left out of the fit, to see whether the others foretell it."
        elif failing.test == "the path" and diagnosis.gap.followed is not None:
            yield f"the simulated robot itself comes {nearer_words(diagnosis.gap.followed)} to the measured one."


def _those(off: Sequence[Failing]) -> str:
    """Return the trials that are farthest off with what is left of them, and what counts as noise."""
    words = [
        f"{failing.trials[0]} ({_root(failing.left)} σ, {_root(failing.allowed)} σ count as noise)"
        for failing in sorted(off, key=lambda failing: -(failing.left or 0.0) / (failing.allowed or 1.0))
    ]
    more = len(words) - _MOST_FAILING
    return ", ".join(words[:_MOST_FAILING]) + (f" and {more} more" if more > 0 else "")


def _root(mean_square: float | None) -> str:
    """Return a gap, told finely enough to be held against another."""
    gap = float("nan") if mean_square is None else mean_square**0.5
    return f"{gap:.2f}" if gap < _FINELY else sigmas(gap)


def _missing(diagnosis: Diagnosis) -> Iterator[str]:
    missing = diagnosis.missing_wrench
    if missing is None:
        return
    for part, unit, first in _WRENCH:
        found = _strongest(missing.by_frequency, first) or _strongest(missing.by_mode, first)
        if found is not None:
            label, axis, value, sigma = found
            direction = f"{'-' if value < 0.0 else '+'}{'xyz'[axis]}"
            size = with_sigma(abs(value), sigma, unit)
            yield f"the model lacks a {part} of {size} towards {direction} {_PLACES.get(label, f'at {label}')}."


def _strongest(by: Mapping[str, WrenchMean], first: int) -> tuple[str, int, float, float] | None:
    """Return the component of a force or a torque that is farthest from zero, in standard deviations."""
    best: tuple[str, int, float, float] | None = None
    highest = SIGNIFICANT
    for label, mean in by.items():
        for axis in range(3):
            value, error = float(mean.wrench[first + axis]), float(mean.sigma[first + axis])
            if error > 0.0 and abs(value) > highest * error:
                best, highest = (label, axis, value, error), abs(value) / error
    return best


def _what(effect: EffectEstimate) -> str:
    numbers = [
        f"{meaning_of(effect.name, key)} {with_interval(interval, unit_of(effect.name, key))}"
        f"{'' if interval.identified else ' (hardly narrowed by these data)'}"
        for key, interval in effect.parameters.items()
    ]
    return f"{title_of(effect.name)}, probability {percent(effect.probability)}: {'; '.join(numbers)}."


def _how_far(diagnosis: Diagnosis) -> str:
    gap = diagnosis.gap
    count = len(gap.held_out_trials)
    held_out = ""
    if count:
        held_out = (
            f"on {count} trials, each left out of a fit once: " if count > 1 else "on one trial, left out of the fit: "
        )
    refitted = f"with only the sensor's nuisances refitted: {gap_words(gap.after_nuisance_only)}"
    if count and gap.after_nuisance_only > gap.before + CLOSED:
        refitted += ", which is more, for it is foretold from the other trials"
    if diagnosis.verdict == "no_gap":
        stated = f"with a perfect sensor and the numbers as stated: {gap_words(gap.before)}; {refitted}"
        return f"{held_out}{gap_words(gap.after)} ({stated}; noise alone: {gap_words(gap.noise_floor)})."
    shrink = gap.shrink
    if not count:
        held_out = "in the fit itself, for no trial could be left out: "
    if count and isfinite(shrink.estimate):
        share = f"; the gap shrinks by {percent(shrink.estimate)}"
        # An interval of what is next to nothing would only repeat it.
        if isfinite(shrink.low) and isfinite(shrink.high) and shrink.high >= ONE_PERCENT:
            share += f" (90 % interval {100.0 * shrink.low:.0f} to {percent(shrink.high)})"
    else:
        share = ""
    said = (
        f"{held_out}from {gap_words(gap.before)} to {gap_words(gap.after)} ({refitted}; "
        f"noise alone: {gap_words(gap.noise_floor)}){share}."
    )
    if nearer := only_uncertain(diagnosis):
        said += " With the effects the computed motion is uncertain by as much: by the sensor's noise alone the"
        said += f" simulated robot comes {nearer} to the measured one."
    return said


def _ties(diagnosis: Diagnosis) -> Iterator[str]:
    for effect in diagnosis.effects:
        if effect.confounded_with:
            others = " or ".join(title_of(name) for name in effect.confounded_with)
            yield f"these trials cannot tell {title_of(effect.name)} from {others}."


def _ruled_out(diagnosis: Diagnosis, most: int | None) -> Iterator[str]:
    by_trial: dict[str, list[str]] = {}
    for name, trial in list(diagnosis.ruled_out.items())[:most]:
        by_trial.setdefault(trial, []).append(title_of(name))
    known = {trial.id: trial for trial in diagnosis.dataset.trials}
    said = [
        f"{', '.join(names)} by trial {trial}" + (f" ({condition_of(known[trial])})" if trial in known else "")
        for trial, names in by_trial.items()
    ]
    more = 0 if most is None else len(diagnosis.ruled_out) - most
    if said:
        yield "; ".join(said) + (f"; {more} more in the report" if more > 0 else "") + "."


def _next(label: str, before: str, proposed: NextTrial) -> list[tuple[str, str]]:
    """Return what a trial tells apart, and on a line of its own what each effect says of it."""
    # Before titles take the place of names, in which there may be any sign.
    reason, _, foretold = proposed.why.partition(": ")
    tells = f"{before}{condition_of_table(proposed.trial)}: {reason_words(reason)}."
    lines = [tells, *(f"{reason_words(says)}." for says in foretold.split("; ") if says)]
    lines.append(f"expected information over all of them: {rounded(proposed.information_bits)} bit.")
    return [(label, line) for line in lines]
