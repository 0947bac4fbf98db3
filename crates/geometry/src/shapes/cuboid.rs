use nalgebra::Vector2;

use crate::prism::{RealProfile, prism};
use crate::profile::HullProfile;
use crate::{Body, Draft, GeometryError};

impl Body {
    /// A cuboid `length × width × height`.
    pub fn cuboid(length: f64, width: f64, height: f64, draft: Draft) -> Result<Self, GeometryError> {
        GeometryError::positive("length", length)?;
        GeometryError::positive("width", width)?;
        GeometryError::positive("height", height)?;
        let (y, z) = (0.5 * length, 0.5 * height);
        let near = [(y, -z), (y, z), (-y, z), (-y, -z)].map(|(y, z)| Vector2::new(y, z)).to_vec();
        let hull = HullProfile::new(near, vec![draft.slope()?; 4], width, draft)?;
        let real = RealProfile { near: hull.near.clone(), far: hull.far.clone() };
        Ok(prism(width, &hull, &real)?.centred())
    }
}
