"""Mass properties, surfaces and touching areas against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tumblers.reference import Body, cuboid, curved, ellipsoid, hull, spiked, spiked_ends
from tumblers.reference.cell import Cell

U = 1e-6
DRAFT = math.radians(4.0)
BODIES = {
    "cuboid": cuboid(800 * U, 400 * U, 100 * U),
    "cuboid drafted": cuboid(800 * U, 400 * U, 100 * U, DRAFT),
    "spiked": spiked(400 * U, 200 * U, 75 * U, 125 * U, 325 * U),
    "spiked drafted": spiked(400 * U, 200 * U, 75 * U, 125 * U, 325 * U, DRAFT, "as_released"),
    "spiked ends": spiked_ends(400 * U, 200 * U, 75 * U, 100 * U, 100 * U),
    "spiked ends drafted": spiked_ends(400 * U, 200 * U, 75 * U, 100 * U, 100 * U, DRAFT),
    "curved": curved(1250 * U, 1100 * U, math.radians(25.0), 400 * U),
    "curved drafted": curved(1250 * U, 1100 * U, math.radians(25.0), 400 * U, math.radians(2.0)),
    "ellipsoid": ellipsoid([100 * U, 200 * U, 300 * U]),
}


def area_of(body: Body, normal: tuple[float, float, float]) -> float:
    """Real area of the face whose normal is nearest to `normal`."""
    faces = [cell for cell in body.cells if cell.kind == "face"]

    def closeness(cell: Cell) -> float:
        (i,) = cell.surfaces
        return float(body.surfaces[i].gradient(np.zeros(3)) @ np.array(normal))

    return max(faces, key=closeness).area


def test_cuboid_inertia() -> None:
    """`(b² + c²)/12` about each axis."""
    a, b, c = 400 * U, 800 * U, 100 * U
    body = cuboid(b, a, c)
    assert body.volume == pytest.approx(a * b * c, rel=1e-13)
    expected = np.diag([b * b + c * c, a * a + c * c, a * a + b * b]) / 12.0
    np.testing.assert_allclose(body.inertia_per_mass, expected, rtol=1e-12, atol=1e-22)
    assert body.radius == pytest.approx(math.sqrt(a * a + b * b + c * c) / 2.0, rel=1e-13)


def test_drafted_cuboid_volume_and_centroid() -> None:
    """Sections `(L - 2d)(H - 2d)`, `d = s tan φ`, `s = x + W/2`, integrated by hand."""
    length, width, height, t = 800 * U, 400 * U, 100 * U, math.tan(DRAFT)
    volume = length * height * width - (length + height) * t * width**2 + 4.0 * t * t * width**3 / 3.0
    first = length * height * width**2 / 2 - 2 * (length + height) * t * width**3 / 3 + t * t * width**4
    body = BODIES["cuboid drafted"]
    assert body.volume == pytest.approx(volume, rel=1e-12)
    nominal_side = min(cell.points[0][0] for cell in body.cells if cell.kind == "vertex")
    assert -nominal_side == pytest.approx(first / volume, rel=1e-12)


def test_hull_of_cuboid_corners_is_the_cuboid() -> None:
    """The general hull, by tetrahedra, agrees with sections."""
    corners = [[x, y, z] for x in (-2e-4, 2e-4) for y in (-4e-4, 4e-4) for z in (-5e-5, 5e-5)]
    general, own = hull([*corners, [0.0, 0.0, 5e-5], [0.0, 4e-4, 0.0]]), BODIES["cuboid"]
    assert len(general.surfaces) == 6
    assert sorted(c.kind for c in general.cells) == sorted(c.kind for c in own.cells)
    np.testing.assert_allclose(general.inertia_per_mass, own.inertia_per_mass, rtol=1e-10, atol=1e-20)


def test_spiked_volume_and_inertia() -> None:
    """Bar plus two triangles of base b and height s; `I_x` by the parallel axis theorem."""
    length, width, height, base, spike = 400 * U, 200 * U, 75 * U, 125 * U, 125 * U
    bar, tooth = length * height, base * spike / 2.0
    body = BODIES["spiked"]
    assert body.volume == pytest.approx(width * (bar + 2 * tooth), rel=1e-12)
    own = base**2 / 24.0 + spike**2 / 18.0
    tooth_inertia = tooth * (own + (height / 2 + spike / 3) ** 2)
    expected = (bar * (length**2 + height**2) / 12.0 + 2.0 * tooth_inertia) / (bar + 2 * tooth)
    assert body.inertia_per_mass[0, 0] == pytest.approx(expected, rel=1e-12)


def test_curved_mass_properties() -> None:
    """Area `α (Ro² - Ri²)`, centroid `2 sin α (Ro³ - Ri³)/(3 α (Ro² - Ri²))`, polar moment `(Ro² + Ri²)/2`."""
    outer, inner, alpha, width = 1250 * U, 1100 * U, math.radians(25.0), 400 * U
    body = BODIES["curved"]
    area = alpha * (outer**2 - inner**2)
    centroid = 2.0 * math.sin(alpha) * (outer**3 - inner**3) / (3.0 * area)
    assert body.volume == pytest.approx(area * width, rel=1e-12)
    assert body.inertia_per_mass[0, 0] == pytest.approx((outer**2 + inner**2) / 2.0 - centroid**2, rel=1e-11)
    assert body.lowest_height(np.eye(3)) == pytest.approx(inner * math.cos(alpha) - centroid, rel=1e-10)


@pytest.mark.parametrize("name", BODIES)
def test_points_are_inside_and_gradients_are_derivatives(name: str) -> None:
    """No corner leaves the body; the surfaces through it vanish on it; gradients match differences."""
    body = BODIES[name]
    for cell in body.cells:
        for point in cell.points:
            values = body.values(point)
            assert values.max() < 1e-12 * body.radius
            assert np.abs(values[sorted(cell.surfaces)]).max() < 1e-12 * body.radius
    point, d = 0.7 * body.radius * np.array([0.3, 0.5, 0.8]), 1e-6 * body.radius
    for surface, gradient in zip(body.surfaces, body.gradients(point), strict=True):
        slope = [(surface.value(point + e) - surface.value(point - e)) / (2.0 * d) for e in d * np.eye(3)]
        np.testing.assert_allclose(gradient, slope, atol=1e-8)


@pytest.mark.parametrize("name", [n for n in BODIES if n != "ellipsoid"])
def test_lowest_height_is_that_of_sampled_points(name: str) -> None:
    """No corner or point of an arc is below the lowest anchor, in any orientation."""
    body, rng = BODIES[name], np.random.default_rng(3)
    points = [point for cell in body.cells for point in cell.points]
    for rim in body.rims:
        angles = np.linspace(-rim.half_angle, rim.half_angle, 400)
        points += [rim.centre + rim.radius * np.array([0.0, math.sin(a), math.cos(a)]) for a in angles]
    for _ in range(20):
        rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        lowest = min(float(rotation[2] @ point) for point in points)
        assert body.lowest_height(rotation) == pytest.approx(lowest, abs=2e-5 * body.radius)


def test_draft_is_measured_in_the_profile_plane() -> None:
    """The far side's end face is inset by `W tan φ`, the hull's corners follow."""
    body = BODIES["cuboid drafted"]
    points = np.array([cell.points[0] for cell in body.cells if cell.kind == "vertex"])
    near, far = points[points[:, 0] < 0.0], points[points[:, 0] > 0.0]
    assert np.ptp(near[:, 1]) == pytest.approx(800 * U)
    assert np.ptp(far[:, 1]) == pytest.approx(800 * U - 2.0 * 400 * U * math.tan(DRAFT))
    assert np.ptp(far[:, 2]) == pytest.approx(100 * U - 2.0 * 400 * U * math.tan(DRAFT))


def test_perimeters_are_the_ideal_speeds() -> None:
    """Hull perimeters 1093 and 1197 µm, the text's ideal speeds at 1 Hz."""
    for name, expected in (("spiked", 1093.4), ("spiked ends", 1197.2)):
        side = [c for c in BODIES[name].cells if c.kind == "face"][-1].points
        around = sum(float(np.linalg.norm(side[i] - side[i - 1])) for i in range(len(side)))
        assert around == pytest.approx(expected * U, rel=1e-4)


