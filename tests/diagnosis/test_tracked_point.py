"""Which point of the body positions are of, where the sensor does not say."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tumblers import diagnose
from tumblers.camera import TrackedPoint
from tumblers.dataset import Dataset
from tumblers.diagnosis.what.tracked_point import with_tracked_point
from tumblers.effects.base import Effect
from tumblers.effects.center_of_mass_offset import CenterOfMassOffset
from tumblers.effects.friction_coefficient import FrictionCoefficient
from tumblers.effects.viscous_drag import ViscousDrag

from .lab import PLANS, measure, plan, quiet

OFFSET = CenterOfMassOffset(offset_m=(0.0, 2.5e-5, 0.0))
KINDS = [CenterOfMassOffset, FrictionCoefficient]


def tracked(dataset: Dataset, point: TrackedPoint | None) -> Dataset:
    return replace(dataset, sensor=replace(dataset.sensor, tracked_point=point))


def unsaid(point: TrackedPoint, *effects: Effect, fields: slice = slice(2)) -> Dataset:
    """Return what is seen of a point of the body by a lab that does not say of which."""
    return tracked(measure(tracked(plan(PLANS[fields]), point), effects, seed=1), None)


@pytest.mark.parametrize("point", ["body_centre", "centre_of_mass"])
def test_an_offset_is_named_of_whichever_point_the_positions_are(point: TrackedPoint) -> None:
    data = unsaid(point, OFFSET)
    assert with_tracked_point(data, KINDS, 1, quiet) == tracked(data, point)
    found = diagnose(data, effects=[kind.name for kind in KINDS], jobs=1)
    assert found.dataset == data
    assert [effect.name for effect in found.effects] == ["center_of_mass_offset"]
    along = found.effects[0].parameters["offset_m[1]"]
    assert along.low <= OFFSET.offset_m[1] <= along.high
    said = {"body_centre": "of the centre of the body's shape,", "centre_of_mass": "of the body's centre of mass:"}
    assert [line for line in found.assumptions if said[point] in line]


def test_what_is_stated_is_believed() -> None:
    data = unsaid("centre_of_mass", OFFSET)
    assert with_tracked_point(tracked(data, "body_centre"), KINDS, 1, quiet) == tracked(data, "body_centre")
    found = diagnose(tracked(unsaid("body_centre"), "body_centre"), effects=["friction_coefficient"], jobs=1)
    assert not [line for line in found.assumptions if line.startswith("Positions are taken to be of")]


@pytest.mark.parametrize(
    "truth",
    [
        (),
        # By chance an offset follows it much better where positions are taken to be of the centre of mass.
        (ViscousDrag(viscosity_Pa_s=1e-3),),
        (ViscousDrag(viscosity_Pa_s=1e-3), CenterOfMassOffset(offset_m=(0.0, 1.5e-5, 0.0))),
    ],
)
def test_what_an_offset_alone_does_not_explain_speaks_for_no_other_point(truth: tuple[Effect, ...]) -> None:
    data = unsaid("body_centre", *truth, fields=slice(1, 4))
    assert with_tracked_point(data, KINDS, 1, quiet) == tracked(data, "body_centre")


def test_where_no_position_was_seen_nothing_is_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tumblers.diagnosis.what.tracked_point._likeliest", None)
    assert with_tracked_point(plan(), KINDS, 1, quiet).sensor.tracked_point == "body_centre"
    assert with_tracked_point(unsaid("body_centre"), KINDS[1:], 1, quiet).sensor.tracked_point == "body_centre"
