from __future__ import annotations

import re
from dataclasses import asdict, fields
from pathlib import Path

import numpy as np

from tumblers import dataset
from tumblers.dataset import CHANNELS, LabTrial, Outcome, Sensor, Tolerance
from tumblers.diagnosis.gap.comparison import Comparison
from tumblers.diagnosis.gap.predictive import is_right
from tumblers.diagnosis.gap.simulator import Simulator

TEXT = (Path(__file__).parents[1] / "docs" / "dataset.md").read_text(encoding="utf-8")


def test_the_example_loads(tmp_path: Path) -> None:
    toml = re.search(r"```toml\n(.*?)```", TEXT, re.DOTALL)
    tracks = re.findall(r"`(tracks/\w+\.csv)`[^`]*```csv\n(.*?)```", TEXT, re.DOTALL)
    assert toml is not None
    assert len(tracks) == 2
    (tmp_path / "tracks").mkdir()
    (tmp_path / "dataset.toml").write_text(toml[1], encoding="utf-8")
    for name, text in tracks:
        (tmp_path / name).write_text(text, encoding="utf-8")

    data = dataset.load(tmp_path)
    assert [trial.id for trial in data.trials] == ["f05", "f08", "slope30", "f15", "tilt05"]
    metres, pixels = data.trial("f05").track, data.trial("f08").track
    assert metres is not None
    assert pixels is not None
    assert metres.frames == 3
    np.testing.assert_allclose(pixels.time_s, [0.0, 0.02, 0.06])
    np.testing.assert_allclose(pixels.channels["y_m"], [-0.2 * 6.5e-6, 35.9 * 6.5e-6, 143.3 * 6.5e-6])
    for trial in data.trials:
        trial.scenario(data, 5e-4).trial()
    comparison = Comparison(data, Simulator(data))
    comparison.take_noise_of(())
    nominal = comparison.residual(comparison.nominal_paths)
    assert is_right(comparison, nominal)
    # Each number by itself, too: of some ten no right model leaves one that far off.
    assert all(np.abs(wrong).max() < 3.0 for wrong in nominal.trials)


def test_every_key_of_the_format_is_explained() -> None:
    for key in {f.name for part in (Sensor, Tolerance, LabTrial, Outcome) for f in fields(part)} | set(CHANNELS):
        assert f"`{key}`" in TEXT, key


def test_the_tolerances_that_are_assumed_are_stated() -> None:
    for key, share in asdict(Tolerance()).items():
        (row,) = (line for line in TEXT.splitlines() if line.startswith("|") and f"`{key}`" in line)
        assert row.split("|")[2].strip() == f"{share:g}", key
