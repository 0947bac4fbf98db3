//! The substrate: friction, adhesion, electrostatic attraction and compliance.

use crate::error::{Invalid, finite, not_negative, positive};

/// What the robot stands on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Substrate {
    /// `μ` at the start.
    pub friction_coefficient: f64,
    /// `k`, 1/s: the friction drifts with the time, `μ(t) = μ max(0, 1 + k t)`.
    pub friction_drift: f64,
    /// `e_t`, `e_o` (-) and `e_r` (m).
    pub friction_ellipsoid: [f64; 3],
    /// `C`, N/m².
    pub adhesion: f64,
    /// `F_elect`, N.
    pub electrostatic_force: f64,
    /// Width of the strip that counts as area where a line touches, m.
    pub line_contact_width: f64,
    /// `c`, m/N: the plane yields by `c λ_n`.
    pub compliance: f64,
}

impl Substrate {
    /// The substrate itself, or the first of its numbers that is refused.
    pub fn checked(self) -> Result<Self, Invalid> {
        not_negative("friction_coefficient", self.friction_coefficient)?;
        finite("friction_drift_per_s", self.friction_drift)?;
        for component in self.friction_ellipsoid {
            positive("friction_ellipsoid", component)?;
        }
        not_negative("adhesion_N_per_m2", self.adhesion)?;
        not_negative("electrostatic_force_N", self.electrostatic_force)?;
        not_negative("line_contact_width_m", self.line_contact_width)?;
        not_negative("compliance_m_per_N", self.compliance)?;
        Ok(self)
    }

    /// `μ(t)`.
    #[inline]
    pub fn friction_at(&self, t: f64) -> f64 {
        self.friction_coefficient * (1.0 + self.friction_drift * t).max(0.0)
    }
}
