"""`AccuracyCase`: a robot in a field of one frequency, perfect or with manufacturing errors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from tumblers.presets import drive, preset_scenario
from tumblers.scenario import Scenario

__all__ = ["DRAFT_DEG", "FREQUENCIES_HZ", "ROBOTS", "SECONDS", "THETA1_DEG", "THETA2_DEG", "AccuracyCase", "cases"]

FREQUENCIES_HZ = (1.0, 2.0, 5.0, 10.0, 15.0)
SECONDS = 1.0
# The corner of the paper's tolerance, and its magnetization error.
DRAFT_DEG, THETA1_DEG, THETA2_DEG = 2.0, 10.0, 10.0
# name: robot, substrate, field strength in T
ROBOTS = {
    "cuboid": ("cuboid", "paper", 0.010),
    "cuboid, second generation": ("cuboid_second_generation", "paper", 0.020),
    "spiked": ("spiked_su8", "paper", 0.020),
    "spiked ends": ("spiked_ends_su8", "paper", 0.020),
    "curved": ("curved_su8", "paper", 0.020),
    "spiked, half size": ("spiked_pdms", "aluminium_pdms", 0.020),
    "spiked ends, half size": ("spiked_ends_pdms", "aluminium_pdms", 0.020),
}


@dataclass(frozen=True)
class AccuracyCase:
    """One run of which speed, drift and twist are wanted.

    Attributes
    ----------
    robot
        A key of `ROBOTS`.
    frequency_Hz
        Of the field.
    errors
        Whether it has manufacturing errors.
    scenario
        All of it; step and treatment of the torque are others in each run.
    """

    robot: str
    frequency_Hz: float
    errors: bool
    scenario: Scenario


def cases(robots: Sequence[str], frequencies_Hz: Sequence[float]) -> list[AccuracyCase]:
    """Return every robot at every frequency, without errors, then with.

    Parameters
    ----------
    robots
        Keys of `ROBOTS`.
    frequencies_Hz
        Of the fields.
    """
    found = []
    for errors in (False, True):
        for name in robots:
            robot, substrate, strength_T = ROBOTS[name]
            for frequency in frequencies_Hz:
                scenario = preset_scenario(
                    robot=robot, substrate=substrate, drive=drive(strength_T, frequency), duration_s=SECONDS
                )
                if errors:
                    # A robot whose magnetic axis is off by design keeps that.
                    theta1 = scenario.robot.theta1_deg or THETA1_DEG
                    made = scenario.robot.with_draft(DRAFT_DEG).with_magnetization(theta1, THETA2_DEG)
                    scenario = replace(scenario, robot=made)
                found.append(AccuracyCase(name, frequency, errors, scenario))
    return found
