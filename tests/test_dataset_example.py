from __future__ import annotations

from pathlib import Path

import pytest

from tumblers import EXPERIMENTS, ROBOTS, SUBSTRATES, dataset, simulate

DATA = dataset.load(Path(__file__).parents[1] / "examples" / "aluminium_30deg")


def test_the_nominal_model_is_the_preset_as_written() -> None:
    experiment = EXPERIMENTS["cuboid_up_aluminium"]
    assert DATA.robot == ROBOTS[experiment.robot].value
    assert DATA.substrate == SUBSTRATES[experiment.substrate].value
    assert DATA.model_given == ("adhesion_acts_at", "adhesion_enters")
    assert [(trial.incline_deg, trial.outcome and trial.outcome.climbs) for trial in DATA.trials] == [
        (20.0, True),
        (30.0, True),
        (45.0, False),
    ]


@pytest.mark.parametrize(("name", "climbs"), [("slope20", True), ("slope30", False), ("slope45", False)])
def test_the_gap_is_at_30_degrees(name: str, climbs: bool) -> None:
    run = simulate(DATA.trial(name).scenario(DATA, 5e-4, output_every_s=0.1))
    # Climbing is tumbling at about 2 (L + H) f, 1.8 mm/s here; a robot that slides is slower than 0.
    assert (run.speed_m_per_s > 1e-3) == climbs
