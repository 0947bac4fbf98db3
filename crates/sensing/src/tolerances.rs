//! How far the nuisances may be off.

use crate::SensingError;
use crate::measured::LOCAL;

/// Bounds and standard deviations of the nuisances.
#[derive(Debug, Clone, PartialEq)]
pub struct Tolerances {
    /// By trial, the most of the clock (s) and of the origin (m), either way.
    pub local_bounds: Vec<[f64; LOCAL]>,
    /// Standard deviations of the same.
    pub local_sigmas: Vec<[f64; LOCAL]>,
    /// The least of the camera's heading (rad) and scale, then of the nominal numbers in their tolerances.
    pub shared_low: Vec<f64>,
    /// The most of the same.
    pub shared_high: Vec<f64>,
    /// Standard deviations of the same.
    pub shared_sigmas: Vec<f64>,
}

impl Tolerances {
    /// Whether sizes and signs are right for so many trials.
    pub(crate) fn check(&self, trials: usize) -> Result<(), SensingError> {
        let count = self.shared_sigmas.len();
        SensingError::same("local_bounds", self.local_bounds.len(), trials)?;
        SensingError::same("local_sigmas", self.local_sigmas.len(), trials)?;
        SensingError::same("shared_low", self.shared_low.len(), count)?;
        SensingError::same("shared_high", self.shared_high.len(), count)?;
        let refused = |what, found: f64, fits: bool| {
            if fits && found.is_finite() { Ok(()) } else { Err(SensingError::Number { what, found }) }
        };
        for bound in self.local_bounds.as_flattened() {
            refused("a local bound", *bound, *bound >= 0.0)?;
        }
        for sigma in self.local_sigmas.as_flattened().iter().chain(&self.shared_sigmas) {
            refused("a standard deviation", *sigma, *sigma > 0.0)?;
        }
        for (low, high) in self.shared_low.iter().zip(&self.shared_high) {
            refused("a lower bound", *low, low <= high)?;
            refused("an upper bound", *high, low <= high)?;
        }
        Ok(())
    }
}
