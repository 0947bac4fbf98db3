"""MuJoCo's model of a case as XML, in millimetres, milligrams and seconds; needs no MuJoCo."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, radians, sin

from . import units
from .case import Case

__all__ = ["SHIPPED", "STIFF", "TIGHT", "Settings", "xml"]


@dataclass(frozen=True)
class Settings:
    """How stiff MuJoCo's contact is.

    Attributes
    ----------
    name
        What the tables call it.
    time_constant_s, time_constant_steps
        First number of solref, s, or in steps where it follows the step: MuJoCo admits no less than two.
    impedance
        First two numbers of solimp.
    impedance_ratio
        ``impratio``, friction's over the normal direction's.
    dimensions
        ``condim``: 3 without friction against spin, 4 with ours.
    """

    name: str
    time_constant_s: float | None
    time_constant_steps: float
    impedance: tuple[float, float]
    impedance_ratio: float
    dimensions: int

    def solref(self, step_s: float) -> str:
        """Return time constant and damping ratio."""
        constant = self.time_constant_s if self.time_constant_s is not None else self.time_constant_steps * step_s
        return f"{constant:.17g} 1"

    @property
    def solimp(self) -> str:
        """Impedance from touch to a depth of a micrometre."""
        return f"{self.impedance[0]:g} {self.impedance[1]:g} 0.001 0.5 2"

    @property
    def words(self) -> str:
        """The settings in MuJoCo's words."""
        solref = "0.02 1" if self.time_constant_s is not None else f"{self.time_constant_steps:g}h 1"
        return f"solref {solref}, solimp {self.solimp}, impratio {self.impedance_ratio:g}, condim {self.dimensions}"


SHIPPED = Settings("as shipped", 0.02, 0.0, (0.9, 0.95), 1.0, 3)
STIFF = Settings("stiff", None, 2.0, (0.9, 0.95), 1.0, 3)
TIGHT = Settings("tight", None, 2.0, (0.99, 0.999), 10.0, 4)


def _numbers(*values: float) -> str:
    return " ".join(f"{value:.17g}" for value in values)


def xml(case: Case, settings: Settings) -> str:
    """Return the model: a plane and a free body, its mass and inertia given, its hull a box or a mesh.

    Islands and midphase are off: for one body they only cost time.

    Parameters
    ----------
    case
        Robot, friction, step and incline.
    settings
        The contact.
    """
    scenario = case.scenario
    robot, substrate, run = scenario.robot, scenario.substrate, scenario.run
    body, mass = robot.body(), robot.total_mass_kg
    inertia = body.unit_inertia_m2 * mass * units.INERTIA
    vertices = case.vertices_m * units.LENGTH
    slope, g = radians(run.incline_deg), run.gravity_m_per_s2 * units.LENGTH
    spin = substrate.friction_coefficient * substrate.friction_ellipsoid[2] * units.LENGTH
    if case.is_box:
        asset, geom = "", f'<geom type="box" size="{_numbers(*vertices.max(axis=0))}"/>'
    else:
        asset = f'<asset><mesh name="hull" vertex="{_numbers(*vertices.ravel())}"/></asset>'
        geom = '<geom type="mesh" mesh="hull"/>'
    six = (inertia[0, 0], inertia[1, 1], inertia[2, 2], inertia[0, 1], inertia[0, 2], inertia[1, 2])
    return f"""<mujoco>
  <option timestep="{run.step_s:.17g}" gravity="{_numbers(0.0, -g * sin(slope), -g * cos(slope))}" integrator="Euler"
          cone="elliptic" solver="Newton" tolerance="1e-8" impratio="{settings.impedance_ratio:g}">
    <flag island="disable" midphase="disable"/>
  </option>
  <default>
    <geom condim="{settings.dimensions}" solref="{settings.solref(run.step_s)}" solimp="{settings.solimp}"
          friction="{_numbers(substrate.friction_coefficient, spin, 0.0)}"/>
  </default>
  {asset}
  <worldbody>
    <geom type="plane" size="0 0 1"/>
    <body pos="{_numbers(0.0, 0.0, -vertices[:, 2].min())}">
      <freejoint/>
      <inertial pos="0 0 0" mass="{mass * units.MASS:.17g}" fullinertia="{_numbers(*six)}"/>
      {geom}
    </body>
  </worldbody>
</mujoco>"""
