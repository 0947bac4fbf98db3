"""The comparison with MuJoCo as one computation."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from tumblers.version import __version__

from .case import Case, at_rest, in_flight, tumbling
from .clock import Contestant
from .contact import contacts_of
from .grid import Grid, timed_grid
from .machine import conditions, is_busy, load, threads
from .mujoco_engine import VERSION, recorded, replayed, stepped, stretch_on_a_line
from .mujoco_model import SHIPPED, STIFF, TIGHT
from .ours import Health, line_contact, swept, throughout
from .ours import recorded as our_run
from .results import Results
from .speed import COPIES, Speed, timed
from .target import Target

if TYPE_CHECKING:
    from tumblers.progress import OnPhase

__all__ = ["MujocoResults", "compare"]

# A grid takes seconds.
_MOST_GRIDS = 3
_PROFILES = (SHIPPED, STIFF, TIGHT)


@dataclass(frozen=True, kw_only=True)
class MujocoResults(Results):
    """All figures."""

    peer = "MuJoCo"
    grids: list[Grid]
    targets: list[Target]

    def to_json(self) -> dict[str, Any]:
        """Return what ``--json`` writes: the headline figures by name, then everything."""
        headline = self.speeds[0]
        on_all = (row.ratio.median for row in self.speeds if row.situation == headline.situation and row.threads > 1)
        return {
            "steps_per_second_ratio": headline.ratio.median,
            "steps_per_second_ratio_all_threads": next(on_all, None),
            "our_us_per_step": headline.ours_us,
            "mujoco_us_per_step": headline.theirs_us,
            **super().to_json(),
            "grids": [asdict(grid) for grid in self.grids],
            "targets": [{**asdict(target), "met": target.met} for target in self.targets],
        }


def compare(repetitions: int, tell: OnPhase, copies: int = COPIES, grids: bool = True) -> MujocoResults:
    """Measure both engines.

    Parameters
    ----------
    repetitions
        Alternating repetitions.
    tell
        Told what is measured, how much of it is done, and of how much.
    copies, grids
        Smaller than usual, and without the grids, for a test.
    """
    found = conditions({"tumblers": __version__, "mujoco": VERSION}, load(), repetitions)
    health = Health()
    speeds = _speeds(repetitions, tell, copies, health)
    contacts = contacts_of(
        MujocoResults.peer, _PROFILES[::-1], tumbling(), lambda case: our_run(case, health)[0], recorded, tell
    )
    times = _grids(min(repetitions, _MOST_GRIDS), tell, health) if grids else []
    return MujocoResults(
        conditions=found,
        profiles=_PROFILES,
        speeds=speeds,
        contacts=contacts,
        grids=times,
        targets=_targets(speeds, times, health, is_busy(found)),
        max_residual=health.max_residual,
        unconverged_steps=health.unconverged_steps,
    )


@dataclass(frozen=True)
class _Race:
    situation: str
    call: str
    threads: int
    contestants: tuple[Contestant, Contestant]


def _speeds(repetitions: int, tell: OnPhase, copies: int, health: Health) -> list[Speed]:
    robots, every = tumbling(), threads()
    tell("recording", 0, 1)
    races = []
    for settings in (STIFF, TIGHT):
        for case in robots:
            ours, theirs = swept([case], copies, 1, health), replayed(recorded(case, settings), copies, 1)
            races.append(_Race(case.name, f"rollout, {settings.name}", 1, (ours, theirs)))
    races += _situations(robots[0], copies, health)
    if every > 1:
        for case in robots:
            many = copies * every
            pair = swept([case], many, every, health), replayed(recorded(case, STIFF), many, every)
            races.append(_Race(case.name, f"rollout, {STIFF.name}", every, pair))
    speeds: list[Speed] = []
    total = len(races) * repetitions
    done = iter(range(1, total + 1))
    for race in races:
        speeds.append(
            timed(
                race.situation,
                race.call,
                race.threads,
                race.contestants,
                repetitions,
                lambda: tell("speed", next(done), total),
            )
        )
    return speeds


def _situations(cuboid: Case, copies: int, health: Health) -> list[_Race]:
    """Return the cuboid in one kind of contact at a time, each engine in that contact."""
    steps = copies * cuboid.steps
    flight, rest = throughout(in_flight(), "airborne", health), throughout(at_rest(), "surface", health)
    line = line_contact(cuboid, health)
    their_line = stretch_on_a_line(recorded(cuboid, STIFF))

    def ours(case: Case) -> Contestant:
        return swept([case], -(-steps // case.steps), 1, health)

    return [
        _Race(
            f"cuboid, {flight.name}",
            f"rollout, {STIFF.name}",
            1,
            (ours(flight), replayed(recorded(flight, STIFF), -(-steps // flight.steps), 1)),
        ),
        _Race(
            f"cuboid, {line.name}",
            f"rollout, {STIFF.name}",
            1,
            (ours(line), replayed(their_line, -(-steps // len(their_line.controls)), 1)),
        ),
        _Race(f"cuboid, {rest.name}", f"mj_step, {STIFF.name}", 1, (ours(rest), stepped(rest, STIFF, copies))),
    ]


def _grids(repetitions: int, tell: OnPhase, health: Health) -> list[Grid]:
    robots = tumbling()[1:]
    total = len(robots) * repetitions
    done = iter(range(1, total + 1))
    return [
        timed_grid(case, threads(), repetitions, health, lambda: tell("592 cases", next(done), total))
        for case in robots
    ]


def _targets(speeds: list[Speed], grids: list[Grid], health: Health, disturbed: bool) -> list[Target]:
    ours = {row.situation: row.ours_us for row in speeds if row.threads == 1}
    targets = [
        Target("a step in flight on one core, µs", 1.5, ours["cuboid, in flight"], True),
        Target("a step in line contact on one core, µs", 1.5, ours["cuboid, line contact"], True),
        Target("steps per second over MuJoCo's, cuboid, one thread", 3.0, speeds[0].ratio.median, False),
        Target("greatest residual of a step of all runs", 1e-10, health.max_residual, True),
    ]
    if grids:
        cores = grids[0].threads
        slowest, worst = max(grid.all_threads_s for grid in grids), min(grid.efficiency for grid in grids)
        targets += [
            Target(f"592 cases of 2000 steps on {cores} cores (aimed at on 4), s", 0.8, slowest, True, disturbed),
            Target(f"parallel efficiency from 1 to {cores} threads", 0.9, worst, False, disturbed),
        ]
    return targets
