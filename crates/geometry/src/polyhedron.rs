use std::collections::HashMap;

use nalgebra::Vector3;

use crate::body::Parts;
use crate::mass_properties::MassProperties;
use crate::normal_cone::NormalCone;
use crate::{Edge, Face, Generator, HalfSpace, Support, Surface};

/// A flat face: its half-space, and its corners in outward order.
#[derive(Clone, Debug)]
pub(crate) struct Facet {
    pub half_space: HalfSpace,
    pub polygon: Vec<u16>,
}

/// Area and centroid of a flat polygon, which need not be convex: with the triangles `a_k` of a fan from its first corner,
/// `A n = Σ a_k`, and the centroid is the mean of the triangles' centroids weighted by `a_k · n`.
pub(crate) fn area_and_centroid(corners: &[Vector3<f64>]) -> (f64, Vector3<f64>) {
    let fan = || {
        corners[1..].windows(2).map(|w| {
            let (a, b) = (w[0] - corners[0], w[1] - corners[0]);
            (0.5 * a.cross(&b), (a + b) / 3.0)
        })
    };
    let total: Vector3<f64> = fan().map(|(area, _)| area).sum();
    let area = total.norm();
    if area == 0.0 {
        return (0.0, corners.iter().sum::<Vector3<f64>>() / corners.len() as f64);
    }
    let normal = total / area;
    let moment: Vector3<f64> = fan().map(|(part, middle)| middle * part.dot(&normal)).sum();
    (area, corners[0] + moment / area)
}

/// Three of the points that are far apart: the point farthest from the first, the one farthest from that, and the one
/// farthest from the line through both.
pub(crate) fn anchors(points: &[Vector3<f64>]) -> [Vector3<f64>; 3] {
    let farthest = |measure: &dyn Fn(&Vector3<f64>) -> f64| {
        points.iter().copied().max_by(|p, q| measure(p).total_cmp(&measure(q))).unwrap_or_else(Vector3::zeros)
    };
    let a = farthest(&|p| (p - points[0]).norm_squared());
    let b = farthest(&|p| (p - a).norm_squared());
    let c = farthest(&|p| (p - a).cross(&(b - a)).norm_squared());
    [a, b, c]
}

/// The edges of closed facets as `(g, h, facet, facet)` with `g < h`, or `None` where an edge does not border exactly two
/// facets.
pub(crate) fn edges_of(facets: &[Facet]) -> Option<Vec<(u16, u16, u16, u16)>> {
    let mut left_of = HashMap::new();
    for (f, facet) in facets.iter().enumerate() {
        for (k, &g) in facet.polygon.iter().enumerate() {
            let h = facet.polygon[(k + 1) % facet.polygon.len()];
            if left_of.insert((g, h), f as u16).is_some() {
                return None;
            }
        }
    }
    let mut edges = Vec::new();
    for (&(g, h), &f) in &left_of {
        let &other = left_of.get(&(h, g))?;
        if g < h {
            edges.push((g, h, f, other));
        }
    }
    edges.sort_unstable();
    Some(edges)
}

/// A body whose hull is a polyhedron, all of it real. Facet, face and surface indices agree, so do corners and
/// generators.
pub(crate) fn assemble(
    vertices: &[Vector3<f64>],
    facets: &[Facet],
    edges: &[(u16, u16, u16, u16)],
    mass_properties: MassProperties,
    hull_perimeter: f64,
) -> Parts {
    let at = |i: u16| vertices[usize::from(i)];
    let surfaces: Vec<Surface> = facets.iter().map(|f| Surface::HalfSpace(f.half_space)).collect();
    let mut faces: Vec<Face> = facets
        .iter()
        .enumerate()
        .map(|(f, facet)| {
            let corners: Vec<Vector3<f64>> = facet.polygon.iter().map(|&i| at(i)).collect();
            let (area, centroid) = area_and_centroid(&corners);
            Face {
                surface: f as u16,
                anchors: anchors(&corners),
                generators: facet.polygon.clone(),
                neighbours: Vec::new(),
                area,
                area_centroid: centroid,
                line_length: 0.0,
                line_centroid: centroid,
            }
        })
        .collect();
    let mut incident = vec![Vec::new(); vertices.len()];
    for (f, facet) in facets.iter().enumerate() {
        for &g in &facet.polygon {
            incident[usize::from(g)].push(f as u16);
        }
    }
    for &(g, h, a, b) in edges {
        faces[usize::from(a)].neighbours.push((b, Support::Line(g, h)));
        faces[usize::from(b)].neighbours.push((a, Support::Line(g, h)));
    }
    Parts {
        point_cones: incident.iter().map(|i| NormalCone::of_vertex(i, &surfaces)).collect(),
        edge_cones: edges.iter().map(|&(_, _, a, b)| NormalCone::of_edge([a, b], &surfaces)).collect(),
        edges: edges
            .iter()
            .map(|&(g, h, a, b)| Edge {
                generators: (g, h),
                surfaces: vec![a, b],
                length: (at(h) - at(g)).norm(),
                midpoint: 0.5 * (at(g) + at(h)),
            })
            .collect(),
        generators: vertices.iter().map(|&v| Generator::Vertex(v)).collect(),
        outline: facets.iter().map(|f| f.polygon.iter().map(|&i| at(i)).collect()).collect(),
        surfaces,
        faces,
        mass_properties,
        hull_perimeter,
    }
}
