//! What a run is summed up in.

use crate::{State, Stepper, Trial, Vec3};
use nalgebra::Quaternion;
use std::f64::consts::{PI, TAU};

/// The paper's three metrics and the health of the solver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Metrics {
    /// Rotation about the long axis after one cycle, rad; NaN where the run has no whole cycle.
    pub twist: f64,
    /// Displacement along `x` after one cycle, m; NaN where the run has no whole cycle.
    pub drift: f64,
    /// Displacement along `y` over the run's time, m/s.
    pub speed: f64,
    /// Steps that did not converge.
    pub unconverged_steps: u64,
    /// Greatest scaled natural residual of a step.
    pub max_residual: f64,
    /// Greatest penetration, m.
    pub max_penetration: f64,
    /// Of the whole run.
    pub newton_iterations: u64,
}

/// Gathers [`Metrics`] along a run.
#[derive(Debug, Clone)]
pub struct Gauge {
    start: Vec3,
    before: State,
    period: Option<f64>,
    metrics: Metrics,
}

impl Gauge {
    /// A gauge at the start of `trial`.
    pub fn new(trial: &Trial) -> Self {
        let initial = *trial.initial();
        let metrics = Metrics {
            twist: f64::NAN,
            drift: f64::NAN,
            speed: 0.0,
            unconverged_steps: 0,
            max_residual: 0.0,
            max_penetration: 0.0,
            newton_iterations: 0,
        };
        Self { start: initial.position, before: initial, period: trial.field().period(), metrics }
    }

    /// Takes note of the step that `stepper` has just made.
    #[inline]
    pub fn read(&mut self, stepper: &Stepper, h: f64) {
        let (solution, state, time) = (stepper.solution(), stepper.state(), stepper.time());
        self.metrics.newton_iterations += u64::from(solution.iterations);
        self.metrics.unconverged_steps += u64::from(!solution.converged);
        // That of a run with a step that was not verified is no number.
        let residuals = [self.metrics.max_residual, solution.residual];
        self.metrics.max_residual =
            if residuals.iter().any(|r| r.is_nan()) { f64::NAN } else { residuals[0].max(residuals[1]) };
        self.metrics.max_penetration = self.metrics.max_penetration.max(solution.penetration);
        self.metrics.speed = (state.position.y - self.start.y) / time;
        // A cycle that ends a rounding after the last step has ended.
        if let Some(period) = self.period.filter(|period| time >= *period * (1.0 - 1e-12)) {
            let share = ((period - (time - h)) / h).clamp(0.0, 1.0);
            let position = self.before.position.lerp(&state.position, share);
            self.metrics.drift = position.x - self.start.x;
            self.metrics.twist = twist(&between(&self.before.orientation, &state.orientation, share));
            self.period = None;
        }
        self.before = *state;
    }

    /// What has been gathered so far.
    pub fn metrics(&self) -> Metrics {
        self.metrics
    }
}

/// The rotation about the body's `y` axis in the swing-twist decomposition, `2 atan2(Q_y, Q_w)` in `(-π, π]`.
pub fn twist(orientation: &Quaternion<f64>) -> f64 {
    let angle = 2.0 * orientation.j.atan2(orientation.w);
    if angle > PI {
        angle - TAU
    } else if angle <= -PI {
        angle + TAU
    } else {
        angle
    }
}

/// The orientation a `share` of the way from `a` to `b`, which are a step apart.
fn between(a: &Quaternion<f64>, b: &Quaternion<f64>, share: f64) -> Quaternion<f64> {
    let b = if a.dot(b) < 0.0 { -*b } else { *b };
    let q = a * (1.0 - share) + b * share;
    q / q.norm()
}
