"""Drake's side: a discrete MultibodyPlant that follows the field, and its replay without an interpreter."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from importlib.metadata import version
from math import cos, radians, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import units
from .case import Case
from .clock import Contestant
from .scaled import Scaled
from .track import Track

__all__ = ["HYDROELASTIC", "POINT", "VERSION", "Recording", "Settings", "recorded", "replayed"]

drake: Any = import_module("pydrake.all")
VERSION = version("drake")
# It warns once that half spaces do not touch deformable bodies, of which there is none.
logging.getLogger("drake").setLevel(logging.ERROR)
# Drake gives a pair of shapes one point: a box rests on its corners instead.
_CORNER_RADIUS = 1e-6

_Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Settings:
    """How Drake's contact yields, in mm, mg and s.

    Attributes
    ----------
    name
        What the tables call it.
    modulus
        Hydroelastic modulus of the box, mg/(mm s²), or None for points.
    stiffness
        Of each corner, mg/s².
    dissipation
        Of Hunt and Crossley, s/mm.
    """

    name: str
    modulus: float | None
    stiffness: float
    dissipation: float

    @property
    def words(self) -> str:
        """The settings in SI units."""
        dissipation = f"Hunt-Crossley dissipation {self.dissipation * units.LENGTH:g} s/m"
        if self.modulus is None:
            stiffness = self.stiffness / units.MASS
            return f"compliant points at the corners of the box, {stiffness:g} N/m each, {dissipation}"
        modulus = self.modulus * units.LENGTH / units.MASS
        return f"compliant hydroelastic box, modulus {modulus:g} Pa, on a rigid half space, {dissipation}"


POINT = Settings("points", None, 1e6, 0.1)
HYDROELASTIC = Settings("hydroelastic", 1e7, 0.0, 0.1)


@dataclass(frozen=True)
class Recording:
    """A run under a torque that followed the robot, step by step.

    Attributes
    ----------
    controls
        Torque and force of every step in the world, shape (n, 6).
    start
        Positions and velocities before the first step.
    poses
        Positions (quaternion first) after every step, shape (n, 7).
    track
        The same, in SI units.
    """

    controls: _Floats
    start: _Floats
    poses: _Floats
    track: Track


def _plant(case: Case, settings: Settings, builder: Any) -> Any:
    scenario = case.scenario
    robot, run = scenario.robot, scenario.run
    mu = scenario.substrate.friction_coefficient
    friction = drake.CoulombFriction(mu, mu)
    plant, _ = drake.AddMultibodyPlantSceneGraph(builder, time_step=run.step_s)
    unit = robot.body().unit_inertia_m2 * units.LENGTH**2
    inertia = drake.SpatialInertia(
        robot.total_mass_kg * units.MASS, np.zeros(3), drake.UnitInertia(*np.diag(unit), *unit[np.triu_indices(3, 1)])
    )
    body = plant.AddRigidBody("robot", inertia)
    slope, g = radians(run.incline_deg), run.gravity_m_per_s2 * units.LENGTH
    plant.mutable_gravity_field().set_gravity_vector([0.0, -g * sin(slope), -g * cos(slope)])
    ground, skin = drake.ProximityProperties(), drake.ProximityProperties()
    vertices = case.vertices_m * units.LENGTH
    if settings.modulus is None:
        for properties in (ground, skin):
            drake.AddContactMaterial(settings.dissipation, settings.stiffness, friction, properties)
        for i, vertex in enumerate(vertices):
            sphere = drake.Sphere(_CORNER_RADIUS)
            plant.RegisterCollisionGeometry(body, drake.RigidTransform(vertex), sphere, f"corner {i}", skin)
        plant.set_contact_model(drake.ContactModel.kPoint)
    else:
        for properties in (ground, skin):
            drake.AddContactMaterial(dissipation=settings.dissipation, friction=friction, properties=properties)
        drake.AddRigidHydroelasticProperties(ground)
        # As coarse as can be: a box needs no finer mesh.
        drake.AddCompliantHydroelasticProperties(2.0 * float(vertices.max()), settings.modulus, skin)
        box = drake.Box(*(2.0 * vertices.max(axis=0)))
        plant.RegisterCollisionGeometry(body, drake.RigidTransform(), box, "box", skin)
        plant.set_contact_model(drake.ContactModel.kHydroelastic)
    plant.RegisterCollisionGeometry(plant.world_body(), drake.RigidTransform(), drake.HalfSpace(), "plane", ground)
    plant.set_discrete_contact_approximation(drake.DiscreteContactApproximation.kLagged)
    plant.Finalize()
    return plant


def recorded(case: Case, settings: Settings, settle_s: float = 0.0) -> Recording:
    """Run a case with the magnetic torque of each step's start.

    Parameters
    ----------
    case, settings
        What is run.
    settle_s
        How long it lies at rest before it gets its velocity, s.
    """
    scaled, h = Scaled.of(case), case.scenario.run.step_s
    builder = drake.DiagramBuilder()
    plant = _plant(case, settings, builder)
    simulator = drake.Simulator(builder.Build())
    root = simulator.get_mutable_context()
    context = plant.GetMyMutableContextFromRoot(root)
    port = plant.get_applied_generalized_force_input_port()
    plant.SetPositions(context, [1.0, 0.0, 0.0, 0.0, *scaled.position])
    control = np.zeros(6)
    control[5] = scaled.attraction
    port.FixValue(context, control)
    simulator.Initialize()
    simulator.AdvanceTo(round(settle_s / h) * h)
    velocity = plant.GetVelocities(context).copy()
    velocity[3:] += scaled.velocity
    plant.SetVelocities(context, velocity)
    root.SetTime(0.0)
    simulator.Initialize()

    start = plant.GetPositionsAndVelocities(context).copy()
    field = case.scenario.field.core()
    controls, poses = np.tile(control, (case.steps, 1)), np.empty((case.steps, 7))
    for k in range(case.steps):
        rotation = drake.Quaternion(_unit(plant.GetPositions(context)[:4])).rotation()
        controls[k, :3] = np.cross(rotation @ scaled.moment, np.array(field.at(k * h)))
        port.FixValue(context, controls[k])
        simulator.AdvanceTo((k + 1) * h)
        poses[k] = plant.GetPositions(context)
    return Recording(controls, start, poses, Track(h, poses[:, 4:] / units.LENGTH, poses[:, :4]))


def _unit(quaternion: _Floats) -> _Floats:
    length: float = float(np.linalg.norm(quaternion))
    return quaternion / length


def replayed(case: Case, settings: Settings, recording: Recording) -> Contestant:
    """Return ``Simulator.AdvanceTo`` over a recorded run.

    Parameters
    ----------
    case, settings, recording
        What was recorded.

    Raises
    ------
    RuntimeError
        The replay is another motion than the recorded one.
    """
    h, steps = case.scenario.run.step_s, case.steps
    builder = drake.DiagramBuilder()
    plant = _plant(case, settings, builder)
    # Half a step early, so that the rounding of a time never picks the row before.
    times = (np.arange(steps + 1) - 0.5) * h
    rows = np.vstack([recording.controls, recording.controls[-1:]])
    source = builder.AddSystem(drake.TrajectorySource(drake.PiecewisePolynomial.ZeroOrderHold(times, rows.T)))
    builder.Connect(source.get_output_port(), plant.get_applied_generalized_force_input_port())
    simulator = drake.Simulator(builder.Build())
    root = simulator.get_mutable_context()
    context = plant.GetMyMutableContextFromRoot(root)
    run = _from_start(simulator, root, plant, context, recording.start, steps * h)
    run()
    if not np.array_equal(plant.GetPositions(context), recording.poses[-1]):
        raise RuntimeError("Drake made another motion of the recorded torque")
    return Contestant(run, steps)


def _from_start(
    simulator: Any, root: Any, plant: Any, context: Any, start: _Floats, end_s: float
) -> Callable[[], None]:
    def run() -> None:
        root.SetTime(0.0)
        plant.SetPositionsAndVelocities(context, start)
        simulator.Initialize()
        simulator.AdvanceTo(end_s)

    return run
