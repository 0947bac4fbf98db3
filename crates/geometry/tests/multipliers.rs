//! Multipliers reproduce a direction at what it finds lowest.

mod common;

use common::{
    as_released, bodies, cuboid, curved, directions, ellipsoid, geometric, geometry, reproduced, spiked, spiked_ends,
};
use geometry::{Body, Support, Surface};
use nalgebra::Vector3;
use proptest::prelude::*;

fn check(name: &str, body: &Body, support: Support, point: &Vector3<f64>, direction: &Vector3<f64>, tolerance: f64) {
    let mut l = vec![f64::NAN; body.surfaces().len()];
    let found = body.multipliers(support, point, direction, &mut l);
    let error = (reproduced(body, point, &l) - direction).norm();
    assert!(found && error < tolerance, "{name} {support:?} {direction} {l:?} {error:e}");
    assert!(l.iter().all(|l| *l >= 0.0));
    for (surface, l) in body.surfaces().iter().zip(&l) {
        assert!(
            *l == 0.0 || surface.value(point).abs() < 1e-9 * body.size(),
            "{name} {support:?} {l:e} off its surface"
        );
    }
}

fn check_lowest(name: &str, body: &Body, direction: &Vector3<f64>) {
    let (g, point) = body.lowest(direction);
    check(name, body, Support::Point(g), &point, direction, 1e-9);
}

#[test]
fn at_the_lowest_point_of_every_shape() {
    for (name, body) in bodies() {
        for direction in directions(3000) {
            check_lowest(&name, &body, &direction);
        }
    }
}

#[test]
fn at_what_touches() {
    for (name, body) in bodies() {
        for direction in directions(300) {
            let support = body.touching(&direction, 1e-9 * body.size());
            let (_, point) = body.lowest(&direction);
            check(&name, &body, support, &point, &direction, 1e-6);
        }
    }
}

#[test]
fn on_edges_and_faces() {
    for (name, body) in bodies() {
        let at = |i: u16, p: &Vector3<f64>| body.surfaces()[usize::from(i)].gradient(p);
        for edge in body.edges() {
            for weight in [0.0, 0.1, 0.5, 1.0] {
                let p = edge.midpoint;
                let direction = match edge.surfaces.as_slice() {
                    [a] => at(*a, &p),
                    [a, b] => (weight * at(*a, &p) + (1.0 - weight) * at(*b, &p)).normalize(),
                    _ => panic!(),
                };
                let (g, h) = edge.generators;
                check(&name, &body, Support::Line(g, h), &p, &direction, 1e-9);
            }
        }
        for (f, face) in body.faces().iter().enumerate() {
            let direction = at(face.surface, &face.area_centroid);
            check(&name, &body, Support::Face(f as u16), &face.area_centroid, &direction, 1e-12);
        }
    }
}

#[test]
fn along_the_outer_corners_of_the_curved_shape() {
    for degrees in [0.0, 4.0] {
        let body = curved(geometric(degrees));
        let generators = body.generators();
        for (g, end) in [(1u16, 2usize), (0, 1)] {
            let Surface::HalfSpace(plane) = body.surfaces()[end] else { panic!() };
            // From a point of the corner, directions between the end plane's normal and the cone's gradient.
            let corner = if degrees == 0.0 { generators[4] } else { generators[usize::from(6 + g)] };
            let point = corner.support(&(plane.normal + Vector3::new(0.0, 0.0, 0.5)).normalize());
            let point = if degrees == 0.0 { Vector3::new(0.0, point.y, point.z) } else { point };
            let cone = body.surfaces()[0].gradient(&point);
            let direction = (0.3 * plane.normal + 0.7 * cone).normalize();
            let support = if degrees == 0.0 { Support::Line(4, 5) } else { Support::Point(6 + g) };
            check("corner", &body, support, &point, &direction, 1e-9);
        }
    }
}

#[test]
fn a_direction_outside_the_support_is_refused() {
    let body = cuboid(geometric(0.0));
    let mut l = vec![0.0; body.surfaces().len()];
    let (g, point) = body.lowest(&Vector3::new(1.0, 1.0, 1.0).normalize());
    let away = -Vector3::new(1.0, 1.0, 1.0).normalize();
    assert!(!body.multipliers(Support::Point(g), &point, &away, &mut l));
    assert!(!body.multipliers(Support::None, &point, &away, &mut l));
    assert!(!body.multipliers(Support::Face(0), &point, &away, &mut l));
    assert!(l.iter().all(|l| *l >= 0.0));
}

fn unit() -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(-1.0..1.0f64)
        .prop_map(Vector3::from)
        .prop_filter("too short", |v| v.norm() > 1e-3)
        .prop_map(|v| v.normalize())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn at_the_lowest_vertex_of_random_hulls(
        points in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 4..60),
        directions in prop::collection::vec(unit(), 50),
    ) {
        if let Ok(body) = Body::hull(&points) {
            for direction in &directions {
                check_lowest("random hull", &body, direction);
            }
        }
    }

    #[test]
    fn at_the_apex_of_many_faces(direction in unit(), corners in 9..60u32) {
        let mut points: Vec<[f64; 3]> = (0..corners)
            .map(|k| {
                let turn = 2.0 * std::f64::consts::PI * f64::from(k) / f64::from(corners);
                [turn.cos(), turn.sin(), -0.5]
            })
            .collect();
        points.push([0.1, 0.2, 1.5]);
        let body = Body::hull(&points).unwrap();
        check_lowest("pyramid", &body, &direction);
    }

    #[test]
    fn at_the_lowest_point_of_drafted_shapes(direction in unit(), degrees in 0.0..6.0f64) {
        let draft = geometric(degrees);
        for body in [cuboid(draft), spiked(draft), spiked_ends(as_released(degrees)), curved(draft), ellipsoid()] {
            check_lowest("drafted", &body, &direction);
            let lowest = body.lowest(&direction).1.dot(&direction);
            let farthest = body.generators().iter().map(|g| g.support(&direction).dot(&direction));
            prop_assert_eq!(lowest, farthest.fold(f64::NEG_INFINITY, f64::max));
        }
    }
}
