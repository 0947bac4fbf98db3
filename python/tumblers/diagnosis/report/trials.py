"""The report's parts on single trials: before and after, what to do next, and the noise floor."""

from __future__ import annotations

from collections.abc import Collection
from html import escape
from math import isfinite

from ...dataset import LabTrial
from ...dataset.climb import CLIMBED
from ...page import data_table, figure, grid, listed, text
from ...section import write_entry
from ..diagnosis import Diagnosis
from ..plots.overlay import plot_overlay
from ..plots.svg import WIDTH_IN, svg_bytes
from ..quantity import plain, rounded, sigmas
from ..result import NextTrial
from ..wording.condition import condition_of, condition_of_table
from ..wording.phrase import title_of
from ..wording.words import LEAVES, NO_TRIAL, observation_words, reason_words, set_words

__all__ = ["floor_part", "next_part", "overlay_part"]

_MOST_OVERLAYS = 6
_CLIMBS = "climbed_share"
# Kinds of outcome in words, with their units.
_OUTCOMES = {
    "mean_speed_m_per_s": ("mean speed", "m/s"),
    "tilt_deg": ("tilt", "degrees"),
    _CLIMBS: ("climbs", "1"),
}


def overlay_part(diagnosis: Diagnosis) -> str:
    """Return what was measured over the model before and after, trial by trial, as HTML."""
    by_trial = diagnosis.gap.by_trial
    tracked = [overlay for overlay in diagnosis.overlays if overlay.measured]
    # The order of the dataset, but the widest gaps before the others.
    order = sorted(tracked, key=lambda overlay: -_finite(by_trial.get(overlay.trial, (0.0,))[0]))
    first = [overlay for overlay in tracked if overlay in order[:_MOST_OVERLAYS]]
    rest = [overlay for overlay in tracked if overlay not in first]
    pictures, others = (
        grid(
            figure(
                svg_bytes(lambda f, drawn=overlay: plot_overlay(drawn, f), WIDTH_IN, 3.0),  # type: ignore[misc]
                f"Trial {overlay.trial}",
                _caption(diagnosis, overlay.trial),
            )
            for overlay in part
        )
        for part in (first, rest)
    )
    if others:
        pictures += f"<details><summary>{len(rest)} more trials, with smaller gaps</summary>\n{others}</details>\n"
    rows = [
        [escape(overlay.trial), _OUTCOMES[kind][0], *(escape(_outcome(kind, value)) for value in values)]
        for overlay in diagnosis.overlays
        for kind, values in overlay.outcomes.items()
    ]
    table = data_table(["trial", "outcome", "measured", "nominal", "with the effects"], rows, numbers=(2, 3, 4))
    if not pictures and not table:
        return ""
    fitted = (
        "a fit that has not seen the trial" if diagnosis.gap.held_out_trials else "the fit, for none could be left out"
    )
    words = (
        f"Measured (dots), nominal (dashed) and with the effects (solid), their parameters from {fitted}; the sensor's "
        "nuisances and the nominal numbers, within their tolerances, are fitted in both. The band is what counts as "
        "noise at each frame, two standard deviations to either side: the sensor's, and what step and tolerances leave "
        "open. Where that is more than the sensor's, neighbouring frames are off alike and count as few."
    )
    return text(words, "soft") + pictures + table


def next_part(diagnosis: Diagnosis) -> str:
    """Return the ties and the trials that would undo them, as HTML."""
    tied = [
        f"These trials cannot tell {title_of(effect.name)} from {' or '.join(map(title_of, effect.confounded_with))}."
        for effect in diagnosis.effects
        if effect.confounded_with
    ]
    proposed = "".join(_proposal(i + 1, trial) for i, trial in enumerate(diagnosis.next_trials))
    if tied and not proposed:
        proposed = text(f"{NO_TRIAL[:1].upper()}{NO_TRIAL[1:]}")
    return (listed(tied) or text("No effect that was tried is tied with the verdict.")) + proposed


def floor_part(diagnosis: Diagnosis) -> str:
    """Return the noise floor of each trial, as HTML."""
    rows = [
        [
            escape(floor.trial),
            escape(condition_of(diagnosis.dataset.trial(floor.trial))),
            plain(floor.step_s, "s"),
            rounded(floor.numerical_sigmas),
            rounded(floor.tolerance_sigmas),
            str(floor.frames),
            str(floor.lost),
            str(floor.compared),
            escape(_seen(diagnosis.dataset.trial(floor.trial))),
        ]
        for floor in diagnosis.floors
    ]
    heads = ["trial", "conditions", "step", "numerical", "tolerances", "frames", "lost", "compared", "seen"]
    words = (
        "What the numbers of each trial can at best be compared to, in noise sigmas: numerical, the change of the path "
        "when the step is halved; tolerances, its change with the nominal numbers' tolerances. Both are part of the "
        "floor, so that they are not taken for physics. Frames are the rows of a track's file, lost those of them "
        "without the robot; a row that was left out is in neither."
    )
    table = data_table(heads, rows, numbers=(2, 3, 4, 5, 6, 7))
    return text(words, "soft") + table if table else ""


def _proposal(number: int, proposed: NextTrial) -> str:
    rows = [
        [escape(set_words(tuple(name.split(" + ")))), escape(observation_words(kind, mean, sigma) + _whose(kind, said))]
        for name, said in proposed.predictions.items()
        for kind, (mean, sigma) in said.items()
    ]
    return (
        f"<h3>{number}. {escape(condition_of_table(proposed.trial))}</h3>\n"
        + text(f"{reason_words(proposed.why)}. Expected information: {rounded(proposed.information_bits)} bit.")
        + data_table(["if it is", "then it shows"], rows)
        + "<details><summary>As a trial of dataset.toml, once it has a track or an outcome</summary>"
        + f"<pre>{escape(write_entry('trial', {'id': f'next{number}', **proposed.trial}))}</pre></details>\n"
    )


def _whose(kind: str, said: Collection[str]) -> str:
    """Return that a number is of the runs that stay in view, where others do not."""
    leaves = not LEAVES.isdisjoint(said)
    return " where it stays in view" if leaves and kind not in {"climbs", *LEAVES} else ""


def _caption(diagnosis: Diagnosis, trial: str) -> str:
    values = diagnosis.gap.by_trial.get(trial)
    gap = ""
    if values is not None:
        perfect, refitted, after = map(sigmas, values)
        gap = f": {perfect} σ with a perfect sensor, {refitted} σ with the sensor refitted"
        gap += f", {after} σ with the effects" if diagnosis.effects else ""
    return condition_of(diagnosis.dataset.trial(trial)) + gap


def _seen(trial: LabTrial) -> str:
    seen = [] if trial.track is None else [", ".join(name.partition("_")[0] for name in trial.track.channels)]
    outcome = trial.outcome
    if outcome is not None:
        kinds = (("climbs", outcome.climbs), ("mean speed", outcome.mean_speed_m_per_s), ("tilt", outcome.tilt_deg))
        seen.append(", ".join(words for words, value in kinds if value is not None))
    return "; ".join(seen)


def _outcome(kind: str, value: float) -> str:
    if kind == _CLIMBS and isfinite(value):
        return "yes" if value >= CLIMBED else "no"
    return plain(value, _OUTCOMES[kind][1])


def _finite(value: float) -> float:
    return value if isfinite(value) else 0.0
