//! Mass properties against closed forms and independent quadrature.

mod common;

use common::{UM, geometric, geometry};
use geometry::{Body, Draft};
use nalgebra::{Matrix3, Vector2, Vector3};

fn near(a: f64, b: f64, relative: f64) -> bool {
    (a - b).abs() <= relative * b.abs().max(a.abs())
}

fn same_inertia(body: &Body, expected: Matrix3<f64>, relative: f64) {
    let error = (body.unit_inertia() - expected).norm() / expected.norm();
    assert!(error < relative, "{error:e}: {} against {expected}", body.unit_inertia());
}

#[test]
fn cuboid() {
    let (l, w, h) = (800.0 * UM, 400.0 * UM, 100.0 * UM);
    let body = Body::cuboid(l, w, h, Draft::NONE).unwrap();
    assert!(near(body.volume(), l * w * h, 1e-14));
    let expected = Vector3::new(l * l + h * h, w * w + h * h, l * l + w * w) / 12.0;
    same_inertia(&body, Matrix3::from_diagonal(&expected), 1e-14);
    assert!(near(body.size(), 0.5 * (l * l + w * w + h * h).sqrt(), 1e-14));
}

#[test]
fn ellipsoid() {
    let (a, b, c) = (300.0 * UM, 500.0 * UM, 100.0 * UM);
    let body = Body::ellipsoid([a, b, c]).unwrap();
    assert!(near(body.volume(), 4.0 / 3.0 * std::f64::consts::PI * a * b * c, 1e-14));
    same_inertia(
        &body,
        Matrix3::from_diagonal(&(Vector3::new(b * b + c * c, a * a + c * c, a * a + b * b) / 5.0)),
        1e-14,
    );
    assert_eq!(body.size(), b);
    let circle = Body::ellipsoid([a, b, b]).unwrap();
    assert!(near(circle.hull_perimeter(), 2.0 * std::f64::consts::PI * b, 1e-14));
    let steps = 4000;
    let at = |k: i32| {
        let (sin, cos) = (2.0 * std::f64::consts::PI * f64::from(k) / f64::from(steps)).sin_cos();
        Vector2::new(b * cos, c * sin)
    };
    let sampled: f64 = (0..steps).map(|k| (at(k + 1) - at(k)).norm()).sum();
    assert!(near(body.hull_perimeter(), sampled, 1e-5));
}

#[test]
fn annular_sector() {
    let (ro, ri, alpha, w) = (1250.0 * UM, 1100.0 * UM, 25f64.to_radians(), 400.0 * UM);
    let body = Body::curved(ro, ri, alpha, w, Draft::NONE).unwrap();
    let area = alpha * (ro * ro - ri * ri);
    let centre = 2.0 * alpha.sin() * (ro.powi(3) - ri.powi(3)) / (3.0 * area);
    let quarter = (ro.powi(4) - ri.powi(4)) / 4.0 / area;
    let (s, c) = alpha.sin_cos();
    let yy = quarter * (alpha - s * c);
    let zz = quarter * (alpha + s * c) - centre * centre;
    let xx = w * w / 12.0;
    assert!(near(body.volume(), area * w, 1e-12));
    same_inertia(&body, Matrix3::from_diagonal(&Vector3::new(yy + zz, xx + zz, xx + yy)), 1e-12);
    let geometry::Generator::Arc(arc) = body.generators()[4] else { panic!() };
    assert!(near(arc.centre.z, -centre, 1e-12));
    assert!(arc.centre.y.abs() < 1e-12 * centre && near(arc.centre.x, -0.5 * w, 1e-12));
    let side = body.faces().last().unwrap();
    assert!(near(side.area, area, 1e-12));
    assert!(side.area_centroid.z.abs() < 1e-12 * ro);
}

/// Area, centre and second moments (y², z²) of rectangles and triangles.
fn summed(pieces: &[(f64, Vector2<f64>, Vector2<f64>)], w: f64) -> (f64, Matrix3<f64>) {
    let area: f64 = pieces.iter().map(|p| p.0).sum();
    let second: Vector2<f64> =
        pieces.iter().map(|(a, c, own)| *a * (c.component_mul(c) + own)).sum::<Vector2<f64>>() / area;
    let xx = w * w / 12.0;
    let inertia = Vector3::new(second.x + second.y, xx + second.y, xx + second.x);
    (area * w, Matrix3::from_diagonal(&inertia))
}

