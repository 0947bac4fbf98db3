use nalgebra::Vector3;

use crate::Support;

/// A flat face of the hull.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// Index of the half-space.
    pub surface: u16,
    /// Three well-spread points of the face that are not in a line.
    pub anchors: [Vector3<f64>; 3],
    /// All generators that touch the face's plane.
    pub generators: Vec<u16>,
    /// Across each boundary: the surface whose `f_i > 0` tells that a point of the plane lies beyond that boundary, and
    /// the boundary as a support: a line where it is straight, a point where it is curved.
    pub neighbours: Vec<(u16, Support)>,
    /// Area of the real body in the face, in m².
    pub area: f64,
    /// Centroid of that area (of the hull's face where the area is zero).
    pub area_centroid: Vector3<f64>,
    /// Length of the real edges in the face that do not border its real area, in m.
    pub line_length: f64,
    /// Centroid of those edges (of the hull's face where there are none).
    pub line_centroid: Vector3<f64>,
}
