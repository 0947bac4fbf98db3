"""Which stages of a diagnosis ask for its runs: ``python benches/diagnosis_stages.py FOLDER [--threads N]``.

A run belongs to the innermost function that is above fits and gaps: for its file see ``docs/how_it_decides.md``.
"""

from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path as FilePath
from time import perf_counter, process_time

import typer

from tumblers import dataset
from tumblers.diagnosis import diagnose
from tumblers.diagnosis.gap.job import Job
from tumblers.diagnosis.gap.pose import Path
from tumblers.diagnosis.gap.simulator import Simulator

_ROOMS = ("what", "where", "how_far", "what_next")


def stage() -> str:
    """Return the file and the function that ask, as ``what/pairs.py add``."""
    frame = sys._getframe(1)
    while frame is not None:
        file = FilePath(frame.f_code.co_filename)
        if file.parent.name in _ROOMS and file.parents[1].name == "diagnosis":
            return f"{file.parent.name}/{file.name} {frame.f_code.co_name}"
        frame = frame.f_back  # type: ignore[assignment]
    return "before all stages"


def main(folder: FilePath, threads: int = 1) -> None:
    """Diagnose a dataset, and print its stages by what their runs take."""
    spent: dict[str, list[float]] = defaultdict(lambda: [0.0, 0.0, 0.0])
    simulate = Simulator.run

    def watched(self: Simulator, jobs: Sequence[Job]) -> list[Path | None]:
        wall, processor = perf_counter(), process_time()
        found = simulate(self, jobs)
        mine = spent[stage()]
        for i, more in enumerate((len(jobs), perf_counter() - wall, process_time() - processor)):
            mine[i] += more
        return found

    Simulator.run = watched  # type: ignore[method-assign]
    wall, processor = perf_counter(), process_time()
    verdict = diagnose(dataset.load(folder), jobs=threads, progress=True).verdict
    wall, processor = perf_counter() - wall, process_time() - processor
    typer.echo(f"{verdict}: {wall:.1f} s, {processor:.1f} s of the processors; in runs:")
    for name, (runs, seconds, of_processors) in sorted(spent.items(), key=lambda one: -one[1][1]):
        typer.echo(f"{seconds:8.1f} s {of_processors:8.1f} s {runs:8.0f} runs  {name}")


if __name__ == "__main__":
    typer.run(main)
