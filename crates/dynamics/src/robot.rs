//! The robot: a body with mass and a magnetic moment.

use crate::error::{Invalid, finite, positive};
use crate::{Mat3, Vec3};
use geometry::Body;
use std::sync::Arc;

/// A rigid magnetic body.
#[derive(Debug, Clone)]
pub struct Robot {
    body: Arc<Body>,
    mass: f64,
    inertia: Mat3,
    moment: Vec3,
}

impl Robot {
    /// A robot of `mass` (kg) whose magnetic moment is `moment = V_m |E| u` (A m², body frame).
    pub fn new(body: Arc<Body>, mass: f64, moment: Vec3) -> Result<Self, Invalid> {
        positive("mass_kg", mass)?;
        for component in moment.iter() {
            finite("magnetic moment", *component)?;
        }
        let inertia = body.unit_inertia() * mass;
        Ok(Self { body, mass, inertia, moment })
    }

    /// The body, as robots share it.
    pub fn shared_body(&self) -> &Arc<Body> {
        &self.body
    }

    /// The shape.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// kg.
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Inertia about the centre of mass in the body frame, kg m².
    pub fn inertia(&self) -> &Mat3 {
        &self.inertia
    }

    /// `V_m |E| u` in the body frame, A m².
    pub fn moment(&self) -> &Vec3 {
        &self.moment
    }

    /// The largest step (s) for which `start_of_step` is stable in a field of `strength` (T):
    /// `2/ω`, `ω² = V_m |E| B λ_max(I⁻¹ (1 - uuᵀ))`.
    pub fn stability_bound(&self, strength: f64) -> f64 {
        let moment = self.moment.norm();
        if moment == 0.0 || strength == 0.0 {
            return f64::INFINITY;
        }
        let u = self.moment / moment;
        let stiffness = Mat3::identity() - u * u.transpose();
        // I⁻¹K is similar to the symmetric L⁻¹ K L⁻ᵀ with I = L Lᵀ.
        let Some(factor) = self.inertia.cholesky() else {
            return 0.0;
        };
        let Some(inverse) = factor.l().try_inverse() else {
            return 0.0;
        };
        let largest = (inverse * stiffness * inverse.transpose()).symmetric_eigenvalues().max();
        2.0 / (moment * strength * largest).sqrt()
    }
}
