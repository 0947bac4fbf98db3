use nalgebra::Vector2;

use crate::prism::{RealProfile, prism};
use crate::profile::HullProfile;
use crate::{Body, Draft, GeometryError};

impl Body {
    /// A bar `length × width × height` with a triangular spike of base `spike_base` above and one below its middle,
    /// `overall_height` from tip to tip.
    pub fn spiked(
        length: f64,
        width: f64,
        height: f64,
        spike_base: f64,
        overall_height: f64,
        draft: Draft,
    ) -> Result<Self, GeometryError> {
        GeometryError::positive("length", length)?;
        GeometryError::positive("width", width)?;
        GeometryError::positive("height", height)?;
        GeometryError::positive("spike base", spike_base)?;
        GeometryError::positive("overall height", overall_height)?;
        GeometryError::less("spike base", spike_base, length)?;
        GeometryError::less("height", height, overall_height)?;

        let (y, z, tip) = (0.5 * length, 0.5 * height, 0.5 * overall_height);
        let near: Vec<Vector2<f64>> =
            [(y, -z), (y, z), (0.0, tip), (-y, z), (-y, -z), (0.0, -tip)].map(|(y, z)| Vector2::new(y, z)).to_vec();
        let (end, slanted) = (draft.slope()?, draft.slanted_slope(y.hypot(tip - z))?);
        let slopes = vec![end, slanted, slanted, end, slanted, slanted];
        let hull = HullProfile::new(near, slopes, width, draft)?;

        // A spike's faces keep their slope, so half its base is in proportion to its height above the bar.
        let half_base_per_height = 0.5 * spike_base / (tip - z);
        let profile = |corners: &[Vector2<f64>]| {
            let mut real = Vec::with_capacity(corners.len() + 4);
            for (i, corner) in corners.iter().enumerate() {
                if i % 3 == 2 {
                    let (before, after) = (corners[i - 1], corners[(i + 1) % corners.len()]);
                    let base = Vector2::new(corner.x, before.y);
                    let half = half_base_per_height * (corner.y - base.y).abs() * (before - base).normalize();
                    real.extend([base + half, *corner, Vector2::new(corner.x, after.y) - half]);
                } else {
                    real.push(*corner);
                }
            }
            real
        };
        let real = RealProfile { near: profile(&hull.near), far: profile(&hull.far) };
        Ok(prism(width, &hull, &real)?.centred())
    }
}
