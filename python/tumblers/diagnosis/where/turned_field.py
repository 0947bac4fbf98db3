"""`TurnedField`: a rotating field that is ahead of where it should be."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, radians, sin
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from ...effects.base import Effect
from ...effects.parameter import Parameter
from ...errors import InputError
from ...field import RotatingField

if TYPE_CHECKING:
    from ...scenario import Scenario

__all__ = ["TurnedField"]


@dataclass(frozen=True, kw_only=True, slots=True)
class TurnedField(Effect):
    """The field is turned about its rotation axis, with its ellipse where that is none of a circle.

    b0' = cos φ b0 + sin φ (a × b0)

    All along, that is another start; from a moment on, it is a source that lost its count.

    Source: the rotation of a vector about an axis at right angles to it.

    Attributes
    ----------
    ahead_deg
        φ, degrees: 0 is neutral.
    """

    name: ClassVar[str] = "turned_field"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter(key="ahead_deg", neutral=0.0, low=-180.0, high=180.0, unit="°", meaning="how far it is ahead"),
    )
    ahead_deg: float = 0.0

    def act(self, scenario: Scenario) -> Scenario:
        """Return the scenario with its field turned.

        Parameters
        ----------
        scenario
            Of a field that rotates.

        Raises
        ------
        InputError
            A field that does not.
        """
        field = scenario.field
        if not isinstance(field, RotatingField):
            raise InputError("field.kind", repr(field.kind), f"'rotating', for {self.name} to act on")
        angle, b0 = radians(self.ahead_deg), np.asarray(field.initial_direction)
        x, y, z = (cos(angle) * b0 + sin(angle) * np.cross(field.rotation_axis, b0)).tolist()
        return replace(scenario, field=replace(field, initial_direction=(x, y, z)))
