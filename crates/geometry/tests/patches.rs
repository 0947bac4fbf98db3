//! Areas, lengths and perimeters of what really touches, and what touches a plane.

mod common;

use common::{UM, as_released, cuboid, curved, ellipsoid, geometric, geometry, spiked, spiked_ends};
use geometry::{Body, ContactMode, Draft, Support, Surface};
use nalgebra::Vector3;

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * b.abs().max(a.abs()).max(1e-12)
}

/// The face of which the outward normal is farthest along a direction.
fn face_towards(body: &Body, direction: Vector3<f64>) -> u16 {
    let along = |f: &geometry::Face| {
        let Surface::HalfSpace(s) = body.surfaces()[usize::from(f.surface)] else { panic!() };
        s.normal.dot(&direction)
    };
    let faces = body.faces();
    (0..faces.len()).max_by(|&a, &b| along(&faces[a]).total_cmp(&along(&faces[b]))).unwrap() as u16
}

fn normal(body: &Body, face: u16) -> Vector3<f64> {
    body.surfaces()[usize::from(body.faces()[usize::from(face)].surface)].gradient(&Vector3::zeros())
}

#[test]
fn perimeters() {
    let undrafted = Draft::NONE;
    assert!((spiked(undrafted).hull_perimeter() - 1093.4 * UM).abs() < 0.05 * UM);
    assert!((spiked_ends(undrafted).hull_perimeter() - 1197.2 * UM).abs() < 0.05 * UM);
    assert!(near(cuboid(undrafted).hull_perimeter(), 1800.0 * UM));
    let alpha = 25f64.to_radians();
    let expected = (2.0 * alpha * 1250.0 + 2.0 * 150.0 + 2.0 * alpha.sin() * 1100.0) * UM;
    assert!(near(curved(undrafted).hull_perimeter(), expected));
    assert!(near(spiked(geometric(4.0)).hull_perimeter(), spiked(undrafted).hull_perimeter()));
}

#[test]
fn cuboid_faces_are_real() {
    let body = cuboid(Draft::NONE);
    let (l, w, h) = (800.0 * UM, 400.0 * UM, 100.0 * UM);
    for (axis, area) in [(Vector3::x(), l * h), (Vector3::y(), w * h), (Vector3::z(), l * w)] {
        for direction in [axis, -axis] {
            let face = face_towards(&body, direction);
            let patch = body.patch(Support::Face(face), &direction);
            assert_eq!(patch.mode, ContactMode::Surface);
            assert!(near(patch.area, area));
            assert_eq!(patch.line_length, 0.0);
            assert!((patch.centroid - direction * 0.5 * Vector3::new(w, l, h).dot(&axis)).norm() < 1e-12 * l);
            assert_eq!(body.touching(&direction, 1e-9), Support::Face(face));
        }
    }
    let edges: f64 = body.edges().iter().map(|e| e.length).sum();
    assert!(near(edges, 4.0 * (l + w + h)));
}

#[test]
fn spiked_slanted_faces_are_bridged_by_air() {
    let body = spiked(Draft::NONE);
    let w = 200.0 * UM;
    let slanted = face_towards(&body, Vector3::new(0.0, 1.0, 2.0).normalize());
    let direction = normal(&body, slanted);
    assert_eq!(body.touching(&direction, 1e-9), Support::Face(slanted));
    let patch = body.patch(Support::Face(slanted), &direction);
    assert_eq!(patch.area, 0.0);
    assert!(near(patch.line_length, 2.0 * w));
    assert!((patch.centroid - Vector3::new(0.0, 100.0, 100.0) * UM).norm() < 1e-12);

    let end = face_towards(&body, Vector3::y());
    assert!(near(body.faces()[usize::from(end)].area, 75.0 * 200.0 * UM * UM));
    assert_eq!(body.faces()[usize::from(end)].line_length, 0.0);
    for direction in [Vector3::x(), -Vector3::x()] {
        let side = &body.faces()[usize::from(face_towards(&body, direction))];
        assert!(near(side.area, (400.0 * 75.0 + 125.0 * 125.0) * UM * UM));
        assert!((side.area_centroid - direction * 0.5 * w).norm() < 1e-12);
    }
    let mut lengths: Vec<f64> = body.edges().iter().map(|e| e.length / UM).collect();
    lengths.sort_by(f64::total_cmp);
    // Eight edges between tips and corners, four bar ends, six along the width.
    let expected = [[0.0; 8].as_slice(), &[75.0; 4], &[200.0; 6]].concat();
    assert!(lengths.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-9), "{lengths:?}");
}

