"""The report of a diagnosis: one HTML file that needs nothing else."""

from __future__ import annotations

from html import escape
from itertools import groupby
from math import isfinite
from operator import itemgetter

from ...page import bar, data_table, figure, grid, listed, page, section, text
from ..diagnosis import Diagnosis
from ..plausible import plausible_ranges
from ..plots.gap import plot_gap
from ..plots.parameters import plot_parameters
from ..plots.ranking import plot_ranking
from ..plots.svg import WIDTH_IN, svg_bytes
from ..quantity import handy_unit, percent, rounded, sigmas, with_interval
from ..wording.condition import condition_of
from ..wording.headline import headline
from ..wording.phrase import meaning_of, title_of, unit_of
from ..wording.words import points, set_words
from .trials import floor_part, next_part, overlay_part
from .where import where_part, wrench_part

__all__ = ["report_html"]

# What the gap "after" is of: without a partial cause of the nominal numbers too.
_LAST = {
    "no_gap": "and with the nominal numbers within their tolerances",
    "explained": "with the effects of the verdict",
    "unexplained": "with what follows the data best",
}
_VERDICTS = {"no_gap": "No gap", "explained": "Explained", "unexplained": "Unexplained"}
_MOST_RANKED = 30


def report_html(diagnosis: Diagnosis) -> str:
    """Return the report as one HTML document, figures and style inside.

    Parameters
    ----------
    diagnosis
        What `diagnose` returned.
    """
    title = diagnosis.dataset.title or "a dataset without a title"
    sections = [
        ("how-far", "How far", _how_far(diagnosis)),
        ("where", "Where", where_part(diagnosis)),
        ("wrench", "The missing wrench", wrench_part(diagnosis)),
        ("ranking", "What: the ranking", _ranking(diagnosis)),
        ("parameters", "Parameters", _parameters(diagnosis)),
        ("overlays", "Before and after", overlay_part(diagnosis)),
        ("next", "Ties and the next trial", next_part(diagnosis)),
        ("floor", "The noise floor", floor_part(diagnosis)),
        ("assumptions", "Assumptions", listed(diagnosis.assumptions)),
        ("again", "To repeat it", _again(diagnosis)),
    ]
    links = "".join(f'<a href="#{anchor}">{escape(words)}</a>' for anchor, words, content in sections if content)
    said = "".join(
        f"<dt>{escape(label)}</dt>" + "".join(f"<dd>{escape(words)}</dd>\n" for _, words in those)
        for label, those in groupby(points(diagnosis, whole=True), key=itemgetter(0))
    )
    body = (
        f"<h1>Diagnosis: {escape(title)}</h1>\n"
        f'<p class="verdict {diagnosis.verdict}"><b>{_VERDICTS[diagnosis.verdict]}</b>'
        f"{escape(headline(diagnosis))}</p>\n"
        f"<dl>\n{said}</dl>\n<nav>{links}</nav>\n"
    )
    return page(f"Diagnosis: {title}", body + "".join(section(*parts) for parts in sections))


def _how_far(diagnosis: Diagnosis) -> str:
    gap = diagnosis.gap
    known = {trial.id: trial for trial in diagnosis.dataset.trials}
    floor = gap.noise_floor
    highest = max([gap.before, gap.after, gap.after_nuisance_only, floor, 1e-9])
    bars = data_table(
        ["", "gap (noise sigmas)"],
        [
            [escape(words), bar(value / highest, sigmas(value))]
            for words, value in (
                ("nominal model, a perfect sensor", gap.before),
                ("with the sensor's nuisances refitted", gap.after_nuisance_only),
                (_LAST[diagnosis.verdict], gap.after),
                ("what noise alone gives", floor),
            )
        ],
    )
    table = data_table(
        ["trial", "conditions", "before", "sensor refitted", "after"],
        [
            [
                escape(trial),
                escape(condition_of(known[trial])) if trial in known else "",
                *(sigmas(value) for value in values),
            ]
            for trial, values in gap.by_trial.items()
        ],
        numbers=(2, 3, 4),
    )
    picture = ""
    if gap.by_trial:
        svg = svg_bytes(lambda f: plot_gap(gap, f.subplots()), WIDTH_IN, 1.4 + 0.24 * len(gap.by_trial))
        picture = grid([figure(svg, "Gap of each trial before and after")])
    count = len(gap.held_out_trials)
    held_out = f"{count} trial{'s' if count > 1 else ''}" if count else ""
    words = (
        "The gap is the root mean square difference between measurement and model over their uncertainty, in which "
        "what is beyond 4 sigma counts less than its square. "
    )
    words += (
        f"It is measured on trials that the fit had not seen ({held_out}, each left out once)."
        if held_out
        else "No trial could be left out of the fit, so that it is measured on the trials that were fitted."
    )
    shrink = ""
    if diagnosis.verdict != "no_gap" and isfinite(gap.shrink.estimate):
        share = percent(gap.shrink.estimate)
        shrink = text(
            f"Shrink, 1 - (after - noise) / (before - noise): {share}, 90 % interval "
            f"{percent(gap.shrink.low)} to {percent(gap.shrink.high)} by bootstrap over trials."
        )
    return text(words, "soft") + bars + shrink + picture + table


