//! Random bodies: hulls of every kind of bad manners, and the robots' own shapes.

use super::random::Random;
use geometry::{Body, Draft, DraftModel, GeometryError};
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// The kinds of bodies, by name.
pub const KINDS: [&str; 8] =
    ["round hull", "sliver", "near-flat", "near-degenerate faces", "prism", "twins", "robot", "ellipsoid"];

/// A body of `kind` about as large as `scale` (m); a refusal is as good an answer as a body.
pub fn body(random: &mut Random, kind: usize, most_points: usize, scale: f64) -> Result<Body, GeometryError> {
    match kind {
        6 => robot(random, scale),
        7 => Body::ellipsoid([0; 3].map(|_| scale * random.decades(-1.5, 0.0))),
        _ => Body::hull(&hull(random, kind, most_points, scale)),
    }
}

/// The points of a hull about their mean, which is inside.
fn hull(random: &mut Random, kind: usize, most_points: usize, scale: f64) -> Vec<[f64; 3]> {
    // As many hulls of few points as of many: 4 to `most_points`, evenly in their decades.
    let count = random.decades(4f64.log10(), (most_points as f64 + 1.0).log10()) as usize;
    let mut points: Vec<Vector3<f64>> = match kind {
        3 => rough_box(random, count),
        4 => prism(random, count),
        _ => (0..count).map(|_| random.direction() * random.between(0.9, 1.0)).collect(),
    };
    if kind == 5 {
        // Pairs of points at next to no distance.
        for i in 0..points.len() / 2 {
            points.push(points[2 * i] + random.direction() * random.decades(-14.0, -4.0));
        }
    }
    let stretch = match kind {
        1 => Vector3::new(random.decades(-4.5, -1.0), 1.0, random.decades(-4.5, -1.0)),
        2 => Vector3::new(1.0, 1.0, random.decades(-5.5, -2.0)),
        _ => Vector3::from_fn(|_, _| random.decades(-1.0, 0.0)),
    };
    let points: Vec<Vector3<f64>> = points.iter().map(|p| p.component_mul(&stretch) * scale).collect();
    let mean = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
    points.iter().map(|p| (p - mean).into()).collect()
}

/// A box with more points on its faces and edges, all of them moved a little: faces that are nearly one.
fn rough_box(random: &mut Random, count: usize) -> Vec<Vector3<f64>> {
    let roughness = random.decades(-15.0, -3.0);
    let corner = |i: usize| Vector3::from_fn(|k, _| if i >> k & 1 == 1 { 1.0 } else { -1.0 });
    let mut points: Vec<Vector3<f64>> = (0..8).map(corner).collect();
    for _ in 8..count.max(8) {
        let mut p = random.in_cube();
        let flat = random.whole(0, 2);
        p[flat] = p[flat].signum();
        if random.chance(0.3) {
            let edge = (flat + 1) % 3;
            p[edge] = p[edge].signum();
        }
        points.push(p);
    }
    points.iter().map(|p| p + random.in_cube() * roughness).collect()
}

/// A prism over a polygon, whose many rim points lie in two planes to rounding.
fn prism(random: &mut Random, count: usize) -> Vec<Vector3<f64>> {
    let (corners, roughness) = ((count / 2).max(3), if random.chance(0.5) { 0.0 } else { random.decades(-15.0, -6.0) });
    (0..2 * corners)
        .map(|i| {
            let (sin, cos) = (TAU * (i / 2) as f64 / corners as f64).sin_cos();
            Vector3::new(if i % 2 == 0 { -1.0 } else { 1.0 }, cos, sin) + random.in_cube() * roughness
        })
        .collect()
}

fn robot(random: &mut Random, scale: f64) -> Result<Body, GeometryError> {
    let angle_rad = if random.chance(0.4) { 0.0 } else { random.between(0.0, 0.25) };
    let draft = Draft { angle_rad, model: random.one_of(&[DraftModel::Geometric, DraftModel::AsReleased]) };
    let mut part = |low: f64, high: f64| scale * random.between(low, high);
    match (part(0.0, 4.0) / scale) as usize {
        0 => Body::cuboid(part(0.5, 1.5), part(0.2, 1.0), part(0.1, 1.0), draft),
        1 => Body::spiked(part(1.0, 1.5), part(0.2, 0.8), part(0.1, 0.3), part(0.2, 0.9), part(0.4, 1.5), draft),
        2 => Body::spiked_ends(part(1.0, 1.5), part(0.2, 0.8), part(0.1, 0.3), part(0.1, 0.5), part(0.1, 0.5), draft),
        _ => {
            let outer = part(1.5, 3.0);
            let (inner, width) = (outer - part(0.1, 0.5), part(0.3, 1.0));
            Body::curved(outer, inner, part(0.1, 1.2) / scale, width, draft)
        }
    }
}
