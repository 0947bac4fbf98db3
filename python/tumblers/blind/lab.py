"""`Lab`: what is set up and how it is looked at, before anything is measured."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..dataset import Sensor
from ..dataset.climb import way_without_slip_m
from ..field import Field
from ..model import Model
from ..robot import Robot
from ..run import Run
from ..scenario import Scenario
from ..substrate import Substrate

__all__ = ["Lab", "Plan"]

# Times at which a trial is looked at whose outcome alone is written down.
_OUTCOME_ROWS = 150


@dataclass(frozen=True, kw_only=True, slots=True)
class Plan:
    """A trial to be made.

    Attributes
    ----------
    id, field, incline_deg, duration_s
        Those of the dataset's trial.
    tracked
        Whether the camera follows the robot.
    outcome
        ``climbs``, ``speed``, ``tilt`` or nothing.
    """

    id: str
    field: Field
    duration_s: float
    incline_deg: float = 0.0
    tracked: bool = True
    outcome: str = ""


@dataclass(frozen=True, kw_only=True, slots=True)
class Lab:
    """A robot on a substrate, a camera and plans.

    Attributes
    ----------
    robot, substrate
        What the lab believes.
    sensor
        The camera's noise.
    channels
        What the camera reads in each frame.
    frames_per_second, view_m
        The camera's rate, Hz, and how far from the start it sees, m.
    step_s
        The step of the world, s.
    plans
        The trials.
    """

    robot: Robot
    substrate: Substrate
    sensor: Sensor
    channels: tuple[str, ...]
    frames_per_second: float
    view_m: float
    step_s: float
    plans: tuple[Plan, ...] = ()

    def scenario(self, plan: Plan) -> Scenario:
        """Return what the lab believes that a plan comes to, in the world's step.

        Parameters
        ----------
        plan
            The plan.
        """
        return Scenario(
            robot=self.robot,
            substrate=self.substrate,
            field=plan.field,
            run=Run(duration_s=plan.duration_s, step_s=self.step_s, incline_deg=plan.incline_deg),
            model=Model(magnetic_torque="midpoint"),
        )

    def frames(self, plan: Plan) -> NDArray[np.float64]:
        """Return the times at which a trial is looked at, s.

        Parameters
        ----------
        plan
            The plan.
        """
        if not plan.tracked:
            return np.linspace(0.0, plan.duration_s, _OUTCOME_ROWS)
        return np.arange(int(plan.duration_s * self.frames_per_second * (1.0 + 1e-9)) + 1) / self.frames_per_second

    def way_m(self, plan: Plan) -> float:
        """Return the way without slip of a plan, m.

        Parameters
        ----------
        plan
            The plan.
        """
        return way_without_slip_m(self.robot, plan.field, plan.duration_s)

    def with_plans(self, plans: tuple[Plan, ...]) -> Lab:
        """Return the lab with other plans.

        Parameters
        ----------
        plans
            The plans.
        """
        return replace(self, plans=plans)
