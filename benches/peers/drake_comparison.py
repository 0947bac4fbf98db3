"""The comparison with Drake as one computation, and PATH's recorded times beside it."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from tumblers.version import __version__

from .case import tumbling
from .clock import alternate, microseconds
from .contact import contacts_of
from .drake_engine import HYDROELASTIC, POINT, VERSION, recorded, replayed
from .machine import conditions, load
from .ours import Health, swept
from .ours import recorded as our_run
from .results import Results
from .speed import COPIES, timed

if TYPE_CHECKING:
    from tumblers.progress import OnPhase

__all__ = ["DrakeResults", "PathTimes", "compare"]

# Mean time of a step in the authors' released runs, ms, and its unknowns.
_PATH_MS = {"cuboid": (6.4, 24), "spiked": (7.8, 26), "spiked ends": (7.4, 28)}


@dataclass(frozen=True)
class PathTimes:
    """One robot's step with PATH as the released runs recorded it, and ours as measured here.

    Attributes
    ----------
    robot
        Its name.
    unknowns
        Of the unreduced problem.
    recorded_us, ours_us
        Time of a step, µs.
    """

    robot: str
    unknowns: int
    recorded_us: float
    ours_us: float

    @property
    def ratio(self) -> float:
        """Our steps per second over PATH's; of two machines."""
        return self.recorded_us / self.ours_us


@dataclass(frozen=True, kw_only=True)
class DrakeResults(Results):
    """All figures."""

    peer = "Drake"
    paths: list[PathTimes]

    def to_json(self) -> dict[str, Any]:
        """Return what ``--json`` writes: the headline figures by name, then everything."""
        return {
            "steps_per_second_ratio": min(row.ratio.median for row in self.speeds),
            "our_us_per_step": self.speeds[0].ours_us,
            **super().to_json(),
            "path_recorded": [{**asdict(path), "ratio": path.ratio} for path in self.paths],
        }


def compare(repetitions: int, tell: OnPhase, copies: int = COPIES) -> DrakeResults:
    """Measure both engines, one thread.

    Parameters
    ----------
    repetitions
        Alternating repetitions.
    tell
        Told what is measured, how much of it is done, and of how much.
    copies
        How many of our runs make a sample.
    """
    found = conditions({"tumblers": __version__, "drake": VERSION}, load(), repetitions)
    health, robots = Health(), tumbling()
    cuboid, profiles = robots[0], (POINT, HYDROELASTIC)
    total = repetitions * len(profiles)
    done = iter(range(1, total + 1))
    speeds = []
    tell("recording", 0, 1)
    for settings in profiles:
        pair = swept([cuboid], copies, 1, health), replayed(cuboid, settings, recorded(cuboid, settings))
        call = f"AdvanceTo, {settings.name}"
        speeds.append(timed(cuboid.name, call, 1, pair, repetitions, lambda: tell("speed", next(done), total)))
    contacts = contacts_of(DrakeResults.peer, profiles, [cuboid], lambda case: our_run(case, health)[0], recorded, tell)
    mine = alternate({case.name: swept([case], copies, 1, health) for case in robots}, repetitions, lambda: None)
    paths = [
        PathTimes(robot, unknowns, 1e3 * milliseconds, microseconds(mine[robot]))
        for robot, (milliseconds, unknowns) in _PATH_MS.items()
    ]
    return DrakeResults(
        conditions=found,
        profiles=profiles,
        speeds=speeds,
        contacts=contacts,
        paths=paths,
        max_residual=health.max_residual,
        unconverged_steps=health.unconverged_steps,
    )
