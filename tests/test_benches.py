"""The comparisons with other simulators: units, models, pages and refusals; the peers where they are installed."""

import json
import re
import subprocess
import sys
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

BENCHES = Path(__file__).parents[1] / "benches"
sys.path.insert(0, str(BENCHES))

from accuracy.case import AccuracyCase, cases  # noqa: E402
from accuracy.comparison import compare as accuracies  # noqa: E402
from accuracy.ladder import Ladder, ladder  # noqa: E402
from accuracy.page import lines as accuracy_lines  # noqa: E402
from accuracy.page import section as accuracy_section  # noqa: E402
from accuracy.price import Price, grouped  # noqa: E402
from peers import units  # noqa: E402
from peers.case import STEP_S, at_rest, in_flight, on_slope, sliding, tumbling  # noqa: E402
from peers.clock import Contestant, Sample, alternate, microseconds, ratio  # noqa: E402
from peers.contact import contact_of  # noqa: E402
from peers.mujoco_model import SHIPPED, STIFF, TIGHT, xml  # noqa: E402
from peers.ours import Health, line_contact, recorded  # noqa: E402
from peers.page import SECTIONS, with_section, written_page  # noqa: E402
from peers.target import Target  # noqa: E402
from peers.track import Track, longest_stretch, lowest_m  # noqa: E402

from tumblers.metrics import Metrics, Yardstick  # noqa: E402

ROBOTS = {case.name: case for case in tumbling()}


def run(command, *arguments, blocked=""):
    """Run a command with a module hidden from it."""
    script = f"""
import importlib.util, runpy, sys
found = importlib.util.find_spec
importlib.util.find_spec = lambda name, *rest: None if name == {blocked!r} else found(name, *rest)
sys.argv = [{str(BENCHES / command)!r}, *sys.argv[1:]]
sys.path.insert(0, {str(BENCHES)!r})
runpy.run_path(sys.argv[0], run_name="__main__")
"""
    call = [sys.executable, "-c", script, *map(str, arguments)]
    return subprocess.run(call, capture_output=True, text=True, timeout=120)


# Units


def test_millimetres_milligrams_and_seconds():
    # A newton is 10⁶ mg · 10³ mm / s²; a joule is a newton over 10³ mm.
    assert units.FORCE == 1e9
    assert units.TORQUE == units.FORCE * units.LENGTH == 1e12
    assert units.INERTIA == units.MASS * units.LENGTH**2 == 1e12


def test_a_torque_turns_a_body_as_fast_in_both_units():
    torque, inertia = 4.35e-9, 2.0e-15
    assert torque * units.TORQUE / (inertia * units.INERTIA) == pytest.approx(torque / inertia, rel=1e-15)


# The model


def bodies(case, settings=STIFF):
    root = ElementTree.fromstring(xml(case, settings))
    return root, root.find("worldbody/body")


@pytest.mark.parametrize("name", ROBOTS)
def test_the_model_has_our_mass_and_inertia(name):
    case = ROBOTS[name]
    robot = case.scenario.robot
    inertial = bodies(case)[1].find("inertial")
    assert float(inertial.get("mass")) == pytest.approx(robot.total_mass_kg * 1e6, rel=1e-15)
    xx, yy, zz, xy, xz, yz = map(float, inertial.get("fullinertia").split())
    found = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) / 1e12
    ours = robot.body().unit_inertia_m2 * robot.total_mass_kg
    np.testing.assert_allclose(found, ours, rtol=0, atol=1e-15 * np.abs(ours).max())


@pytest.mark.parametrize("name", ["spiked", "spiked ends"])
def test_the_model_of_a_hull_has_our_corners(name):
    case = ROBOTS[name]
    root, _ = bodies(case)
    found = np.array(root.find("asset/mesh").get("vertex").split(), dtype=float).reshape(-1, 3) / 1e3
    corners = np.concatenate(case.scenario.robot.body().outline)
    size = np.abs(corners).max()
    distance = np.linalg.norm(corners[:, None] - found[None], axis=2)
    # Every corner of ours is one of theirs, and every one of theirs is ours.
    assert distance.min(axis=1).max() < 1e-8 * size
    assert distance.min(axis=0).max() < 1e-8 * size


def test_the_model_of_the_cuboid_is_a_box_of_half_its_size_that_rests_on_the_plane():
    _, body = bodies(ROBOTS["cuboid"])
    np.testing.assert_allclose(np.array(body.find("geom").get("size").split(), dtype=float), [0.2, 0.4, 0.05])
    np.testing.assert_allclose(np.array(body.get("pos").split(), dtype=float), [0.0, 0.0, 0.05])