def test_what_is_bridged_by_air_has_no_area() -> None:
    """Slanted faces of the spiked robot, the top of the one with spiked ends, the chord of the curved one."""
    assert area_of(BODIES["spiked"], (0.0, 0.53, 0.85)) == 0.0
    assert area_of(BODIES["spiked"], (0.0, 1.0, 0.0)) == pytest.approx(75 * 200 * U * U)
    assert area_of(BODIES["spiked"], (1.0, 0.0, 0.0)) == pytest.approx((400 * 75 + 125 * 125) * U * U)
    assert area_of(BODIES["spiked ends"], (0.0, 0.0, 1.0)) == 0.0
    assert area_of(BODIES["spiked ends"], (0.0, 0.89, 0.45)) == pytest.approx(math.hypot(50, 100) * 200 * U * U)
    assert area_of(BODIES["curved"], (0.0, 0.0, -1.0)) == 0.0
    assert area_of(BODIES["cuboid"], (0.0, 0.0, -1.0)) == pytest.approx(800 * 400 * U * U)


def test_vanishing_face_is_refused() -> None:
    """A draft that closes the profile names what is wrong."""
    with pytest.raises(ValueError, match="draft: a face of the profile vanishes"):
        cuboid(800 * U, 400 * U, 100 * U, math.radians(20.0))
