"""Where a robot was seen, taken back to the substrate frame."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from numpy.testing import assert_allclose, assert_array_equal

from tests.cameras import CAMERAS
from tumblers.camera import Camera
from tumblers.dataset import LabTrial, Outcome, Track
from tumblers.diagnosis.gap.guide import Guide
from tumblers.presets import drive

TIME = np.arange(0.0, 1.0, 0.05)
# A robot that goes on, and to and fro as it turns over.
WAY = np.stack([1e-4 * TIME, 2e-3 * TIME + 1e-4 * np.sin(30.0 * TIME), 4e-4 + 0.0 * TIME], axis=1)


def trial(time: Any = TIME, **channels: Any) -> LabTrial:
    track = Track(time_s=time, channels={name: np.array(values) for name, values in channels.items()})
    return LabTrial(id="a", field=drive(0.01, 5.0), duration_s=1.0, track=track)


@given(CAMERAS, CAMERAS)
def test_what_two_cameras_saw_is_taken_back(first: Camera, second: Camera) -> None:
    seen = second.seen_position(first.seen_position(WAY))
    behind = Guide(TIME, seen[:, 0], seen[:, 1]).behind((first, second))
    assert behind is not None
    assert_allclose(behind[0], TIME + (first.time_offset_s + second.time_offset_s), rtol=0.0, atol=1e-15)
    # Rounding of an origin a centimetre away, seen a hundred times smaller.
    assert_allclose(behind[1], WAY[:, 1], rtol=0.0, atol=1e-14)


def test_without_x_the_robot_stayed_at_x_0_and_a_camera_that_is_turned_far_shows_nothing() -> None:
    camera = Camera(scale=1.1, heading_deg=20.0, origin_m=(1e-4, -2e-4))
    straight = WAY * np.array([0.0, 1.0, 1.0])
    guide = Guide.of(trial(y_m=camera.seen_position(straight)[:, 1]))
    assert guide is not None
    behind = guide.behind((camera,))
    assert behind is not None
    assert_allclose(behind[1], WAY[:, 1], atol=1e-12)
    for heading in (30.0, 90.0, 180.0, -90.0):
        assert guide.behind((Camera(heading_deg=heading),)) is None


def test_an_x_that_is_lost_is_taken_between_its_neighbours() -> None:
    x = WAY[:, 0].copy()
    x[3:9] = np.nan
    guide = Guide.of(trial(x_m=x, y_m=WAY[:, 1]))
    assert guide is not None
    assert_allclose(guide.x_m, WAY[:, 0], atol=1e-15)
    alone = Guide.of(trial(x_m=np.full(len(TIME), np.nan), y_m=WAY[:, 1]))
    assert alone is not None
    assert alone.x_m is None


def test_lost_frames_and_those_at_odds_with_both_neighbours_are_left_out() -> None:
    y = WAY[:, 1].copy()
    y[[0, 7]] = np.nan
    y[12] += 5e-3
    guide = Guide.of(trial(y_m=y))
    assert guide is not None
    # Beside what is no robot its neighbours are at odds too.
    assert_array_equal(guide.time_s, np.delete(TIME, [0, 7, 11, 12, 13]))
    # A robot at rest whose place is read to the pixel.
    still = Guide.of(trial(y_m=np.where(np.arange(len(TIME)) == 5, 1e-6, 0.0)))
    assert still is not None
    assert len(still.time_s) == len(TIME)


@pytest.mark.parametrize("count", [0, 1])
def test_one_frame_is_no_guide(count: int) -> None:
    y = np.full(len(TIME), np.nan)
    y[:count] = 1e-4
    assert Guide.of(trial(y_m=y)) is None
    assert Guide.of(trial(TIME[:1], y_m=[1e-4])) is None
    assert Guide.of(trial(tilt_deg=np.zeros(len(TIME)))) is None
    outcome = LabTrial(id="a", field=drive(0.01, 5.0), duration_s=1.0, outcome=Outcome(climbs=True))
    assert Guide.of(outcome) is None
