from __future__ import annotations

from pathlib import Path

import pytest

from tumblers import (
    InputError,
    Scenario,
)

# Each: what to replace, by what, the key that the error names, words that it holds.
REFUSED = [
    ("mass_kg = 3.78e-8", "mass_kg = -1.0", "robot.mass_kg", "-1.0"),
    ("mass_kg = 3.78e-8", "mass_kg = 0", "robot.mass_kg", "greater than 0"),
    ("mass_kg = 3.78e-8", "mass_kg = nan", "robot.mass_kg", "nan"),
    ("mass_kg = 3.78e-8", "mass_kg = inf", "robot.mass_kg", "inf"),
    ("mass_kg = 3.78e-8", "mass_kg = true", "robot.mass_kg", "True"),
    ("mass_kg = 3.78e-8", 'mass_kg = "heavy"', "robot.mass_kg", "'heavy'"),
    ("mass_kg = 3.78e-8", "mass_kg = 1979-05-27", "robot.mass_kg", "a finite number"),
    ("mass_kg = 3.78e-8", "mass_kg = 1" + "0" * 400, "robot.mass_kg", "a finite number"),
    ("mass_kg = 3.78e-8\n", "", "robot.mass_kg", "found no such key, expected "),
    ("length_m = 8.0e-4", "length_m = 0.0", "robot.length_m", "0.0"),
    ("length_m = 8.0e-4\n", "", "robot.length_m", "found no such key, expected "),
    ("[robot]", '[robot]\ncolour = "red"', "robot.colour", "unknown key"),
    ("[robot]", "[robot]\nspike_base_m = 1e-5", "robot.spike_base_m", "unknown key"),
    ("[robot]", "[robot]\n'a\\nb' = 1", "robot.", "unknown key"),
    ('shape = "cuboid"', 'shape = "sphere"', "robot.shape", "'sphere'"),
    ('shape = "cuboid"\n', "", "robot.shape", "found no such key, expected "),
    ("magnetization_A_per_m = 15000\n", "", "robot.magnetization_A_per_m", "found no such key, expected "),
    ("magnetization_axis = [0.0, 1.0, 0.0]", "magnetization_axis = [0, 0, 0]", "robot.magnetization_axis", "not zero"),
    ("magnetization_axis = [0.0, 1.0, 0.0]", "magnetization_axis = [0, 1]", "robot.magnetization_axis", "[0, 1]"),
    ("magnetization_axis = [0.0, 1.0, 0.0]", "magnetization_axis = 1", "robot.magnetization_axis", "3 numbers"),
    ("magnetization_axis = [0.0,", "theta1_deg = 1\nmagnetization_axis = [0.0,", "robot.theta1_deg", "not both"),
    ("magnetization_axis = [0.0, 1.0, 0.0]", "theta2_deg = 1", "robot.theta1_deg", "theta2_deg"),
    ("[robot]", "[robot]\ndraft_deg = -1", "robot.draft_deg", "at least 0"),
    ("[robot]", "[robot]\ndraft_deg = 80", "robot.draft_deg", "draft"),
    ("[robot]", '[robot]\ndraft_model = "drawn"', "robot.draft_model", "geometric or as_released"),
    ("friction_coefficient = 0.3", "friction_coefficient = -0.3", "substrate.friction_coefficient", "-0.3"),
    ("friction_coefficient = 0.3\n", "", "substrate.friction_coefficient", "found no such key, expected "),
    ("[1.0, 1.0, 0.1]", "[1.0, 1.0, 0.0]", "substrate.friction_ellipsoid[2]", "greater than 0"),
    ("[1.0, 1.0, 0.1]", "[1.0, 1.0, false]", "substrate.friction_ellipsoid[2]", "False"),
    ("[substrate]", "[substrate]\nmu = 1", "substrate.mu", "unknown key"),
    ('kind = "rotating"', 'kind = "wobbling"', "field.kind", "rotating or static or table"),
    ('kind = "rotating"\n', "", "field.kind", "found no such key, expected "),
    ("frequency_Hz = 5", "frequency_Hz = 0", "field.frequency_Hz", "greater than 0"),
    ("frequency_Hz = 5\n", "", "field.frequency_Hz", "found no such key, expected "),
    ("frequency_Hz = 5", "frequency_Hz = 5\nrotation_axis = [0, 1, 0]", "field.initial_direction", "right angles"),
    ("frequency_Hz = 5", "frequency_Hz = 5\nrotation_axis = [0, 0, 0]", "field.rotation_axis", "not zero"),
    ("frequency_Hz = 5", "direction = [0, 0, 1]", "field.direction", "unknown key"),
    ("step_s = 5.0e-4", "step_s = 0", "run.step_s", "greater than 0"),
    ("duration_s = 0.25\n", "", "run.duration_s", "found no such key, expected "),
    ("step_s = 5.0e-4", "step_s = [1]", "run.step_s", "a finite number"),
    ("duration_s = 0.25", "duration_s = -1", "run.duration_s", "-1"),
    ("duration_s = 0.25", "duration_s = 1e9", "run.duration_s", "steps"),
    ("[run]\n", "[[run]]\n", "run", "a table"),
    ("[run]", "effect = [1]\n[run]", "field.effect", "unknown key"),
    ("step_s = 5.0e-4", "step_s = 5.0e-4\noutput_every_s = 7e-4", "run.output_every_s", "multiple"),
    ("step_s = 5.0e-4", "step_s = 5.0e-4\noutput_every_s = 1e-5", "run.output_every_s", "multiple"),
    ("step_s = 5.0e-4", "step_s = 5.0e-4\nincline_deg = 90", "run.incline_deg", "less than 90"),
    ("[run]", "[model]\nmagnetic_torque = 'later'\n[run]", "model.magnetic_torque", "end_of_step or start_of_step"),
    ("[run]", "[model]\nsolver = 'x'\n[run]", "model.solver", "unknown key"),
    ("[run]", "[initial]\norientation = [1, 1, 0, 0]\n[run]", "initial.orientation", "length 1"),
    ("[run]", "[initial]\norientation = [1, 0, 0]\n[run]", "initial.orientation", "4 numbers"),
    ("[run]", "[initial]\nposition_m = [0, 0, -1]\n[run]", "initial.position_m", "substrate"),
    ("[run]", "[[effect]]\nname = 'gremlins'\n[run]", "effect[0].name", "'gremlins'"),
    ("[run]", "[[effect]]\nname = 'viscous_drag'\nviscosity = 1\n[run]", "effect[0].viscosity", "unknown key"),
    ("[run]", "[[effect]]\nname = 'friction_coefficient'\nfactor = nan\n[run]", "effect[0].factor", "nan"),
    ("[run]", "[[effect]]\n[run]", "effect[0].name", "found no such key, expected "),
    ("[run]", "[effect]\n[run]", "effect", "array of tables"),
    ("[run]", "[light]\n[run]", "light", "unknown key"),
    ("[run]", "[camera]\nscale = 0\n[run]", "camera.scale", "greater than 0"),
    ("[run]", "[camera]\nheading_deg = nan\n[run]", "camera.heading_deg", "nan"),
    ("[run]", "[camera]\norigin_m = [0.0]\n[run]", "camera.origin_m", "a list of 2 numbers"),
    ("[run]", "[camera]\ntime_offset_s = 'a'\n[run]", "camera.time_offset_s", "'a'"),
    ("[run]", "[camera]\ntracked_point = 'nose'\n[run]", "camera.tracked_point", "body_centre or centre_of_mass"),
    ("[run]", "[relief]\nwavelength_m = 0\n[run]", "relief.wavelength_m", "greater than 0"),
    ("[run]", "[relief]\ncosine_m = [1e-6]\n[run]", "relief.sine_m", "found 0 amplitudes, expected 1, as many as in"),
    ("[run]", "[relief]\ncosine_m = ['a']\n[run]", "relief.cosine_m[0]", "a finite number"),
    ("[run]", "[surroundings]\nforce_N = [1, 2]\n[run]", "surroundings.force_N", "3 numbers"),
    ("[run]", "[surroundings]\ntranslational_drag_N_s_per_m = -1\n[run]", "surroundings.translational", "at least 0"),
    ("[run]", "[surroundings]\nsheet_conductance_S = inf\n[run]", "surroundings.sheet_conductance_S", "inf"),
    ("[run]", "[surroundings]\nwrench_time_s = [0, 0]\n[run]", "surroundings.wrench_time_s[1]", "a time after 0.0 s"),
    ("[run]", "[surroundings]\nwrench_time_s = [0]\n[run]", "surroundings.wrench_N_N_m", "found 0 rows, expected 1"),
    (
        "[run]",
        "[surroundings]\nwrench_time_s = [0]\nwrench_N_N_m = [[0, 0, 0]]\n[run]",
        "surroundings.wrench_N_N_m[0]",
        "6 numbers",
    ),
    ("[robot]", "[robot]\ncenter_of_mass_m = [0, 0, 1]", "robot.center_of_mass_m", "one inside the body"),
    ("[robot]", "[robot]\ncenter_of_mass_m = [0, 0]", "robot.center_of_mass_m", "3 numbers"),
    ("[substrate]", "[substrate]\ncompliance_m_per_N = -1", "substrate.compliance_m_per_N", "at least 0"),
    ("frequency_Hz = 5", "frequency_Hz = 5\nquadrature_ratio = -1", "field.quadrature_ratio", "at least 0"),
    ("frequency_Hz = 5", "frequency_Hz = 5\nphase_error_deg = inf", "field.phase_error_deg", "inf"),
    ("step_s = 5.0e-4", "step_s = 5.0e-4\nside_incline_deg = -90", "run.side_incline_deg", "greater than -90"),
    ("[run]", "[run", None, "malformed TOML"),
    ("mass_kg = 3.78e-8", "mass_g = 3.78e-5", "robot.mass_g", "found an unknown key (did you mean mass_kg?), expected"),
    ("length_m = 8.0e-4", "length_m = 1e200", "robot.length_m", "found 1e+200, expected"),
    ("length_m = 8.0e-4", "length_m = 1e-200", "robot.length_m", "found 1e-200, expected"),
    ("[robot]", "[robot]\ndraft_deg = 80", "robot.draft_deg", "found 80 degrees, at which the "),
    ("step_s = 5.0e-4", "step_s = 0.3", "run.step_s", "found 0.3, expected at most duration_s, which is 0.25"),
    (
        "step_s = 5.0e-4",
        "step_s = 0.02",
        "run.step_s",
        "found 0.02, expected at most 0.01 s, 1/20 of the field's period",
    ),
    ("duration_s = 0.25", "duration_s = 1e300", "run.duration_s", "found 1e+300 s in steps of 0.0005 s, expected"),
    ("step_s = 5.0e-4", "step_s = 1e-300", "run.duration_s", "found 0.25 s in steps of 1e-300 s, expected at most"),
    (
        "step_s = 5.0e-4",
        "step_s = 5e-4\noutput_every_s = 0.3",
        "run.output_every_s",
        "at most duration_s, which is 0.25",
    ),
    ("mass_kg = 3.78e-8", "mass_kg = 1\nmass_kg = 2", None, "malformed TOML: mass_kg a second time (at line 9)"),
    ("[run]", "[field]\n[run]", None, "malformed TOML: [field] a second time"),
    ("tumblers-scenario/1", "tumblers-scenario/2", "format", "tumblers-scenario/1"),
    ('format = "tumblers-scenario/1"\n', "", "format", "found no such key, expected "),
    ("[robot]", "robot = 1\n[robots]", "robots", "unknown key"),
]


