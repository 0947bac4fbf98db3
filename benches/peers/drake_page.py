"""The section on Drake and PATH, in Markdown."""

from __future__ import annotations

from .contact_table import contact_table
from .drake_comparison import DrakeResults
from .machine import conditions_in_words
from .page import table
from .speed import speed_lines, speed_table

__all__ = ["lines", "section"]

_SETUP = """The cuboid on paper, 10 mT at 5 Hz, 2000 steps of 500 µs, with the same mass, inertia and friction
coefficient. Drake runs a discrete `MultibodyPlant` in mm, mg and s, its lagged convex approximation (SAP), without
adhesion by area or friction against spin, and with F_elect as a constant force:

{settings}

Drake's torque was computed before, along a run of Drake's own that followed the field, and a `TrajectorySource`
replays it to the bit, which is checked; what is timed is one `Simulator.AdvanceTo` over the whole run. Ours computes
its torque in every step. One thread each; times are the process's processor time, the median of the repetitions; the
ratio is the median of the repetitions' ratios, with their extremes."""

_PATH = """PATH's times are those that the authors' released runs recorded for each step, mean values, on another
machine, from MATLAB; a step that failed was started again at random up to 60 times. They were not measured here: the
ratio compares two machines, and says no more than its order of magnitude. At that rate the paper's 592 cases of 2000
steps take about 2.4 hours a shape."""


def section(results: DrakeResults) -> str:
    """Return the section.

    Parameters
    ----------
    results
        All figures.
    """
    rows = [
        [
            path.robot,
            str(path.unknowns),
            f"{path.recorded_us / 1e3:g} ms",
            f"{path.ours_us:.3g} µs",
            f"about {float(f'{path.ratio:.2g}'):g}",
        ]
        for path in results.paths
    ]
    head = ["robot", "unknowns", "PATH, recorded, a step", "ours, a step", "ours over theirs, steps per second"]
    return "\n\n".join(
        [
            "## Against Drake, and PATH's recorded times",
            conditions_in_words(results.conditions),
            f"Our greatest residual of a step is {results.max_residual:.2g}; {results.unconverged_steps} steps of all"
            " runs did not converge.",
            _SETUP.format(settings=results.settings_list),
            speed_table(results.speeds, results.peer),
            contact_table(results.contacts),
            "### PATH",
            table(head, rows),
            _PATH,
        ]
    )


def lines(results: DrakeResults) -> list[str]:
    """Return what the command says.

    Parameters
    ----------
    results
        All figures.
    """
    return [*speed_lines(results.speeds), f"greatest residual of a step: {results.max_residual:.2g}"]
