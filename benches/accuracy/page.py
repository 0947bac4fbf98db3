"""The section on time to accuracy, in Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import median

from peers.machine import conditions_in_words
from peers.page import table

from tumblers.model import MagneticTorque
from tumblers.step_choice import ACCURACY

from .case import DRAFT_DEG, SECONDS, THETA1_DEG, THETA2_DEG
from .comparison import AccuracyResults, Row
from .ladder import KNOWN_TO, STEPS_S, TORQUES
from .price import Group

__all__ = ["lines", "section"]

_SETUP = f"""The paper's robots for {SECONDS:g} s on its paper at 20 mT (the first cuboid at 10 mT), those of half size
on aluminium at 20 mT; without errors, and with a draft of {DRAFT_DEG:g}° and a magnetic axis that is off by
θ1 = {THETA1_DEG:g}° (the first cuboid's own 27°) and θ2 = {THETA2_DEG:g}°, a corner of the paper's tolerance.
The step goes from {1e3 * STEPS_S[0]:g} ms down to {1e6 * STEPS_S[-1]:.2g} µs by halves.

- *accurate*: speed, drift and twist after a cycle within {100 * ACCURACY:g} % of the converged ones. A displacement
  shorter than the perimeter of the hull counts as a share of that, a twist of less than a flip (45°) as a share of a
  flip: {100 * ACCURACY:g} % is then 10 to 25 µm of drift, and 0.45°.
- *converged*: the torque at the midpoint in the finest step. It is *known to* the greatest difference from it of that
  scheme in twice and four times the step, and of the torque at the start in the finest two. Where that is more than
  {100 * KNOWN_TO:g} % (**bold**) there is no value to be near to, and no time: the motion is chaotic, or needs finer
  steps than these.
- *step, time*: the longest step from which on all are accurate, and the processor's time of a simulated second in it,
  on one thread. A dash: not even the finest. **Bold**: the least time."""

_GROUPS = """*Reached*: in how many cases a step is accurate; *cheapest*: in how many of them the treatment takes the
least time; *time*: over the least of the case, geometric mean; a treatment that does not get there counts with the time
of the finest step, which is too little. *Best*: the least of these."""

_CHOSEN = """What `step_s = "auto"` ([scenario.md](scenario.md)) chooses by its error estimate, from 0.5 ms to 15.6 µs.
*Met*: in how many cases it finds a step whose estimate is at most 1 %; *error*: the greatest distance from the
converged value in the step that it then takes; *choosing*: processor time for a simulated second, the median of the
cases."""

_WORDS: dict[MagneticTorque, str] = {
    "start_of_step": "start of step",
    "end_of_step": "end of step",
    "midpoint": "midpoint",
}


def section(results: AccuracyResults) -> str:
    """Return the section.

    Parameters
    ----------
    results
        All figures.
    """
    rows = results.rows
    return "\n\n".join(
        [
            "## Time to accuracy",
            conditions_in_words(results.conditions),
            f"{_verdict(results.groups)} {_known(rows)}",
            _SETUP,
            "### Which treatment of the torque",
            _group_table(results.groups),
            _GROUPS,
            "### A step that is chosen by itself",
            _hidden(rows),
            _chosen_table(rows),
            _CHOSEN,
            "### Without errors",
            _case_table([row for row in rows if not row.ladder.case.errors]),
            "### With manufacturing errors",
            _case_table([row for row in rows if row.ladder.case.errors]),
        ]
    )


def _verdict(groups: Sequence[Group]) -> str:
    whole = groups[-1]
    kinds = "; ".join(f"{_WORDS[group.best]} {group.words}" for group in groups[:-1])
    return (
        f"Best of all cases is the torque at the **{_WORDS[whole.best]}**, accurate in {whole.reached[whole.best]} of"
        f" {whole.count} at {whole.over_cheapest[whole.best]:.2g} times the least time; by kind of case: {kinds}."
    )


def _known(rows: Sequence[Row]) -> str:
    unknown = [row.ladder for row in rows if not row.ladder.is_known]
    if not unknown:
        return f"All {len(rows)} cases converge."
    with_errors = sum(each.case.errors for each in unknown)
    return (
        f"In {len(unknown)} of {len(rows)} cases ({with_errors} of them with errors) the finest steps are too far apart"
        " to call a value converged."
    )


def _hidden(rows: Sequence[Row]) -> str:
    known = [row.ladder for row in rows if row.ladder.is_known]
    words = []
    for torque in TORQUES:
        found = [(hidden, ladder.case) for ladder in known for hidden in ladder.hidden(torque)]
        if not found:
            continue
        (step, change, error), case = max(found, key=lambda each: each[0][2])
        errors = " with errors" if case.errors else ""
        words.append(
            f"- {_WORDS[torque]}: {len(found)} steps, in {len({id(case) for _, case in found})} cases; the worst"
            f" {_shown(1e6 * step)} µs of the robot '{case.robot}'{errors} at {case.frequency_Hz:g} Hz, which halving"
            f" moves by {100 * change:.1g} % and which is off by {100 * error:.2g} %."
        )
    head = (
        f"Halving the step does not always show its error. Steps of the cases that converge, which halving moves by"
        f" {100 * ACCURACY:g} % or less and which are off by more:"
    )
    return "\n".join([head, "", *(words or ["- none."])])


def _chosen_table(rows: Sequence[Row]) -> str:
    ladders = [row.ladder for row in rows]
    body = []
    for torque in TORQUES:
        known = [each for each in ladders if each.is_known]
        met = [each for each in known if each.chosen[torque].met]
        others = [each for each in ladders if not each.is_known]
        errors = [each.yardstick.apart(each.chosen[torque].run, each.converged) for each in met]
        body.append(
            [
                _WORDS[torque],
                f"{len(met)} of {len(known)}",
                f"{100 * max(errors, default=0.0):.2g} %",
                f"{sum(each.chosen[torque].met for each in others)} of {len(others)}",
                f"{_shown(median(each.chosen[torque].ms for each in ladders) / SECONDS)} ms",
            ]
        )
    head = ["torque", "met where a value is known", "error, greatest", "met where none is", "choosing"]
    return table(head, body)


def _group_table(groups: Sequence[Group]) -> str:
    head = ["cases", "how many", *(f"{_WORDS[torque]}: reached, cheapest, time" for torque in TORQUES), "best"]
    body = [
        [
            group.words,
            str(group.count),
            *(
                f"{group.reached[torque]}, {group.cheapest[torque]}, {group.over_cheapest[torque]:.2g}"
                for torque in TORQUES
            ),
            f"**{_WORDS[group.best]}**",
        ]
        for group in groups
    ]
    return table(head, body)


def _case_table(rows: Sequence[Row]) -> str:
    head = [
        "robot",
        "Hz",
        "speed, mm/s",
        "drift, µm",
        "twist",
        "known to",
        *(f"{_WORDS[torque]}" for torque in TORQUES),
    ]
    return table(head, [_case_row(row) for row in rows])


def _case_row(row: Row) -> list[str]:
    ladder = row.ladder
    value = ladder.converged
    numbers = ["-", "-", "-"]
    if value is not None:
        numbers = [f"{1e3 * value.speed_m_per_s:.4g}", f"{1e6 * value.drift_m:z.0f}", f"{value.twist_deg:z.1f}°"]
    return [
        ladder.case.robot,
        f"{ladder.case.frequency_Hz:g}",
        *numbers,
        f"{100 * ladder.known_to:.2g} %" if ladder.is_known else f"**{100 * ladder.known_to:.2g} %**",
        *(_price(row, torque) for torque in TORQUES),
    ]


def _price(row: Row, torque: MagneticTorque) -> str:
    if row.prices is None:
        return ""
    price = row.prices[torque]
    if price.step_s is None:
        return "-"
    words = f"{_shown(1e6 * price.step_s)} µs, {_shown(price.ms_per_s)} ms"
    reached = [other.ms_per_s for other in row.prices.values() if other.step_s is not None]
    return f"**{words}**" if price.ms_per_s == min(reached) else words


def _shown(value: float) -> str:
    return f"{value:.0f}" if value >= 100.0 else f"{value:.3g}"


def lines(results: AccuracyResults) -> list[str]:
    """Return what the command says.

    Parameters
    ----------
    results
        All figures.
    """
    found = []
    for group in results.groups:
        times = ", ".join(
            f"{_WORDS[torque]} in {group.reached[torque]} at {group.over_cheapest[torque]:.2g} times the least time"
            for torque in TORQUES
        )
        found.append(f"{group.words}, {group.count} cases: best {_WORDS[group.best]}; accurate {times}")
    return [*found, _known(results.rows)]
