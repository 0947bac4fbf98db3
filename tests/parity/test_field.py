"""Fields at any time."""

from __future__ import annotations

import numpy as np
import pytest

from tumblers import Field, RotatingField, StaticField, TableField

from .twin import reference_field

FIELDS: dict[str, Field] = {
    "rotating": RotatingField(strength_T=0.01, frequency_Hz=5.0),
    "rotating about an axis": RotatingField(
        strength_T=0.02, frequency_Hz=12.3, rotation_axis=(1.0, 2.0, -1.0), initial_direction=(1.0, 0.0, 1.0)
    ),
    "on an ellipse": RotatingField(strength_T=0.02, frequency_Hz=3.0, quadrature_ratio=0.7, phase_error_deg=-20.0),
    "static": StaticField(strength_T=0.015, direction=(1.0, -2.0, 0.5)),
    "table": TableField(
        time_s=(0.0, 0.1, 0.15, 1.0), field_T=((0, 0, 0.01), (0, 0.01, 0), (0.02, 0, 0), (0, 0, -0.01))
    ),
}


@pytest.mark.parametrize("name", FIELDS)
def test_field(name: str) -> None:
    field = FIELDS[name]
    core, other = field.core(), reference_field(field)
    # A midpoint torque asks for half a step before the start and after the end of a table.
    for time in [-2.5e-4, 0.0, 0.1, 1.0, 1.00025, *np.random.default_rng(1).uniform(0.0, 1.0, 100)]:
        np.testing.assert_allclose(core.at(time), other.at(time), rtol=1e-12, atol=1e-15)
