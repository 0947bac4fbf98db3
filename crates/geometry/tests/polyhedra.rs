//! Structure: Euler's characteristic, generators on their surfaces, faces and edges; and what is refused.

mod common;

use common::{UM, as_released, bodies, directions, geometric, geometry};
use geometry::{Body, Draft, DraftModel, Generator, GeometryError, Surface};
use nalgebra::Vector3;
use proptest::prelude::*;

fn places(generator: &Generator) -> Vec<Vector3<f64>> {
    match generator {
        Generator::Vertex(p) => vec![*p],
        Generator::Arc(arc) => (-4..=4).map(|k| arc.point(f64::from(k) / 4.0 * arc.half_angle)).collect(),
        Generator::Corner(corner) => (0..=8).map(|k| corner.point(f64::from(k) / 8.0 * corner.width)).collect(),
        Generator::Ellipsoid(_) => directions(50).iter().map(|d| generator.support(d)).collect(),
    }
}

fn check(name: &str, body: &Body, tolerance: f64) {
    let tolerance = tolerance * body.size();
    for (g, generator) in body.generators().iter().enumerate() {
        for point in places(generator) {
            let (_, value) = body.max_value(&point);
            assert!(value.abs() <= tolerance, "{name}: generator {g} {value:e}");
        }
        for &f in body.faces_of(g as u16) {
            let face = &body.faces()[usize::from(f)];
            assert!(face.generators.contains(&(g as u16)));
            let surface = &body.surfaces()[usize::from(face.surface)];
            let nearest = places(generator).iter().map(|p| surface.value(p).abs()).fold(f64::INFINITY, f64::min);
            assert!(nearest <= tolerance, "{name}: generator {g} face {f} {nearest:e}");
        }
    }
    for face in body.faces() {
        let surface = &body.surfaces()[usize::from(face.surface)];
        assert!(matches!(surface, Surface::HalfSpace(_)));
        for point in face.anchors.iter().chain([&face.area_centroid, &face.line_centroid]) {
            assert!(surface.value(point).abs() <= tolerance, "{name} {}", surface.value(point));
            assert!(body.max_value(point).1 <= tolerance, "{name}");
        }
        let [a, b, c] = face.anchors;
        assert!((b - a).cross(&(c - a)).norm() > 0.0);
        for &(across, _) in &face.neighbours {
            let beyond = &body.surfaces()[usize::from(across)];
            assert!(beyond.value(&face.area_centroid) < 0.0);
        }
    }
    for edge in body.edges() {
        for &s in &edge.surfaces {
            assert!(body.surfaces()[usize::from(s)].value(&edge.midpoint).abs() <= tolerance, "{name} {edge:?}");
        }
    }
}

#[test]
fn every_generator_is_inside_and_on_its_surfaces() {
    for (name, body) in bodies() {
        check(&name, &body, 1e-14);
        if !name.starts_with("curved") && !name.starts_with("ellipsoid") {
            assert_eq!(body.generators().len() + body.faces().len(), body.edges().len() + 2, "{name}");
        }
    }
}

fn cube(scale: [f64; 3]) -> Vec<[f64; 3]> {
    (0..8).map(|k| [0, 1, 2].map(|i| if k >> i & 1 == 1 { scale[i] } else { -scale[i] })).collect()
}

#[test]
fn coplanar_triangles_are_merged_and_inner_points_dropped() {
    let mut points = cube([UM, UM, UM]);
    points.extend(cube([UM, UM, UM]));
    points.extend(cube([0.5 * UM, 0.5 * UM, 0.5 * UM]));
    points.extend([[UM, 0.0, 0.0], [UM, UM, 0.3 * UM], [0.2 * UM, UM, UM]]);
    let body = Body::hull(&points).unwrap();
    assert_eq!((body.generators().len(), body.edges().len(), body.faces().len()), (8, 12, 6));
    assert!(body.faces().iter().all(|f| (f.area - 4.0 * UM * UM).abs() < 1e-24 && f.line_length == 0.0));
    assert!(body.edges().iter().all(|e| (e.length - 2.0 * UM).abs() < 1e-18));
    check("cube", &body, 1e-14);
}