def test_the_model_has_our_step_weight_slope_and_friction():
    case = on_slope()
    root, _ = bodies(case, TIGHT)
    option, contact = root.find("option"), root.find("default/geom")
    assert float(option.get("timestep")) == STEP_S == case.scenario.run.step_s
    gravity = np.array(option.get("gravity").split(), dtype=float)
    assert np.linalg.norm(gravity) == pytest.approx(9800.0)
    assert gravity[1] / gravity[2] == pytest.approx(np.tan(np.radians(10.0)))
    assert contact.get("friction").split()[0] == "0.29999999999999999"
    # e_r of 0.1 m is 100 mm.
    assert float(contact.get("friction").split()[1]) == pytest.approx(0.3 * 100.0)
    assert (option.get("cone"), option.get("solver")) == ("elliptic", "Newton")


def test_solref_follows_the_step_except_as_shipped():
    assert [settings.solref(1e-4) for settings in (STIFF, SHIPPED)] == ["0.00020000000000000001 1", "0.02 1"]


# Poses


def test_the_lowest_point_of_a_turned_box():
    case = ROBOTS["cuboid"]
    half = np.sqrt(0.5)
    orientation = np.array([[1.0, 0.0, 0.0, 0.0], [half, half, 0.0, 0.0], [half, 0.0, half, 0.0]])
    track = Track(1.0, np.zeros((3, 3)), orientation)
    # Flat, on its end, and on its side.
    np.testing.assert_allclose(lowest_m(track, case.vertices_m), [-0.5e-4, -4e-4, -2e-4], rtol=1e-12)


def test_the_longest_stretch():
    flags = np.array([1, 0, 1, 1, 0, 1, 1, 1], dtype=bool)
    assert longest_stretch(flags) == (5, 3)
    assert longest_stretch(~flags) == (1, 1)
    assert longest_stretch(np.zeros(3, dtype=bool)) == (0, 0)


def test_our_contact_neither_sinks_nor_slips_nor_lifts():
    health = Health()
    found = contact_of("tumblers", [ROBOTS["cuboid"]], lambda case: recorded(case, health)[0])
    # µm: a rounding of poses in metres is far below.
    assert max(found.tumbles[0].greatest_um, found.rest_um, found.lift_um, found.fine_lift_um) < 1e-9
    assert abs(found.creep_um_per_s) < 1e-9
    assert health.unconverged_steps == 0
    assert health.max_residual <= 1e-10


def test_a_box_that_slides_stops_where_friction_stops_it():
    case = sliding(STEP_S)
    track, _ = recorded(case, Health())
    v, a, h = case.scenario.initial.linear_velocity_m_per_s[1], 0.5 * 9.8, STEP_S
    # Σ h (v - k a h) over the steps that it still slides.
    expected = sum(h * (v - k * a * h) for k in range(1, int(v / (a * h)) + 1))
    assert track.position_m[-1, 1] == pytest.approx(expected, rel=1e-9)


def test_a_stretch_on_a_line_is_part_of_the_run():
    health, case = Health(), ROBOTS["cuboid"]
    stretch = line_contact(case, health)
    _, whole = recorded(case, health)
    part, _ = recorded(stretch, health)
    start = int(np.flatnonzero((whole["position_m"].values == part.position_m[0]).all(axis=1))[0])
    same = whole["position_m"].values[start : start + len(part.position_m)]
    # The field's angle is rounded, and no more.
    np.testing.assert_allclose(part.position_m, same, rtol=0, atol=1e-12)


def test_the_robot_in_flight_does_not_land():
    _, rows = recorded(in_flight(), Health())
    assert not rows["contact_mode"].values.any()
    assert recorded(at_rest(), Health())[1]["contact_mode"].values.all()


# Clocks


def test_repetitions_alternate_after_one_that_does_not_count():
    calls = []
    contestants = {name: Contestant(lambda name=name: calls.append(name), 10) for name in "ab"}
    samples = alternate(contestants, 2, lambda: calls.append("|"))
    assert "".join(calls) == "abab|ba|"
    assert [len(samples[name]) for name in "ab"] == [2, 2]


def test_a_ratio_is_the_median_of_the_repetitions():
    ours = [Sample(1.0, 2.0), Sample(2.0, 2.0), Sample(4.0, 2.0)]
    theirs = [Sample(4.0, 2.0), Sample(4.0, 6.0), Sample(4.0, 4.0)]
    found = ratio(ours, theirs)
    assert (found.median, found.least, found.greatest) == (2.0, 1.0, 4.0)
    assert ratio(ours, theirs, wall=True).median == 2.0
    assert (microseconds(ours), microseconds(theirs, wall=True)) == (2.0, 4.0)