fn rectangle(l: f64, h: f64) -> (f64, Vector2<f64>, Vector2<f64>) {
    (l * h, Vector2::zeros(), Vector2::new(l * l, h * h) / 12.0)
}

fn triangle(base: f64, height: f64, y: f64, z: f64) -> (f64, Vector2<f64>, Vector2<f64>) {
    let middle = Vector2::new(y, z + z.signum() * height / 3.0);
    (0.5 * base * height, middle, Vector2::new(base * base / 24.0, height * height / 18.0))
}

#[test]
fn spiked_is_a_bar_and_two_triangles() {
    let (l, w, h, b, o) = (400.0 * UM, 200.0 * UM, 75.0 * UM, 125.0 * UM, 325.0 * UM);
    let body = Body::spiked(l, w, h, b, o, Draft::NONE).unwrap();
    let spike = 0.5 * (o - h);
    let pieces = [rectangle(l, h), triangle(b, spike, 0.0, 0.5 * h), triangle(b, spike, 0.0, -0.5 * h)];
    let (volume, inertia) = summed(&pieces, w);
    assert!(near(body.volume(), volume, 1e-14));
    same_inertia(&body, inertia, 1e-13);
}

#[test]
fn spiked_ends_is_a_bar_and_four_triangles() {
    let (l, w, h, b, s) = (400.0 * UM, 200.0 * UM, 75.0 * UM, 100.0 * UM, 100.0 * UM);
    let body = Body::spiked_ends(l, w, h, b, s, Draft::NONE).unwrap();
    let mut pieces = vec![rectangle(l, h)];
    for y in [-1.0, 1.0] {
        for z in [-1.0, 1.0] {
            pieces.push(triangle(b, s, y * 0.5 * (l - b), z * 0.5 * h));
        }
    }
    let (volume, inertia) = summed(&pieces, w);
    assert!(near(body.volume(), volume, 1e-14));
    same_inertia(&body, inertia, 1e-13);
}

/// Midpoint quadrature in `x` of sections given by area and central `y²`, `z²` about their own centre `(0, z)`.
fn stacked(w: f64, steps: i32, section: impl Fn(f64) -> (f64, f64, f64, f64)) -> (f64, Vector3<f64>, Matrix3<f64>) {
    let (mut volume, mut first, mut second) = (0.0, Vector3::zeros(), Matrix3::zeros());
    for k in 0..steps {
        let x = w * ((f64::from(k) + 0.5) / f64::from(steps) - 0.5);
        let (area, z, yy, zz) = section(x + 0.5 * w);
        let dv = area * w / f64::from(steps);
        volume += dv;
        first += dv * Vector3::new(x, 0.0, z);
        second += dv * Matrix3::new(x * x, 0.0, x * z, 0.0, yy, 0.0, x * z, 0.0, zz + z * z);
    }
    let centre = first / volume;
    let spread = second / volume - centre * centre.transpose();
    (volume, centre, Matrix3::identity() * spread.trace() - spread)
}

#[test]
fn drafted_cuboid_against_quadrature() {
    let (l, w, h) = (800.0 * UM, 400.0 * UM, 100.0 * UM);
    let t = 4f64.to_radians().tan();
    let body = Body::cuboid(l, w, h, geometric(4.0)).unwrap();
    let (volume, centre, inertia) = stacked(w, 200_000, |x| {
        let (l, h) = (l - 2.0 * x * t, h - 2.0 * x * t);
        (l * h, 0.0, l * l / 12.0, h * h / 12.0)
    });
    assert!(near(body.volume(), volume, 1e-9));
    same_inertia(&body, inertia, 1e-9);
    let nearest = body.faces()[4].anchors[0].x;
    assert!(near(nearest, -0.5 * w - centre.x, 1e-9));
}

