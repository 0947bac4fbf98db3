//! A camera that looks down on the substrate.

/// A camera that is turned about `+z` and scaled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// By what share lengths are greater.
    pub(crate) scale: f64,
    /// Sine and cosine of the heading, and of its half.
    pub(crate) turned: (f64, f64),
    pub(crate) half: (f64, f64),
}

impl Camera {
    /// How many numbers say what a camera is.
    pub const COUNT: usize = 2;

    /// A camera that is turned by `heading` from `+y` towards `-x`, rad, and shows lengths greater by the share `scale`.
    pub fn new(heading: f64, scale: f64) -> Self {
        Self { scale, turned: heading.sin_cos(), half: (0.5 * heading).sin_cos() }
    }
}
