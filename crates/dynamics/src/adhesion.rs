//! Adhesion that scales with the area that touches.

use crate::{Substrate, Vec3};
use geometry::Patch;

/// The adhesive impulse of a step, from the patch found in the step before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adhesion {
    /// `p_a = h C (A + w ℓ)`, N s.
    pub impulse: f64,
    /// Centroid of the patch in the substrate frame, m.
    pub centroid: Vec3,
}

impl Adhesion {
    /// No adhesion: the last step ended in the air.
    pub fn none() -> Self {
        Self { impulse: 0.0, centroid: Vec3::zeros() }
    }

    /// `λ_a = C A_contact`, with the strip of width `w` where lines touch.
    pub fn of_patch(substrate: &Substrate, patch: &Patch, h: f64, centroid: Vec3) -> Self {
        let area = patch.area + substrate.line_contact_width * patch.line_length;
        Self { impulse: h * substrate.adhesion * area, centroid }
    }
}
