"""`Parameter`: one number of an effect."""

from __future__ import annotations

from dataclasses import dataclass
from math import asinh, sinh
from typing import Literal

__all__ = ["FORM_SHARE", "Nuisance", "Parameter"]

# How often an effect is expected to vary in a way for which it has a parameter: as often as not. Nobody knows:
# dry friction runs in and wears (Blau 2005, Tribology International 38, 1007), or stays.
FORM_SHARE = 0.5

# What of each trial's sensor is fitted in every hypothesis, in the order in which a diagnosis keeps it.
Nuisance = Literal["clock", "origin x", "origin y", "origin z"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Parameter:
    """One number of an effect.

    Attributes
    ----------
    key
        Where it stands in ``[[effect]]``: ``factor``, or ``gradient_T_per_m[1]`` for an entry of a list.
    neutral
        The value that changes nothing.
    low, high
        Plausible range, which a fit searches.
    unit
        Its unit, ``1`` for a pure number.
    meaning
        What it is, in a few words.
    least, above
        Bounds beyond which a value is refused, where there are any.
    turns
        Whether it is an angle in degrees that comes back to itself after 360.
    fine
        Where the range spans decades: the size c from which on a fit moves in its logarithm, by asinh(c / fine).
    beyond
        Which of the sensor's nuisances does the same to each trial within its tolerance, if any does: a diagnosis
        searches the parameter where that tolerance is not enough.
    always
        Whether it has a value of its own wherever the effect acts, as a wavelength has; any other may be at neutral
        while the rest act, and a diagnosis counts on that.
    form
        Whether it says how the effect varies, as a drift does, which a diagnosis expects in `FORM_SHARE` of the cases.
    """

    key: str
    neutral: float
    low: float
    high: float
    unit: str
    meaning: str
    least: float | None = None
    above: float | None = None
    turns: bool = False
    fine: float | None = None
    beyond: Nuisance | None = None
    always: bool = False
    form: bool = False

    @property
    def field(self) -> str:
        """Name of the effect's field that holds the number."""
        return self.key.partition("[")[0]

    def to_fit(self, value: float) -> float:
        """Return the coordinate in which a fit moves.

        Parameters
        ----------
        value
            Of the parameter.
        """
        return value if self.fine is None else asinh(value / self.fine)

    def from_fit(self, coordinate: float) -> float:
        """Return the parameter's value.

        Parameters
        ----------
        coordinate
            In which a fit moves.
        """
        if self.fine is None:
            return coordinate
        # Neutral has to stay neutral to the last bit.
        return self.neutral if coordinate == self.to_fit(self.neutral) else self.fine * sinh(coordinate)
