"""The comparison with Drake as one computation, and PATH's recorded times beside it."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any

from tumblers.version import __version__

from .case import Case, tumbling
from .clock import alternate, microseconds
from .contact import Contact, contact_of
from .drake_engine import HYDROELASTIC, POINT, VERSION, Settings, recorded, replayed
from .machine import conditions, load
from .ours import Health, swept
from .ours import recorded as our_run
from .speed import Speed, timed

if TYPE_CHECKING:
    from tumblers.progress import OnPhase

__all__ = ["DrakeResults", "PathTimes", "compare"]

_COPIES = 16
_SETTLE_S = 0.1
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


@dataclass(frozen=True)
class DrakeResults:
    """All figures."""

    conditions: dict[str, Any]
    speeds: list[Speed]
    contacts: list[Contact]
    paths: list[PathTimes]
    max_residual: float
    unconverged_steps: int
    settings: dict[str, str] = field(
        default_factory=lambda: {settings.name: settings.words for settings in (POINT, HYDROELASTIC)}
    )

    def to_json(self) -> dict[str, Any]:
        """Return what ``--json`` writes: the headline figures by name, then everything."""
        return {
            "steps_per_second_ratio": min(row.ratio.median for row in self.speeds),
            "our_us_per_step": self.speeds[0].ours_us,
            "max_residual": self.max_residual,
            "unconverged_steps": self.unconverged_steps,
            "conditions": self.conditions,
            "drake_settings": self.settings,
            "speeds": [asdict(row) for row in self.speeds],
            "contacts": [asdict(contact) for contact in self.contacts],
            "path_recorded": [{**asdict(path), "ratio": path.ratio} for path in self.paths],
        }


def compare(repetitions: int, tell: OnPhase, copies: int = _COPIES) -> DrakeResults:
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
    contacts = [contact_of("tumblers", [cuboid], lambda case: our_run(case, health)[0])]
    for i, settings in enumerate(profiles):
        tell("contact", i, len(profiles))
        contacts.append(_contact(settings, cuboid))
    mine = alternate({case.name: swept([case], copies, 1, health) for case in robots}, repetitions, lambda: None)
    paths = [
        PathTimes(robot, unknowns, 1e3 * milliseconds, microseconds(mine[robot]))
        for robot, (milliseconds, unknowns) in _PATH_MS.items()
    ]
    return DrakeResults(found, speeds, contacts, paths, health.max_residual, health.unconverged_steps)


def _contact(settings: Settings, cuboid: Case) -> Contact:
    # What slides has settled into its soft contact before.
    return contact_of(
        f"Drake, {settings.name}", [cuboid], lambda case: recorded(case, settings, settle_s=_SETTLE_S).track
    )
