use nalgebra::{Vector2, Vector3};

use crate::body::Parts;
use crate::mass_properties::MassProperties;
use crate::polyhedron::{self, Facet, area_and_centroid};
use crate::profile::HullProfile;
use crate::{Edge, Face, GeometryError, HalfSpace};

/// The real body's side profile at both side planes, counter-clockwise, corner `k` of one belonging to corner `k` of the
/// other.
#[derive(Clone, Debug)]
pub(crate) struct RealProfile {
    pub near: Vec<Vector2<f64>>,
    pub far: Vec<Vector2<f64>>,
}

/// A point of the side profile nearer to the hull's than this part of the size lies on it.
const COINCIDENT: f64 = 1e-9;

/// The body between `x = -W/2` and `x = +W/2` with a tapered convex hull and a real profile inside it. Hull corner `i` is
/// generator `i` at `-W/2` and `N + i` at `+W/2`; profile edge `j` is surface `j`, the side planes are `N` and `N + 1`.
pub(crate) fn prism(width: f64, hull: &HullProfile, real: &RealProfile) -> Result<Parts, GeometryError> {
    let count = hull.near.len();
    let vertices: Vec<Vector3<f64>> = placed(&hull.near, -0.5 * width).chain(placed(&hull.far, 0.5 * width)).collect();
    let facets = facets(width, hull);
    let edges =
        polyhedron::edges_of(&facets).ok_or(GeometryError::HullNotFound { points: vertices.len(), excess: 0.0 })?;

    let real_count = real.near.len();
    let near: Vec<Vector3<f64>> = placed(&real.near, -0.5 * width).collect();
    let far: Vec<Vector3<f64>> = placed(&real.far, 0.5 * width).collect();
    let corners: Vec<Vector3<f64>> = near.iter().chain(&far).copied().collect();
    let polygons: Vec<Vec<u16>> = lateral(real_count)
        .chain([(0..real_count as u16).rev().collect(), (real_count as u16..2 * real_count as u16).collect()])
        .collect();

    let mass_properties = MassProperties::of_polygons(&corners, &polygons);
    let mut parts = polyhedron::assemble(&vertices, &facets, &edges, mass_properties, hull.perimeter());
    parts.outline = polygons.iter().map(|p| p.iter().map(|&i| corners[usize::from(i)]).collect()).collect();

    let size = vertices.iter().map(|v| v.amax()).fold(0.0, f64::max);
    for j in 0..count {
        let lying: Vec<usize> = (0..real_count)
            .filter(|&k| {
                let next = (k + 1) % real_count;
                let on = |i: usize| {
                    let normal = hull.normal(j);
                    normal.dot(&(real.near[i] - hull.near[j])).abs() < COINCIDENT * size
                        && normal.dot(&(real.far[i] - hull.far[j])).abs() < COINCIDENT * size
                };
                on(k) && on(next)
            })
            .collect();
        let ends = |side: &[Vector3<f64>]| -> Vec<(Vector3<f64>, Vector3<f64>)> {
            lying.iter().map(|&k| (side[k], side[(k + 1) % real_count])).collect()
        };
        let (near_ends, far_ends) = (ends(&near), ends(&far));
        let next = (j + 1) % count;
        set_area(&mut parts.faces[j], &near_ends, &far_ends);
        let alone = [j, next].into_iter().filter(|&i| {
            let touches = |p: &Vector3<f64>| (p - vertices[i]).norm() < COINCIDENT * size;
            !near_ends.iter().any(|(p, q)| touches(p) || touches(q))
        });
        set_lines(&mut parts.faces[j], alone.map(|i| (vertices[i], vertices[count + i])));
        for (ends, g, h) in [(near_ends, j, next), (far_ends, count + j, count + next)] {
            let pair = (g.min(h) as u16, g.max(h) as u16);
            if let Some(edge) = parts.edges.iter_mut().find(|e| e.generators == pair) {
                set_length(edge, &ends);
            }
        }
    }
    for (face, side) in parts.faces[count..].iter_mut().zip([&near, &far]) {
        (face.area, face.area_centroid) = area_and_centroid(side);
        face.line_centroid = face.area_centroid;
    }
    Ok(parts)
}

fn placed(profile: &[Vector2<f64>], x: f64) -> impl Iterator<Item = Vector3<f64>> {
    profile.iter().map(move |p| Vector3::new(x, p.x, p.y))
}

/// The outward quadrilaterals between two profiles of `count` corners.
fn lateral(count: usize) -> impl Iterator<Item = Vec<u16>> {
    (0..count).map(move |j| {
        let next = (j + 1) % count;
        [j, next, count + next, count + j].map(|i| i as u16).to_vec()
    })
}

/// A profile edge `n · p ≤ c - (x + W/2) t` is the half-space of the normal `(t, n)/√(1 + t²)`.
fn facets(width: f64, hull: &HullProfile) -> Vec<Facet> {
    let count = hull.near.len() as u16;
    let mut facets: Vec<Facet> = lateral(hull.near.len())
        .enumerate()
        .map(|(j, polygon)| {
            let (slope, normal) = (hull.slopes[j], hull.normal(j));
            let length = (1.0 + slope * slope).sqrt();
            let half_space = HalfSpace {
                normal: Vector3::new(slope, normal.x, normal.y) / length,
                offset: (normal.dot(&hull.near[j]) - 0.5 * width * slope) / length,
            };
            Facet { half_space, polygon }
        })
        .collect();
    let side = |normal: Vector3<f64>| HalfSpace { normal, offset: 0.5 * width };
    facets.push(Facet { half_space: side(-Vector3::x()), polygon: (0..count).rev().collect() });
    facets.push(Facet { half_space: side(Vector3::x()), polygon: (count..2 * count).collect() });
    facets
}

type Segment = (Vector3<f64>, Vector3<f64>);

fn set_area(face: &mut Face, near: &[Segment], far: &[Segment]) {
    let parts: Vec<(f64, Vector3<f64>)> =
        near.iter().zip(far).map(|(n, f)| area_and_centroid(&[n.0, n.1, f.1, f.0])).collect();
    face.area = parts.iter().map(|p| p.0).sum();
    if face.area > 0.0 {
        face.area_centroid = parts.iter().map(|p| p.0 * p.1).sum::<Vector3<f64>>() / face.area;
        face.line_centroid = face.area_centroid;
    }
}

fn set_lines(face: &mut Face, lines: impl Iterator<Item = Segment>) {
    let lines: Vec<(f64, Vector3<f64>)> = lines.map(|(p, q)| ((q - p).norm(), 0.5 * (p + q))).collect();
    face.line_length = lines.iter().map(|l| l.0).sum();
    if face.line_length > 0.0 {
        face.line_centroid = lines.iter().map(|l| l.0 * l.1).sum::<Vector3<f64>>() / face.line_length;
    }
}

fn set_length(edge: &mut Edge, segments: &[Segment]) {
    edge.length = segments.iter().map(|(p, q)| (q - p).norm()).sum();
    if edge.length > 0.0 {
        let moment: Vector3<f64> = segments.iter().map(|(p, q)| (q - p).norm() * 0.5 * (p + q)).sum();
        edge.midpoint = moment / edge.length;
    }
}
