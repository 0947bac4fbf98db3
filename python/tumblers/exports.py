"""The package's public names, imported the first time one of them is asked for."""

from . import blind, dataset, effects
from .diagnosis.result import Diagnosis
from .errors import InputError, SimulationError, TumblersError
from .field import Field, RotatingField, StaticField, TableField
from .grid import PAPER_DRAFTS_DEG, PAPER_MAGNETIZATION_DEG
from .initial import Initial
from .model import Model
from .netcdf import save_netcdf
from .presets import DRIVES, EXPERIMENTS, ROBOTS, SUBSTRATES, drive, preset_scenario
from .robot import Robot
from .run import Run
from .scenario import Scenario
from .shape import Cuboid, Curved, Ellipsoid, Hull, Shape, Spiked, SpikedEnds
from .simulate import simulate
from .substrate import Substrate
from .sweep import faster_cases, ideal_speed, preferred_cases, sweep
from .version import __version__

__all__ = [
    "DRIVES",
    "EXPERIMENTS",
    "PAPER_DRAFTS_DEG",
    "PAPER_MAGNETIZATION_DEG",
    "ROBOTS",
    "SUBSTRATES",
    "Cuboid",
    "Curved",
    "Diagnosis",
    "Ellipsoid",
    "Field",
    "Hull",
    "Initial",
    "InputError",
    "Model",
    "Robot",
    "RotatingField",
    "Run",
    "Scenario",
    "Shape",
    "SimulationError",
    "Spiked",
    "SpikedEnds",
    "StaticField",
    "Substrate",
    "TableField",
    "TumblersError",
    "__version__",
    "blind",
    "dataset",
    "drive",
    "effects",
    "faster_cases",
    "ideal_speed",
    "preferred_cases",
    "preset_scenario",
    "save_netcdf",
    "simulate",
    "sweep",
]
