"""A sound dataset of two trials, and its folder with traps in it and beside it."""

from __future__ import annotations

import os
from pathlib import Path

from tumblers.dataset import Dataset, LabTrial, Outcome, Sensor
from tumblers.field import RotatingField
from tumblers.presets import ROBOTS, SUBSTRATES

__all__ = ["DATASET", "TRACK", "one_outcome", "write_dataset"]

DATASET = """\
format = "tumblers-dataset/1"
title = "two trials"

[robot]
shape = "cuboid"
length_m = 8.0e-4
width_m = 4.0e-4
height_m = 1.0e-4
mass_kg = 3.78e-8
magnetization_A_per_m = 15000

[substrate]
friction_coefficient = 0.3

[sensor]
position_noise_m = 3.0e-6
angle_noise_deg = 1.0

[[trial]]
id = "f05"
duration_s = 2.0
field = { kind = "rotating", strength_T = 0.010, frequency_Hz = 5.0 }
track = "tracks/f05.csv"

[[trial]]
id = "slope"
incline_deg = 30.0
duration_s = 4
field = { kind = "static", strength_T = 0.020, direction = [0, 0, 1] }
outcome = { mean_speed_m_per_s = 0.03, sigma_m_per_s = 0.001 }
"""
TRACK = "time_s,x_m,tilt_deg\n0,0,0\n0.5,1e-4,3\n1.0,,\n"


def write_dataset(folder: Path, dataset: str = DATASET, track: str = TRACK) -> Path:
    """Write a dataset and its track, a link that leads out, one to itself and a pipe."""
    (folder / "tracks").mkdir(parents=True)
    (folder / "dataset.toml").write_text(dataset)
    (folder / "tracks" / "f05.csv").write_text(track)
    (folder.parent / "outside.csv").write_text(track)
    (folder / "link.csv").symlink_to(folder.parent / "outside.csv")
    (folder / "loop.csv").symlink_to(folder / "loop.csv")
    os.mkfifo(folder / "pipe.csv")
    return folder


def one_outcome(frequency_Hz: float = 3.0) -> Dataset:
    """Return the dataset that is diagnosed in no time: a trial that was seen to climb."""
    field = RotatingField(strength_T=0.010, frequency_Hz=frequency_Hz)
    return Dataset(
        robot=ROBOTS["spiked_pdms"].value,
        substrate=SUBSTRATES["aluminium_pdms"].value,
        sensor=Sensor(position_noise_m=3e-6, angle_noise_deg=1.0),
        trials=(LabTrial(id="climbed", field=field, duration_s=0.5, outcome=Outcome(climbs=True)),),
    )
