//! The change of angular momentum in a step, gyroscopic term and what drag takes of it included.
//!
//! ```text
//! start, end of step:   I^u (ω⁺ - ω) + h ω × I^u ω                 the paper's, explicit in the gyroscopic term
//! midpoint:             C(ω⁺) I^u ω⁺ - C(ω)ᵀ I^u ω                 C(ω): the body's turn in half a step
//! ```
//!
//! Drag adds `h D ω⁺`, implicit in every law.
//!
//! `C(ω⁺) I^u ω⁺` is the momentum in the middle of this step and `C(ω)ᵀ I^u ω` that in the middle of the last, for
//! `C(ω)² = Cay(hω/2)` leaves `ω` as it is. In the air it is kept to rounding whatever `h|ω|` is, so that a body that
//! tumbles fast cannot gain energy without bound, as it does from the explicit term.

use crate::rotation::cayley;
use crate::{MagneticTorque, Mat3, Vec3};

/// The change of angular momentum, and what drag takes, as a function of `ω⁺`.
#[derive(Debug, Clone, Copy)]
pub struct MomentumLaw {
    kept: Kept,
    /// `h D`.
    drag: Option<Mat3>,
}

#[derive(Debug, Clone, Copy)]
enum Kept {
    /// `I^u ω⁺ - k`.
    Explicit { known: Vec3 },
    /// `C(ω⁺) I^u ω⁺ - k`.
    Midpoint { known: Vec3, h: f64 },
}

impl MomentumLaw {
    /// The law for a body of `inertia` that spins with `omega`, with the torque per angular velocity `drag` against it.
    pub fn new(when: MagneticTorque, inertia: &Mat3, omega: &Vec3, h: f64, drag: Option<&Mat3>) -> Self {
        let momentum = inertia * omega;
        let kept = match when {
            MagneticTorque::StartOfStep | MagneticTorque::EndOfStep => {
                Kept::Explicit { known: momentum - omega.cross(&momentum) * h }
            }
            MagneticTorque::Midpoint => Kept::Midpoint { known: cayley(&half_turn(omega, h)).tr_mul(&momentum), h },
        };
        Self { kept, drag: drag.map(|drag| drag * h) }
    }

    /// The change.
    #[inline]
    pub fn change(&self, inertia: &Mat3, omega: &Vec3) -> Vec3 {
        let change = match &self.kept {
            Kept::Explicit { known } => inertia * omega - known,
            Kept::Midpoint { known, h } => cayley(&half_turn(omega, *h)) * (inertia * omega) - known,
        };
        self.drag.as_ref().map_or(change, |drag| change + drag * omega)
    }

    /// Its derivative by `ω⁺`.
    #[inline]
    pub fn by_angular(&self, inertia: &Mat3, omega: &Vec3) -> Mat3 {
        let by_angular = match &self.kept {
            Kept::Explicit { .. } => *inertia,
            Kept::Midpoint { h, .. } => {
                let turn = cayley(&half_turn(omega, *h));
                let momentum = turn * (inertia * omega);
                turn * inertia - momentum.cross_matrix() * half_turn_tangent(omega, *h)
            }
        };
        self.drag.as_ref().map_or(by_angular, |drag| by_angular + drag)
    }
}

/// `s'` with `Cay(s')² = Cay(s)`, `s = hω/2`: `s' = s/(1 + √(1 + |s|²))`, the tangent of a quarter of the angle.
#[inline]
fn half_turn(omega: &Vec3, h: f64) -> Vec3 {
    let s = omega * (0.5 * h);
    s / (1.0 + (1.0 + s.norm_squared()).sqrt())
}

/// `dφ'/dω` of `Cay(s')`: `2/(1 + |s'|²) (1 + [s']ₓ) ds'/dω`, `ds' = k (ds - k s (s·ds)/√(1 + |s|²))`,
/// `k = 1/(1 + √(1 + |s|²))`.
#[inline]
fn half_turn_tangent(omega: &Vec3, h: f64) -> Mat3 {
    let s = omega * (0.5 * h);
    let root = (1.0 + s.norm_squared()).sqrt();
    let k = 1.0 / (1.0 + root);
    let half = s * k;
    let by_omega = (Mat3::identity() - s * s.transpose() * (k / root)) * (0.5 * h * k);
    (Mat3::identity() + half.cross_matrix()) * by_omega * (2.0 / (1.0 + half.norm_squared()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_derivative(w in prop::array::uniform3(-4.0..4.0f64), d in prop::array::uniform3(-1.0..1.0f64)) {
            let inertia = Mat3::new(2.0, 0.1, 0.0, 0.1, 0.7, -0.2, 0.0, -0.2, 1.5);
            let drag = Mat3::new(0.8, 0.1, 0.3, 0.1, 0.4, 0.0, 0.3, 0.0, 0.5);
            let laws = [MagneticTorque::EndOfStep, MagneticTorque::Midpoint].map(|when| (when, None));
            for (when, drag) in laws.into_iter().chain(laws.map(|(when, _)| (when, Some(&drag)))) {
                let law = MomentumLaw::new(when, &inertia, &Vec3::new(1.0, -2.0, 0.5), 0.9, drag);
                let (w, d, e) = (Vec3::from(w), Vec3::from(d), 1e-6);
                let numeric = (law.change(&inertia, &(w + d * e)) - law.change(&inertia, &(w - d * e))) / (2.0 * e);
                prop_assert!((numeric - law.by_angular(&inertia, &w) * d).norm() < 1e-7);
            }
        }

        #[test]
        fn two_half_turns_are_the_turn(w in prop::array::uniform3(-9.0..9.0f64)) {
            let omega = Vec3::from(w);
            let half = cayley(&half_turn(&omega, 0.8));
            prop_assert!((half * half - cayley(&(omega * 0.4))).norm() < 1e-13);
        }
    }
}