#[test]
fn drafted_spiked_against_quadrature() {
    let (l, w, h, b, o) = (400.0 * UM, 200.0 * UM, 75.0 * UM, 125.0 * UM, 325.0 * UM);
    let t = 4f64.to_radians().tan();
    let body = Body::spiked(l, w, h, b, o, geometric(4.0)).unwrap();
    let (rise, run) = (0.5 * (o - h), 0.5 * l);
    let slanted = rise.hypot(run);
    let (volume, _, inertia) = stacked(w, 200_000, |x| {
        let d = x * t;
        // The slanted line run z + rise y = run o/2 moves inwards by d.
        let tip = 0.5 * o - d * slanted / run;
        let y = 0.5 * l - d;
        let z = tip - rise / run * y;
        let spike = tip - z;
        let base = b * spike / rise;
        let (bar, point) = (4.0 * y * z, 0.5 * base * spike);
        let area = bar + 2.0 * point;
        let yy = bar * y * y / 3.0 + 2.0 * point * base * base / 24.0;
        let zz = bar * z * z / 3.0 + 2.0 * point * (spike * spike / 18.0 + (z + spike / 3.0).powi(2));
        (area, 0.0, yy / area, zz / area)
    });
    assert!(near(body.volume(), volume, 1e-9));
    same_inertia(&body, inertia, 1e-9);
}

#[test]
fn drafted_curved_against_quadrature() {
    let (ro, ri, alpha, w) = (1250.0 * UM, 1100.0 * UM, 25f64.to_radians(), 400.0 * UM);
    let t = 3f64.to_radians().tan();
    let body = Body::curved(ro, ri, alpha, w, geometric(3.0)).unwrap();
    let (volume, centre, inertia) = stacked(w, 2000, |x| {
        let d = x * t;
        // The chord's corner is at the distance d from the undrafted end line and from the undrafted chord.
        let corner = Vector2::new(d, ri + d * (1.0 - alpha.sin()) / alpha.cos());
        let (inner, outer) = (corner.norm(), ro - d);
        let steps = 500;
        let (mut area, mut z, mut yy, mut zz) = (0.0, 0.0, 0.0, 0.0);
        for k in 0..steps {
            let r = inner + (outer - inner) * (f64::from(k) + 0.5) / f64::from(steps);
            let beta = alpha - (d / r).asin();
            let dr = (outer - inner) / f64::from(steps);
            area += 2.0 * beta * r * dr;
            z += 2.0 * beta.sin() * r * r * dr;
            yy += (beta - beta.sin() * beta.cos()) * r.powi(3) * dr;
            zz += (beta + beta.sin() * beta.cos()) * r.powi(3) * dr;
        }
        (area, z / area, yy / area, zz / area - (z / area).powi(2))
    });
    assert!(near(body.volume(), volume, 1e-6));
    same_inertia(&body, inertia, 1e-6);
    let geometry::Generator::Arc(arc) = body.generators()[4] else { panic!() };
    assert!(near(arc.centre.z, -centre.z, 1e-6));
    assert!(near(arc.centre.x, -0.5 * w - centre.x, 1e-6));
}

#[test]
fn closed_outlines_hold_the_volume_about_the_origin() {
    for (name, body) in common::bodies() {
        let volume: f64 =
            body.outline().iter().flat_map(|p| p[1..].windows(2).map(|w| p[0].dot(&w[0].cross(&w[1])) / 6.0)).sum();
        let tolerance = if name.starts_with("ellipsoid") { 0.1 } else { 1e-3 };
        assert!(near(volume, body.volume(), tolerance), "{name} {volume} {}", body.volume());
    }
}

#[test]
fn hull_inertia_is_about_its_own_centroid() {
    let corners = |shift: f64| {
        let mut corners = Vec::new();
        for x in [-1.0, 1.0] {
            for y in [-2.0, 2.0] {
                for z in [-3.0, 3.0] {
                    corners.push([(x + shift) * UM, y * UM, z * UM]);
                }
            }
        }
        Body::hull(&corners).unwrap()
    };
    let (centred, shifted) = (corners(0.0), corners(0.4));
    let expected = Vector3::new(16.0 + 36.0, 4.0 + 36.0, 4.0 + 16.0) * UM * UM / 12.0;
    same_inertia(&centred, Matrix3::from_diagonal(&expected), 1e-13);
    same_inertia(&shifted, Matrix3::from_diagonal(&expected), 1e-13);
    assert!(near(centred.volume(), 48.0 * UM.powi(3), 1e-13));
    assert!(near(centred.hull_perimeter(), 20.0 * UM, 1e-13));
    assert!(shifted.size() > centred.size());
}