def _ranking(diagnosis: Diagnosis) -> str:
    if not diagnosis.ranking:
        return ""
    shown = diagnosis.ranking[:_MOST_RANKED]
    rows = [
        [
            escape(set_words(ranked.effects)),
            bar(ranked.probability, percent(ranked.probability)),
            sigmas(ranked.gap),
            "" if ranked.held_out_gap is None else sigmas(ranked.held_out_gap),
            "" if ranked.shrink is None else percent(ranked.shrink),
            f"{ranked.log_evidence:z.1f}",
        ]
        for ranked in shown
    ]
    heads = ["hypothesis", "probability", "gap, fitted", "gap, held out", "shrink", "log evidence"]
    top = [ranked for ranked in shown[:8] if ranked.probability >= 0.005] or list(shown[:1])
    names = sum(max(1, len(ranked.effects)) for ranked in top)
    svg = svg_bytes(lambda f: plot_ranking(top, f.subplots()), WIDTH_IN, 0.9 + 0.32 * names)
    words = (
        "Every hypothesis that was fitted, the best first. Gaps are in noise sigmas; held out means on trials that the "
        "fit had not seen, measured for the leading hypotheses. The evidence is relative to the nominal model. The "
        "probability of an effect, above, is that of all hypotheses with it together."
    )
    more = len(diagnosis.ranking) - len(shown)
    rest = text(f"{more} more, all less probable, are in diagnosis.json.", "soft") if more else ""
    return (
        text(words, "soft")
        + grid([figure(svg, "Probabilities of the hypotheses")])
        + data_table(heads, rows, numbers=(2, 3, 4, 5))
        + rest
    )


def _parameters(diagnosis: Diagnosis) -> str:
    rows = []
    for effect in diagnosis.effects:
        ranges = plausible_ranges(diagnosis, effect.name)
        for key, interval in effect.parameters.items():
            unit = unit_of(effect.name, key)
            rows.append(
                [
                    escape(title_of(effect.name)),
                    f"<code>{escape(key)}</code><br>{escape(meaning_of(effect.name, key))}",
                    escape(with_interval(interval, unit)),
                    escape(_span(interval.low, interval.high, unit)),
                    escape(_span(*ranges[key], unit)) if key in ranges else "",
                    "yes" if interval.identified else "hardly",
                ]
            )
    if not rows:
        return ""
    heads = ["effect", "parameter", "estimate", "90 % interval", "plausible range", "narrowed by the data"]
    svg = svg_bytes(lambda f: plot_parameters(diagnosis, f.subplots()), WIDTH_IN, 0.7 + 0.55 * len(rows))
    words = (
        "The keys are those of a scenario's [[effect]]. The bar is the plausible range, the dash the value that "
        "changes nothing; a hollow marker is a parameter that the data hardly narrow."
    )
    return text(words, "soft") + grid([figure(svg, "Parameters in their plausible range")]) + data_table(heads, rows)


def _again(diagnosis: Diagnosis) -> str:
    switches = (
        f"magnetic_torque {diagnosis.model.magnetic_torque}, adhesion_acts_at {diagnosis.model.adhesion_acts_at}, "
        f"adhesion_enters {diagnosis.model.adhesion_enters}"
    )
    words = f"tumblers {diagnosis.version}, seed {diagnosis.seed}; model: {switches}."
    toml = diagnosis.effects_toml()
    pasted = text("Paste into a scenario (effects.toml):", "soft") + f"<pre>{escape(toml)}</pre>\n" if toml else ""
    return text(words) + pasted


def _span(low: float, high: float, unit: str) -> str:
    factor, written = handy_unit(max(abs(low), abs(high)), unit)
    error = 0.1 * factor * (high - low)
    after = written if written in ("", "°") else f" {written}"
    return f"{rounded(factor * low, error)} to {rounded(factor * high, error)}{after}"
