"""Robots, substrates, drives and experiments of the paper, by name, each with its source.

The paper is J. Xie, C. Bi, D. J. Cappelleri, N. Chakraborty, *Dynamic Simulation-Guided Design of Tumbling Magnetic
Microrobots* ("text"); "released" is the authors' publicly released code; "derived" is arithmetic on both.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

from .errors import InputError, show
from .field import RotatingField
from .model import Model
from .robot import Robot
from .run import Run, StepLength
from .scenario import Scenario
from .shape import Cuboid, Curved, Shape, Spiked, SpikedEnds
from .substrate import Substrate

__all__ = ["DRIVES", "EXPERIMENTS", "ROBOTS", "SUBSTRATES", "Experiment", "Preset", "drive", "preset_scenario"]

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Preset(Generic[T]):
    """A named value and where it comes from."""

    value: T
    source: str


@dataclass(frozen=True, slots=True)
class Experiment:
    """Names of a robot, a substrate and a drive, the incline (degrees) and the time (s)."""

    robot: str
    substrate: str
    drive: str
    incline_deg: float
    duration_s: float
    source: str


def drive(strength_T: float, frequency_Hz: float) -> RotatingField:
    """Return the rotating field that rolls the robot towards +y.

    Parameters
    ----------
    strength_T, frequency_Hz
        B, T, and the frequency, Hz.
    """
    return RotatingField(strength_T=strength_T, frequency_Hz=frequency_Hz)


_CUBOID = Cuboid(length_m=8.0e-4, width_m=4.0e-4, height_m=1.0e-4)


def _su8(shape: Shape) -> Robot:
    return Robot(shape=shape, density_kg_per_m3=2168.8, magnetization_A_per_m=51835.0)


def _pdms(shape: Shape) -> Robot:
    return Robot(shape=shape, density_kg_per_m3=2668.4, magnetization_A_per_m=18661.0)


_MAGNETIC = "magnetic volume = body volume (released)"

ROBOTS: dict[str, Preset[Robot]] = {
    "cuboid": Preset(
        Robot(
            shape=_CUBOID,
            mass_kg=3.78e-8,
            magnetic_volume_m3=2.9e-11,
            magnetization_A_per_m=15000.0,
            theta1_deg=27.0,
            theta2_deg=0.0,
        ),
        "text: first generation, table of parameters on paper; alignment offset 27° as θ1",
    ),
    "cuboid_second_generation": Preset(
        Robot(shape=_CUBOID, mass_kg=4.44e-8, magnetic_volume_m3=3.2e-11, magnetization_A_per_m=51835.0),
        "text: second generation, table of parameters on aluminium",
    ),
    "spiked_su8": Preset(
        _su8(Spiked(length_m=8.0e-4, width_m=3.0e-4, height_m=1.5e-4, spike_base_m=2.0e-4, overall_height_m=6.5e-4)),
        f"released: full size; half of 650 µm is the text's q_z = 325 µm; {_MAGNETIC}",
    ),
    "spiked_ends_su8": Preset(
        _su8(SpikedEnds(length_m=8.0e-4, width_m=4.0e-4, height_m=1.5e-4, spike_base_m=2.0e-4, spike_height_m=2.0e-4)),
        f"derived: full size, from the text's q_z = 275 µm and speed; {_MAGNETIC}",
    ),
    "curved_su8": Preset(
        _su8(Curved(width_m=4.0e-4, outer_radius_m=1.25e-3, inner_radius_m=1.1e-3, half_angle_deg=25.0)),
        f"released: full size; {_MAGNETIC}",
    ),
    "spiked_pdms": Preset(
        _pdms(Spiked(length_m=4.0e-4, width_m=2.0e-4, height_m=7.5e-5, spike_base_m=1.25e-4, overall_height_m=3.25e-4)),
        f"released: half size; hull perimeter 1093.4 µm = the text's 1093 µm/s at 1 Hz; {_MAGNETIC}",
    ),
    "spiked_ends_pdms": Preset(
        _pdms(SpikedEnds(length_m=4.0e-4, width_m=2.0e-4, height_m=7.5e-5, spike_base_m=1.0e-4, spike_height_m=1.0e-4)),
        f"derived: half size; hull perimeter 1197.2 µm = the text's 1197 µm/s at 1 Hz; {_MAGNETIC}",
    ),
}

_E_R = "e_r = 0.1 m (released)"


def _substrate(friction: float, adhesion: float, electrostatic: float) -> Substrate:
    return Substrate(
        friction_coefficient=friction,
        friction_ellipsoid=(1.0, 1.0, 0.1),
        adhesion_N_per_m2=adhesion,
        electrostatic_force_N=electrostatic,
    )


SUBSTRATES: dict[str, Preset[Substrate]] = {
    "paper": Preset(_substrate(0.3, 1.19, 6.54e-7), f"text: table of parameters on paper; {_E_R}"),
    "paper_released": Preset(_substrate(0.3, 3.7148, 3.2022e-6), f"released: C and F_elect; text: μ; {_E_R}"),
    "aluminium": Preset(_substrate(0.54, 26.18, 0.0), f"text: table of parameters on aluminium; {_E_R}"),
    "aluminium_released": Preset(_substrate(0.5359, 26.1771, 0.0), f"released: μ and C; text: F_elect; {_E_R}"),
    "aluminium_pdms": Preset(_substrate(0.8, 340.115, 2.2022e-7), f"released: PDMS on aluminium; {_E_R}"),
}

_SPEED = "text: speed against frequency on paper"
DRIVES: dict[str, Preset[RotatingField]] = {
    "10mT_1Hz": Preset(drive(0.010, 1.0), _SPEED),
    "10mT_5Hz": Preset(drive(0.010, 5.0), _SPEED),
    "10mT_10Hz": Preset(drive(0.010, 10.0), _SPEED),
    "10mT_15Hz": Preset(drive(0.010, 15.0), _SPEED),
    "20mT_1Hz": Preset(drive(0.020, 1.0), "text: inclines, and manufacturing errors"),
    "20mT_10Hz": Preset(drive(0.020, 10.0), "text: four shapes"),
}

_ERRORS = "text: manufacturing errors at 1 Hz, 1 s"
_SHAPES = "text: four shapes, locomotion tests"
EXPERIMENTS: dict[str, Experiment] = {
    "spiked": Experiment("spiked_pdms", "aluminium_pdms", "20mT_1Hz", 0.0, 1.0, _ERRORS),
    "spiked_ends": Experiment("spiked_ends_pdms", "aluminium_pdms", "20mT_1Hz", 0.0, 1.0, _ERRORS),
    "cuboid_on_paper": Experiment("cuboid", "paper", "10mT_5Hz", 0.0, 1.0, _SPEED),
    "cuboid_up_paper": Experiment("cuboid", "paper", "20mT_1Hz", 45.0, 4.0, "text: paper inclines, adhesion at 45°"),
    "cuboid_up_aluminium": Experiment(
        "cuboid_second_generation", "aluminium", "20mT_1Hz", 30.0, 4.0, "text: aluminium inclines"
    ),
    "four_shapes_cuboid": Experiment("cuboid_second_generation", "paper", "20mT_10Hz", 0.0, 1.0, _SHAPES),
    "four_shapes_spiked": Experiment("spiked_su8", "paper", "20mT_10Hz", 0.0, 1.0, _SHAPES),
    "four_shapes_spiked_ends": Experiment("spiked_ends_su8", "paper", "20mT_10Hz", 0.0, 1.0, _SHAPES),
    "four_shapes_curved": Experiment("curved_su8", "paper", "20mT_10Hz", 0.0, 1.0, _SHAPES),
}


def _named(kind: str, presets: dict[str, T], name: str) -> T:
    if name not in presets:
        raise InputError(kind, show(name), f"one of {', '.join(presets)}")
    return presets[name]


def preset_scenario(
    experiment: str | None = None,
    *,
    robot: str | None = None,
    substrate: str | None = None,
    drive: str | RotatingField | None = None,
    incline_deg: float | None = None,
    duration_s: float | None = None,
    step_s: StepLength = 5.0e-4,
    model: Model | None = None,
) -> Scenario:
    """Return a scenario of the paper by name.

    Parameters
    ----------
    experiment
        A key of `EXPERIMENTS`; without it `robot`, `substrate` and `drive` are needed.
    robot, substrate, drive
        Keys of `ROBOTS`, `SUBSTRATES` and `DRIVES` (or a field) that replace those of the experiment.
    incline_deg, duration_s
        Incline, degrees (0 without an experiment), and time, s (1 without an experiment).
    step_s
        Step, s, or ``"auto"``; 5·10⁻⁴ as released.
    model
        Switches of the model. Where they leave it open the torque is taken at the end of the step, as released, and at
        the midpoint where the step is ``"auto"``.

    Raises
    ------
    InputError
        A name that is none of these, or a missing one.
    """
    base = None if experiment is None else _named("experiment", EXPERIMENTS, experiment)
    names = {"robot": robot, "substrate": substrate, "drive": drive}
    for kind, name in names.items():
        names[kind] = name if name is not None else getattr(base, kind, None)
        if names[kind] is None:
            raise InputError(kind, "nothing", "an experiment, or a robot, a substrate and a drive")
    field = names["drive"]
    if not isinstance(field, RotatingField):
        field = _named("drive", DRIVES, str(field)).value
    incline = incline_deg if incline_deg is not None else (base.incline_deg if base else 0.0)
    duration = duration_s if duration_s is not None else (base.duration_s if base else 1.0)
    return Scenario(
        robot=_named("robot", ROBOTS, str(names["robot"])).value,
        substrate=_named("substrate", SUBSTRATES, str(names["substrate"])).value,
        field=field,
        run=Run(duration_s=duration, step_s=step_s, incline_deg=incline),
        model=model if model is not None else Model(),
    )
