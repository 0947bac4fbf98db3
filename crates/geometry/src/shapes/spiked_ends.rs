use nalgebra::Vector2;

use crate::prism::{RealProfile, prism};
use crate::profile::HullProfile;
use crate::{Body, Draft, GeometryError};

impl Body {
    /// A bar `length × width × height` with four triangular spikes, above and below both of its ends: each base runs
    /// from the bar's end inwards by `spike_base`, each tip is above the middle of its base by `spike_height`.
    pub fn spiked_ends(
        length: f64,
        width: f64,
        height: f64,
        spike_base: f64,
        spike_height: f64,
        draft: Draft,
    ) -> Result<Self, GeometryError> {
        GeometryError::positive("length", length)?;
        GeometryError::positive("width", width)?;
        GeometryError::positive("height", height)?;
        GeometryError::positive("spike base", spike_base)?;
        GeometryError::positive("spike height", spike_height)?;
        GeometryError::less("spike base", spike_base, 0.5 * length)?;

        let half_base = 0.5 * spike_base;
        let (y, z, tip) = (0.5 * length, 0.5 * height, 0.5 * height + spike_height);
        let inner = y - half_base;
        let near = [(y, -z), (y, z), (inner, tip), (-inner, tip), (-y, z), (-y, -z), (-inner, -tip), (inner, -tip)]
            .map(|(y, z)| Vector2::new(y, z))
            .to_vec();
        let (end, slanted) = (draft.slope()?, draft.slanted_slope(half_base.hypot(spike_height))?);
        let slopes = vec![end, slanted, end, slanted, end, slanted, end, slanted];
        let hull = HullProfile::new(near, slopes, width, draft)?;

        // A spike's inner face keeps its slope, so its foot is in proportion to the spike's height above the bar.
        let profile = |corners: &[Vector2<f64>]| {
            let foot = |tip: Vector2<f64>, bar: Vector2<f64>| {
                let inwards = half_base / spike_height * (tip.y - bar.y).abs();
                Vector2::new(tip.x - inwards * tip.x.signum(), bar.y)
            };
            let [a, b, c, d, e, f, g, h] = [0, 1, 2, 3, 4, 5, 6, 7].map(|i| corners[i]);
            vec![a, b, c, foot(c, b), foot(d, e), d, e, f, g, foot(g, f), foot(h, a), h]
        };
        let real = RealProfile { near: profile(&hull.near), far: profile(&hull.far) };
        if real.far[3].x <= real.far[4].x {
            return Err(GeometryError::DraftTooLarge {
                angle_rad: draft.angle_rad,
                vanishing: "notch between the spikes",
            });
        }
        Ok(prism(width, &hull, &real)?.centred())
    }
}
