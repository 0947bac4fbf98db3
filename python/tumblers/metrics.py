"""`Metrics`: what a run comes to; `Yardstick`: how far apart two runs of one scenario are.

Two runs are as far apart as the greatest of

```text
T |v - v'| / max(T |v'|, P),    |d - d'| / max(|d'|, P),    |θ - θ'| / max(|θ'|, 45°)
```

v is the speed, T the run's time, d the drift, θ the twist and P the perimeter of the body's hull, which is the way of a
cycle without slip: a drift or a twist of nearly nothing is measured by what a cycle and a flip are.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf, isfinite
from typing import Any, Self

import numpy as np

from . import _core
from .errors import TumblersError
from .field import RotatingField
from .scenario import Scenario

__all__ = ["FLIP_DEG", "Metrics", "Yardstick", "measured"]

FLIP_DEG = 45.0
_ROUNDING = 1e-9


@dataclass(frozen=True, kw_only=True, slots=True)
class Metrics:
    """What a run comes to.

    Attributes
    ----------
    speed_m_per_s
        Displacement along y over the time, m/s.
    drift_m, twist_deg
        Displacement along x, m, and twist, degrees, after one cycle of the field; of a run that has none the
        displacement along x and the tilt of the long axis at its end.
    """

    speed_m_per_s: float
    drift_m: float
    twist_deg: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Yardstick:
    """What the differences of two runs are measured by.

    Attributes
    ----------
    duration_s
        T, s.
    way_m
        P, m.
    """

    duration_s: float
    way_m: float

    @classmethod
    def of(cls, scenario: Scenario) -> Self:
        """Return the yardstick of a scenario.

        Parameters
        ----------
        scenario
            The robot and its time.
        """
        effective = scenario.effective()
        return cls(duration_s=effective.run.duration_s, way_m=effective.robot.body().hull_perimeter_m)

    def apart(self, run: Metrics | None, other: Metrics | None) -> float:
        """Return how far a run is from another one, as a share; infinite where one of them failed.

        Parameters
        ----------
        run, other
            The run, and the one that it is compared with.
        """
        if run is None or other is None:
            return inf
        way, ways = self.duration_s * run.speed_m_per_s, self.duration_s * other.speed_m_per_s
        turned = (run.twist_deg - other.twist_deg + 180.0) % 360.0 - 180.0
        shares = (
            abs(way - ways) / max(abs(ways), self.way_m),
            abs(run.drift_m - other.drift_m) / max(abs(other.drift_m), self.way_m),
            abs(turned) / max(abs(other.twist_deg), FLIP_DEG),
        )
        if not isfinite(shares[0]):
            return inf
        # A cycle that ends with the run may miss its end by a rounding: there is no drift and no twist then.
        return max(share for share in shares if isfinite(share))


def measured(scenarios: Sequence[Scenario], threads: int = 0) -> list[Metrics | None]:
    """Run scenarios as one native batch; None for one that is refused or fails.

    Parameters
    ----------
    scenarios
        What to run, each with a number for its step.
    threads
        Number of threads, 0 for all. The result does not depend on it.
    """
    found: list[Metrics | None] = [None] * len(scenarios)
    batches: dict[bool, list[tuple[int, _core.Trial]]] = {True: [], False: []}
    for i, scenario in enumerate(scenarios):
        try:
            batches[_has_cycle(scenario)].append((i, scenario.trial()))
        except TumblersError:
            continue
    swept: Mapping[str, Any] = _core.sweep([trial for _, trial in batches[True]], threads)
    for row, (i, _) in enumerate(batches[True]):
        if swept["error"][row] is None:
            found[i] = Metrics(
                speed_m_per_s=float(swept["speed_m_per_s"][row]),
                drift_m=float(swept["drift_m"][row]),
                twist_deg=float(np.degrees(swept["twist_rad"][row])),
            )
    # Of a run without a cycle its start and its end are kept.
    trials = [trial for _, trial in batches[False]]
    rollouts = _core.rollouts(trials, [trial.steps for trial in trials], threads)
    for (i, _), rollout in zip(batches[False], rollouts, strict=True):
        # One that diverged has no end.
        if rollout["error"] is None and len(rollout["time_s"]) > 1:
            found[i] = _at_the_end(rollout)
    return found


def _has_cycle(scenario: Scenario) -> bool:
    field = scenario.effective().field
    return isinstance(field, RotatingField) and scenario.run.duration_s * field.frequency_Hz >= 1.0 - _ROUNDING


def _at_the_end(rollout: _core._Rollout) -> Metrics:
    x, y, _ = rollout["position_m"][-1] - rollout["position_m"][0]
    qw, qx, qy, qz = rollout["orientation"][-1]
    return Metrics(
        speed_m_per_s=float(y / rollout["time_s"][-1]),
        drift_m=float(x),
        # The height of the body's +y end over its length.
        twist_deg=float(np.degrees(np.arcsin(np.clip(2.0 * (qy * qz + qw * qx), -1.0, 1.0)))),
    )
