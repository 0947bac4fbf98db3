use crate::Status;

/// What a solve came to. The point itself is in the `z` that was handed to [`Solver::solve`](crate::Solver::solve).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solution {
    /// How the solve ended.
    pub status: Status,
    /// The natural residual `max(|g|_∞, |min(v, f)|_∞)` at the point returned: the lowest one met. NaN if the
    /// functions are not finite at the start.
    pub residual: f64,
    /// The number of steps taken, those of the smoothing restart included.
    pub iterations: usize,
}
