"""The slope at which a contact that only friction holds begins to slide."""

from __future__ import annotations

from math import asin, atan, degrees, sin

from ..scenario import Scenario

__all__ = ["friction_limit_deg", "line_adhesion_N"]


def friction_limit_deg(scenario: Scenario, adhesion_N: float = 0.0) -> float:
    """Return the greatest slope that friction holds, degrees; 90 where it holds on any.

    A body at rest on a slope φ needs the friction m g sin φ, and the model's cone (`docs/model.md`: p_o² ≤ (μ e_o p̄)²)
    gives as much as μ_y = μ e_o times what presses the contact together::

        m g sin φ = μ_y (m g cos φ + F_elect + F_adhesion)
        tan φ_max = μ_y (1 + (F_elect + F_adhesion)/(m g cos φ_max))

    With φ_μ = atan μ_y both sides times cos φ_μ are sin(φ_max - φ_μ) = sin φ_μ (F_elect + F_adhesion)/(m g), so that::

        φ_max = φ_μ + asin(sin φ_μ (F_elect + F_adhesion)/(m g))

    Left out are inertia, a drift of the friction, the slope to the side, what else pulls (`surroundings`), and whether
    the field can turn the robot.

    Parameters
    ----------
    scenario
        Robot, substrate and gravity, its effects counted in; its own slope does not matter.
    adhesion_N
        F_adhesion, N.
    """
    scenario = scenario.effective()
    substrate = scenario.substrate
    angle = atan(substrate.friction_coefficient * substrate.friction_ellipsoid[1])
    weight = scenario.robot.total_mass_kg * scenario.run.gravity_m_per_s2
    held = sin(angle) * (substrate.electrostatic_force_N + adhesion_N)
    if held >= weight:
        return 90.0
    return min(degrees(angle + asin(held / weight)), 90.0)


def line_adhesion_N(scenario: Scenario) -> float:
    """Return the adhesion of the edge that a robot turns on, C w W, N.

    W is the width of the shape and w the `line_contact_width_m` of the substrate. A line has no area: without a width
    for it, which is the paper's model, nothing adheres. Shapes without a width count as touching at a point.

    Parameters
    ----------
    scenario
        Robot and substrate, its effects counted in.
    """
    scenario = scenario.effective()
    edge = float(getattr(scenario.robot.shape, "width_m", 0.0))
    return scenario.substrate.adhesion_N_per_m2 * scenario.substrate.line_contact_width_m * edge
