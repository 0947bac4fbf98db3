"""Robots of the paper for the reference's tests (SI)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tumblers.reference import RotatingField, Trial, cuboid, spiked

MICRON = 1e-6


@pytest.fixture
def paper_cuboid() -> Trial:
    """Cuboid on paper, 10 mT at 5 Hz."""
    return Trial(
        body=cuboid(800 * MICRON, 400 * MICRON, 100 * MICRON),
        mass=3.78e-8,
        moment=np.array([0.0, 2.9e-11 * 15000.0, 0.0]),
        mu=0.3,
        adhesion_coefficient=1.19,
        electrostatic_force=6.54e-7,
        field=RotatingField(0.010, 5.0),
    )


@pytest.fixture
def half_size() -> dict[str, Any]:
    """PDMS on aluminium, for a `Trial` of the half-size spiked robot."""
    body = spiked(400 * MICRON, 200 * MICRON, 75 * MICRON, 125 * MICRON, 325 * MICRON, np.radians(2.0))
    return {
        "body": body,
        "mass": 2668.4 * body.volume,
        "moment": np.array([0.0, 18661.0 * body.volume, 0.0]),
        "mu": 0.8,
        "ellipsoid": np.array([1.0, 1.0, 0.1]),
        "adhesion_coefficient": 340.115,
        "electrostatic_force": 2.2022e-7,
        "field": RotatingField(0.020, 1.0),
    }
