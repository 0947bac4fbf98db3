"""Grids and counts that the studies take where none are given, for the commands and the functions alike."""

from __future__ import annotations

__all__ = [
    "AXIS_SIGMA_DEG",
    "CYCLES",
    "DRAFTS_DEG",
    "DRAFT_MOST_DEG",
    "DRAWS",
    "DRIFT_COST",
    "E_R_M",
    "GENERATIONS",
    "RESOLUTION_DEG",
    "SAMPLES",
    "SETTLING_CYCLES",
    "SLOPES_DEG",
    "STEPS_S",
    "THETA1_DEG",
    "THETA2_DEG",
    "TORQUES",
]

# climb: the cycles are the paper's 4 s at 1 Hz.
SLOPES_DEG: tuple[float, ...] = tuple(2.5 * n for n in range(36))
RESOLUTION_DEG = 0.1
SETTLING_CYCLES, CYCLES = 1, 3

# tolerance
DRAFTS_DEG: tuple[float, ...] = tuple(0.5 * n for n in range(17))
THETA1_DEG: tuple[float, ...] = tuple(2.5 * n for n in range(5))
THETA2_DEG: tuple[float, ...] = tuple(5.0 * n for n in range(-36, 37))

# design: the paper's own robots, φ = 4° and θ1 = 10°, are at the edge of these errors.
SAMPLES, GENERATIONS, DRAWS = 128, 8, 64
DRAFT_MOST_DEG, AXIS_SIGMA_DEG = 4.0, 5.0
DRIFT_COST = 1.0

# convergence
STEPS_S: tuple[float, ...] = (5e-4, 2.5e-4, 1e-4, 5e-5, 2.5e-5)
TORQUES: tuple[str, ...] = ("end_of_step", "midpoint", "start_of_step")
E_R_M: tuple[float, ...] = (1e-4, 1e-2, 1e-1)