def test_a_target_is_met_on_its_own_side():
    assert Target("", 1.5, 1.4, True).met
    assert not Target("", 3.0, 2.9, False).met
    assert Target("", 3.0, 2.9, False, disturbed=True).verdict == "**missed**, while other work ran"


# Time to accuracy


def a_ladder(start, end, midpoint):
    """Return a ladder whose runs have these speeds, m/s, over a second and a perimeter of a millimetre."""
    runs = {
        torque: [None if v is None else Metrics(speed_m_per_s=v, drift_m=0.0, twist_deg=0.0) for v in speeds]
        for torque, speeds in (("start_of_step", start), ("end_of_step", end), ("midpoint", midpoint))
    }
    steps = tuple(1e-3 / 2**n for n in range(len(midpoint)))
    return Ladder(cases(["cuboid"], [1.0])[0], steps, runs, {}, Yardstick(duration_s=1.0, way_m=1e-3))


def test_the_longest_step_is_the_one_from_which_on_all_are_accurate():
    found = a_ladder([None, 1.02, 1.002, 1.001], [0.9, 0.9, 0.9, 0.9], [1.0, 1.05, 1.001, 1.0])
    # A value that is right by chance, 1 ms, does not count; nor does a scheme that stays where it is.
    assert found.longest_step_s("midpoint") == 2.5e-4
    assert found.longest_step_s("start_of_step") == 2.5e-4
    assert found.longest_step_s("end_of_step") is None
    # Halving shows nothing of the error where the value stays.
    assert [step for step, _, _ in found.hidden("end_of_step")] == [1e-3, 5e-4, 2.5e-4]
    # Two finest of the start, two before the finest of the midpoint: 5 %.
    assert found.known_to == pytest.approx(0.05)
    assert not found.is_known
    assert a_ladder([1.0] * 4, [0.9] * 4, [1.3, 1.001, 1.0, 1.0]).is_known


def test_what_does_not_get_there_is_not_the_cheapest_but_counts():
    prices = {
        "end_of_step": Price(None, 1.0),
        "start_of_step": Price(1e-4, 4.0),
        "midpoint": Price(2e-4, 2.0),
    }
    found = grouped("all", [prices, prices])
    assert found.reached == {"end_of_step": 0, "start_of_step": 2, "midpoint": 2}
    assert found.cheapest == {"end_of_step": 0, "start_of_step": 0, "midpoint": 2}
    assert found.over_cheapest["start_of_step"] == pytest.approx(2.0)


def test_a_ladder_leaves_out_steps_that_the_period_does_not_allow():
    whole = cases(["cuboid"], [100.0])[0].scenario
    # A fifth of its second: no step meets the accuracy at 100 Hz, and each one is tried.
    case = AccuracyCase("cuboid", 100.0, False, replace(whole, run=replace(whole.run, duration_s=0.2)))
    assert ladder(case, (2e-3, 5e-4, 2.5e-4)).steps_s == (5e-4, 2.5e-4)


def test_a_small_run_of_time_to_accuracy():
    told = []
    results = accuracies(
        1, lambda *what: told.append(what), ["spiked, half size"], [1.0], tuple(5e-4 / 2**n for n in range(5))
    )
    perfect, made = results.rows
    assert (perfect.ladder.case.errors, made.ladder.case.errors) == (False, True)
    # docs/studies.md: 1092.8 µm/s converged, and the released step's is right already.
    assert perfect.ladder.converged.speed_m_per_s == pytest.approx(1092.8e-6, rel=1e-3)
    assert perfect.prices["end_of_step"].step_s == 5e-4
    assert perfect.ladder.chosen["midpoint"].met
    assert perfect.ladder.chosen["midpoint"].step_s == perfect.prices["midpoint"].step_s == 2.5e-4
    assert all(price.ms_per_s > 0.0 for price in perfect.prices.values())
    found = json.loads(json.dumps(results.to_json()))
    assert len(found["cases"]) == 2
    assert accuracy_section(results).startswith("## Time to accuracy")
    assert all(line.count("\n") == 0 for line in accuracy_lines(results))
    assert {phase for phase, _, _ in told} == {"steps", "times"}


# The page


def test_each_command_replaces_its_own_section_only():
    first = with_section("", "drake", "of Drake")
    both = with_section(first, "mujoco", "of MuJoCo")
    assert both.index("of MuJoCo") < both.index("of Drake")
    again = with_section(both, "mujoco", "anew \\1")
    assert "of MuJoCo" not in again
    assert again.replace("anew \\1", "of MuJoCo") == both
    assert with_section(again, "mujoco", "anew \\1") == again


