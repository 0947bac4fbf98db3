"""What the native module refuses, in the words and under the keys of a scenario.

Nearly all of it is refused before: this table is for what only the native module can see.
"""

from __future__ import annotations

import re
from math import degrees

from .errors import InputError

__all__ = ["core_error"]

_NUMBER = r"(-?[\d.]+(?:e-?\d+)?|inf|-inf|NaN)"
# The native module's name of a number: its key.
_NAMES = {
    "length": "robot.length_m",
    "width": "robot.width_m",
    "height": "robot.height_m",
    "spike base": "robot.spike_base_m",
    "spike height": "robot.spike_height_m",
    "overall height": "robot.overall_height_m",
    "outer radius": "robot.outer_radius_m",
    "inner radius": "robot.inner_radius_m",
    "half angle": "robot.half_angle_deg",
    "draft angle": "robot.draft_deg",
    **{f"semi-axis {axis}": "robot.semi_axes_m" for axis in "xyz"},
    "vertex coordinate": "robot.vertices_m",
    "mass_kg": "robot.mass_kg",
    "magnetic moment": "robot.magnetization_A_per_m",
    "center_of_mass_m": "robot.center_of_mass_m",
    "friction_coefficient": "substrate.friction_coefficient",
    "friction_drift_per_s": "substrate.friction_drift_per_s",
    "friction_ellipsoid": "substrate.friction_ellipsoid",
    "adhesion_N_per_m2": "substrate.adhesion_N_per_m2",
    "electrostatic_force_N": "substrate.electrostatic_force_N",
    "line_contact_width_m": "substrate.line_contact_width_m",
    "compliance_m_per_N": "substrate.compliance_m_per_N",
    "strength_T": "field.strength_T",
    "frequency_Hz": "field.frequency_Hz",
    "rotation_axis": "field.rotation_axis",
    "initial_direction": "field.initial_direction",
    "quadrature_ratio": "field.quadrature_ratio",
    "phase_error_deg": "field.phase_error_deg",
    "direction": "field.direction",
    "time_s": "field.time_s",
    "the field's table": "field.field_T",
    "incline_deg": "run.incline_deg",
    "side_incline_deg": "run.side_incline_deg",
    "gravity_m_per_s2": "run.gravity_m_per_s2",
    "duration_s": "run.duration_s",
    "step_s": "run.step_s",
    "initial velocity": "initial.linear_velocity_m_per_s",
    "orientation": "initial.orientation",
    "length of orientation": "initial.orientation",
    "position_m": "initial.position_m",
    "magnetic_torque": "model.magnetic_torque",
    "adhesion_acts_at": "model.adhesion_acts_at",
    "adhesion_enters": "model.adhesion_enters",
    **{name: f"relief.{name}" for name in ("wavelength_m", "cosine_m", "sine_m")},
    **{
        name: f"surroundings.{name}"
        for name in (
            "force_N",
            "torque_N_m",
            "translational_drag_N_s_per_m",
            "rotational_drag_N_m_s",
            "sheet_conductance_S",
            "wrench_time_s",
            "wrench_N_N_m",
        )
    },
}
# A whole message: its key, what was found, what was expected.
_MESSAGES = [
    (rf"the draft angle of {_NUMBER} rad makes the (.*) vanish over the width", "robot.draft_deg",
     "{deg} degrees, at which the {1} vanishes over the width", "a smaller draft"),
    (r"the hull has (.*), expected (.*)", "robot.vertices_m", "{0}", "{1}"),
    (r"the hull is flat: its thickness is (.*), expected (.*)", "robot.vertices_m",
     "points of a thickness of {0}, which are flat", "{1}"),
    (r"the centre of mass \(the origin\) lies (.*) m outside the hull or on its boundary", "robot.vertices_m",
     "the origin {0} m outside the hull or on its boundary", "the centre of mass, which is the origin, inside"),
    (r"center_of_mass_m lies (.*), expected inside", "robot.center_of_mass_m", "a point {0}", "one inside the body"),
    (r"row (.*) of wrench_time_s is at (.*), expected (.*)", "surroundings.wrench_time_s", "row {0} at {1}", "{2}"),
    (r"no consistent convex hull was found for (.*)", "robot.vertices_m",
     "no consistent convex hull for {0}", "points of a convex body"),
    (r"rotation_axis and initial_direction have cosine (.*), expected .*", "field.initial_direction",
     "a direction whose cosine with rotation_axis is {0}", "one at right angles to rotation_axis"),
    (r"row (.*) of the field's table is at (.*), expected (.*)", "field.time_s", "row {0} at {1}", "{2}"),
    (r"the field's table covers (.*), expected it to cover (.*)", "field.time_s", "{0}", "rows that cover {1}"),
    (r"the field's table has (.*), expected (.*)", "field.time_s", "{0}", "{1}"),
    (r"the run of (.*) has (.*), expected (.*)", "run.duration_s", "{0} in {1}", "{2}"),
    (r"position_m puts (.*), expected it (.*)", "initial.position_m", "a position that puts {0}", "one {1}"),
    (r"(.*?) has length (.*), expected (.*)", None, "a length of {1}", "{2}"),
    (r"(.*?) has (.* entries), expected (.*)", None, "{1}", "{2}"),
    (r"(.*?) is (.*?), expected (.*)", None, "{1}", "{2}"),
]  # fmt: skip


def core_error(error: Exception) -> InputError:
    """Return what the native module says as an error of a scenario.

    Parameters
    ----------
    error
        The native module's ``ValueError``.
    """
    text = " ".join(str(error).split())
    for pattern, key, found, expected in _MESSAGES:
        match = re.fullmatch(pattern, text)
        if match is None:
            continue
        parts = list(match.groups())
        key = key or _NAMES.get(parts[0])
        if key is None:
            break
        deg = ""
        if key.endswith("_deg"):
            # The native module measures angles in radians.
            words = parts[0] if "{deg}" in found else parts[1]
            deg = _degrees(words)
            parts[1:] = [_in_degrees(part) for part in parts[1:]]
        return InputError(key, found.format(*parts, deg=deg), expected.format(*parts))
    return InputError("scenario", text, "a run that can be carried out")


def _degrees(words: str) -> str:
    return f"{degrees(float(words)):.6g}"


def _in_degrees(words: str) -> str:
    # The zero of a bound has no unit.
    return re.sub(rf"(?<![\w.]){_NUMBER}", lambda number: _degrees(number[1]), words)
