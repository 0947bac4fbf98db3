"""The section on MuJoCo, in Markdown."""

from __future__ import annotations

from .contact_table import contact_table
from .grid import Grid
from .machine import conditions_in_words
from .mujoco_comparison import MujocoResults
from .page import table
from .speed import speed_lines, speed_table
from .target import target_table

__all__ = ["lines", "section"]

_SETUP = """Both engines run the same robots with the same mass, inertia, friction coefficient, field and step
(500 µs), in float64. MuJoCo runs in mm, mg and s, as it refuses the robots' inertia in SI units; elliptic cone, Newton,
tolerance 1e-8, Euler; islands and midphase off, which makes it faster here; the cuboid as a box, the spiked hulls as
meshes, F_elect as a constant force. It has no adhesion by area; ours is on in the robots' runs and in the sweep. Its
contact (h is the step):

{settings}

*Stiff* is the faster of the two that tumble as they should, and what the headline is against; *tight* is nearest to a
rigid contact with our friction; *as shipped* the cuboid at rest sinks deeper than it is high."""

_SPEED = """- What is timed is native on both sides, and keeps no states. MuJoCo's torque was computed before, along a
  run of MuJoCo's own that followed the field (the torque of each step's start), and `mujoco.rollout` replays that run
  to the bit, which is checked. Ours computes the torque (of each step's end) in every step, and the residual of the
  unreduced problem. Ours is built as `make` builds it, with the machine's wider instructions where it has them; MuJoCo
  is its own wheel. A wheel of ours, for any machine, takes about a seventh longer ([step.md](step.md)).
- *µs a step*: the median of the repetitions; on one thread of the process's processor time, on several of the time on
  the wall, over the steps of all runs together. *Ours over theirs*: the median of the repetitions' ratios, and their
  extremes.
- *in flight*, *line contact*, *at rest*: the cuboid with nothing touching; on an edge, in the longest such stretch of
  each engine's run; and on a face without a field, where one call of `mj_step` makes all steps."""

_GRID = """592 cases of manufacturing errors (16 drafts, 37 magnetizations), 2000 steps each, as `tumblers sweep` runs
them; medians of at most three repetitions. *Efficiency* is one thread's time on the wall over that of all threads times
their number; *of the processors* is the same of processor times, which do not wait for other work."""


def section(results: MujocoResults) -> str:
    """Return the section.

    Parameters
    ----------
    results
        All figures.
    """
    headline = results.speeds[0].ratio
    parts = [
        "## Against MuJoCo",
        conditions_in_words(results.conditions),
        f"Cuboid, one thread: **{headline.median:.3g} times** MuJoCo's steps per second ({headline.least:.3g} to"
        f" {headline.greatest:.3g}), at a residual of at most {results.max_residual:.2g}"
        f" ({results.unconverged_steps} steps of all runs did not converge).",
        "### Aims",
        target_table(results.targets),
        "### The same robots",
        _SETUP.format(settings=results.settings_list),
        "### Speed",
        speed_table(results.speeds, results.peer),
        _SPEED,
        "### Contact",
        contact_table(results.contacts),
    ]
    if results.grids:
        parts += ["### The paper's sweep", _grid_table(results.grids), _GRID]
    return "\n\n".join(parts)


def _grid_table(grids: list[Grid]) -> str:
    rows = [
        [
            grid.robot,
            f"{grid.one_thread_s:.3g}",
            f"{grid.all_threads_s:.3g} ({grid.threads} threads)",
            f"{100 * grid.efficiency:.0f} %",
            f"{100 * grid.processor_efficiency:.0f} %",
        ]
        for grid in grids
    ]
    return table(["robot", "one thread, s", "all threads, s", "efficiency", "of the processors"], rows)


def lines(results: MujocoResults) -> list[str]:
    """Return what the command says.

    Parameters
    ----------
    results
        All figures.
    """
    aims = [
        f"{target.what}: {target.measured:.3g}, aim {target.aim:g}, {target.verdict.replace('*', '')}"
        for target in results.targets
    ]
    return [*speed_lines(results.speeds), *aims]
