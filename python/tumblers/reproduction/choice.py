"""`Choices`: what a result's run depends on beside its own conditions."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from ..effects.stray_field_gradient import StrayFieldGradient
from ..field import RotatingField
from ..model import AdhesionActsAt, AdhesionEnters, MagneticTorque, Model
from ..presets import ROBOTS, SUBSTRATES
from ..robot import DraftModel
from ..run import Run
from ..scenario import Scenario
from .pose import Pose, initial

__all__ = ["Choices", "Ground", "ParameterSet"]

ParameterSet = Literal["text", "released"]
Ground = Literal["paper", "aluminium", "aluminium_pdms"]

_SUBSTRATE: dict[tuple[Ground, ParameterSet], str] = {
    ("paper", "text"): "paper",
    ("paper", "released"): "paper_released",
    ("aluminium", "text"): "aluminium",
    ("aluminium", "released"): "aluminium_released",
    # The text has one table for aluminium, that of SU-8, and only words on PDMS.
    ("aluminium_pdms", "text"): "aluminium",
    ("aluminium_pdms", "released"): "aluminium_pdms",
}


@dataclass(frozen=True, kw_only=True, slots=True)
class Choices:
    """What a result's run depends on beside its own conditions, by default as in the text and the released code.

    Attributes
    ----------
    parameters
        ``text`` or ``released``: whose numbers of the substrate.
    draft_model
        ``geometric`` or ``as_released``: how the slanted faces take the draft.
    magnetic_torque, adhesion_acts_at, adhesion_enters
        The switches of `tumblers.Model`.
    step_s
        Step, s; 5·10⁻⁴ as released.
    e_r_m
        The friction ellipsoid's third axis, m; 0.1 as released.
    line_contact_width_m
        Width of the strip that counts as area where a line touches, m; 0 is the paper's model.
    pose
        How the robot is set down.
    field_factor
        The field's strength over the one that the result is run with.
    electrostatic_force_N
        F_elect, N; that of the parameter set if None.
    stray_gradient_T_per_m
        Pull along the direction of travel per magnetic moment at 10 Hz, T/m; 0 is the paper's model.
    stray_gradient_power
        Power of the frequency that it grows with.
    """

    parameters: ParameterSet = "text"
    draft_model: DraftModel = "geometric"
    magnetic_torque: MagneticTorque = "end_of_step"
    adhesion_acts_at: AdhesionActsAt = "ecp"
    adhesion_enters: AdhesionEnters = "normal"
    step_s: float = 5.0e-4
    e_r_m: float = 0.1
    line_contact_width_m: float = 0.0
    pose: Pose = "lying"
    field_factor: float = 1.0
    electrostatic_force_N: float | None = None
    stray_gradient_T_per_m: float = 0.0
    stray_gradient_power: float = 0.0

    def substrate(self, ground: Ground) -> str:
        """Return the name of the preset that these choices take for a ground.

        Parameters
        ----------
        ground
            What the robot moves on.
        """
        return _SUBSTRATE[ground, self.parameters]

    def scenario(
        self,
        robot: str,
        ground: Ground,
        field: RotatingField,
        *,
        duration_s: float,
        incline_deg: float = 0.0,
        output_every_s: float | None = None,
    ) -> Scenario:
        """Return a scenario under these choices.

        Parameters
        ----------
        robot
            Key of `tumblers.ROBOTS`.
        ground
            What it moves on.
        field
            What drives it.
        duration_s, incline_deg, output_every_s
            Time, s, slope along the direction of travel, degrees, and time between two rows, s.

        Raises
        ------
        InputError
            Choices that the scenario refuses, such as a step that is too long for the field.
        """
        gradient = StrayFieldGradient(
            gradient_T_per_m=(0.0, self.stray_gradient_T_per_m, 0.0), frequency_exponent=self.stray_gradient_power
        )
        substrate = SUBSTRATES[self.substrate(ground)].value
        e_t, e_o, _ = substrate.friction_ellipsoid
        return Scenario(
            robot=replace(ROBOTS[robot].value, draft_model=self.draft_model),
            substrate=replace(
                substrate,
                friction_ellipsoid=(e_t, e_o, self.e_r_m),
                line_contact_width_m=self.line_contact_width_m,
                electrostatic_force_N=(
                    substrate.electrostatic_force_N
                    if self.electrostatic_force_N is None
                    else self.electrostatic_force_N
                ),
            ),
            field=replace(field, strength_T=self.field_factor * field.strength_T),
            run=Run(duration_s=duration_s, step_s=self.step_s, incline_deg=incline_deg, output_every_s=output_every_s),
            model=Model(
                magnetic_torque=self.magnetic_torque,
                adhesion_acts_at=self.adhesion_acts_at,
                adhesion_enters=self.adhesion_enters,
            ),
            initial=initial(self.pose, robot),
            effects=() if gradient.is_neutral() else (gradient,),
        )