#[test]
fn spiked_ends_touch_with_the_outer_faces_of_the_spikes() {
    let body = spiked_ends(Draft::NONE);
    let top = face_towards(&body, Vector3::z());
    let patch = body.patch(Support::Face(top), &Vector3::z());
    assert_eq!(patch.area, 0.0);
    assert!(near(patch.line_length, 400.0 * UM));
    assert!((patch.centroid - Vector3::new(0.0, 0.0, 137.5) * UM).norm() < 1e-12);
    let slanted = face_towards(&body, Vector3::new(0.0, 2.0, 1.0).normalize());
    let face = &body.faces()[usize::from(slanted)];
    assert!(near(face.area, 200.0 * 50f64.hypot(100.0) * UM * UM));
    assert_eq!(face.line_length, 0.0);
    let side = &body.faces()[usize::from(face_towards(&body, -Vector3::x()))];
    assert!(near(side.area, (400.0 * 75.0 + 4.0 * 0.5 * 100.0 * 100.0) * UM * UM));
    let real = body.edges().iter().filter(|e| e.length > 0.0).count();
    assert_eq!((body.edges().len(), real), (24, 20));
}

#[test]
fn curved_rests_on_two_lines() {
    for (draft, exact) in [(Draft::NONE, true), (geometric(3.0), false)] {
        let body = curved(draft);
        let chord = face_towards(&body, -Vector3::z());
        let direction = normal(&body, chord);
        assert_eq!(body.touching(&direction, 1e-9), Support::Face(chord));
        let patch = body.patch(Support::Face(chord), &direction);
        assert_eq!(patch.area, 0.0);
        assert!((patch.line_length - 800.0 * UM).abs() < if exact { 1e-15 } else { 5.0 * UM });
        let end = face_towards(&body, Vector3::new(0.0, 1.0, -0.4).normalize());
        assert_eq!(body.touching(&normal(&body, end), 1e-9), Support::Face(end));
        if exact {
            assert!(near(body.faces()[usize::from(end)].area, 150.0 * 400.0 * UM * UM));
        }
        for x in [Vector3::x(), -Vector3::x()] {
            let side = face_towards(&body, x);
            assert_eq!(body.touching(&x, 1e-9), Support::Face(side));
        }
    }
}

#[test]
fn curved_rolls_on_a_ruling() {
    for draft in [Draft::NONE, geometric(3.0)] {
        let body = curved(draft);
        let angle = draft.angle_rad;
        for theta in [-0.2f64, 0.0, 0.3] {
            let (sin, cos) = theta.sin_cos();
            let direction = Vector3::new(angle.sin(), angle.cos() * sin, angle.cos() * cos);
            assert_eq!(body.touching(&direction, 1e-12), Support::Line(4, 5));
            let patch = body.patch(Support::Line(4, 5), &direction);
            assert!(near(patch.line_length, 400.0 * UM / angle.cos()));
            assert_eq!(body.edge_between(4, 5).map(|e| e.surfaces.clone()), Some(vec![0]));
        }
    }
}

