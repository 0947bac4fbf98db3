"""Reference implementation in NumPy and SciPy, written from docs/model.md alone, to compare the fast core with."""

from .adhesion import ContactMode, Patch, patch_at
from .body import Body
from .field import RotatingField, StaticField, TableField
from .metrics import cycle_twist, drift, flipped, pose_at, speed, tilt, twist
from .parameters import State, Trial
from .problem import StepProblem, Unknowns
from .relief import Relief
from .residual import residual, residual_rows
from .shapes import cuboid, curved, ellipsoid, hull, spiked, spiked_ends
from .solver import solve
from .stepper import StepSolution, step
from .surface import Cone, Ellipsoid, HalfSpace
from .surroundings import Surroundings
from .trial import Run, run

__all__ = [
    "Body",
    "Cone",
    "ContactMode",
    "Ellipsoid",
    "HalfSpace",
    "Patch",
    "Relief",
    "RotatingField",
    "Run",
    "State",
    "StaticField",
    "StepProblem",
    "StepSolution",
    "Surroundings",
    "TableField",
    "Trial",
    "Unknowns",
    "cuboid",
    "curved",
    "cycle_twist",
    "drift",
    "ellipsoid",
    "flipped",
    "hull",
    "patch_at",
    "pose_at",
    "residual",
    "residual_rows",
    "run",
    "solve",
    "speed",
    "spiked",
    "spiked_ends",
    "step",
    "tilt",
    "twist",
]
