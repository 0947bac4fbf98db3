"""`Surroundings`: what acts on the robot beside gravity, the field and the substrate."""

from __future__ import annotations

from dataclasses import dataclass

from .check import Vector, number, sequence, vector
from .errors import InputError, show

__all__ = ["Surroundings", "Wrench"]

Wrench = tuple[float, float, float, float, float, float]


@dataclass(frozen=True, kw_only=True, slots=True)
class Surroundings:
    """Forces, torques and drags, substrate frame; forces act at the centre of mass.

    Attributes
    ----------
    force_N, torque_N_m
        Constant force, N, and torque, N m.
    translational_drag_N_s_per_m, rotational_drag_N_m_s
        Force per velocity, N s/m, and torque per angular velocity, N m s, against the motion.
    sheet_conductance_S
        Conductivity times thickness of a conducting sheet at z = 0, S, whose eddy currents drag on the magnet.
    wrench_time_s, wrench_N_N_m
        Increasing times, s, shape (n,), and generalized forces [Fx, Fy, Fz, Tx, Ty, Tz], N and N m, shape (n, 6). A row
        acts from its time to that of the next, the last to the end; nothing acts before the first.

    Raises
    ------
    InputError
        A number that is refused, times that do not increase, or lists of different length.
    """

    force_N: Vector = (0.0, 0.0, 0.0)
    torque_N_m: Vector = (0.0, 0.0, 0.0)
    translational_drag_N_s_per_m: float = 0.0
    rotational_drag_N_m_s: float = 0.0
    sheet_conductance_S: float = 0.0
    wrench_time_s: tuple[float, ...] = ()
    wrench_N_N_m: tuple[Wrench, ...] = ()

    def __post_init__(self) -> None:
        for name in ("force_N", "torque_N_m"):
            object.__setattr__(self, name, vector(f"surroundings.{name}", getattr(self, name)))
        for name in ("translational_drag_N_s_per_m", "rotational_drag_N_m_s", "sheet_conductance_S"):
            object.__setattr__(self, name, number(f"surroundings.{name}", getattr(self, name), least=0.0))
        key = "surroundings.wrench_time_s"
        times = sequence(key, self.wrench_time_s, "a list of numbers", number)
        for i in range(1, len(times)):
            if not times[i] > times[i - 1]:
                raise InputError(f"{key}[{i}]", show(times[i]), f"a time after {times[i - 1]} s")
        key = "surroundings.wrench_N_N_m"
        wrenches = sequence(key, self.wrench_N_N_m, "a list of [Fx, Fy, Fz, Tx, Ty, Tz]", _wrench)
        if len(wrenches) != len(times):
            raise InputError(key, f"{len(wrenches)} rows", f"{len(times)}, as many as in wrench_time_s")
        object.__setattr__(self, "wrench_time_s", times)
        object.__setattr__(self, "wrench_N_N_m", wrenches)


def _wrench(key: str, value: object) -> Wrench:
    expected = "a list of 6 numbers"
    found = sequence(key, value, expected, number)
    if len(found) != 6:
        raise InputError(key, show(value), expected)
    fx, fy, fz, tx, ty, tz = found
    return fx, fy, fz, tx, ty, tz
