/// What of a body touches a plane, by the indices of its generators and faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Support {
    /// Nothing touches.
    None,
    /// One generator.
    Point(u16),
    /// The segment between two generators, the smaller index first.
    Line(u16, u16),
    /// A flat face, by its index in [`Body::faces`](crate::Body::faces).
    Face(u16),
}

impl Support {
    /// The line between two generators in either order.
    pub fn line(g: u16, h: u16) -> Self {
        Support::Line(g.min(h), g.max(h))
    }
}
