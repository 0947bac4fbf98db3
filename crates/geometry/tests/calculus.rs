//! Derivatives of surfaces and supports against finite differences, supports against sampling.

mod common;

use common::{bodies, directions, geometric, geometry};
use geometry::{Cone, EllipsoidSurface, Generator, HalfSpace, Surface};
use nalgebra::{Matrix3, Vector3};

fn surfaces() -> [Surface; 3] {
    [
        Surface::HalfSpace(HalfSpace { normal: Vector3::new(0.6, 0.0, 0.8), offset: 0.3 }),
        Surface::Cone(Cone { x0: -0.2, y0: 0.1, z0: -0.3, radius: 1.2, draft: 0.2 }),
        Surface::Ellipsoid(EllipsoidSurface {
            semi_axes: Vector3::new(0.7, 1.0, 0.4),
            centre: Vector3::new(0.1, -0.2, 0.05),
        }),
    ]
}

#[test]
fn gradients_and_hessians_are_derivatives() {
    let h = 1e-5;
    for surface in surfaces() {
        for direction in directions(40) {
            let point = 0.9 * direction + Vector3::new(0.01, 0.02, 0.4);
            for k in 0..3 {
                let step = Vector3::ith(k, h);
                let slope = (surface.value(&(point + step)) - surface.value(&(point - step))) / (2.0 * h);
                assert!((slope - surface.gradient(&point)[k]).abs() < 1e-8);
                let column = (surface.gradient(&(point + step)) - surface.gradient(&(point - step))) / (2.0 * h);
                assert!((column - surface.hessian(&point).column(k)).norm() < 1e-7);
            }
        }
    }
}

#[test]
fn half_spaces_and_cones_have_unit_gradients() {
    for (name, body) in bodies() {
        for surface in body.surfaces() {
            if !matches!(surface, Surface::Ellipsoid(_)) {
                let gradient = surface.gradient(&Vector3::new(1e-5, 2e-5, 3e-5));
                assert!((gradient.norm() - 1.0).abs() < 1e-14, "{name}");
            }
        }
    }
}

#[test]
fn the_cone_is_the_table_s_formula() {
    let cone = Cone { x0: -0.2, y0: 0.1, z0: -0.3, radius: 1.2, draft: 0.2 };
    let p: Vector3<f64> = Vector3::new(0.3, 0.8, 0.5);
    let expected = 0.2f64.cos() * ((p.y - 0.1).hypot(p.z + 0.3) - 1.2 + (p.x + 0.2) * 0.2f64.tan());
    assert!((Surface::Cone(cone).value(&p) - expected).abs() < 1e-15);
}

/// Samples of a generator.
fn samples(generator: &Generator) -> Vec<Vector3<f64>> {
    let steps = 2000;
    let unit = (0..=steps).map(|k| f64::from(k) / f64::from(steps));
    match generator {
        Generator::Vertex(p) => vec![*p],
        Generator::Arc(arc) => unit.map(|t| arc.point((2.0 * t - 1.0) * arc.half_angle)).collect(),
        Generator::Corner(corner) => unit.map(|t| corner.point(t * corner.width)).collect(),
        Generator::Ellipsoid(e) => directions(20000).iter().map(|d| e.semi_axes.component_mul(d)).collect(),
    }
}

#[test]
fn supports_are_the_farthest_samples() {
    for (name, body) in bodies() {
        let size = body.size();
        for generator in body.generators() {
            let samples = samples(generator);
            for direction in directions(60) {
                let reached = generator.support(&direction).dot(&direction);
                let sampled = samples.iter().map(|p| p.dot(&direction)).fold(f64::NEG_INFINITY, f64::max);
                assert!(reached > sampled - 1e-12 * size, "{name} {direction}");
                assert!(reached < sampled + 1e-3 * size, "{name} {direction}");
            }
        }
    }
}

#[test]
fn support_derivatives_are_derivatives() {
    for (name, body) in bodies() {
        for generator in body.generators() {
            for direction in directions(200) {
                let h = 1e-6;
                let at = |step: Vector3<f64>| generator.support(&(direction + step));
                let column = |k: usize, h: f64| (at(Vector3::ith(k, h)) - at(Vector3::ith(k, -h))) / (2.0 * h);
                let numeric = Matrix3::from_columns(&[0, 1, 2].map(|k| column(k, h)));
                let coarser = Matrix3::from_columns(&[0, 1, 2].map(|k| column(k, 2.0 * h)));
                // At the ends of a curve, and where the direction is normal to its plane, there is no derivative.
                let scale = body.size() + numeric.norm();
                if (numeric - coarser).norm() > 1e-6 * scale {
                    continue;
                }
                let error = (numeric - generator.support_derivative(&direction)).norm();
                assert!(error < 1e-5 * scale, "{name} {generator:?} {direction} {error}");
            }
        }
    }
}

#[test]
fn a_direction_normal_to_an_arc_s_plane_has_no_derivative() {
    for body in [common::curved(geometric(0.0)), common::curved(geometric(3.0))] {
        for generator in body.generators() {
            for x in [-1.0, 1.0] {
                let direction = Vector3::new(x, 0.0, 0.0);
                assert!(generator.support(&direction).iter().all(|v| v.is_finite()));
                assert_eq!(generator.support_derivative(&direction), Matrix3::zeros());
            }
        }
    }
}

#[test]
fn a_drafted_corner_has_a_derivative_inside() {
    let body = common::curved(geometric(5.0));
    let inside = directions(20000)
        .iter()
        .flat_map(|d| body.generators().iter().map(move |g| (g, d)))
        .filter(|(g, d)| matches!(g, Generator::Corner(_)) && g.support_derivative(d) != Matrix3::zeros())
        .count();
    assert!(inside > 0);
}
