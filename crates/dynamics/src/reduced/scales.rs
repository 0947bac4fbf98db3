//! The scales of the reduced problem's rows and columns.

use super::Unknowns;
use crate::step::Step;

/// Row and column scales that make the linear system one of plain numbers: mass `m`, length `ℓ`, time `h`.
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
        Self {
            angular: 1.0 / step.h,
            impulse: step.mass * step.size / step.h,
            moment: step.mass * step.size * step.size / step.h,
            length: step.size,
            load: step.load_scale + contact,
        }
    }
}
