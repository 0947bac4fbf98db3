from __future__ import annotations

from dataclasses import replace
from math import atan, cos, degrees, radians, sin

import pytest

from tumblers import Scenario, preset_scenario
from tumblers.studies.friction_limit import friction_limit_deg, line_adhesion_N


def on(substrate: str, **changes: object) -> Scenario:
    scenario = preset_scenario(robot="cuboid", substrate=substrate, drive="20mT_1Hz")
    return replace(scenario, substrate=replace(scenario.substrate, **changes))


@pytest.mark.parametrize("adhesion_N", [0.0, 1e-7, 3e-7])
@pytest.mark.parametrize("e_o", [0.5, 1.0, 1.2])
def test_the_slope_found_balances_weight_and_friction(adhesion_N: float, e_o: float) -> None:
    scenario = on("paper", friction_ellipsoid=(1.0, e_o, 0.1))
    slope = radians(friction_limit_deg(scenario, adhesion_N))
    weight = 3.78e-8 * 9.8
    friction = 0.3 * e_o * (weight * cos(slope) + 6.54e-7 + adhesion_N)
    assert weight * sin(slope) == pytest.approx(friction, rel=1e-12, abs=0.0)


def test_without_other_forces_it_is_the_friction_angle() -> None:
    assert friction_limit_deg(on("aluminium")) == pytest.approx(degrees(atan(0.54)), rel=1e-12)


def test_what_holds_on_any_slope_is_ninety_degrees() -> None:
    assert friction_limit_deg(on("paper"), 1e-5) == 90.0
    weightless = on("paper")
    assert friction_limit_deg(replace(weightless, run=replace(weightless.run, gravity_m_per_s2=0.0))) == 90.0


def test_a_line_adheres_by_its_width_alone() -> None:
    assert line_adhesion_N(on("aluminium")) == 0.0
    assert line_adhesion_N(on("aluminium", line_contact_width_m=6e-6)) == pytest.approx(26.18 * 6e-6 * 4e-4, abs=0.0)
