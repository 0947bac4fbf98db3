from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

from tumblers import InputError, preset_scenario, simulate
from tumblers.effects.size_error import SizeError
from tumblers.effects.substrate_tilt import SubstrateTilt
from tumblers.plots.body import ABOVE, SIDE, draw_body
from tumblers.plots.scene import Scene


def short(robot: str) -> xr.Dataset:
    return simulate(preset_scenario(robot=robot, substrate="paper", drive="20mT_1Hz", duration_s=0.002))


@pytest.mark.parametrize("robot", ["cuboid", "spiked_pdms", "spiked_ends_pdms", "curved_su8"])
def test_the_normals_point_outward(robot: str) -> None:
    scene = Scene.of(short(robot))
    # The divergence theorem: the volume is a third of the faces' areas times their distances from the origin.
    areas = np.array([0.5 * np.cross(face, np.roll(face, -1, axis=0)).sum(axis=0) for face in scene.faces])
    volume = sum(area @ face[0] for area, face in zip(areas, scene.faces, strict=True)) / 3.0
    body = preset_scenario(robot=robot, substrate="paper", drive="20mT_1Hz").robot.body()
    assert volume == pytest.approx(body.volume_m3, rel=1e-9)
    np.testing.assert_allclose(np.einsum("ij,ij->i", areas, scene.normals), np.linalg.norm(areas, axis=1), rtol=1e-12)


# A box has 12 edges; a bar with one spike above and below has 10 corners on either side.
@pytest.mark.parametrize(("robot", "edges"), [("cuboid", 12), ("spiked_pdms", 30)])
def test_creases_are_the_edges_of_the_body(robot: str, edges: int) -> None:
    assert len(Scene.of(short(robot)).creases()) == edges


def test_no_crease_runs_across_a_curved_surface() -> None:
    scene = Scene.of(short("curved_su8"))
    across = [edge for edge in scene.creases() if np.ptp(edge[:, 0]) > 1e-4]
    assert len(across) == 4


def test_the_nearest_rows_are_found() -> None:
    scene = Scene.of(simulate(preset_scenario("spiked", duration_s=0.01)))
    assert scene.rows([0.0, 0.00074, 0.00076, 0.01]).tolist() == [0, 1, 2, 20]
    with pytest.raises(InputError, match=r"from 0 to 0\.01 s"):
        scene.rows([0.02])


def test_effects_change_the_body_and_gravity() -> None:
    scenario = preset_scenario("cuboid_on_paper", duration_s=0.002)
    tilted = replace(scenario, effects=(SizeError(length_factor=2.0), SubstrateTilt(slope_y_deg=30.0)))
    scene = Scene.of(simulate(tilted))
    assert np.ptp(np.concatenate(scene.faces)[:, 1]) == pytest.approx(1.6e-3)
    np.testing.assert_allclose(scene.down, [0.0, -0.5, -np.sqrt(0.75)], atol=1e-12)
    assert scene.incline_deg == pytest.approx(30.0)


def test_what_an_observer_sees() -> None:
    scene = Scene.of(short("cuboid"))
    (face, normal, edges), *others = list(scene.seen(0, (0.0, 0.0, 1.0)))
    assert others == []
    np.testing.assert_allclose(normal, [0.0, 0.0, 1.0], atol=1e-12)
    assert len(edges) == 4
    np.testing.assert_allclose(np.abs(face[:, 1]), 4e-4, rtol=1e-12)
    # From a corner three faces show, the farthest first.
    seen = list(scene.seen(0, (0.6, 0.48, 0.64)))
    depths = [float((face @ (0.6, 0.48, 0.64)).mean()) for face, _, _ in seen]
    assert len(seen) == 3
    assert depths == sorted(depths)


@pytest.mark.parametrize(("view", "extents"), [(ABOVE, (0.4, 0.8)), (SIDE, (0.8, 0.1))])
def test_the_body_is_drawn_in_millimetres(view: object, extents: tuple[float, float]) -> None:
    ax = Figure().subplots()
    drawn = draw_body(ax, Scene.of(short("cuboid")), 0, view, "#0072B2")  # type: ignore[arg-type]
    corners = np.concatenate([path.vertices for path in drawn.get_paths()])
    np.testing.assert_allclose(np.ptp(corners, axis=0), extents, rtol=1e-9)