#[test]
fn prisms_and_thin_plates_are_hulls() {
    for corners in [3, 6, 17, 60] {
        for thickness in [1.0, 1e-2, 1e-4, 1e-5] {
            let points: Vec<[f64; 3]> = (0..2 * corners)
                .map(|k| {
                    let turn = 2.0 * std::f64::consts::PI * f64::from(k / 2) / f64::from(corners) + 0.1;
                    let z = if k % 2 == 0 { thickness } else { -thickness };
                    [1e-3 * turn.cos(), 1e-3 * turn.sin(), 1e-3 * z]
                })
                .collect();
            let body = Body::hull(&points).unwrap();
            let counts = (body.generators().len(), body.edges().len(), body.faces().len());
            assert_eq!(counts, (2 * corners as usize, 3 * corners as usize, corners as usize + 2));
            check("prism", &body, 1e-13);
        }
    }
}

#[test]
fn a_shape_s_hull_of_vertices_is_the_shape() {
    let body = common::spiked(geometric(3.0));
    let points: Vec<[f64; 3]> = body.generators().iter().map(|g| g.support(&Vector3::x()).into()).collect();
    let hull = Body::hull(&points).unwrap();
    assert_eq!(hull.faces().len(), body.faces().len());
    assert_eq!(hull.edges().len(), body.edges().len());
    assert!((hull.size() - body.size()).abs() < 1e-18);
    assert!((hull.hull_perimeter() - body.hull_perimeter()).abs() < 1e-12 * body.hull_perimeter());
}

#[test]
fn degenerate_hulls_are_refused() {
    let flat: Vec<[f64; 3]> = (0..9).map(|k| [f64::from(k % 3) - 1.0, f64::from(k / 3) - 1.0, 0.0]).collect();
    assert!(matches!(Body::hull(&flat), Err(GeometryError::Flat { .. })));
    let tilted: Vec<[f64; 3]> = flat.iter().map(|p| [p[0], p[1], 0.3 * p[0] - 0.7 * p[1]]).collect();
    assert!(matches!(Body::hull(&tilted), Err(GeometryError::Flat { .. })));
    let line: Vec<[f64; 3]> = (0..5).map(|k| [f64::from(k), 2.0 * f64::from(k), 0.0]).collect();
    assert!(matches!(Body::hull(&line), Err(GeometryError::Flat { .. })));
    assert!(matches!(Body::hull(&[]), Err(GeometryError::TooFewPoints { distinct: 0 })));
    assert!(matches!(Body::hull(&flat[..3]), Err(GeometryError::TooFewPoints { distinct: 3 })));
    assert!(matches!(Body::hull(&[[1.0, 2.0, 3.0]; 6]), Err(GeometryError::TooFewPoints { distinct: 1 })));
    for bad in [f64::NAN, f64::INFINITY] {
        let mut points = cube([UM, UM, UM]);
        points[3][1] = bad;
        assert!(matches!(Body::hull(&points), Err(GeometryError::NotFinite { .. })));
    }
    let away: Vec<[f64; 3]> = cube([UM, UM, UM]).iter().map(|p| [p[0] + 3.0 * UM, p[1], p[2]]).collect();
    let Err(GeometryError::OriginOutside { distance }) = Body::hull(&away) else { panic!() };
    assert!((distance - 2.0 * UM).abs() < 1e-15);
    let touching: Vec<[f64; 3]> = cube([UM, UM, UM]).iter().map(|p| [p[0] + UM, p[1], p[2]]).collect();
    assert!(matches!(Body::hull(&touching), Err(GeometryError::OriginOutside { .. })));
}

