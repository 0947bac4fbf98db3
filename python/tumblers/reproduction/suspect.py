"""`Suspect`: one choice that is changed to see whether it is why a row differs."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

from .choice import Choices

__all__ = ["DRAFT", "STANDARD", "STRAY_GRADIENT", "UNSTATED", "Suspect", "suspects"]


@dataclass(frozen=True, slots=True)
class Suspect:
    """A named change of one choice.

    Attributes
    ----------
    words
        What it is in words.
    changes
        The attributes of `Choices` that it sets.
    """

    words: str
    changes: dict[str, Any] = field(hash=False)

    def applied(self, choices: Choices) -> Choices:
        """Return the choices with this change.

        Parameters
        ----------
        choices
            What is changed.
        """
        return replace(choices, **self.changes)


DRAFT: tuple[Suspect, ...] = (
    Suspect("the draft as drawn", {"draft_model": "geometric"}),
    Suspect("the released draft formula", {"draft_model": "as_released"}),
)
# The text gives the field's strength for SU-8 robots only, and says that aluminium bears no electrostatic force.
UNSTATED: tuple[Suspect, ...] = (
    *(Suspect(f"a field of {20.0 * factor:g} mT", {"field_factor": factor}) for factor in (0.5, 2.0, 5.0)),
    Suspect("no electrostatic force", {"electrostatic_force_N": 0.0}),
)
STRAY_GRADIENT: tuple[Suspect, ...] = tuple(
    Suspect(
        f"a stray gradient of {gradient:g} T/m at 10 Hz"
        + (", growing with the cube of the frequency" if power else ""),
        {"stray_gradient_T_per_m": gradient, "stray_gradient_power": power},
    )
    for power in (0.0, 3.0)
    for gradient in (0.05, 0.15)
)
STANDARD: tuple[Suspect, ...] = (
    Suspect("the text's parameters", {"parameters": "text"}),
    Suspect("the released parameters", {"parameters": "released"}),
    Suspect("adhesion acting at the patch's centroid", {"adhesion_acts_at": "patch_centroid"}),
    Suspect("adhesion entering the friction bound only", {"adhesion_enters": "friction_only"}),
    *(Suspect(f"e_r = {e_r:g} m", {"e_r_m": e_r}) for e_r in (1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 1.0)),
    *(
        Suspect(f"a line contact {width * 1e6:g} µm wide", {"line_contact_width_m": width})
        for width in (3e-6, 6e-6, 9e-6, 12e-6)
    ),
    Suspect("the robot falling from the stated height", {"pose": "stated"}),
    Suspect("the robot set down upside down", {"pose": "upside_down"}),
    Suspect("the robot set down on its side", {"pose": "on_side"}),
    Suspect("the robot set down on its end", {"pose": "on_end"}),
    Suspect("the torque at the middle of the step", {"magnetic_torque": "midpoint"}),
    # The explicit torque needs the shorter step to be stable.
    Suspect("the torque at the start of a step of 1e-4 s", {"magnetic_torque": "start_of_step", "step_s": 1e-4}),
    *(Suspect(f"a step of {step:g} s", {"step_s": step}) for step in (1e-3, 2.5e-4, 1e-4, 5e-5)),
)


def suspects(tried: tuple[Suspect, ...], choices: Choices) -> list[Suspect]:
    """Return those of the suspects that are a change of the given choices.

    Parameters
    ----------
    tried
        Suspects.
    choices
        What a row was run with.
    """
    return [suspect for suspect in tried if suspect.applied(choices) != choices]
