use nalgebra::Vector2;

use crate::GeometryError;
use crate::mass_properties::SectionMoments;

/// The curved body's side profile where its hull is inset by `d`, about the circles' centre in the `(y, z)` plane. With
/// the half angle `α`, the end line's outward normal `n = (cos α, -sin α)` and its radial direction
/// `t = (sin α, cos α)`:
///
/// - outer arc: radius `R_o - d`, to the corner `-d n + s_o t`, `s_o² = R_o² - 2 R_o d`;
/// - chord `z = R_i cos α + d`, to the corner `-d n + s_i t`, `s_i = R_i + d (1 - sin α)/cos α`;
/// - the real inner arc is about the same centre through the chord's corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Section {
    pub outer_radius: f64,
    pub outer_half_angle: f64,
    /// Corner of the outer arc at positive `y`.
    pub outer_corner: Vector2<f64>,
    pub inner_radius: f64,
    pub inner_half_angle: f64,
    /// Corner of the chord at positive `y`.
    pub inner_corner: Vector2<f64>,
}

/// The undrafted radii and half angle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sector {
    pub outer_radius: f64,
    pub inner_radius: f64,
    pub half_angle: f64,
}

impl Sector {
    pub fn section(&self, inset: f64) -> Section {
        let (sin, cos) = self.half_angle.sin_cos();
        let on_end = |along: f64| along * Vector2::new(sin, cos) - inset * Vector2::new(cos, -sin);
        let along_outer = (self.outer_radius * (self.outer_radius - 2.0 * inset)).max(0.0).sqrt();
        let along_inner = self.inner_radius + inset * (1.0 - sin) / cos;
        Section {
            outer_radius: self.outer_radius - inset,
            outer_half_angle: self.half_angle - (inset / along_outer).atan(),
            outer_corner: on_end(along_outer),
            inner_radius: along_inner.hypot(inset),
            inner_half_angle: self.half_angle - (inset / along_inner).atan(),
            inner_corner: on_end(along_inner),
        }
    }

    /// Refuses an inset that leaves nothing of the section.
    pub fn inset(&self, inset: f64, angle_rad: f64) -> Result<Section, GeometryError> {
        let vanishing = |vanishing| Err(GeometryError::DraftTooLarge { angle_rad, vanishing });
        if inset.is_nan() || 2.0 * inset >= self.outer_radius {
            return vanishing("outer arc");
        }
        let section = self.section(inset);
        if section.outer_half_angle <= 0.0 {
            return vanishing("outer arc");
        }
        if section.inner_corner.x <= 0.0 {
            return vanishing("chord");
        }
        let (sin, cos) = self.half_angle.sin_cos();
        let along = (section.outer_corner - section.inner_corner).dot(&Vector2::new(sin, cos));
        if along <= 0.0 || section.inner_radius >= section.outer_radius {
            return vanishing("wall between the arcs");
        }
        Ok(section)
    }
}

impl Section {
    /// Sum over the boundary, counter-clockwise, of what it subtends at the circles' centre: for an arc of radius `r`
    /// between `±β` from `+z`
    ///
    /// `A = r² β`, `∫z = ⅔ r³ sin β`, `∫y² = ¼ r⁴ (β - ½ sin 2β)`, `∫z² = ¼ r⁴ (β + ½ sin 2β)`,
    ///
    /// for a segment `PQ` with `a = ½ P × Q`
    ///
    /// `A = a`, `∫p = a (P + Q)/3`, `∫ppᵀ = a/12 (PPᵀ + QQᵀ + (P + Q)(P + Q)ᵀ)`.
    pub fn moments(&self) -> SectionMoments {
        let arc = |r: f64, beta: f64| {
            let half = 0.5 * (2.0 * beta).sin();
            let quarter = 0.25 * r.powi(4);
            [r * r * beta, 2.0 / 3.0 * r.powi(3) * beta.sin(), quarter * (beta - half), quarter * (beta + half)]
        };
        let outer = arc(self.outer_radius, self.outer_half_angle);
        let inner = arc(self.inner_radius, self.inner_half_angle);
        let (p, q) = (self.inner_corner, self.outer_corner);
        let twice = 2.0 * 0.5 * p.perp(&q);
        let sum = p + q;
        let square = |k: usize| (p[k] * p[k] + q[k] * q[k] + sum[k] * sum[k]) / 12.0;
        let ends = [twice, twice * sum.y / 3.0, twice * square(0), twice * square(1)];
        let [area, z, yy, zz] = [0, 1, 2, 3].map(|k| outer[k] - inner[k] + ends[k]);
        SectionMoments { area, first: [0.0, z], second: [yy, 0.0, zz] }
    }

    /// Points of the outer arc and, the other way round, of the inner arc: a counter-clockwise polygon.
    pub fn sampled(&self, steps: usize) -> Vec<Vector2<f64>> {
        let at = |radius: f64, half_angle: f64, k: usize| {
            let (sin, cos) = (half_angle * (1.0 - 2.0 * k as f64 / steps as f64)).sin_cos();
            radius * Vector2::new(sin, cos)
        };
        let outer = (0..=steps).map(|k| at(self.outer_radius, self.outer_half_angle, k));
        let inner = (0..=steps).rev().map(|k| at(self.inner_radius, self.inner_half_angle, k));
        outer.chain(inner).collect()
    }
}
