"""Runs a result, reads its claims, and tries the suspects where one differs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import xarray as xr

from ..errors import TumblersError
from ..progress import OnProgress
from .choice import Choices
from .claim import Claim
from .paper_result import PaperResult
from .row import Row, Trial, Verdict
from .suspect import Suspect, suspects

__all__ = ["Examined", "examine", "most_runs"]


@dataclass(frozen=True, slots=True)
class Examined:
    """A result that was run.

    Attributes
    ----------
    result
        The result.
    data
        Its data, by the names of the sets of choices.
    rows
        A row for each claim and set.
    """

    result: PaperResult
    data: dict[str, xr.Dataset]
    rows: tuple[Row, ...]


class _Bench:
    """A result's data under any choices, each of them run once."""

    def __init__(self, result: PaperResult, threads: int, on_progress: OnProgress) -> None:
        self.result = result
        self.threads = threads
        self.on_progress = on_progress
        self.done = 0
        self._known: dict[Choices, xr.Dataset | TumblersError] = {}

    def data(self, choices: Choices) -> xr.Dataset:
        if choices not in self._known:
            before = self.done
            try:
                self._known[choices] = self.result.simulate(
                    choices, self.threads, lambda done: self.on_progress(before + done)
                )
            except TumblersError as error:
                self._known[choices] = error
        self.skip(1)
        found = self._known[choices]
        if isinstance(found, TumblersError):
            raise found
        return found

    def skip(self, times: int) -> None:
        self.done += times * self.result.runs
        self.on_progress(self.done)


def most_runs(result: PaperResult, tried: Sequence[Suspect] | None = None) -> int:
    """Return how many runs `examine` takes at most.

    Parameters
    ----------
    result, tried
        As in `examine`.
    """
    offered = tuple(result.suspects if tried is None else tried)
    return result.runs * sum(1 + len(suspects(offered, choices)) for choices in result.sets.values())


def examine(
    result: PaperResult, threads: int, on_progress: OnProgress, tried: Sequence[Suspect] | None = None
) -> Examined:
    """Run a result under each of its sets of choices, and the suspects for the sets where a row differs.

    Parameters
    ----------
    result
        The result.
    threads
        Number of threads, 0 for all; nothing depends on it.
    on_progress
        Told how many of `most_runs` are done or need not be done.
    tried
        The suspects; the result's own by default.

    Raises
    ------
    InputError, SimulationError
        A set of the result's own cannot be run; a suspect that cannot be run is a trial that says so.
    """
    offered = tuple(result.suspects if tried is None else tried)
    bench = _Bench(result, threads, on_progress)
    data: dict[str, xr.Dataset] = {}
    rows: list[Row] = []
    for name, choices in result.sets.items():
        data[name] = bench.data(choices)
        changes = suspects(offered, choices)
        ours = [claim.measure(data[name]) for claim in result.claims]
        verdicts = [_verdict(claim, value) for claim, value in zip(result.claims, ours, strict=True)]
        trials: list[list[Trial]] = [[] for _ in result.claims]
        if "differs" in verdicts:
            for suspect in changes:
                for i, trial in enumerate(_tried(bench, result.claims, suspect, choices)):
                    trials[i].append(trial)
        else:
            bench.skip(len(changes))
        rows += [
            Row(
                number=result.number,
                name=result.name,
                claim=claim,
                set_name=name,
                choices=choices,
                ours=value,
                verdict=verdict,
                trials=tuple(found) if verdict == "differs" else (),
                matching=verdicts.count("match"),
                of=len(verdicts),
            )
            for claim, value, verdict, found in zip(result.claims, ours, verdicts, trials, strict=True)
        ]
    return Examined(result, data, tuple(rows))


def _verdict(claim: Claim, ours: float | str) -> Verdict:
    return "match" if claim.tolerance.holds(claim.paper, ours) else "differs"


def _tried(bench: _Bench, claims: Sequence[Claim], suspect: Suspect, choices: Choices) -> list[Trial]:
    try:
        data = bench.data(suspect.applied(choices))
    except TumblersError:
        return [Trial(suspect.words, "a run that fails", "differs", 0, len(claims)) for _ in claims]
    ours = [claim.measure(data) for claim in claims]
    verdicts = [_verdict(claim, value) for claim, value in zip(claims, ours, strict=True)]
    matching = verdicts.count("match")
    return [
        Trial(suspect.words, value, verdict, matching, len(claims))
        for value, verdict in zip(ours, verdicts, strict=True)
    ]
