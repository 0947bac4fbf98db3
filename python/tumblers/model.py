"""`Model`: the choices that the paper leaves open."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, get_args

from .check import choice

__all__ = ["RELEASED_TORQUE", "MagneticTorque", "Model"]

MagneticTorque = Literal["end_of_step", "start_of_step", "midpoint"]
AdhesionActsAt = Literal["ecp", "patch_centroid"]
AdhesionEnters = Literal["normal", "friction_only"]

RELEASED_TORQUE: MagneticTorque = "end_of_step"


@dataclass(frozen=True, kw_only=True, slots=True)
class Model:
    """Switches of the model; see `docs/model.md`.

    Attributes
    ----------
    magnetic_torque
        Where in the step the torque is taken: ``end_of_step`` (the authors' released code), ``start_of_step`` (the
        paper's equation) or ``midpoint`` (second order). None leaves it to the scenario: ``midpoint`` where the step is
        to be chosen, ``end_of_step`` where it is a number.
    adhesion_acts_at
        ``ecp`` (the paper's equation) or ``patch_centroid``.
    adhesion_enters
        ``normal`` (the paper's equation) or ``friction_only``.

    Raises
    ------
    InputError
        A word that is none of these.
    """

    magnetic_torque: MagneticTorque | None = None
    adhesion_acts_at: AdhesionActsAt = "ecp"
    adhesion_enters: AdhesionEnters = "normal"

    def __post_init__(self) -> None:
        if self.magnetic_torque is not None:
            choice("model.magnetic_torque", self.magnetic_torque, get_args(MagneticTorque))
        choice("model.adhesion_acts_at", self.adhesion_acts_at, get_args(AdhesionActsAt))
        choice("model.adhesion_enters", self.adhesion_enters, get_args(AdhesionEnters))

    def with_torque(self, magnetic_torque: MagneticTorque) -> Model:
        """Return the model with a time for the torque where it has none.

        Parameters
        ----------
        magnetic_torque
            Where in the step.
        """
        return self if self.magnetic_torque is not None else replace(self, magnetic_torque=magnetic_torque)
