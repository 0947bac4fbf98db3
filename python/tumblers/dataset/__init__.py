"""What a lab measured: folders of the format ``tumblers-dataset/1``.

Examples
--------
>>> from tumblers import dataset
>>> data = dataset.load("examples/aluminium_30deg")
>>> data.trial("slope30").outcome
Outcome(climbs=True, mean_speed_m_per_s=None, sigma_m_per_s=None, tilt_deg=None, sigma_deg=None)
"""

from .dataset import FORMAT, Dataset
from .folder import load
from .lab_trial import LabTrial
from .outcome import Outcome
from .sensor import Sensor
from .slip import likely_slips
from .tolerance import Tolerance
from .track import CHANNELS, Track

__all__ = [
    "CHANNELS",
    "FORMAT",
    "Dataset",
    "LabTrial",
    "Outcome",
    "Sensor",
    "Tolerance",
    "Track",
    "likely_slips",
    "load",
]
