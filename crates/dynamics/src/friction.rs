//! Maximum power dissipation over the friction ellipsoid, as a projection.
//!
//! With `φ = E⁻¹p` and `ν = E u` the paper's problem, maximise `-u·p` subject to `|E⁻¹p| ≤ b`, is solved by
//! `φ = proj_b(φ - ρν)` for any `ρ > 0` (the variational inequality of a ball; Facchinei and Pang 2003, 1.5.8).

use crate::{Mat3, Vec3};

/// The projection equation's value and its generalized derivatives.
#[derive(Debug, Clone, Copy)]
pub struct FrictionRows {
    /// `φ - proj_b(φ - ρν)`.
    pub value: Vec3,
    /// By `φ`.
    pub by_friction: Mat3,
    /// By `ν`.
    pub by_slip: Mat3,
    /// By `b`.
    pub by_bound: Vec3,
    /// Whether `φ - ρν` lies outside the ball, so that the contact slips.
    pub slips: bool,
}

/// The rows at `φ`, `ν`, for the bound `b`.
#[inline]
pub fn friction_rows(friction: &Vec3, slip: &Vec3, bound: f64, rho: f64) -> FrictionRows {
    let w = friction - slip * rho;
    let length = w.norm();
    if bound <= 0.0 {
        return FrictionRows {
            value: *friction,
            by_friction: Mat3::identity(),
            by_slip: Mat3::zeros(),
            by_bound: Vec3::zeros(),
            slips: true,
        };
    }
    if length <= bound {
        return FrictionRows {
            value: slip * rho,
            by_friction: Mat3::zeros(),
            by_slip: Mat3::from_diagonal_element(rho),
            by_bound: Vec3::zeros(),
            slips: false,
        };
    }
    let direction = w / length;
    let projector = (Mat3::identity() - direction * direction.transpose()) * (bound / length);
    FrictionRows {
        value: friction - direction * bound,
        by_friction: Mat3::identity() - projector,
        by_slip: projector * rho,
        by_bound: -direction,
        slips: true,
    }
}