#[test]
fn impossible_shapes_are_refused() {
    let none = Draft::NONE;
    for bad in [f64::NAN, f64::INFINITY, 0.0, -1e-4] {
        for k in 0..3 {
            let mut a = [1e-4; 3];
            a[k] = bad;
            assert!(Body::cuboid(a[0], a[1], a[2], none).is_err());
            assert!(Body::ellipsoid(a).is_err());
        }
        for k in 0..5 {
            let mut a = [4e-4, 2e-4, 0.75e-4, 1.25e-4, 3.25e-4];
            a[k] = bad;
            assert!(Body::spiked(a[0], a[1], a[2], a[3], a[4], none).is_err());
            assert!(Body::spiked_ends(a[0], a[1], a[2], a[3], a[4], none).is_err());
        }
        for k in 0..4 {
            let mut a = [1.25e-3, 1.1e-3, 0.4, 4e-4];
            a[k] = bad;
            assert!(Body::curved(a[0], a[1], a[2], a[3], none).is_err());
        }
    }
    assert!(matches!(Body::curved(1e-3, 1e-3, 0.4, 4e-4, none), Err(GeometryError::TooLarge { .. })));
    assert!(matches!(Body::curved(1e-3, 9e-4, 1.6, 4e-4, none), Err(GeometryError::TooLarge { .. })));
    assert!(matches!(Body::spiked(4e-4, 2e-4, 1e-4, 5e-4, 3e-4, none), Err(GeometryError::TooLarge { .. })));
    assert!(matches!(Body::spiked(4e-4, 2e-4, 1e-4, 1e-4, 9e-5, none), Err(GeometryError::TooLarge { .. })));
    assert!(matches!(Body::spiked_ends(4e-4, 2e-4, 1e-4, 2e-4, 1e-4, none), Err(GeometryError::TooLarge { .. })));
    for bad in [f64::NAN, f64::INFINITY, -0.1, 1.6] {
        for model in [DraftModel::Geometric, DraftModel::AsReleased] {
            assert!(Body::cuboid(4e-4, 2e-4, 1e-4, Draft { angle_rad: bad, model }).is_err());
        }
    }
    for degrees in [60.0, 80.0, 89.9] {
        for draft in [geometric(degrees), as_released(degrees)] {
            let bodies = [
                Body::cuboid(4e-4, 2e-4, 1e-4, draft),
                Body::spiked(4e-4, 2e-4, 0.75e-4, 1.25e-4, 3.25e-4, draft),
                Body::spiked_ends(4e-4, 2e-4, 0.75e-4, 1e-4, 1e-4, draft),
                Body::curved(1.25e-3, 1.1e-3, 0.4, 4e-4, draft),
            ];
            for body in bodies {
                assert!(matches!(body, Err(GeometryError::DraftTooLarge { .. })), "{degrees}");
            }
        }
    }
}

#[test]
fn the_paper_s_draft_angles_are_possible() {
    for degrees in 0..=15 {
        for draft in [geometric(degrees.into()), as_released(degrees.into())] {
            common::spiked(draft);
            let ends = Body::spiked_ends(4e-4, 2e-4, 0.75e-4, 1e-4, 1e-4, draft);
            // With the released slope the spikes' outer faces vanish at d = 40 µm on the far side, at 11.3°.
            let vanishes = draft.model == DraftModel::AsReleased && degrees >= 12;
            assert_eq!(ends.is_err(), vanishes, "{degrees}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn random_hulls_close(points in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 4..60)) {
        match Body::hull(&points) {
            Ok(body) => {
                prop_assert_eq!(body.generators().len() + body.faces().len(), body.edges().len() + 2);
                check("random", &body, 1e-9);
                for p in &points {
                    prop_assert!(body.max_value(&Vector3::from(*p)).1 <= 1e-9);
                }
            }
            Err(error) => prop_assert!(matches!(error, GeometryError::OriginOutside { .. }), "{error}"),
        }
    }

    /// Points on a coarse grid: many duplicates, coplanar and collinear ones.
    #[test]
    fn grid_hulls_close(points in prop::collection::vec(prop::array::uniform3(-3..=3i32), 4..80), scale in 1e-6..1.0f64) {
        let points: Vec<[f64; 3]> = points.iter().map(|p| p.map(|c| f64::from(c) * scale)).collect();
        match Body::hull(&points) {
            Ok(body) => {
                prop_assert_eq!(body.generators().len() + body.faces().len(), body.edges().len() + 2);
                check("grid", &body, 1e-9);
                for p in &points {
                    prop_assert!(body.max_value(&Vector3::from(*p)).1 <= 1e-9 * body.size());
                }
            }
            Err(error) => prop_assert!(!matches!(error, GeometryError::HullNotFound { .. }), "{error}"),
        }
    }
}