#[test]
fn touching_tells_faces_lines_and_points() {
    for body in [cuboid(Draft::NONE), spiked(geometric(2.0)), spiked_ends(as_released(3.0)), cuboid(geometric(5.0))] {
        let tolerance = 1e-9 * body.size();
        for (f, face) in body.faces().iter().enumerate() {
            let direction = normal(&body, f as u16);
            assert_eq!(body.touching(&direction, tolerance), Support::Face(f as u16));
            let [a, b, c] = [0, 1, 2].map(|i| face.generators[i]);
            assert_eq!(body.face_through(a, b, c), Some(f as u16));
            for &(_, line) in &face.neighbours {
                let Support::Line(g, h) = line else { panic!() };
                assert!(g < h && body.face_touches(f as u16, g) && body.face_touches(f as u16, h));
            }
        }
        for edge in body.edges() {
            let (g, h) = edge.generators;
            let direction = edge.surfaces.iter().map(|&s| normal(&body, s)).sum::<Vector3<f64>>().normalize();
            assert_eq!(body.touching(&direction, tolerance), Support::Line(g, h));
            assert_eq!(body.edge_between(h, g), Some(edge));
            let patch = body.patch(Support::Line(g, h), &direction);
            assert_eq!((patch.mode, patch.area, patch.line_length), (ContactMode::Line, 0.0, edge.length));
        }
        for g in 0..body.generators().len() as u16 {
            let direction = body.faces_of(g).iter().map(|&f| normal(&body, f)).sum::<Vector3<f64>>().normalize();
            assert_eq!(body.touching(&direction, tolerance), Support::Point(g));
            assert_eq!(body.patch(Support::Point(g), &direction).mode, ContactMode::Point);
        }
    }
    assert_eq!(ellipsoid().touching(&Vector3::z(), 1e-9), Support::Point(0));
    assert_eq!(ellipsoid().patch(Support::None, &Vector3::z()).mode, ContactMode::Airborne);
}

#[test]
fn draft_tilts_the_faces() {
    let tan = 4f64.to_radians().tan();
    let slope = |body: &Body, direction: Vector3<f64>| {
        let n = normal(body, face_towards(body, direction));
        n.x / n.y.hypot(n.z)
    };
    let slanted = Vector3::new(0.0, 1.0, 2.0).normalize();
    assert!(near(slope(&spiked(geometric(4.0)), slanted), tan));
    let n = 2.0 * 0.2f64.hypot(0.125);
    assert!((n - 0.4717).abs() < 5e-5);
    assert!(near(slope(&spiked(as_released(4.0)), slanted), n * tan));
    assert!(near(slope(&spiked(as_released(4.0)), Vector3::y()), tan));
    let outer = Vector3::new(0.0, 2.0, 1.0).normalize();
    assert!(near(slope(&spiked_ends(as_released(4.0)), outer), 2.0 * 0.05f64.hypot(0.1) * tan));
    assert!(near(slope(&spiked_ends(as_released(4.0)), Vector3::z()), tan));
    assert!(near(slope(&curved(as_released(4.0)), -Vector3::z()), tan));
    assert_eq!(cuboid(as_released(4.0)).generators(), cuboid(geometric(4.0)).generators());
}

#[test]
fn drafted_side_planes_are_smaller() {
    let body = cuboid(geometric(4.0));
    let d = 400.0 * UM * 4f64.to_radians().tan();
    let far = &body.faces()[usize::from(face_towards(&body, Vector3::x()))];
    assert!(near(far.area, (800.0 * UM - 2.0 * d) * (100.0 * UM - 2.0 * d)));
    let body = spiked(geometric(4.0));
    let near_side = &body.faces()[usize::from(face_towards(&body, -Vector3::x()))];
    assert!(near(near_side.area, (400.0 * 75.0 + 125.0 * 125.0) * UM * UM));
    let far = &body.faces()[usize::from(face_towards(&body, Vector3::x()))];
    assert!(far.area < near_side.area && far.area > 0.3 * near_side.area);
}
