from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import tumblers
from tumblers import InputError, Scenario, preset_scenario
from tumblers.effects.field_rolloff import FieldRolloff
from tumblers.studies.family import family_of
from tumblers.studies.front import pareto_front
from tumblers.studies.robust import Errors
from tumblers.studies.space import DesignSpace
from tumblers.studies.tipping import tipping_field_T, tipping_torque_N_m

SMALL = {"samples": 8, "generations": 2, "errors": Errors(draws=8)}


@pytest.fixture(scope="module")
def spiked() -> Scenario:
    return preset_scenario("spiked", drive=tumblers.drive(0.020, 10.0), duration_s=0.1)


@pytest.fixture(scope="module")
def found(spiked: Scenario) -> xr.Dataset:
    return tumblers.design(spiked, **SMALL)


def test_tipping_a_cuboid_takes_weight_and_adhesion_of_its_largest_face() -> None:
    scenario = preset_scenario(robot="cuboid", substrate="paper", drive="20mT_1Hz")
    pressed = 3.78e-8 * 9.8 + 6.54e-7
    expected = pressed * 4e-4 + 1.19 * 8e-4 * 4e-4 * 4e-4
    assert tipping_torque_N_m(scenario) == pytest.approx(expected, rel=1e-9, abs=0.0)
    assert tipping_field_T(scenario) == pytest.approx(expected / (2.9e-11 * 15000.0), rel=1e-9, abs=0.0)


def test_a_hull_over_a_gap_does_not_adhere(spiked: Scenario) -> None:
    """The spiked robot rests on tip and corner; only its short ends touch with an area."""
    shape, substrate = spiked.robot.shape, spiked.substrate
    pressed = spiked.robot.total_mass_kg * 9.8 + substrate.electrostatic_force_N
    end = pressed * 3.75e-5 + substrate.adhesion_N_per_m2 * 7.5e-5 * shape.width_m * 3.75e-5
    tip, corner = np.array([0.0, 1.625e-4]), np.array([2.0e-4, 3.75e-5])
    along = (corner - tip) / np.linalg.norm(corner - tip)
    slanted = pressed * max(corner @ along, -tip @ along)
    assert tipping_torque_N_m(spiked) == pytest.approx(max(end, slanted), rel=1e-9, abs=0.0)
    bare = replace(spiked, substrate=replace(substrate, adhesion_N_per_m2=0.0))
    assert tipping_torque_N_m(bare) == pytest.approx(max(pressed * 3.75e-5, slanted), rel=1e-9, abs=0.0)


@pytest.mark.parametrize("robot", ["cuboid", "spiked_su8", "spiked_ends_pdms", "curved_su8"])
def test_a_family_holds_its_base_robot(robot: str) -> None:
    base = tumblers.ROBOTS[robot].value
    family = family_of(base)
    again = family.robot(family.start)
    assert again.body().volume_m3 == pytest.approx(base.body().volume_m3, rel=1e-9, abs=0.0)
    assert again.body().hull_perimeter_m == pytest.approx(base.body().hull_perimeter_m, rel=1e-9, abs=0.0)
    assert again.total_mass_kg == pytest.approx(base.total_mass_kg, rel=1e-9, abs=0.0)
    moment = np.linalg.norm(base.magnetic_moment_A_m2)
    assert np.linalg.norm(again.magnetic_moment_A_m2) == pytest.approx(moment, rel=1e-9, abs=0.0)
    for corner in np.ndindex(*(2,) * len(family.parameters)):
        made = family.robot(family.values(corner))
        assert made.with_draft(4.0).body().volume_m3 > 0.0


def test_an_ellipsoid_has_no_family() -> None:
    robot = replace(tumblers.ROBOTS["cuboid"].value, shape=tumblers.Ellipsoid(semi_axes_m=(1e-4, 2e-4, 1e-4)))
    with pytest.raises(InputError, match=r"robot\.shape: found 'ellipsoid'"):
        family_of(robot)


def test_nothing_beats_the_front() -> None:
    costs = np.random.default_rng(0).integers(0, 5, (60, 3)).astype(float)
    costs[7] = np.nan
    front = pareto_front(costs)
    for i, mine in enumerate(costs):
        beaten = any((other <= mine).all() and (other < mine).any() for other in costs)
        assert front[i] == (not beaten and i != 7)


def test_errors_have_the_distribution_that_they_state() -> None:
    errors = Errors(draft_most_deg=4.0, axis_sigma_deg=5.0, draws=4096)
    draft, theta1, theta2 = errors.drawn().T
    # A Sobol sequence of 4096 points takes means to better than a thousandth.
    assert draft.mean() == pytest.approx(2.0, rel=1e-3)
    assert (theta1**2).mean() == pytest.approx(2.0 * 5.0**2, rel=5e-3)
    assert theta2.mean() == pytest.approx(180.0, rel=1e-3)
    assert draft.min() >= 0.0
    assert draft.max() <= 4.0
    assert (errors.drawn() == replace(errors).drawn()).all()


def test_candidates_are_the_best_of_their_kind(found: xr.Dataset) -> None:
    nominal = found.candidate_nominal_merit_m_per_s.sel(candidate="nominal")
    assert float(nominal) >= float(found.nominal_merit_m_per_s.max()) * (1.0 - 1e-12)
    gain = found.attrs["robust_gain_m_per_s"]
    merit = found.candidate_robust_merit_m_per_s
    assert gain == pytest.approx(float(merit.sel(candidate="robust") - merit.sel(candidate="nominal")), rel=1e-9)
    assert gain > 0.0
    assert found.candidate_speed_m_per_s.sel(candidate="base") == pytest.approx(10.934e-3, rel=0.02)