@pytest.mark.parametrize(("old", "new", "key", "words"), REFUSED)
def test_bad_input_gets_one_line(
    scenario_file: Path, text: str, old: str, new: str, key: str | None, words: str
) -> None:
    assert text.count(old) >= 1
    scenario_file.write_text(text.replace(old, new, 1))
    with pytest.raises(InputError) as caught:
        Scenario.load(scenario_file)
    error = caught.value
    line = str(error)
    assert "\n" not in line
    assert line.startswith(f"{scenario_file}: ")
    assert error.key == key or (error.key or "").startswith(key or "!")
    assert words in line
    assert "found " in line
    assert ", expected " in line
    assert len(line) < 500 + len(str(scenario_file))


def test_a_step_beyond_the_stability_bound_is_refused_with_the_numbers(text: str) -> None:
    explicit = text + '\n[model]\nmagnetic_torque = "start_of_step"\n'
    Scenario.from_toml(explicit)
    with pytest.raises(InputError, match=r"run\.step_s: found 0\.01, expected less than 0\.001") as caught:
        Scenario.from_toml(explicit.replace("step_s = 5.0e-4", "step_s = 0.01"))
    assert "start_of_step" in str(caught.value)


def test_missing_files_and_folders_get_one_line(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nowhere\.toml: found no such file, expected a tumblers-scenario/1 file"):
        Scenario.load(tmp_path / "nowhere.toml")
    with pytest.raises(InputError, match="found a directory, expected a tumblers-scenario/1 file"):
        Scenario.load(tmp_path)
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="UTF-8"):
        Scenario.load(tmp_path / "binary.toml")
    with pytest.raises(InputError, match="found a path with a NUL byte"):
        Scenario.load("nul\0.toml")
