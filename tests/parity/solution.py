"""The core's solution of a step, in the reference's terms."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tumblers import _core
from tumblers.reference import StepProblem, Unknowns
from tumblers.reference.array import Array
from tumblers.simulate import Solver

from .case import Case


def core_step(case: Case, solver: Solver = "reduced") -> Any:
    """Make the step with the core."""
    state = case.state
    return _core.step(
        case.twin.core,
        case.time,
        state.position,
        state.quaternion,
        state.velocity,
        state.angular_velocity,
        case.adhesion_force,
        case.patch_centroid,
        solver,
    )


def reference_problem(case: Case) -> StepProblem:
    """Return the step's unreduced problem."""
    return StepProblem(case.twin.reference, case.state, case.time, case.adhesion_force, case.patch_centroid)


def surface_order(problem: StepProblem, V: Array, a1: Array, gradients: Array) -> NDArray[np.intp]:
    """Return, for every surface of the reference, its index in the core, shape (m,).

    The gradients at `a1` name the surfaces: those of a body's faces are all different, and a cone or an ellipsoid is
    the only one of its kind.
    """
    _, own = problem.surface_rows(V, a1)
    apart = np.linalg.norm(own[:, None] - gradients[None], axis=2)
    order: NDArray[np.intp] = apart.argmin(axis=1)
    assert sorted(order) == list(range(len(own)))
    assert apart.min(axis=1).max() <= 1e-9
    return order


def core_unknowns(problem: StepProblem, found: Any) -> Unknowns:
    """Return the core's unknowns with the reference's numbers of the surfaces."""
    V = np.concatenate([found["linear_velocity_m_per_s"], found["angular_velocity_rad_per_s"]])
    order = surface_order(problem, V, found["ecp_m"], found["gradients"])
    return Unknowns(
        V,
        found["ecp_m"],
        found["ecp_substrate_m"],
        found["friction_impulse"],
        found["multipliers"][order],
        found["plane_multiplier"],
        found["sigma"],
        found["normal_impulse"],
        int(order.tolist().index(found["active"])),
    )
