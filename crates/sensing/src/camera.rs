//! A camera that looks down on the substrate.

use nalgebra::{UnitQuaternion, Vector3};

/// A camera that is turned about `+z` and scaled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// How the scene is turned.
    pub(crate) turn: UnitQuaternion<f64>,
    /// By what share lengths are greater.
    pub(crate) scale: f64,
}

impl Camera {
    /// How many numbers say what a camera is.
    pub const COUNT: usize = 2;

    /// A camera that is turned by `heading` from `+y` towards `-x`, rad, and shows lengths greater by the share `scale`.
    pub fn new(heading: f64, scale: f64) -> Self {
        Self { turn: UnitQuaternion::from_axis_angle(&Vector3::z_axis(), heading), scale }
    }
}
