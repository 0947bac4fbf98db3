from __future__ import annotations

import pytest

from tumblers import (
    InputError,
    Scenario,
)

HULL = """shape = "hull"
vertices_m = {vertices}
"""
CUBOID = """shape = "cuboid"
length_m = 8.0e-4
width_m = 4.0e-4
height_m = 1.0e-4
"""
CORNERS = [[x, y, z] for x in (-1e-4, 1e-4) for y in (-2e-4, 2e-4) for z in (-1e-4, 1e-4)]


@pytest.mark.parametrize(
    ("vertices", "key", "words"),
    [
        ([], "robot.vertices_m", "no points"),
        ([[0, 0, 0], [1e-4, 0, 0], [0, 1e-4, 0]], "robot.vertices_m", "3 distinct points"),
        ([[0, 0, 0], [1e-4, 0, 0], [0, 1e-4, 0], [0, 0, 0]], "robot.vertices_m", "3 distinct points"),
        ([[0, 0, 0], [1e-4, 0, 0], [0, 1e-4, 0], [1e-4, 1e-4, 0]], "robot.vertices_m", "flat"),
        ([[0, 0], [1e-4, 0], [0, 1e-4], [1e-4, 1e-4]], "robot.vertices_m[0]", "3 numbers"),
        ([*CORNERS, [0, 0, 1e-6]], "robot.vertices_m[8]", "convex"),
        ([[x + 1e-3, y, z] for x, y, z in CORNERS], "robot.vertices_m", "outside the hull"),
    ],
)
def test_bad_hulls_get_one_line(text: str, vertices: list[list[float]], key: str, words: str) -> None:
    assert CUBOID in text
    with pytest.raises(InputError, match="found") as caught:
        Scenario.from_toml(text.replace(CUBOID, HULL.format(vertices=vertices)))
    assert caught.value.key == key
    assert words in str(caught.value)


def test_a_good_hull_is_welcome(text: str) -> None:
    scenario = Scenario.from_toml(text.replace(CUBOID, HULL.format(vertices=CORNERS)))
    assert scenario.robot.body().volume_m3 == pytest.approx(1.6e-11, rel=1e-12)


def test_a_hull_takes_no_draft(text: str) -> None:
    with pytest.raises(InputError, match=r"robot\.draft_deg: found a draft of the shape hull"):
        Scenario.from_toml(text.replace(CUBOID, HULL.format(vertices=CORNERS) + "draft_deg = 1.0\n"))


def test_a_point_on_a_face_is_welcome(text: str) -> None:
    on_a_face = [*CORNERS, [0.0, 0.0, 1e-4], [1e-4, 1e-5, -2e-5]]
    scenario = Scenario.from_toml(text.replace(CUBOID, HULL.format(vertices=on_a_face)))
    assert scenario.robot.body() is scenario.robot.with_magnetization(10.0, 20.0).body()
