"""The static torque that turns a robot over every face that it comes to rest on."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from ..errors import InputError, TumblersError
from ..scenario import Scenario

__all__ = ["tipping_field_T", "tipping_torque_N_m"]

Floats = NDArray[np.float64]

# What lies this close to a face, over the body's size, lies in it.
_IN_FACE = 1e-6


def tipping_torque_N_m(scenario: Scenario) -> float:
    """Return the greatest static torque of one turn on a level substrate, N m.

    In one turn a prism comes to rest on every edge i of the hull of its side profile. It leaves that face by turning
    about its leading edge, against the moments of what presses it down::

        T_i = (m g + F_elect) d_i + C Σ_j A_ij c_ij

    d_i is the lever of the centre of mass, where the model's weight and electrostatic force act, A_ij the areas that
    really touch (none where the hull bridges a gap), and c_ij the levers of their centroids: adhesion acts there in the
    paper's measurement of C (a field is raised until the robot starts to turn), and in the model with
    ``adhesion_acts_at = "patch_centroid"``. Return max_i T_i. A round side counts as the chords of its outline.
    Left out are inertia and the adhesion of lines.

    Parameters
    ----------
    scenario
        Robot and substrate, its effects counted in. The robot is taken without draft.

    Raises
    ------
    InputError
        A shape that is not a prism across the direction of travel.
    """
    scenario = scenario.effective()
    robot, substrate = scenario.robot, scenario.substrate
    if not hasattr(robot.shape, "width_m"):
        raise InputError("robot.shape", repr(robot.shape.kind), "cuboid, spiked, spiked_ends or curved")
    weight = robot.total_mass_kg * scenario.run.gravity_m_per_s2 + substrate.electrostatic_force_N
    body = robot.with_draft(0.0).body()
    sides = [polygon for polygon in body.outline if np.ptp(polygon[:, 0]) > 0.0]
    points = np.concatenate([polygon[:, 1:] for polygon in sides])
    hull = ConvexHull(points)
    greatest = 0.0
    for edge, (n_y, n_z, offset) in zip(hull.simplices, hull.equations, strict=True):
        # With the outward normal downwards, this is the direction of travel.
        forward = np.array([-n_z, n_y])
        lead = float((points[edge] @ forward).max())
        torque = weight * max(lead, 0.0)
        for polygon in sides:
            profile = polygon[:, 1:]
            if np.abs(profile @ (n_y, n_z) + offset).max() <= _IN_FACE * body.size_m:
                centroid = float((profile @ forward).mean())
                torque += substrate.adhesion_N_per_m2 * _area(polygon) * (lead - centroid)
        greatest = max(greatest, torque)
    return greatest


def tipping_field_T(scenario: Scenario) -> float:
    """Return the weakest field at right angles to the moment that gives the tipping torque, T; inf without a moment.

    ``B = T / |M|``, with M the magnetic moment.

    Parameters
    ----------
    scenario
        As in `tipping_torque_N_m`.

    Raises
    ------
    InputError
        A shape that is not a prism across the direction of travel.
    """
    moment = float(np.linalg.norm(scenario.effective().robot.magnetic_moment_A_m2))
    return tipping_torque_N_m(scenario) / moment if moment > 0.0 else float("inf")


def tipping_or_nan(scenario: Scenario) -> tuple[float, float]:
    """Return torque (N m) and field (T) of tipping; NaN where the body cannot be built.

    Parameters
    ----------
    scenario
        As in `tipping_torque_N_m`.
    """
    try:
        return tipping_torque_N_m(scenario), tipping_field_T(scenario)
    except TumblersError:
        return float("nan"), float("nan")


def _area(polygon: Floats) -> float:
    spokes = polygon[1:] - polygon[0]
    return 0.5 * float(np.linalg.norm(np.cross(spokes[:-1], spokes[1:]).sum(axis=0)))
