"""Every robot, frequency and treatment of the torque as one computation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from peers.machine import conditions, load
from peers.ours import Health

from tumblers.model import MagneticTorque
from tumblers.version import __version__

from .case import FREQUENCIES_HZ, ROBOTS, cases
from .ladder import STEPS_S, Ladder, ladder
from .price import Group, Price, grouped, prices

if TYPE_CHECKING:
    from tumblers.progress import OnPhase

__all__ = ["AccuracyResults", "Row", "compare"]

# Below, a robot follows the field; from here on the faster ones hop.
_FAST_HZ = 5.0


@dataclass(frozen=True)
class Row:
    """One case.

    Attributes
    ----------
    ladder
        Its values.
    prices
        By treatment of the torque; None where its value is not known.
    """

    ladder: Ladder
    prices: dict[MagneticTorque, Price] | None

    def to_json(self) -> dict[str, Any]:
        """Return all of it."""
        found = self.ladder
        return {
            "robot": found.case.robot,
            "frequency_Hz": found.case.frequency_Hz,
            "manufacturing_errors": found.case.errors,
            "known_to": found.known_to,
            "steps_s": found.steps_s,
            "runs": {
                torque: [None if run is None else asdict(run) for run in runs] for torque, runs in found.runs.items()
            },
            "chosen": {torque: asdict(chosen) for torque, chosen in found.chosen.items()},
            "prices": None if self.prices is None else {torque: asdict(price) for torque, price in self.prices.items()},
        }


@dataclass(frozen=True)
class AccuracyResults:
    """All figures."""

    conditions: dict[str, Any]
    rows: list[Row]
    groups: list[Group]

    def to_json(self) -> dict[str, Any]:
        """Return what ``--json`` writes: the groups first, then everything."""
        return {
            "groups": [{**asdict(group), "best": group.best} for group in self.groups],
            "conditions": self.conditions,
            "cases": [row.to_json() for row in self.rows],
        }


def compare(
    repetitions: int,
    tell: OnPhase,
    robots: Sequence[str] = tuple(ROBOTS),
    frequencies_Hz: Sequence[float] = FREQUENCIES_HZ,
    steps_s: Sequence[float] = STEPS_S,
) -> AccuracyResults:
    """Measure every case.

    Parameters
    ----------
    repetitions
        Alternating repetitions of what is timed.
    tell
        Told what is measured, how much of it is done, and of how much.
    robots, frequencies_Hz, steps_s
        Fewer than usual, for a test.
    """
    found = conditions({"tumblers": __version__}, load(), repetitions)
    ladders = []
    every = cases(robots, frequencies_Hz)
    for done, case in enumerate(every):
        tell("steps", done, len(every))
        ladders.append(ladder(case, steps_s))
    health = Health()
    known = [each for each in ladders if each.is_known]
    total = len(known) * repetitions
    progress = iter(range(1, total + 1))
    priced = {
        id(each): prices(each, repetitions, health, lambda: tell("times", next(progress), total)) for each in known
    }
    rows = [Row(each, priced.get(id(each))) for each in ladders]
    return AccuracyResults(found, rows, _groups(rows))


def _groups(rows: Sequence[Row]) -> list[Group]:
    groups = []
    for errors in (False, True):
        for fast in (False, True):
            chosen = [
                row.prices
                for row in rows
                if row.prices is not None
                and row.ladder.case.errors == errors
                and (row.ladder.case.frequency_Hz >= _FAST_HZ) == fast
            ]
            words = f"{'with' if errors else 'without'} errors, {'from' if fast else 'below'} {_FAST_HZ:g} Hz"
            if chosen:
                groups.append(grouped(f"{words}{' on' if fast else ''}", chosen))
    groups.append(grouped("all", [row.prices for row in rows if row.prices is not None]))
    return groups
