//! A run, recorded.

use crate::error::Diverged;
use crate::metrics::Gauge;
use crate::{Metrics, SolverKind, Stepper, Trial};
use std::ops::ControlFlow;

/// The rows of a run: every `every`-th step, and the start.
#[derive(Debug, Clone, Default)]
pub struct Recording {
    /// s.
    pub time: Vec<f64>,
    /// Centre of mass as it is seen, m.
    pub position: Vec<[f64; 3]>,
    /// `w, x, y, z`, as it is seen.
    pub orientation: Vec<[f64; 4]>,
    /// `v`, m/s, in the frame of the tangent plane, as all that follows but the ECP.
    pub linear: Vec<[f64; 3]>,
    /// `ω`, rad/s.
    pub angular: Vec<[f64; 3]>,
    /// `a1` as it is seen, m.
    pub ecp: Vec<[f64; 3]>,
    /// 0 airborne, 1 point, 2 line, 3 surface.
    pub contact_mode: Vec<i8>,
    /// `λ_n`, N.
    pub normal_force: Vec<f64>,
    /// `λ_t`, `λ_o` (N) and `λ_r` (N m).
    pub friction_force: Vec<[f64; 3]>,
    /// `λ_a`, N.
    pub adhesion_force: Vec<f64>,
    /// Speed of the ECP along the substrate, m/s.
    pub slip_speed: Vec<f64>,
    /// Scaled natural residual.
    pub residual: Vec<f64>,
    /// Of the step.
    pub newton_iterations: Vec<i64>,
}

impl Recording {
    /// Appends the state of `stepper` on `trial` and the last step, during which `adhesion` (N s) acted.
    fn push(&mut self, trial: &Trial, stepper: &Stepper, adhesion: f64) {
        let (state, solution, h) = (stepper.state(), stepper.solution(), trial.step());
        let (position, q) = trial.seen(state);
        let relief = trial.relief();
        let ecp = if relief.is_flat() {
            solution.ecp
        } else {
            position + relief.tilt(position.y) * (solution.ecp - state.position)
        };
        self.time.push(stepper.time());
        self.position.push(position.into());
        self.orientation.push([q.w, q.i, q.j, q.k]);
        self.linear.push(state.linear.into());
        self.angular.push(state.angular.into());
        self.ecp.push(ecp.into());
        self.contact_mode.push(solution.patch.mode as i8);
        self.normal_force.push(solution.normal / h);
        self.friction_force.push((solution.friction / h).into());
        self.adhesion_force.push(adhesion / h);
        self.slip_speed.push(solution.slip.xy().norm());
        self.residual.push(solution.residual);
        self.newton_iterations.push(i64::from(solution.iterations));
    }
}

/// Why a run has no recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ended {
    /// `watch` stopped it.
    Stopped,
    /// The state left the finite numbers.
    Diverged(Diverged),
}

/// Runs `trial` and keeps every `every`-th step and the last. `watch` is told the number of steps done and may stop the
/// run.
pub fn record(
    trial: &Trial,
    kind: SolverKind,
    every: u64,
    mut watch: impl FnMut(u64) -> ControlFlow<()>,
) -> Result<(Recording, Metrics), Ended> {
    let (h, steps) = (trial.step(), trial.steps());
    let mut stepper = Stepper::new(trial, kind);
    let mut gauge = Gauge::new(trial);
    let mut recording = Recording::default();
    recording.push(trial, &stepper, stepper.adhesion().impulse);
    for done in 1..=steps {
        let adhesion = stepper.adhesion().impulse;
        stepper.advance();
        if !stepper.is_finite() {
            return Err(Ended::Diverged(Diverged { time: stepper.time() }));
        }
        gauge.read(&stepper, h);
        if done % every == 0 || done == steps {
            recording.push(trial, &stepper, adhesion);
        }
        if watch(done).is_break() {
            return Err(Ended::Stopped);
        }
    }
    Ok((recording, gauge.metrics()))
}
