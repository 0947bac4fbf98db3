"""What the commands of the studies read from their options."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from ..check import choice, thread_count
from ..errors import InputError
from ..options import PLOT_SUFFIXES, output_file
from ..presets import DRIVES, EXPERIMENTS, ROBOTS, SUBSTRATES, preset_scenario
from ..scenario import Scenario

__all__ = ["as_options", "outputs", "prepared", "words_of"]

# Arguments of the studies whose options have another name.
_OPTIONS = {
    "slopes_deg": "--slopes",
    "resolution_deg": "--resolution",
    "settling_cycles": "--settling",
    "drafts_deg": "--drafts",
    "theta1_deg": "--theta1",
    "theta2_deg": "--theta2",
    "draft_most_deg": "--draft-most",
    "axis_sigma_deg": "--axis-sigma",
    "steps_s": "--steps",
    "e_r_m": "--e-r",
    "numbers": "--only",
    "torques": "--torques",
    "parts": "--out",
    "threads": "--jobs",
    **{name: f"--{name}" for name in ("cycles", "samples", "generations", "draws", "seed")},
    "drift_cost": "--drift-cost",
}


def words_of(text: str) -> list[str]:
    """Return the words of ``a,b,c``; none of an empty text."""
    return [word.strip() for word in text.split(",")] if text else []


def prepared(
    robot: str, substrate: str | None, field: str | None, out: Path, plot: Path | None, jobs: int | None
) -> Scenario:
    """Return the scenario that is meant, after all that names files has been checked."""
    named = robot in EXPERIMENTS or robot in ROBOTS
    file = None if named else Path(robot)
    if file is not None and file.suffix != ".toml" and (not file.exists() or file.is_dir()):
        raise InputError("--robot", repr(robot), f"{', '.join([*EXPERIMENTS, *ROBOTS])} or a scenario file .toml")
    outputs(out, plot, file, jobs)
    if substrate is not None:
        choice("--substrate", substrate, list(SUBSTRATES))
    if field is not None:
        choice("--field", field, list(DRIVES))
    if file is not None:
        scenario = Scenario.load(file)
    elif robot in EXPERIMENTS:
        scenario = preset_scenario(robot)
    else:
        scenario = preset_scenario(robot=robot, substrate="aluminium_pdms", drive="20mT_1Hz")
    if substrate is not None:
        scenario = replace(scenario, substrate=SUBSTRATES[substrate].value)
    return scenario if field is None else replace(scenario, field=DRIVES[field].value)


def outputs(out: Path, plot: Path | None, scenario: Path | None, jobs: int | None) -> None:
    """Refuse files that could not be written, and a number of threads that is none, before anything is computed."""
    taken = [] if scenario is None else [scenario]
    output_file("--out", out, (".nc",), taken)
    if plot is not None:
        output_file("--plot", plot, PLOT_SUFFIXES, [*taken, out])
    if jobs is not None:
        thread_count("--jobs", jobs)


@contextmanager
def as_options() -> Iterator[None]:
    """Name an argument as the command line does."""
    try:
        yield
    except InputError as error:
        name, bracket, rest = (error.key or "").partition("[")
        if name in _OPTIONS:
            raise InputError(f"{_OPTIONS[name]}{bracket}{rest}", error.found, error.expected, error.file) from None
        raise
