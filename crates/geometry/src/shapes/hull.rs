use nalgebra::Vector3;

use super::hull_facets::hull_facets;
use crate::mass_properties::MassProperties;
use crate::polyhedron::{self, Facet};
use crate::{Body, GeometryError};

/// The table of edges grows with the square of the number of vertices.
const MOST_VERTICES: usize = 2048;
/// The origin has to be inside every face by this part of the hull's extent.
const INSIDE: f64 = 1e-9;

impl Body {
    /// The convex hull of points in the body frame. The points are taken as they are: the origin is the centre of mass by
    /// the format's contract, while the inertia is that of the uniform hull about its own centroid.
    pub fn hull(points: &[[f64; 3]]) -> Result<Self, GeometryError> {
        for &value in points.iter().flatten() {
            if !value.is_finite() {
                return Err(GeometryError::NotFinite { name: "vertex coordinate", value });
            }
        }
        let points: Vec<Vector3<f64>> = points.iter().map(|&p| Vector3::from(p)).collect();
        let (vertices, facets) = hull_facets(&points)?;
        if vertices.len() > MOST_VERTICES {
            return Err(GeometryError::TooMany { what: "vertices", count: vertices.len(), limit: MOST_VERTICES });
        }
        let size = vertices.iter().map(|v| v.norm()).fold(0.0, f64::max);
        let depth = facets.iter().map(|f| f.half_space.offset).fold(f64::INFINITY, f64::min);
        if depth < INSIDE * size {
            return Err(GeometryError::OriginOutside { distance: (-depth).max(0.0) });
        }
        let edges =
            polyhedron::edges_of(&facets).ok_or(GeometryError::HullNotFound { points: points.len(), excess: 0.0 })?;
        let polygons: Vec<Vec<u16>> = facets.iter().map(|f| f.polygon.clone()).collect();
        let mass_properties = MassProperties::of_polygons(&vertices, &polygons);
        let perimeter = shadow_perimeter(&vertices, &facets, &edges);
        Ok(polyhedron::assemble(&vertices, &facets, &edges, mass_properties, perimeter).in_place())
    }
}

/// Length of the projection onto the `y`–`z` plane of the edges between faces that look along `+x` and faces that do not.
fn shadow_perimeter(vertices: &[Vector3<f64>], facets: &[Facet], edges: &[(u16, u16, u16, u16)]) -> f64 {
    let ahead = |f: u16| facets[usize::from(f)].half_space.normal.x > 0.0;
    edges
        .iter()
        .filter(|&&(_, _, a, b)| ahead(a) != ahead(b))
        .map(|&(g, h, _, _)| {
            let along = vertices[usize::from(h)] - vertices[usize::from(g)];
            along.y.hypot(along.z)
        })
        .sum()
}
