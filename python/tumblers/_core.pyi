"""The native core: SI units, radians, plain numbers and arrays; ``ValueError`` with one line for what is refused."""

from collections.abc import Callable, Sequence
from typing import Final, Literal, TypeAlias, TypedDict, final, type_check_only

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "CLOCK_STEP_S",
    "END_ROWS",
    "FAR",
    "HUBER",
    "Body",
    "Field",
    "Measured",
    "Trial",
    "Walk",
    "compare",
    "rollouts",
    "simulate",
    "step",
    "sweep",
]

_Numbers: TypeAlias = Sequence[float] | NDArray[np.float64]
_Rows: TypeAlias = Sequence[Sequence[float]] | NDArray[np.float64]
_Floats: TypeAlias = NDArray[np.float64]

@type_check_only
class _Run(TypedDict):
    time_s: _Floats
    position_m: _Floats
    orientation: _Floats
    linear_velocity_m_per_s: _Floats
    angular_velocity_rad_per_s: _Floats
    ecp_m: _Floats
    contact_mode: NDArray[np.int8]
    normal_force_N: _Floats
    friction_force_N: _Floats
    adhesion_force_N: _Floats
    slip_speed_m_per_s: _Floats
    residual: _Floats
    newton_iterations: NDArray[np.int64]
    twist_rad: float
    drift_m: float
    speed_m_per_s: float
    unconverged_steps: int
    max_residual: float
    max_penetration_m: float

@type_check_only
class _Sweep(TypedDict):
    twist_rad: _Floats
    drift_m: _Floats
    speed_m_per_s: _Floats
    unconverged_steps: NDArray[np.int64]
    newton_iterations: NDArray[np.int64]
    max_residual: _Floats
    max_penetration_m: _Floats
    error: list[str | None]

@type_check_only
class _Rollout(TypedDict):
    time_s: _Floats
    position_m: _Floats
    orientation: _Floats
    contact_mode: NDArray[np.int8]
    unconverged_steps: int
    error: str | None

@type_check_only
class _Walked(TypedDict):
    time_s: float
    position_m: _Floats
    orientation: _Floats
    linear_velocity_m_per_s: _Floats
    angular_velocity_rad_per_s: _Floats
    seen_position_m: _Floats
    seen_orientation: _Floats
    contact_mode: int
    normal_force_N: float
    converged: bool

@type_check_only
class _Step(TypedDict):
    linear_velocity_m_per_s: _Floats
    angular_velocity_rad_per_s: _Floats
    ecp_m: _Floats
    ecp_substrate_m: _Floats
    friction_impulse: _Floats
    multipliers: _Floats
    gradients: _Floats
    plane_multiplier: float
    sigma: float
    normal_impulse: float
    active: int
    residual: float
    penetration_m: float
    contact_mode: int
    area_m2: float
    newton_iterations: int
    converged: bool

@final
class Body:
    """A body in its own frame (y along the length, x the width, z the height), origin at the centre of mass."""

    @staticmethod
    def cuboid(length_m: float, width_m: float, height_m: float, draft_rad: float) -> Body: ...
    @staticmethod
    def spiked(
        length_m: float,
        width_m: float,
        height_m: float,
        spike_base_m: float,
        overall_height_m: float,
        draft_rad: float,
        draft_as_released: bool,
    ) -> Body: ...
    @staticmethod
    def spiked_ends(
        length_m: float,
        width_m: float,
        height_m: float,
        spike_base_m: float,
        spike_height_m: float,
        draft_rad: float,
        draft_as_released: bool,
    ) -> Body: ...
    @staticmethod
    def curved(
        outer_radius_m: float, inner_radius_m: float, half_angle_rad: float, width_m: float, draft_rad: float
    ) -> Body: ...
    @staticmethod
    def ellipsoid(semi_axes_m: _Numbers) -> Body: ...
    @staticmethod
    def hull(vertices_m: _Rows) -> Body: ...
    def with_center_of_mass(self, offset_m: _Numbers) -> Body:
        """Return the body with its centre of mass, and the origin with it, elsewhere, m, body frame."""
    @property
    def volume_m3(self) -> float:
        """Volume of the real body, m³."""
    @property
    def unit_inertia_m2(self) -> _Floats:
        """Inertia about the centre of mass over the mass, body frame, m², shape (3, 3)."""
    @property
    def size_m(self) -> float:
        """Greatest distance of a point from the centre of mass, m."""
    @property
    def hull_perimeter_m(self) -> float:
        """Perimeter of the hull's side profile, m."""
    @property
    def outline(self) -> list[_Floats]:
        """Faces of the real body as polygons, body frame, m, each of shape (k, 3)."""

@final
class Field:
    """A uniform magnetic field over time, substrate frame, T."""

    @staticmethod
    def rotating(
        strength_T: float,
        frequency_Hz: float,
        rotation_axis: _Numbers,
        initial_direction: _Numbers,
        quadrature_ratio: float = 1.0,
        phase_error_rad: float = 0.0,
    ) -> Field: ...
    @staticmethod
    def uniform(strength_T: float, direction: _Numbers) -> Field: ...
    @staticmethod
    def table(time_s: _Numbers, field_T: _Rows) -> Field: ...
    def at(self, time_s: float) -> list[float]:
        """Return B(t), T."""

