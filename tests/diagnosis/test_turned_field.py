"""A field that is ahead."""

from __future__ import annotations

from math import radians

import numpy as np
import pytest

from tumblers.diagnosis.where.turned_field import TurnedField
from tumblers.errors import InputError
from tumblers.field import Field, RotatingField, StaticField
from tumblers.presets import drive
from tumblers.scenario import Scenario

from .lab import plan


def scenario(field: Field) -> Scenario:
    dataset = plan([("one", field, 0.0)], duration_s=0.3)
    return dataset.trials[0].scenario(dataset, 5e-4)


def test_a_field_that_is_ahead_is_what_it_would_be_later() -> None:
    before = scenario(drive(0.010, 4.0))
    field = TurnedField(ahead_deg=50.0).edit(before).field
    assert isinstance(field, RotatingField)
    late_s = radians(50.0) / (2.0 * np.pi * 4.0)
    for time in (0.0, 0.03, 0.2):
        np.testing.assert_allclose(field.core().at(time), before.field.core().at(time + late_s), atol=1e-15)
    assert TurnedField().edit(before) is before


def test_a_field_that_does_not_turn_is_not_ahead() -> None:
    still = scenario(StaticField(strength_T=1e-3, direction=(0.0, 0.0, 1.0)))
    with pytest.raises(InputError, match=r"field\.kind: found 'static', expected 'rotating'"):
        TurnedField(ahead_deg=1.0).edit(still)
