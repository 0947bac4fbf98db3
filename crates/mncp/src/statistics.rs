use crate::Direction;

/// One accepted step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// The natural residual `max(|g|_∞, |min(v, f)|_∞)` after the step.
    pub residual: f64,
    /// The merit `Ψ_ε = ½|Φ_ε|²` after the step.
    pub merit: f64,
    /// `t` of `z + t d`.
    pub step: f64,
    /// How `d` was found.
    pub direction: Direction,
    /// `ε` of `Φ_ε`, zero outside the smoothing restart.
    pub smoothing: f64,
}

/// The history of the last solve.
#[derive(Clone, Debug)]
pub struct Statistics {
    iterations: Vec<Iteration>,
    start_residual: f64,
}

impl Statistics {
    pub(crate) fn with_capacity(steps: usize) -> Self {
        Self { iterations: Vec::with_capacity(steps), start_residual: f64::NAN }
    }

    pub(crate) fn restart(&mut self, start_residual: f64) {
        self.iterations.clear();
        self.start_residual = start_residual;
    }

    pub(crate) fn record(&mut self, iteration: Iteration) {
        self.iterations.push(iteration);
    }

    /// The accepted steps, in order. A smoothing restart begins again at the start, with the first `smoothing > 0`.
    pub fn iterations(&self) -> &[Iteration] {
        &self.iterations
    }

    /// The natural residual of the start.
    pub fn start_residual(&self) -> f64 {
        self.start_residual
    }
}
