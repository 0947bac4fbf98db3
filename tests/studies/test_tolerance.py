from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import tumblers
from tumblers import InputError, Scenario, preset_scenario
from tumblers.studies.words import tolerance_words

GRID = {
    "drafts_deg": [0.0, 1.0, 2.0, 3.0],
    "theta1_deg": [0.0, 5.0, 10.0],
    "theta2_deg": np.arange(-180.0, 181.0, 10.0),
}


@pytest.fixture(scope="module")
def released() -> Scenario:
    scenario = preset_scenario("spiked")
    return replace(scenario, robot=replace(scenario.robot, draft_model="as_released"))


@pytest.fixture(scope="module")
def found(released: Scenario) -> xr.Dataset:
    return tumblers.tolerance(released, **GRID)


def test_single_tolerances_of_the_spiked_robot(found: xr.Dataset) -> None:
    """The paper's φ ≤ 2° with the released draft; |θ2| ≤ 10° on its grid of 10°, which ends at 15° on a finer one."""
    assert found.attrs["draft_tolerance_deg"] == pytest.approx(2.0, abs=0.05)
    assert found.attrs["theta2_tolerance_deg"] == pytest.approx(15.2, abs=0.2)
    assert (found.attrs["draft_tolerance_open"], found.attrs["theta2_tolerance_open"]) == (0, 0)


def test_the_draft_as_drawn_is_borne_half_as_far() -> None:
    drawn = tumblers.tolerance(preset_scenario("spiked"), **GRID)
    assert drawn.attrs["draft_tolerance_deg"] == pytest.approx(1.05, abs=0.05)


def test_the_cases_are_those_of_a_sweep(released: Scenario, found: xr.Dataset) -> None:
    cases = tumblers.sweep(released, drafts_deg=[2.0], magnetization=[(0.0, 0.0), (5.0, 180.0), (10.0, 340.0)])
    drift = found.drift_m.sel(draft_deg=2.0)
    assert (drift.sel(theta1_deg=0.0) == cases.drift_m.values[0, 0]).all()
    for theta2 in (-180.0, 180.0):
        assert float(drift.sel(theta1_deg=5.0, theta2_deg=theta2)) == cases.drift_m.values[0, 1]
    assert float(drift.sel(theta1_deg=10.0, theta2_deg=-20.0)) == cases.drift_m.values[0, 2]


def test_kept_is_no_flip_and_little_drift(found: xr.Dataset) -> None:
    expected = (abs(found.drift_m) <= 50e-6) & (abs(found.twist_deg) <= 45.0)
    assert (found.kept == expected).all()
    assert bool(found.kept.any())
    assert not bool(found.kept.all())
    circle = found.kept.sel(theta2_deg=slice(-180.0, 170.0))
    assert np.allclose(found.kept_share, circle.mean("theta2_deg"))


@pytest.mark.parametrize("name", ["joint_draft_deg", "joint_draft_any_theta1_deg"])
def test_joint_tolerances_are_kept_and_no_greater_ones_are(found: xr.Dataset, name: str) -> None:
    kept = found.kept if name.endswith("any_theta1_deg") else found.kept.isel(theta1_deg=[-1])
    for bound, draft in zip(found.theta2_bound_deg.values, found[name].values, strict=True):
        inside = kept.where(abs(kept.theta2_deg) <= bound, drop=True).astype(bool)
        least = -1.0 if np.isnan(draft) else draft
        assert bool(inside.sel(draft_deg=inside.draft_deg <= least).all())
        beyond = inside.sel(draft_deg=inside.draft_deg > least)
        assert beyond.size == 0 or not bool(beyond.isel(draft_deg=0).all())


def test_the_papers_box_is_judged_where_the_grid_has_its_corners(released: Scenario, found: xr.Dataset) -> None:
    box = found.sel(theta1_deg=10.0, draft_deg=slice(0.0, 2.0), theta2_deg=slice(-10.0, 10.0))
    assert found.attrs["paper_box_kept"] == pytest.approx(float(box.kept.mean()))
    assert found.attrs["paper_box_drift_m"] == float(abs(box.drift_m).max())
    assert found.attrs["joint_theta2_draft_deg"] == 2.0
    for drafts, theta2 in (([0.0, 1.0], [-10.0, 0.0, 10.0]), ([0.0, 2.0], [0.0, 10.0])):
        small = tumblers.tolerance(released, drafts_deg=drafts, theta1_deg=[0.0, 10.0], theta2_deg=theta2)
        assert np.isnan(small.attrs["paper_box_kept"])
        assert np.isnan(small.attrs["paper_box_drift_m"])
        assert small.attrs["joint_theta2_draft_deg"] == drafts[-1]
        said = tolerance_words(small)
        assert f"; with φ ≤ {drafts[-1]:g}° " in said
        assert said.endswith("|θ2| ≤ 10°: not judged, the grid has not its corners")
    # A range of steps may end a rounding above 2.
    rounded = tumblers.tolerance(
        released, drafts_deg=[0.0, 2.0 + 1e-15], theta1_deg=[0.0, 10.0], theta2_deg=[-10.0, 0.0, 10.0]
    )
    assert 0.0 <= rounded.attrs["paper_box_kept"] <= 1.0


def test_a_wider_limit_bears_more(released: Scenario, found: xr.Dataset) -> None:
    wide = tumblers.tolerance(released, drift_limit_m=1.0, **GRID)
    assert wide.attrs["draft_tolerance_open"] == 1
    assert wide.attrs["draft_tolerance_deg"] == 3.0
    assert bool((wide.kept >= found.kept).all())


@pytest.mark.parametrize(
    ("arguments", "key"),
    [
        ({"drift_limit_m": 0.0}, "drift_limit_m"),
        ({"drafts_deg": [1.0, 2.0]}, "drafts_deg"),
        ({"drafts_deg": []}, "drafts_deg"),
        ({"theta1_deg": [0.0]}, "theta1_deg"),
        ({"theta2_deg": [10.0, 20.0]}, "theta2_deg"),
        ({"theta2_deg": [0.0, 20.0, 10.0]}, "theta2_deg"),
        ({"threads": 0}, "threads"),
    ],
)
def test_bad_arguments_are_refused(released: Scenario, arguments: dict[str, object], key: str) -> None:
    with pytest.raises(InputError) as refused:
        tumblers.tolerance(released, **arguments)  # type: ignore[arg-type]
    assert refused.value.key == key
