"""Cameras of any kind, for property tests."""

from __future__ import annotations

from typing import get_args

from hypothesis import strategies as st

from tumblers.camera import Camera, TrackedPoint

__all__ = ["CAMERAS"]

CAMERAS = st.builds(
    Camera,
    scale=st.floats(0.1, 2),
    heading_deg=st.floats(-180, 180),
    origin_m=st.tuples(st.floats(-1e-2, 1e-2), st.floats(-1e-2, 1e-2)),
    time_offset_s=st.floats(-1, 1),
    tracked_point=st.sampled_from(get_args(TrackedPoint)),
)
