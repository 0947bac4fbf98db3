//! The magnetic torque `T_m = M × B` and when in the step it is taken, with the torque that does not depend on the pose.

use crate::rotation::{cayley, cayley_tangent};
use crate::{MagneticTorque, Mat3, Vec3};

/// `hT` as a function of the step's angular velocity: `h T = c + w M(αω) × B`, with `M(αω) = Cay(αω) M`.
#[derive(Debug, Clone, Copy)]
pub struct TorqueLaw {
    /// `c`, N m s: the part that is known before the step.
    known: Vec3,
    /// `w`, s: the weight of the part that follows the step; zero for the paper's equation.
    weight: f64,
    /// `α`, s: how far into the step the moment is turned, `h/2` for its end and `h/4` for its middle.
    alpha: f64,
    /// Whether that is its end.
    at_end: bool,
    /// `M` at the start of the step, A m².
    moment: Vec3,
    /// `B` where the moment is turned to, T.
    field: Vec3,
}

impl TorqueLaw {
    /// The law for a body that spins with `omega`, with `moment` in the substrate frame, at time `t` in the field `B(t)`.
    pub fn new(when: MagneticTorque, field: impl Fn(f64) -> Vec3, moment: Vec3, omega: &Vec3, t: f64, h: f64) -> Self {
        match when {
            MagneticTorque::StartOfStep => {
                let known = moment.cross(&field(t)) * h;
                Self { known, weight: 0.0, alpha: 0.0, at_end: false, moment, field: Vec3::zeros() }
            }
            MagneticTorque::EndOfStep => {
                Self { known: Vec3::zeros(), weight: h, alpha: 0.5 * h, at_end: true, moment, field: field(t + h) }
            }
            MagneticTorque::Midpoint => {
                let back = cayley(&(omega * (-0.25 * h))) * moment;
                let known = back.cross(&field(t - 0.5 * h)) * (0.5 * h);
                Self { known, weight: 0.5 * h, alpha: 0.25 * h, at_end: false, moment, field: field(t + 0.5 * h) }
            }
        }
    }

    /// The law with an `impulse` (N m s) more.
    pub fn with_impulse(self, impulse: Vec3) -> Self {
        Self { known: self.known + impulse, ..self }
    }

    /// `hT`.
    #[inline]
    pub fn impulse(&self, omega: &Vec3) -> Vec3 {
        if self.weight == 0.0 {
            return self.known;
        }
        self.known + self.turned(omega).cross(&self.field) * self.weight
    }

    /// `hT` where the turn `Cay(hω/2)` of the whole step is known: it is that of the moment at the end of the step.
    #[inline]
    pub fn impulse_after(&self, turn: &Mat3, omega: &Vec3) -> Vec3 {
        if self.at_end {
            self.known + (turn * self.moment).cross(&self.field) * self.weight
        } else {
            self.impulse(omega)
        }
    }

    /// `h ∂T/∂ω⁺`. From `d(M × B) = (dφ × M) × B = (M Bᵀ - (M·B) 1) dφ`.
    #[inline]
    pub fn by_angular(&self, omega: &Vec3) -> Mat3 {
        if self.weight == 0.0 {
            return Mat3::zeros();
        }
        let moment = self.turned(omega);
        let by_turn = moment * self.field.transpose() - Mat3::from_diagonal_element(moment.dot(&self.field));
        by_turn * cayley_tangent(omega, self.alpha) * self.weight
    }

    #[inline]
    fn turned(&self, omega: &Vec3) -> Vec3 {
        cayley(&(omega * self.alpha)) * self.moment
    }

    /// An upper bound of `|hT|`.
    #[inline]
    pub fn greatest(&self) -> f64 {
        self.known.norm() + self.weight * self.moment.norm() * self.field.norm()
    }
}
