"""The package's public names, imported the first time one of them is asked for."""

from importlib import import_module
from typing import TYPE_CHECKING

from . import dataset, effects
from .camera import Camera
from .errors import EffectError, InputError, SimulationError, TumblersError
from .field import Field, RotatingField, StaticField, TableField
from .grid import PAPER_DRAFTS_DEG, PAPER_MAGNETIZATION_DEG
from .initial import Initial
from .model import Model
from .netcdf import save_netcdf
from .presets import DRIVES, EXPERIMENTS, ROBOTS, SUBSTRATES, drive, preset_scenario
from .relief import Relief
from .robot import Robot
from .run import Run
from .scenario import Scenario
from .shape import Cuboid, Curved, Ellipsoid, Hull, Shape, Spiked, SpikedEnds
from .simulate import simulate
from .step_choice import StepChoice, choose_step
from .substrate import Substrate
from .surroundings import Surroundings
from .sweep import faster_cases, ideal_speed, preferred_cases, sweep
from .version import __version__

if TYPE_CHECKING:
    from . import blind
    from .diagnosis.diagnose import diagnose
    from .diagnosis.diagnosis import Diagnosis
    from .studies.climb import climb
    from .studies.convergence import convergence
    from .studies.design import design
    from .studies.tolerance import tolerance

__all__ = [
    "DRIVES",
    "EXPERIMENTS",
    "PAPER_DRAFTS_DEG",
    "PAPER_MAGNETIZATION_DEG",
    "ROBOTS",
    "SUBSTRATES",
    "Camera",
    "Cuboid",
    "Curved",
    "Diagnosis",
    "EffectError",
    "Ellipsoid",
    "Field",
    "Hull",
    "Initial",
    "InputError",
    "Model",
    "Relief",
    "Robot",
    "RotatingField",
    "Run",
    "Scenario",
    "Shape",
    "SimulationError",
    "Spiked",
    "SpikedEnds",
    "StaticField",
    "StepChoice",
    "Substrate",
    "Surroundings",
    "TableField",
    "TumblersError",
    "__version__",
    "blind",
    "choose_step",
    "climb",
    "convergence",
    "dataset",
    "design",
    "diagnose",
    "drive",
    "effects",
    "faster_cases",
    "ideal_speed",
    "preferred_cases",
    "preset_scenario",
    "save_netcdf",
    "simulate",
    "sweep",
    "tolerance",
]

# SciPy comes with a diagnosis: it waits until its own names are asked for.
_OF_THE_DIAGNOSIS = ("Diagnosis", "diagnose")
# Each is named as its module.
_OF_THE_STUDIES = ("climb", "convergence", "design", "tolerance")


def __getattr__(name: str) -> object:
    if name == "blind":
        return import_module(".blind", __package__)
    if name in _OF_THE_DIAGNOSIS:
        return getattr(import_module(".diagnosis", __package__), name)
    if name in _OF_THE_STUDIES:
        return getattr(import_module(f".studies.{name}", __package__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
