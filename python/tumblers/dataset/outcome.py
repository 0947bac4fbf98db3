"""`Outcome`: what a trial came to, in one word or one number."""

from __future__ import annotations

from dataclasses import dataclass

from ..check import number
from ..errors import InputError, show

__all__ = ["REST_SHARE", "Outcome"]

# The robot has come to rest in this last share of a static trial.
REST_SHARE = 1.0 / 3.0

_SIGMAS = {"mean_speed_m_per_s": "sigma_m_per_s", "tilt_deg": "sigma_deg"}
# What is beyond these is in another unit, m/s and degrees; no measurement is surer than the least.
_MOST = {"mean_speed_m_per_s": 10.0, "tilt_deg": 90.0, "sigma_m_per_s": 10.0, "sigma_deg": 360.0}
_LEAST_SIGMA = 1e-12


@dataclass(frozen=True, kw_only=True, slots=True)
class Outcome:
    """What was seen of a trial as a whole; any combination, but not nothing.

    Attributes
    ----------
    climbs
        Whether the robot got on along +y.
    mean_speed_m_per_s, sigma_m_per_s
        Displacement along +y over the trial's time, and its standard deviation, m/s.
    tilt_deg, sigma_deg
        Angle by which the body's +y end points above the substrate at rest, and its standard deviation, degrees.

    Raises
    ------
    InputError
        No observation at all, a number without its standard deviation or the reverse, or a number that is refused.
    """

    climbs: bool | None = None
    mean_speed_m_per_s: float | None = None
    sigma_m_per_s: float | None = None
    tilt_deg: float | None = None
    sigma_deg: float | None = None

    def __post_init__(self) -> None:
        def put(name: str, value: float) -> None:
            object.__setattr__(self, name, value)

        if self.climbs is not None and not isinstance(self.climbs, bool):
            raise InputError("outcome.climbs", show(self.climbs), "true or false")
        for name, sigma in _SIGMAS.items():
            if getattr(self, name) is None:
                if getattr(self, sigma) is not None:
                    raise InputError(f"outcome.{name}", f"no such key beside {sigma}", name)
                continue
            put(name, number(f"outcome.{name}", getattr(self, name), least=-_MOST[name], most=_MOST[name]))
            if getattr(self, sigma) is None:
                raise InputError(f"outcome.{sigma}", f"no such key beside {name}", "its standard deviation")
            put(sigma, number(f"outcome.{sigma}", getattr(self, sigma), above=0.0, most=_MOST[sigma]))
            number(f"outcome.{sigma}", getattr(self, sigma), least=_LEAST_SIGMA)
        if self.climbs is None and self.mean_speed_m_per_s is None and self.tilt_deg is None:
            raise InputError("outcome", "no observation", "climbs, mean_speed_m_per_s or tilt_deg")