@final
class Trial:
    """A robot on a substrate in a field for a time, every number checked."""

    def __new__(
        cls,
        *,
        body: Body,
        mass_kg: float,
        magnetic_moment_A_m2: _Numbers,
        friction_coefficient: float,
        friction_ellipsoid: _Numbers,
        adhesion_N_per_m2: float,
        electrostatic_force_N: float,
        line_contact_width_m: float,
        field: Field,
        incline_rad: float,
        gravity_m_per_s2: float,
        duration_s: float,
        step_s: float,
        magnetic_torque: str,
        adhesion_acts_at: str,
        adhesion_enters: str,
        position_m: _Numbers | None = None,
        orientation: _Numbers | None = None,
        linear_velocity_m_per_s: _Numbers = ...,
        angular_velocity_rad_per_s: _Numbers = ...,
        side_incline_rad: float = 0.0,
        compliance_m_per_N: float = 0.0,
        relief_wavelength_m: float = 2e-3,
        relief_cosine_m: _Numbers = ...,
        relief_sine_m: _Numbers = ...,
        force_N: _Numbers = ...,
        torque_N_m: _Numbers = ...,
        translational_drag_N_s_per_m: float = 0.0,
        rotational_drag_N_m_s: float = 0.0,
        sheet_conductance_S: float = 0.0,
        wrench_time_s: _Numbers = ...,
        wrench_N_N_m: _Rows = ...,
        friction_drift_per_s: float = 0.0,
    ) -> Trial: ...
    def with_interlude(self, other: Trial, edges_s: _Numbers) -> Trial:
        """Return the trial from which another takes over.

        That is from the first of the increasing edges, s, to the second, from the third to the fourth, and so on. The
        other has the same body, relief and step, and neither a guide nor an interlude.
        """
    def guided(self, time_s: _Numbers, y_m: _Numbers, point_m: _Numbers, rate_per_s: float) -> Trial:
        """Return the trial drawn along y to the places `y_m`, m, where it was seen at `time_s`, s, at a rate, 1/s."""
    @property
    def stability_bound_s(self) -> float:
        """Largest stable step of ``start_of_step``, s."""
    @property
    def steps(self) -> int:
        """Number of steps of the run."""

def simulate(
    trial: Trial,
    every: int,
    solver: Literal["reduced", "general"] = "reduced",
    on_progress: Callable[[int], None] | None = None,
) -> _Run:
    """Run a trial; a row for the start, every `every`-th step and the end."""

def sweep(trials: Sequence[Trial], threads: int = 0, on_progress: Callable[[int], None] | None = None) -> _Sweep:
    """Run trials in parallel (0: all threads); the same bits for any number of threads."""

def rollouts(
    trials: Sequence[Trial],
    every: Sequence[int],
    threads: int = 0,
    on_progress: Callable[[int], None] | None = None,
    *,
    while_resolved: bool = False,
    verified: bool = True,
) -> list[_Rollout]:
    """Run trials in parallel (0: all threads) and return their poses as seen: of trial i every `every[i]`-th step, to
    the last that is finite, or with `while_resolved` to the last before a step turns the body by a right angle. The
    quaternions are of one sign along a run. Unless `verified`, a step for which the reduced problem has a solution is
    not held against the unreduced one."""

# Where a loss turns from square to linear, and a track's mean square from which it counts by its logarithm; between two
# looks at a path from which a derivative by the clock is taken; how near to its last row a path's end is read, rows.
HUBER: Final[float]
FAR: Final[float]
CLOCK_STEP_S: Final[float]
END_ROWS: Final[float]

# The interval of a path's rows, s, its time when the camera's clock says 0, s, and the rows (n, 7), or None; the scaled
# differences of the outcomes (k, 2).
_Seen: TypeAlias = tuple[tuple[float, float, _Floats] | None, _Floats]

@final
class Measured:
    """One trial's measurements with their noise.

    By channel its name (``axis_heading`` for a heading that comes back to itself after half a turn), times (k,),
    numbers (k, 1) or unit quaternions (k, 4), and the inverse Cholesky factor of its covariance (k, k); the whitened
    change with each nominal number (n, shared), how many outcomes there are, and how many numbers the whole track has.
    """

    def __new__(
        cls, columns: list[tuple[str, _Floats, _Floats, _Floats]], tolerance: _Floats, outcomes: int, whole: int
    ) -> Measured: ...
    def whitened(self, run: _Seen, local: list[float], shared: list[float]) -> _Floats:
        """Return the whitened differences, shape (n,), for a clock (s) and origin (m), shape (4,), and what all share:
        the camera's heading (rad) and scale, then how far the nominal numbers are off."""

def compare(
    trials: list[Measured],
    runs: list[list[_Seen]],
    local_bounds: list[list[float]],
    local_sigmas: list[list[float]],
    shared: tuple[list[float], list[float], list[float]],
    train: list[bool],
    outcome_weight: float = 1.0,
    held: list[float] | None = None,
    fit: bool = True,
    threads: int = 0,
) -> list[tuple[_Floats, _Floats, list[_Floats | None]]]:
    """Return for each run of all trials its clocks (s) and origins (m), shape (trials, 4), what all share, and by trial
    the whitened differences.

    Bounds and standard deviations of clock and origin are by trial, (trials, 4); of what all share, least, most and
    standard deviations. What all share is fitted from the trials of `train`, an outcome having the weight of
    `outcome_weight` numbers of a track.
    """

@final
class Walk:
    """A run whose trial may be exchanged on the way, for a world whose laws change with time and place."""

    def __new__(cls, trial: Trial, solver: Literal["reduced", "general"] = "reduced") -> Walk: ...
    def advance(self, trial: Trial, steps: int) -> _Walked:
        """Make `steps` steps of `trial`, whose ``step_s`` is the walk's, from where the walk is."""

def step(
    trial: Trial,
    time_s: float,
    position_m: _Numbers,
    orientation: _Numbers,
    linear_velocity_m_per_s: _Numbers,
    angular_velocity_rad_per_s: _Numbers,
    adhesion_force_N: float,
    patch_centroid_m: _Numbers,
    solver: Literal["reduced", "general"] = "reduced",
) -> _Step:
    """Make one step and return all its unknowns, for parity tests."""
