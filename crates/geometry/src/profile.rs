use nalgebra::Vector2;

use crate::GeometryError;

/// How the sides of a body taper from `x = -W/2` to `x = +W/2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Draft {
    /// The draft angle `φ`, in radians, `0 ≤ φ < π/2`.
    pub angle_rad: f64,
    /// What it means for slanted faces.
    pub model: DraftModel,
}

/// The taper of slanted faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DraftModel {
    /// `tan φ` on every profile face.
    Geometric,
    /// `n tan φ` on the slanted faces of the spiked shapes, `n` twice the slanted hull edge's length in millimetres.
    AsReleased,
}

impl Draft {
    /// No taper.
    pub const NONE: Draft = Draft { angle_rad: 0.0, model: DraftModel::Geometric };

    /// `tan φ`.
    pub(crate) fn slope(&self) -> Result<f64, GeometryError> {
        if !self.angle_rad.is_finite() {
            return Err(GeometryError::NotFinite { name: "draft angle", value: self.angle_rad });
        }
        if self.angle_rad < 0.0 {
            return Err(GeometryError::Negative { name: "draft angle", value: self.angle_rad });
        }
        GeometryError::less("draft angle", self.angle_rad, std::f64::consts::FRAC_PI_2)?;
        Ok(self.angle_rad.tan())
    }

    /// The slope of a slanted face whose hull edge has the given length in metres.
    pub(crate) fn slanted_slope(&self, edge: f64) -> Result<f64, GeometryError> {
        Ok(match self.model {
            DraftModel::Geometric => self.slope()?,
            DraftModel::AsReleased => 2.0 * edge * 1e3 * self.slope()?,
        })
    }
}

/// A convex side profile in the `(y, z)` plane, counter-clockwise, at both side planes. Edge `j` runs from corner `j` to
/// corner `j + 1`.
#[derive(Clone, Debug)]
pub(crate) struct HullProfile {
    /// The corners at `x = -W/2`.
    pub near: Vec<Vector2<f64>>,
    /// The corners at `x = +W/2`.
    pub far: Vec<Vector2<f64>>,
    /// By how much each edge moves inwards per length along `x`.
    pub slopes: Vec<f64>,
}

impl HullProfile {
    /// The corner between the edges `i` and `j` moves by `p` with `n_i · p = -W t_i`, `n_j · p = -W t_j`.
    pub fn new(near: Vec<Vector2<f64>>, slopes: Vec<f64>, width: f64, draft: Draft) -> Result<Self, GeometryError> {
        let count = near.len();
        let mut far = near.clone();
        for (j, corner) in far.iter_mut().enumerate() {
            let i = (j + count - 1) % count;
            let (a, b) = (outward(&near, i), outward(&near, j));
            let (ra, rb) = (-width * slopes[i], -width * slopes[j]);
            *corner += Vector2::new(ra * b.y - rb * a.y, rb * a.x - ra * b.x) / a.perp(&b);
        }
        for j in 0..count {
            let next = (j + 1) % count;
            let kept = (far[next] - far[j]).dot(&(near[next] - near[j])) / (near[next] - near[j]).norm_squared();
            if kept.is_nan() || kept < 1e-9 {
                return Err(GeometryError::DraftTooLarge { angle_rad: draft.angle_rad, vanishing: "side profile" });
            }
        }
        Ok(Self { near, far, slopes })
    }

    /// Outward unit normal of edge `j`.
    pub fn normal(&self, j: usize) -> Vector2<f64> {
        outward(&self.near, j)
    }

    /// Length of the nominal profile's boundary.
    pub fn perimeter(&self) -> f64 {
        (0..self.near.len()).map(|j| (self.near[(j + 1) % self.near.len()] - self.near[j]).norm()).sum()
    }
}

fn outward(corners: &[Vector2<f64>], j: usize) -> Vector2<f64> {
    let along = corners[(j + 1) % corners.len()] - corners[j];
    Vector2::new(along.y, -along.x).normalize()
}
