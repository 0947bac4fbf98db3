#![allow(dead_code)]

use geometry::{Body, Draft, DraftModel};
use nalgebra::Vector3;

pub use tumblers_geometry as geometry;

pub const UM: f64 = 1e-6;

pub fn geometric(degrees: f64) -> Draft {
    Draft { angle_rad: degrees.to_radians(), model: DraftModel::Geometric }
}

pub fn as_released(degrees: f64) -> Draft {
    Draft { angle_rad: degrees.to_radians(), model: DraftModel::AsReleased }
}

pub fn cuboid(draft: Draft) -> Body {
    Body::cuboid(800.0 * UM, 400.0 * UM, 100.0 * UM, draft).unwrap()
}

pub fn spiked(draft: Draft) -> Body {
    Body::spiked(400.0 * UM, 200.0 * UM, 75.0 * UM, 125.0 * UM, 325.0 * UM, draft).unwrap()
}

pub fn spiked_ends(draft: Draft) -> Body {
    Body::spiked_ends(400.0 * UM, 200.0 * UM, 75.0 * UM, 100.0 * UM, 100.0 * UM, draft).unwrap()
}

pub fn curved(draft: Draft) -> Body {
    Body::curved(1250.0 * UM, 1100.0 * UM, 25f64.to_radians(), 400.0 * UM, draft).unwrap()
}

pub fn ellipsoid() -> Body {
    Body::ellipsoid([300.0 * UM, 500.0 * UM, 100.0 * UM]).unwrap()
}

/// Every shape, without and with draft.
pub fn bodies() -> Vec<(String, Body)> {
    let mut bodies = vec![("ellipsoid".to_owned(), ellipsoid())];
    for degrees in [0.0, 1e-5, 2.0, 5.0] {
        let draft = geometric(degrees);
        bodies.push((format!("cuboid {degrees}"), cuboid(draft)));
        bodies.push((format!("spiked {degrees}"), spiked(draft)));
        bodies.push((format!("spiked ends {degrees}"), spiked_ends(draft)));
        bodies.push((format!("curved {degrees}"), curved(draft)));
        bodies.push((format!("spiked as released {degrees}"), spiked(as_released(degrees))));
        bodies.push((format!("spiked ends as released {degrees}"), spiked_ends(as_released(degrees))));
    }
    bodies
}

/// Directions over the sphere, and the special ones along the axes and in the coordinate planes.
pub fn directions(count: usize) -> Vec<Vector3<f64>> {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let mut directions: Vec<Vector3<f64>> = (0..count)
        .map(|k| {
            let z = 1.0 - 2.0 * (k as f64 + 0.5) / count as f64;
            let radius = (1.0 - z * z).sqrt();
            let (sin, cos) = (golden * k as f64).sin_cos();
            Vector3::new(radius * cos, radius * sin, z)
        })
        .collect();
    for x in [-1.0, 0.0, 1.0] {
        for y in [-1.0, 0.0, 1.0] {
            for z in [-1.0, 0.0, 1.0] {
                directions.extend(Vector3::new(x, y, z).try_normalize(0.0));
            }
        }
    }
    directions
}

pub fn reproduced(body: &Body, point: &Vector3<f64>, l: &[f64]) -> Vector3<f64> {
    body.surfaces().iter().zip(l).map(|(s, l)| *l * s.gradient(point)).sum()
}
