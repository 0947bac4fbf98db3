from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

import tumblers
from tumblers import InputError, Scenario, StaticField, preset_scenario
from tumblers.effects.size_error import SizeError
from tumblers.studies.ascent import Ascent, Slopes, bisections
from tumblers.studies.plots import plot_climb

COARSE = [0.0, 20.0, 40.0, 60.0, 80.0]


def scenario(robot: str, substrate: str, strip_m: float = 0.0) -> Scenario:
    made = preset_scenario(robot=robot, substrate=substrate, drive="20mT_1Hz")
    return replace(made, substrate=replace(made.substrate, line_contact_width_m=strip_m))


@pytest.mark.parametrize(
    ("robot", "substrate", "strip_m"),
    [
        ("cuboid", "paper", 0.0),
        ("cuboid_second_generation", "aluminium", 0.0),
        ("cuboid_second_generation", "aluminium", 6e-6),
        ("spiked_su8", "aluminium", 6e-6),
        ("spiked_ends_pdms", "aluminium_pdms", 0.0),
    ],
)
def test_robots_climb_to_the_friction_limit(robot: str, substrate: str, strip_m: float) -> None:
    """What ends climbing in the model is the line that slides; the search resolves 0.1°, and as much is slip."""
    result = tumblers.climb(scenario(robot, substrate, strip_m), slopes_deg=COARSE)
    limit = result.attrs["friction_limit_with_line_adhesion_deg"]
    assert result.attrs["limit_deg"] == pytest.approx(limit, abs=0.2)
    assert 0.0 < result.attrs["limit_above_deg"] - result.attrs["limit_deg"] <= 0.1
    assert result.attrs["monotone"] == 1
    assert (result.attrs["friction_limit_deg"] == limit) == (strip_m == 0.0)


def test_the_result_holds_every_slope_tried_and_its_scenario() -> None:
    made = scenario("cuboid", "paper")
    result = tumblers.climb(made, slopes_deg=COARSE, resolution_deg=5.0)
    assert result.incline_deg.values.tolist() == [0.0, 20.0, 40.0, 45.0, 50.0, 60.0, 80.0]
    assert result.incline_deg.values[result.scanned.values].tolist() == COARSE
    assert result.climbs.values.tolist() == [True, True, True, True, False, False, False]
    # On the level the way of a cycle is the perimeter, to the damping of the step.
    assert float(result.mean_share[0]) == pytest.approx(1.0, abs=1e-3)
    assert float(result.speed_m_per_s[0]) == pytest.approx(1.8e-3, rel=1e-3)
    assert Scenario.from_toml(result.attrs["scenario"]) == made
    again = tumblers.climb(made, slopes_deg=COARSE, resolution_deg=5.0, threads=1)
    assert again.identical(result)


def test_a_robot_that_stays_where_it_is_climbs_nothing() -> None:
    made = scenario("cuboid", "paper")
    still = replace(made, field=replace(made.field, strength_T=0.0))
    result = tumblers.climb(still, slopes_deg=COARSE)
    assert np.isnan(result.attrs["limit_deg"])
    assert result.attrs["limit_above_deg"] == 0.0
    assert not result.climbs.values.any()


def test_a_limit_beyond_the_scan_is_open() -> None:
    result = tumblers.climb(scenario("cuboid", "paper"), slopes_deg=[0.0, 10.0])
    assert result.attrs["limit_deg"] == 10.0
    assert np.isnan(result.attrs["limit_above_deg"])


def ascent(slope: float, mean: float, worst: float) -> Ascent:
    return Ascent(
        incline_deg=slope, speed_m_per_s=0.0, mean_share=mean, worst_share=worst, unconverged_steps=0, error=""
    )


@pytest.mark.parametrize(
    ("mean", "worst", "expected"),
    [(0.5, 0.4, True), (0.5, 0.0, True), (0.005, 0.0, False), (0.5, -0.2, False), (np.nan, np.nan, False)],
)
def test_climbing_is_progress_without_sliding_back(mean: float, worst: float, expected: bool) -> None:
    assert ascent(0.0, mean, worst).climbs is expected


def test_climbing_that_ends_more_than_once_is_noticed() -> None:
    shares = [1.0, 1.0, 0.0, 0.0, 1.0, 0.0]
    slopes = Slopes(ascents=tuple(ascent(10.0 * i, s, s) for i, s in enumerate(shares)), scanned=())
    assert slopes.limit == (10.0, 20.0)
    assert slopes.greatest == (40.0, 50.0)
    assert not slopes.monotone


def test_bisections_reach_the_resolution() -> None:
    assert bisections([0.0, 2.5, 10.0], 0.1) == 7  # 7.5° / 2^7 = 0.06°
    assert bisections([0.0, 2.5], 2.5) == 0
    assert bisections([5.0], 0.1) == 0


@pytest.mark.parametrize(
    ("arguments", "key"),
    [
        ({"slopes_deg": []}, "slopes_deg"),
        ({"slopes_deg": [10.0, 5.0]}, "slopes_deg"),
        ({"slopes_deg": [0.0, 90.0]}, "slopes_deg[1]"),
        ({"resolution_deg": 0.0}, "resolution_deg"),
        ({"cycles": 0}, "cycles"),
        ({"settling_cycles": -1}, "settling_cycles"),
        ({"threads": 0}, "threads"),
    ],
)
def test_bad_arguments_are_refused(arguments: dict[str, object], key: str) -> None:
    with pytest.raises(InputError) as refused:
        tumblers.climb(scenario("cuboid", "paper"), **arguments)  # type: ignore[arg-type]
    assert refused.value.key == key


def test_a_field_without_cycles_is_refused() -> None:
    still = replace(scenario("cuboid", "paper"), field=StaticField(strength_T=0.01, direction=(0.0, 1.0, 0.0)))
    with pytest.raises(InputError, match=r"field\.kind: found 'static', expected 'rotating'"):
        tumblers.climb(still)


def test_the_way_without_slip_is_that_of_the_body_with_every_effect() -> None:
    cuboid = replace(scenario("cuboid", "paper"), effects=(SizeError(length_factor=1.5),))
    result = tumblers.climb(cuboid, slopes_deg=[0.0])
    # Without a slope it does not slip: the way of a cycle is the perimeter.
    assert float(result.mean_share[0]) == pytest.approx(1.0, abs=0.01)
    (ax,) = plot_climb(result, Figure()).axes
    (without_slip,) = (line for line in ax.get_lines() if line.get_label() == "without slip")
    assert without_slip.get_ydata()[0] == pytest.approx(float(result.speed_m_per_s[0]) * 1e6, rel=0.01)