def test_the_published_page_has_both_sections_as_they_would_be_written_again():
    page = BENCHES.parent / "docs" / "performance.md"
    text = page.read_text(encoding="utf-8")
    for name in SECTIONS:
        section = re.search(f"<!-- {name}: .*? -->\n(.*?)<!-- end of {name} -->", text, re.DOTALL)
        assert written_page(page, name, section.group(1)).decode() == text


# The commands


@pytest.mark.parametrize(("command", "module"), [("against_mujoco.py", "mujoco"), ("against_drake.py", "pydrake")])
def test_a_peer_that_is_missing_is_named_in_one_line(command, module, tmp_path):
    found = run(command, "--json", tmp_path / "x.json", blocked=module)
    assert found.returncode == 2
    assert found.stdout == ""
    assert found.stderr.startswith(f"{command}: found no module {module}, expected it to be installed: pip install ")
    assert found.stderr.count("\n") == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--repetitions", "0"], "--repetitions: found 0, expected at least 1"),
        (["--repetitions", "many"], "--repetitions: invalid int value: 'many'"),
        (["--jsn", "x"], "unrecognized arguments: --jsn x"),
    ],
)
@pytest.mark.parametrize("command", ["against_mujoco.py", "time_to_accuracy.py"])
def test_an_option_that_is_refused_is_told_in_one_line(command, arguments, said):
    found = run(command, *arguments)
    assert (found.returncode, found.stdout) == (2, "")
    assert said in found.stderr
    assert found.stderr.count("\n") == 1


@pytest.mark.skipif(find_spec("mujoco") is None, reason="mujoco is not installed")
@pytest.mark.parametrize("option", ["--json", "--page"])
def test_a_file_that_cannot_be_written_is_refused_before_anything_is_computed(option, tmp_path):
    missing = tmp_path / "missing" / ("x.json" if option == "--json" else "x.md")
    found = run("against_mujoco.py", option, missing)
    assert found.returncode == 2
    assert found.stderr.count("\n") == 1
    assert option in found.stderr
    assert "missing' does not" in found.stderr


@pytest.mark.skipif(find_spec("mujoco") is None, reason="mujoco is not installed")
def test_a_page_that_cannot_be_read_is_refused_and_left_as_it_is(tmp_path):
    page = tmp_path / "x.md"
    page.write_bytes(b"\xff")
    found = run("against_mujoco.py", "--page", page)
    assert (found.returncode, found.stdout) == (2, "")
    assert (
        found.stderr
        == "against_mujoco.py: --page: found bytes that are no UTF-8 text, expected a page that can be read\n"
    )
    assert page.read_bytes() == b"\xff"


# The peers


@pytest.mark.skipif(find_spec("mujoco") is None, reason="mujoco is not installed")
def test_a_small_comparison_with_mujoco():
    from peers.mujoco_comparison import compare
    from peers.mujoco_page import lines, section

    results = compare(1, lambda *told: None, copies=1, grids=False)
    found = json.loads(json.dumps(results.to_json()))
    assert found["steps_per_second_ratio"] > 0.0
    assert found["max_residual"] <= 1e-10
    assert found["unconverged_steps"] == 0
    ours, tight, stiff, shipped = results.contacts
    # Their robots go as far as ours, and their contact is worse.
    for theirs in (tight, stiff):
        for mine, other in zip(ours.tumbles, theirs.tumbles, strict=True):
            assert other.speed_um_per_s == pytest.approx(mine.speed_um_per_s, rel=0.05)
            assert mine.greatest_um < other.greatest_um
    assert shipped.rest_um > stiff.rest_um > tight.rest_um > ours.rest_um
    assert section(results).startswith("## Against MuJoCo")
    assert all(line.count("\n") == 0 for line in lines(results))


@pytest.mark.skipif(find_spec("pydrake") is None, reason="drake is not installed")
def test_a_small_comparison_with_drake():
    from peers.drake_engine import POINT, replayed
    from peers.drake_engine import recorded as drake_run

    case = in_flight()
    recording = drake_run(case, POINT)
    # Its replay is compared with the recording to the bit.
    assert replayed(case, POINT, recording).steps == case.steps
    mine, _ = recorded(tumbling()[0], Health())
    assert drake_run(tumbling()[0], POINT).track.speed_m_per_s == pytest.approx(mine.speed_m_per_s, rel=0.05)
