//! The scales of the reduced problem's rows and columns.

use super::Unknowns;
use crate::step::Step;

/// Row and column scales that make the linear system one of plain numbers: mass `m`, length `ℓ`, time `h`, each rounded down to
/// a power of two, so that scaling rounds nothing in whatever order it is done.
pub(super) struct Scales<const N: usize> {
    pub(super) angular: f64,
    pub(super) impulse: f64,
    pub(super) moment: f64,
    pub(super) length: f64,
    /// `P`.
    pub(super) load: f64,
}

impl<const N: usize> Scales<N> {
    pub(super) fn new(step: &Step, start: &Unknowns) -> Self {
        let contact = start.impulses.iter().map(|p| p.abs()).sum::<f64>();
        let (mass, length, time) = (power_of_two(step.mass), power_of_two(step.size), power_of_two(step.h));
        Self {
            angular: 1.0 / time,
            impulse: mass * length / time,
            moment: mass * length * length / time,
            length,
            load: step.load_scale + contact,
        }
    }
}

/// The greatest power of two that is not greater than a positive `value`.
#[inline]
fn power_of_two(value: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff << 52;
    f64::from_bits(value.to_bits() & EXPONENT)
}
