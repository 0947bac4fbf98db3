"""The scores as a page and as tables on a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from ..dataset import Tolerance
from .draw import CLEAR_SIGMA, LEAST_BESIDE_SIGMA, QUIET_SIGMA, QUIET_TRIAL_SIGMA, REPEATS
from .jitter import DIMENSIONS, NUMBERS
from .layout import STEADY_SIGMA
from .overlap import halves
from .repeated import TRIALS, Repeated
from .score import CORES, TIE_SIGMA, Criterion, Scores
from .share import Share
from .ties import SIZES

__all__ = ["page_of", "print_scores"]

_MET = {True: "yes", False: "no", None: "nothing to measure"}


def page_of(scores: Scores) -> str:
    """Return the page ``blind-results.md``.

    Parameters
    ----------
    scores
        The scores.
    """
    versions = ", ".join(scores.versions) or "unknown"
    parts = [
        "# Diagnoses of datasets whose cause is withheld",
        f"{scores.drawn} datasets drawn from seed {scores.seed}, {scores.datasets} of them tried, {scores.diagnosed} "
        f"diagnosed by version {versions}; those not tried do not count below."
        " Every answer was sealed before the diagnosis and its seal checked after it. Made by\n\n"
        f"```\ntumblers blind make --seed {scores.seed} --count {scores.drawn} --out DIR\n"
        "tumblers blind run DIR\ntumblers blind repeat DIR\n"
        "tumblers blind score DIR --answers DIR/answers.json --page blind-results.md\n```",
        "The strength of a cause is the root mean square of what it changes in all numbers that were observed, in "
        "standard deviations of their noise, after the sensor's stated tolerances (origin, clock, heading, scale) and "
        "a standard deviation of each nominal number have taken what they can.",
        _jitter(),
        "Easier than a lab's data in these ways: a lab drops a trial in which the nominal numbers' being off and the "
        f"world's own step alone show by more than {STEADY_SIGMA:g} sigma; it is drawn again where they would move "
        f"all its numbers by more than {QUIET_SIGMA:g} sigma, or one trial's by more "
        f"than {QUIET_TRIAL_SIGMA:g}, so that the most sensitive motions near step-out and the friction angle are "
        f"missing. A world whose motion depends on its own step by more than {QUIET_SIGMA:g} sigma and "
        f"{100.0 * REPEATS:.0f} % of what its causes change is drawn again, for a lab shows what it sees again: it is "
        f"taken where none else was found in a dozen labs. {_clear(scores)}"
        "An effect counts as named first where it leads the effects of the diagnosis, whatever the verdict; as truly "
        "tied where the diagnosis itself says that it cannot tell it from the first, and the first's estimate shows "
        "with the lab's "
        f"numbers what the truth, in its own form, shows with the world's, to {TIE_SIGMA:g} sigma, by simulation, "
        "or where a truth of one effect has another form what its effect shows in the catalogue's form, in "
        f"{SIZES[0]:g} to {SIZES[1]:g} times its size, "
        "after the sensor's tolerances and a standard deviation of each nominal number have taken what they can of the "
        "difference, as they do of a cause's strength.",
        "## What has to hold",
        _table(
            ("", "found", "wanted", "of", "met"),
            [(*_criterion_row(c), "**no**" if c.met is False else _MET[c.met]) for c in scores.criteria],
        ),
        "## What was named first",
        "Rows are truths, columns what a diagnosis said: the first effect where it is `explained`, else its verdict. "
        "Datasets with two effects are below.",
        _confusion(scores),
        "## Verdicts by kind of truth",
        _table(
            ("truth", "verdicts"),
            [
                (kind, ", ".join(f"{n} {word}" for word, n in said.items()) or "-")
                for kind, said in scores.verdicts.items()
            ],
        ),
        _explained(scores),
        _tied_by_effect(scores),
        _tied_pairs(scores),
        "## One effect, by its strength",
        _table(
            ("strength, sigma", "named first", "of"),
            [(name, _percent(s.share), str(s.count)) for name, s in scores.by_strength.items()],
        ),
        "## Calibration",
        "The stated probability of the best hypothesis against how often it was the truth, for truths in the catalogue "
        f"of 1 sigma or more and for no effect. Expected calibration error: {_number(scores.calibration_error)}.",
        _table(
            ("stated", "mean", "right", "of"),
            [(name, _number(said), _number(right), str(n)) for name, (said, right, n) in scores.reliability.items()],
        ),
        "## Parameters inside their 90 % interval",
        "Rightly named effects in the catalogue's form.",
        _table(
            ("effect", "inside", "of"),
            [(name, _percent(s.share), str(s.count)) for name, s in scores.coverage_by_effect.items()],
        ),
        "## Shrink",
        "Medians over single causes of 3 sigma or more, on trials that no fit saw. A shrink counts from a perfect "
        "sensor and the numbers as stated: refitting the clock, the origin, the heading and the scale alone shrinks "
        "the gap too, and of what that leaves, so much is the effects' own.",
        _table(
            ("form", "the sensor alone", "with the effects", "of what the sensor leaves"),
            [(form, *map(_number, medians)) for form, medians in scores.shrinks.items()],
        ),
        "## Where",
        "Overlap of the trials that were pointed out with those that the causes affect by 1 sigma or more (what both "
        "share over all of them), where that is a part of the trials; and regions of other axes in which a cause acts, "
        "overlapped by half or more: what both intervals share over what they cover together, so that a region of "
        "everything does not count. A part of the cycle is no narrower than a frame of the trial that shows it most.",
        _table(
            ("axis", "by half or more", "of"),
            [
                _share_row("trial", halves(scores.overlaps)),
                _share_row("trial, if every one were pointed out", halves(scores.everywhere)),
                *(_share_row(axis, s) for axis, s in scores.regions.items()),
            ],
        ),
        "## Time",
        f"Mean {_number(scores.seconds_mean, 1)} s, longest {_number(scores.seconds_longest, 1)} s; wall time, each "
        f"diagnosis on {'one thread' if scores.threads == 1 else f'{scores.threads} threads'}, others beside it."
        + _repeated(scores),
        "## Every dataset",
        _table(
            ("dataset", "truth", "strength, sigma", "verdict", "named", "shrink", "s"),
            [
                (
                    str(row["dataset"]),
                    " + ".join(row["truth"]) or "none",
                    f"{row['strength_sigma']:.1f}",
                    str(row["verdict"]),
                    " + ".join(row["named"]) or "-",
                    _number(row["shrink"]),
                    _number(row["seconds"], 1),
                )
                for row in scores.rows
            ],
        ),
    ]
    return "\n\n".join(parts) + "\n"


def _jitter() -> str:
    assumed = {name.replace("_", " "): share for name, share in asdict(Tolerance()).items()}
    drawn = {name: DIMENSIONS if name in ("length", "height") else NUMBERS for name in assumed}
    same = [name for name, sigma in drawn.items() if sigma == assumed[name]]
    other = [f"{_share(share)} of {name}" for name, share in assumed.items() if name not in same]
    return (
        "The world's numbers are off from those that the lab believes, each by its own draw, with a standard deviation "
        f"of {_share(NUMBERS)}, the lengths of its shape with one of {_share(DIMENSIONS)}. These are the standard "
        f"deviations that the diagnosis itself assumes of {', '.join(same)}"
        + (f"; it assumes {', '.join(other)}" if other else "")
        + ". A lab whose numbers are worse than that is not among these."
    )


def _share(value: float) -> str:
    return f"{100.0 * value:g} %"


def _repeated(scores: Scores) -> str:
    said = ""
    for timed, which in ((True, f"of up to {TRIALS} trials"), (False, "of more")):
        again = [each for each in scores.repeated if each.is_timed == timed]
        if again:
            said += f" The slowest {which} again, {_time_of(again)}."
    return said


def _time_of(repeated: Sequence[Repeated]) -> str:
    longest = max(repeated, key=lambda again: again.seconds)
    cores = "" if longest.cores is None else f" (cores: {longest.cores})"
    said = f"one after another on {longest.threads} threads{cores}: at most {longest.seconds:.0f} s"
    there = [seconds for again in repeated if (seconds := again.seconds_on(CORES)) is not None]
    if longest.processor_s is not None and longest.seconds_on(CORES) not in (None, longest.seconds):
        said += (
            f", {longest.processor_s:.0f} s of the processors. On {CORES} cores that is at most {max(there):.0f} s by "
            "Amdahl's law, if what runs on all of these runs on all of those as well; it was not measured there"
        )
    return said


def _clear(scores: Scores) -> str:
    """Return what is to be seen, and what of two causes, which older answers do not tell."""
    two = (
        "either of two alone and where the other is at work"
        if scores.beside
        else "either of two alone, though not where the other is at work,"
    )
    least = f", of two with {LEAST_BESIDE_SIGMA:g} sigma of either beside the other at least" if scores.beside else ""
    return (
        f"Causes outside the catalogue, and {two} are to show {CLEAR_SIGMA:g} sigma; after every three labs another "
        f"pair is drawn. Where no lab has that, the strongest has to do{least}. "
    )


def print_scores(scores: Scores) -> None:
    """Print what has to hold, and the accuracy by strength, as tables.

    Parameters
    ----------
    scores
        The scores.
    """
    from rich.console import Console
    from rich.table import Table

    console = Console()
    title = f"{scores.drawn} datasets drawn, {scores.datasets} tried, {scores.diagnosed} diagnosed; every seal whole"
    table = Table(title=title)
    for heading in ("", "found", "wanted", "of", "met"):
        table.add_column(heading, overflow="fold")
    for criterion in scores.criteria:
        table.add_row(*_criterion_row(criterion), _MET[criterion.met])
    console.print(table)
    table = Table(title="one effect, by its strength")
    for heading in ("sigma", "named first", "of"):
        table.add_column(heading)
    for name, share in scores.by_strength.items():
        table.add_row(name, _percent(share.share), str(share.count))
    console.print(table)
    console.print(_explained(scores))
    console.print(_tied_by_effect(scores))
    console.print(_tied_pairs(scores))


def _explained(scores: Scores) -> str:
    said = scores.explained
    return f"Of {said.count} that are `explained`, {said.hits} name all that was at work and nothing else."


def _tied_by_effect(scores: Scores) -> str:
    return (
        f"Of the single effects that are truly tied {scores.tied_by_effect} are so in what their effect shows in the "
        f"catalogue's form, while their own form shows {TIE_SIGMA:g} sigma or more beside it."
    )


def _tied_pairs(scores: Scores) -> str:
    said = scores.both_or_tied
    return (
        f"Of {said.count} with two effects, {said.hits} have both named, or one of them and in the place of the other "
        "one with which that is truly tied."
    )


def _criterion_row(criterion: Criterion) -> tuple[str, str, str, str]:
    open_end = criterion.high == float("inf")
    if criterion.low == 0.0:
        wanted = f"at most {criterion.high:g}"
    elif open_end or criterion.high == 1.0:
        wanted = f"at least {criterion.low:g}"
    else:
        wanted = f"{criterion.low:g} to {criterion.high:g}"
    digits = 0 if open_end else 2
    return criterion.words, _number(criterion.value, digits), wanted, str(criterion.count)


def _confusion(scores: Scores) -> str:
    said = sorted({word for row in scores.confusion.values() for word in row})
    rows = [(truth, *(str(row.get(word, "")) for word in said)) for truth, row in scores.confusion.items()]
    return _table(("truth", *said), rows)


def _share_row(axis: str, share: Share) -> tuple[str, str, str]:
    return axis, _percent(share.share), str(share.count)


def _table(headings: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    if not rows:
        return "None."
    lines = [headings, ["---"] * len(headings), *rows]
    return "\n".join(f"| {' | '.join(cell.replace('|', '/') for cell in line)} |" for line in lines)


def _number(value: Any, digits: int = 2) -> str:
    return "-" if value is None else f"{value:.{digits}f}"


def _percent(share: float | None) -> str:
    return "-" if share is None else f"{100.0 * share:.0f} %"
