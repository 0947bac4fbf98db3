//! Maximum power dissipation over the friction ellipsoid, as a projection.
//!
//! With `φ = E⁻¹p` and `ν = E u` the paper's problem, maximise `-u·p` subject to `|E⁻¹p| ≤ b`, is solved by
//! `φ = proj_b(φ - ρν)` for any `ρ > 0` (the variational inequality of a ball; Facchinei and Pang 2003, 1.5.8).

use crate::{Mat3, Vec3};

/// The projection equation's value, and what its generalized derivatives follow from.
#[derive(Debug, Clone, Copy)]
pub struct FrictionRows {
    /// `φ - proj_b(φ - ρν)`.
    pub value: Vec3,
    rho: f64,
    regime: Regime,
}

/// Where `φ - ρν` lies.
#[derive(Debug, Clone, Copy)]
enum Regime {
    /// Anywhere: the ball is a point.
    Frictionless,
    /// In the ball.
    Sticks,
    /// Outside the ball, which it reaches along `direction`; `share = b/|φ - ρν|`.
    Slips { direction: Vec3, share: f64 },
}

impl FrictionRows {
    /// The rows at `φ`, `ν`, for the bound `b`.
    #[inline]
    pub fn new(friction: &Vec3, slip: &Vec3, bound: f64, rho: f64) -> Self {
        let w = friction - slip * rho;
        let length = w.norm();
        if bound <= 0.0 {
            return Self { value: *friction, rho, regime: Regime::Frictionless };
        }
        if length <= bound {
            return Self { value: slip * rho, rho, regime: Regime::Sticks };
        }
        let direction = w / length;
        Self { value: friction - direction * bound, rho, regime: Regime::Slips { direction, share: bound / length } }
    }

    /// Whether `φ - ρν` lies outside the ball, so that the contact slips.
    #[inline]
    pub fn slips(&self) -> bool {
        !matches!(self.regime, Regime::Sticks)
    }

    /// The derivatives by `φ`, by `ν` and by `b`.
    #[inline]
    pub fn derivatives(&self) -> (Mat3, Mat3, Vec3) {
        match &self.regime {
            Regime::Frictionless => (Mat3::identity(), Mat3::zeros(), Vec3::zeros()),
            Regime::Sticks => (Mat3::zeros(), Mat3::from_diagonal_element(self.rho), Vec3::zeros()),
            Regime::Slips { direction, share } => {
                let projector = (Mat3::identity() - direction * direction.transpose()) * *share;
                (Mat3::identity() - projector, projector * self.rho, -direction)
            }
        }
    }
}