def test_merit_is_speed_less_drift_of_what_stays_upright(found: xr.Dataset) -> None:
    each = (found.draw_speed_m_per_s - abs(found.draw_drift_m) * 10.0).where(found.draw_upright.astype(bool), 0.0)
    assert np.allclose(each.mean("draw"), found.candidate_robust_merit_m_per_s, rtol=1e-12)
    assert np.allclose(found.draw_upright.mean("draw"), found.candidate_upright_share)


def test_a_field_too_weak_to_tip_a_design_gives_it_no_merit(spiked: Scenario) -> None:
    weak = replace(spiked, field=replace(spiked.field, strength_T=1.5e-3))
    result = tumblers.design(weak, samples=8, generations=0, errors=Errors(draws=8))
    turns = result.tipping_field_T <= 1.5e-3
    assert (result.turns == turns).all()
    assert bool(turns.any())
    assert not bool(turns.all())
    assert (result.robust_merit_m_per_s.where(~turns, drop=True) == 0.0).all()
    assert not bool((result.front & ~turns).any())


def test_the_field_that_tips_a_design_is_that_with_every_effect(spiked: Scenario) -> None:
    rolled = replace(spiked, effects=(FieldRolloff(time_constant_s=0.1),))
    strength = rolled.effective().field.strength_T
    assert strength < 0.2 * spiked.field.strength_T
    assert DesignSpace(rolled, 1.0).turns(np.array([0.99, 1.01]) * strength).tolist() == [True, False]


class Stopped(Exception):
    pass


def test_a_second_call_goes_on_and_ends_the_same(spiked: Scenario, found: xr.Dataset, tmp_path: Path) -> None:
    reports: list[int] = []
    whole = tumblers.design(spiked, **SMALL, threads=1, progress=reports.append)
    assert whole.identical(found)
    total = reports[-1]
    parts = tmp_path / "parts"

    def until(most: int) -> None:
        def stop(done: int) -> None:
            if done > most:
                raise Stopped

        tumblers.design(spiked, **SMALL, parts=parts, progress=stop)

    names: list[set[str]] = []
    for share in (0.5, 0.8):
        with pytest.raises(Stopped):
            until(int(share * total))
        names.append({file.name for file in parts.iterdir()})
    assert "settings.json" in names[0]
    assert "samples-00000.json" in names[0]
    assert names[0] < names[1]
    assert not any(name.endswith(".tmp") for name in names[1])
    kept = {name: (parts / name).stat().st_mtime_ns for name in names[1]}
    assert tumblers.design(spiked, **SMALL, parts=parts).identical(found)
    assert {name: (parts / name).stat().st_mtime_ns for name in names[1]} == kept


def test_parts_of_other_settings_are_refused(spiked: Scenario, tmp_path: Path) -> None:
    parts = tmp_path / "parts"
    tumblers.design(spiked, samples=8, generations=0, errors=Errors(draws=8), parts=parts)
    assert json.loads((parts / "settings.json").read_text())["samples"] == 8
    with pytest.raises(InputError, match=r"parts: found samples 8 in .*, expected samples 16, or another file"):
        tumblers.design(spiked, samples=16, generations=0, errors=Errors(draws=8), parts=parts)
    other = replace(spiked, robot=tumblers.ROBOTS["spiked_ends_pdms"].value)
    with pytest.raises(InputError, match="parts: found another scenario in"):
        tumblers.design(other, samples=8, generations=0, errors=Errors(draws=8), parts=parts)
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "notes.txt").write_text("of someone")
    with pytest.raises(InputError, match="parts: found no such file"):
        tumblers.design(spiked, **SMALL, parts=tmp_path / "mine")


@pytest.mark.parametrize(
    ("arguments", "key"),
    [
        ({"samples": 12}, "samples"),
        ({"samples": 4}, "samples"),
        ({"errors": Errors(draws=10)}, "draws"),
        ({"generations": -1}, "generations"),
        ({"drift_cost": -1.0}, "drift_cost"),
        ({"seed": 0.5}, "seed"),
        ({"threads": 0}, "threads"),
    ],
)
def test_bad_arguments_are_refused(spiked: Scenario, arguments: dict[str, object], key: str) -> None:
    with pytest.raises(InputError) as refused:
        tumblers.design(spiked, **arguments)  # type: ignore[arg-type]
    assert refused.value.key == key


def test_a_run_shorter_than_a_cycle_is_refused(spiked: Scenario) -> None:
    with pytest.raises(InputError, match=r"run\.duration_s"):
        tumblers.design(replace(spiked, run=replace(spiked.run, duration_s=0.05)))


def test_a_robust_design_that_is_no_better_gets_a_warning(found: xr.Dataset) -> None:
    from tumblers.studies.words import warnings

    clean = found.assign(unconverged_steps=0 * found.unconverged_steps)
    assert warnings(clean.assign_attrs(robust_gain_m_per_s=2e-4, robust_gain_error_m_per_s=1e-4)) == []
    (line,) = warnings(clean.assign_attrs(robust_gain_m_per_s=-2e-4, robust_gain_error_m_per_s=1e-4))
    assert line.startswith("the robust design is no better than the nominal one")


def test_designs_whose_runs_failed_are_counted(found: xr.Dataset) -> None:
    from tumblers.studies.words import warnings

    lost = found.error_speed_m_per_s.where(np.arange(found.sizes["design"]) > 1)
    assert "2 of 8 designs have runs that failed, and no speed for it" in warnings(
        found.assign(error_speed_m_per_s=lost)
    )
    assert not any("designs have runs" in line for line in warnings(found))
