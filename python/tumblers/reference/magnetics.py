"""The magnetic torque of a step (docs/model.md, "Loads").

Equations, with the moment `M = V_m |E| R u`::

    T_m(R, t) = M × B(t)
    start_of_step   T = T_m(R, t)
    end_of_step     T = T_m(R⁺, t + h)
    midpoint        T = ½ T_m(R⁻ʰ, t - h/2) + ½ T_m(R⁺ʰ, t + h/2)

`R⁺ = C(h ω⁺/2) R`, `R⁺ʰ = C(h ω⁺/4) R`, `R⁻ʰ = C(-h ω/4) R`, where `C` is the Cayley map.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy as np

from .array import Array
from .field import Field
from .rotation import cayley, cross

TorqueTime = Literal["start_of_step", "end_of_step", "midpoint"]


def torque(moment: Array, rotation: Array, flux_density: Array) -> Array:
    """`T_m = (R M) × B` [N m], shape (3,), substrate frame.

    Parameters
    ----------
    moment : Array, shape (3,)
        `V_m |E| u` [A m²], body frame.
    rotation : Array, shape (3, 3)
        `R`, body to substrate.
    flux_density : Array, shape (3,)
        `B` [T], substrate frame.
    """
    return cross(rotation @ moment, flux_density)


def step_torque(
    when: TorqueTime, moment: Array, rotation: Array, omega: Array, field: Field, time: float, step: float
) -> Callable[[Array], Array]:
    """The torque of one step as a function of `ω⁺`.

    Parameters
    ----------
    when : TorqueTime
        Row of the table above.
    moment : Array, shape (3,)
        [A m²], body frame.
    rotation : Array, shape (3, 3)
        `R` at the start of the step.
    omega : Array, shape (3,)
        `ω` at the start of the step [rad/s], substrate frame.
    field : Field
        Magnetic field.
    time, step : float
        `t` and `h` [s].

    Returns
    -------
    Callable
        `ω⁺` [rad/s] to `T` [N m], both shape (3,), substrate frame.
    """
    start = rotation @ moment
    if when == "start_of_step":
        constant = cross(start, field.at(time))
        return lambda _: constant
    if when == "end_of_step":
        end_field = field.at(time + step)
        return lambda omega_end: cross(cayley(0.5 * step * omega_end) @ start, end_field)
    if when != "midpoint":
        raise ValueError(f"torque_time: found {when!r}, expected start_of_step, end_of_step or midpoint")
    back = 0.5 * cross(cayley(-0.25 * step * omega) @ start, field.at(time - 0.5 * step))
    ahead = 0.5 * field.at(time + 0.5 * step)
    return lambda omega_end: np.asarray(back + cross(cayley(0.25 * step * omega_end) @ start, ahead))
