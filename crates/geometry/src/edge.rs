use nalgebra::Vector3;

/// A straight line of the hull between two generators.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    /// The two generators, the smaller index first.
    pub generators: (u16, u16),
    /// The two half-spaces that meet in the edge, or the cone that it is a ruling of.
    pub surfaces: Vec<u16>,
    /// Length of the real body in the edge, in m. Between two curved generators the points move with the direction, and
    /// with them the length and the middle: see [`Body::patch`](crate::Body::patch).
    pub length: f64,
    /// Middle of the edge.
    pub midpoint: Vector3<f64>,
}
