//! The state of the robot.

use crate::Vec3;
use nalgebra::Quaternion;

/// Pose and generalized velocity of the body, in the substrate frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// Centre of mass `q`, m.
    pub position: Vec3,
    /// Unit quaternion, body to substrate.
    pub orientation: Quaternion<f64>,
    /// `v`, m/s.
    pub linear: Vec3,
    /// `ω`, rad/s.
    pub angular: Vec3,
}
