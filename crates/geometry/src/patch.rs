use nalgebra::Vector3;

/// How a body touches a plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum ContactMode {
    /// It does not.
    Airborne = 0,
    /// At one point.
    Point = 1,
    /// Along a line.
    Line = 2,
    /// With a flat face of its hull.
    Surface = 3,
}

/// What of the real body touches: `A` and `ℓ` of the adhesion `p_a = h C (A + w ℓ)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// How the hull touches.
    pub mode: ContactMode,
    /// Area `A` that really touches, in m².
    pub area: f64,
    /// Length `ℓ` of the real edges that touch outside any touching area, in m.
    pub line_length: f64,
    /// Centroid of the area, or of the lines where no area touches, in the body frame.
    pub centroid: Vector3<f64>,
}
