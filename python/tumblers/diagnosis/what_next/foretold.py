"""What hypotheses say of a trial that has not been made."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp

import numpy as np
from numpy.typing import NDArray

from ...dataset import Dataset
from ...dataset.outcome import REST_SHARE
from ...field import RotatingField
from ..gap.pose import Path, body_axis, tilt_of
from ..gap.reading import reached
from ..gap.simulator import Simulator
from .candidate import Candidate

__all__ = ["CLIMBS", "EVENTS", "RUNS", "SLIDES", "STAYS", "Foretold", "Said", "foretell"]

Floats = NDArray[np.float64]

# What can happen: out of view down or up a slope, in view, and climbing one.
RUNS, SLIDES, STAYS, CLIMBS = -2, -1, 0, 1
EVENTS = (RUNS, SLIDES, STAYS, CLIMBS)
# A speed that is measured again differs by this share of the way without slip over the time, and a rest by this angle,
# or by what the body still swings.
_REPEATS, _REST_DEG = 0.01, 1.0
# Beyond this many times the speed without slip the robot is gone from the camera's view, no matter how fast.
_GONE = 2.0


@dataclass(frozen=True, eq=False)
class Said:
    """What one hypothesis says of a candidate.

    Attributes
    ----------
    shares
        Of its different draws, shape (n,), together 1.
    values
        What would be measured with each, shape (n, kinds).
    events
        What happens, shape (n,): `CLIMBS` on a slope, `STAYS` in view, `SLIDES` or `RUNS` out of it.
    """

    shares: Floats
    values: Floats
    events: NDArray[np.int8]

    def share(self, event: int) -> float:
        """Return the share of the draws with an event."""
        return float(self.shares[self.events == event].sum())

    @property
    def seen(self) -> NDArray[np.bool_]:
        """Whether the robot stays in view."""
        return np.asarray(self.events >= STAYS)


@dataclass(frozen=True, eq=False)
class Foretold:
    """What the hypotheses say of a candidate.

    Attributes
    ----------
    kinds
        Of measurement.
    noise
        One standard deviation of each kind when it is measured, shape (kinds,).
    said
        By hypothesis.
    """

    kinds: tuple[str, ...]
    noise: Floats
    said: tuple[Said, ...]


def foretell(
    dataset: Dataset, simulator: Simulator, option: Candidate, run: Sequence[Sequence[tuple[int, Path | None]]]
) -> Foretold | None:
    """Return what is foretold of a candidate, None where a hypothesis cannot be run at all.

    Parameters
    ----------
    dataset, simulator
        What the lab did, and of the same.
    option
        The trial.
    run
        By hypothesis, how often each different draw was drawn, and its path.
    """
    time, field = option.duration_s, option.field
    level = 0.0
    if isinstance(field, RotatingField):
        level = simulator.nominal(0).robot.body().hull_perimeter_m * field.frequency_Hz
    swings = 0.0
    said = []
    for mine in run:
        values, events = [], []
        for _, path in mine:
            if path is None:
                continue
            if isinstance(field, RotatingField):
                ends, _ = path.at(np.array([0.0, time]))
                speed, drift = (float(ends[1, k] - ends[0, k]) / time for k in (1, 0))
                # What is noted as a climb more often than not.
                noted = exp(-0.5 * reached(speed / level, True) ** 2) > 0.5
                up = CLIMBS if option.incline_deg > 0.0 and noted else STAYS
                gone = abs(speed) > _GONE * level
                values.append([speed, drift])
                events.append((SLIDES if speed * option.incline_deg < 0.0 else RUNS) if gone else up)
            else:
                rest = np.linspace((1.0 - REST_SHARE) * time, time, 16)
                tilts = np.degrees(tilt_of(body_axis(path.at(rest)[1])))
                values.append([float(np.mean(tilts))])
                events.append(STAYS)
                swings = max(swings, float(np.std(tilts)))
        if not values:
            return None
        times = np.array([count for count, path in mine if path is not None], dtype=np.float64)
        said.append(Said(times / times.sum(), np.array(values), np.array(events, dtype=np.int8)))
    if isinstance(field, RotatingField):
        noise = np.hypot(np.sqrt(2.0) * dataset.sensor.position_noise_m / time, _REPEATS * level)
        return Foretold(("mean_speed_m_per_s", "drift_m_per_s"), np.full(2, noise), tuple(said))
    return Foretold(("tilt_deg",), np.array([np.hypot(_REST_DEG, swings)]), tuple(said))
