"""`Kind`: effects that may act in a part of the data alone, in strengths of a scale of their own."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ...effects.adhesion_coefficient import AdhesionCoefficient
from ...effects.base import Effect
from ...effects.electrostatic_force import ElectrostaticForce
from ...effects.friction_coefficient import FrictionCoefficient
from ...effects.magnetization_strength import MagnetizationStrength
from ...scenario import Scenario
from ..quantity import plain
from .turned_field import TurnedField

__all__ = ["DRIVE", "TURN", "Kind", "of_place", "words_of"]


class Kind(NamedTuple):
    """Effects by their strength.

    Attributes
    ----------
    effects
        Of a strength in a scenario.
    scale
        Strengths that are tried first, increasing; there are others between them and beyond.
    """

    effects: Callable[[float, Scenario], tuple[Effect, ...]]
    scale: tuple[float, ...]

    @property
    def step(self) -> float:
        """The usual step between those that are tried first."""
        return float(np.median(np.diff(self.scale)))


def _area(strength: float, _: Scenario) -> tuple[Effect, ...]:
    return (AdhesionCoefficient(factor=1.0 + 2.0**strength),)


def _force(strength: float, scenario: Scenario) -> tuple[Effect, ...]:
    weight = scenario.robot.total_mass_kg * scenario.run.gravity_m_per_s2
    return (ElectrostaticForce(added_force_N=2.0**strength * (weight + scenario.substrate.electrostatic_force_N)),)


def _both(strength: float, scenario: Scenario) -> tuple[Effect, ...]:
    return (*_area(strength, scenario), *_force(strength, scenario))


def _friction(strength: float, _: Scenario) -> tuple[Effect, ...]:
    return (FrictionCoefficient(factor=2.0**strength),)


def _drive(strength: float, _: Scenario) -> tuple[Effect, ...]:
    return (MagnetizationStrength(factor=max(1.0 - strength, 0.0)),)


def _turn(strength: float, _: Scenario) -> tuple[Effect, ...]:
    # By half a turn more it is behind.
    return (TurnedField(ahead_deg=180.0 - (180.0 - strength) % 360.0),)


# The field drives the robot by less, or by more; and is ahead, degrees.
DRIVE = Kind(_drive, (-0.25, 0.25, 0.5, 0.75, 1.0))
TURN = Kind(_turn, (-135.0, -90.0, -45.0, -15.0, 15.0, 45.0, 90.0, 135.0, 180.0))
# The substrate holds on by a force, is rougher or smoother; and holds on by the area that touches, without and with a
# force.
_OF_ANY_PLACE = Kind(_force, (-2.0, -0.5, 1.0, 2.5, 4.0)), Kind(_friction, (-1.0, 1.0, 2.0))
_OF_STICKY_PLACE = Kind(_area, (0.0, 1.5, 3.0, 4.5)), Kind(_both, (-2.0, -0.5, 1.0, 2.5, 4.0))


def of_place(scenario: Scenario) -> tuple[Kind, ...]:
    """Return what the substrate may do in a place.

    Parameters
    ----------
    scenario
        The nominal one: a multiple of no adhesion is none.
    """
    sticks = scenario.substrate.adhesion_N_per_m2 > 0.0
    return (*_OF_ANY_PLACE, *_OF_STICKY_PLACE) if sticks else _OF_ANY_PLACE


def words_of(effects: tuple[Effect, ...]) -> str:
    """Return what effects do, such as ``0.12 times the magnetic torque``.

    Parameters
    ----------
    effects
        Of a `Kind`.
    """
    return " and ".join(_words(effect) for effect in effects)


def _words(effect: Effect) -> str:
    match effect:
        case AdhesionCoefficient(factor=factor):
            return f"{_times(factor)} the adhesion"
        case FrictionCoefficient(factor=factor):
            return f"{_times(factor)} the friction"
        case MagnetizationStrength(factor=factor):
            return f"{_times(factor)} the magnetic torque"
        case TurnedField(ahead_deg=ahead):
            return f"the field {_two_digits(abs(ahead))}° {'ahead of' if ahead > 0.0 else 'behind'} where it should be"
        case ElectrostaticForce(added_force_N=force):
            return f"{plain(force, 'N')} more attraction"
    raise AssertionError(effect)


def _times(factor: float) -> str:
    return f"{_two_digits(factor)} times"


def _two_digits(value: float) -> str:
    # Written out.
    return f"{float(f'{value:.2g}'):g}"
