"""How well an engine keeps its contact: penetration, slip below friction, lift of a sliding box."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .case import FINE_STEP_S, STEP_S, Case, at_rest, on_slope, sliding
from .track import Track, lowest_m

if TYPE_CHECKING:
    from tumblers.progress import OnPhase

    from .results import Profile

__all__ = ["TRANSIENT_S", "Contact", "Tumble", "contact_of", "contacts_of"]

# A run starts with the field off the robot's axis, and with a jerk that is not counted.
TRANSIENT_S = 0.2
_CREEP_FROM_S = 1.0
# What slides has settled into a peer's soft contact before.
_SETTLE_S = 0.1


@dataclass(frozen=True)
class Tumble:
    """A robot that tumbles.

    Attributes
    ----------
    robot
        Its name.
    speed_um_per_s
        Along y over the whole run, µm/s.
    greatest_um, median_um
        Depth of the lowest point below the plane after the first 0.2 s, µm; the median counts 0 in the air.
    """

    robot: str
    speed_um_per_s: float
    greatest_um: float
    median_um: float


@dataclass(frozen=True)
class Contact:
    """What an engine leaves of a rigid contact with friction.

    Attributes
    ----------
    engine
        Its name, with its settings.
    tumbles
        One for each robot.
    rest_um
        Depth of the cuboid after a second at rest on a face, µm.
    creep_um_per_s
        How fast it slips down a slope of 10° with μ = 0.3 in the second second, µm/s.
    lift_um, fine_lift_um
        Greatest height of the lowest point of the sliding cuboid, µm, with the step of all runs and a finer one.
    """

    engine: str
    tumbles: tuple[Tumble, ...]
    rest_um: float
    creep_um_per_s: float
    lift_um: float
    fine_lift_um: float


def contact_of(engine: str, robots: Sequence[Case], track_of: Callable[[Case], Track]) -> Contact:
    """Measure an engine by its poses alone, and every engine by the same arithmetic.

    Parameters
    ----------
    engine
        Its name.
    robots
        The cases that tumble.
    track_of
        Runs a case.
    """
    tumbles = tuple(_tumble(case, track_of(case)) for case in robots)
    rest = at_rest()
    lowest_at_rest = lowest_m(track_of(rest), rest.vertices_m)[-1]
    creep = -track_of(on_slope()).after(_CREEP_FROM_S).speed_m_per_s
    lifts = []
    for step_s in (STEP_S, FINE_STEP_S):
        case = sliding(step_s)
        lifts.append(_up(float(lowest_m(track_of(case), case.vertices_m).max())))
    return Contact(engine, tumbles, _up(-float(lowest_at_rest)), 1e6 * creep, lifts[0], lifts[1])


def contacts_of(
    peer: str,
    profiles: Sequence[Profile],
    robots: Sequence[Case],
    ours: Callable[[Case], Track],
    recorded: Callable[[Case, Any, float], Any],
    tell: OnPhase,
) -> list[Contact]:
    """Measure our engine, and a peer with each of its settings.

    Parameters
    ----------
    peer, profiles
        Its name, and its settings.
    robots
        The cases that tumble.
    ours, recorded
        Run a case: ours, and the peer's with its settings and the time that it lies at rest before, s.
    tell
        Told how many settings are done.
    """
    contacts = [contact_of("tumblers", robots, ours)]
    for i, settings in enumerate(profiles):
        tell("contact", i, len(profiles))

        def track_of(case: Case, settings: Profile = settings) -> Track:
            track: Track = recorded(case, settings, _SETTLE_S).track
            return track

        contacts.append(contact_of(f"{peer}, {settings.name}", robots, track_of))
    return contacts


def _tumble(case: Case, track: Track) -> Tumble:
    depths = np.maximum(-lowest_m(track.after(TRANSIENT_S), case.vertices_m), 0.0)
    return Tumble(case.name, 1e6 * track.speed_m_per_s, 1e6 * float(depths.max()), 1e6 * float(np.median(depths)))


def _up(height_m: float) -> float:
    return 1e6 * max(height_m, 0.0)
