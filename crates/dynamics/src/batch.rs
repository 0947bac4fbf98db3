//! A batch of trials over threads.
//!
//! Trials share nothing that is written, so that the bits of a result do not depend on the number of threads.

use crate::error::Diverged;
use crate::metrics::Gauge;
use crate::{Metrics, SolverKind, Stepper, Trial};
use rayon::ThreadPoolBuilder;
use rayon::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// How many steps are made between two looks at the flag that stops a batch.
const STEPS_BETWEEN_LOOKS: u64 = 64;

/// What became of one trial of a batch.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// It ran to its end.
    Done(Metrics),
    /// It left the finite numbers, or met a defect of this library; with the message.
    Failed(String),
    /// The batch was stopped before its end.
    Stopped,
}

/// How a batch is watched and stopped from another thread.
#[derive(Debug, Default)]
pub struct Control {
    /// Set from another thread to stop the batch.
    pub stop: AtomicBool,
    /// How many trials have ended.
    pub finished: AtomicUsize,
}

/// Runs `trials` on `threads` threads (0: one a core).
pub fn sweep(trials: &[Trial], threads: usize, control: &Control) -> Result<Vec<Outcome>, rayon::ThreadPoolBuildError> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build()?;
    Ok(pool.install(|| {
        trials
            .par_iter()
            .with_max_len(1)
            .map(|trial| {
                let outcome = catch_unwind(AssertUnwindSafe(|| run(trial, control)));
                control.finished.fetch_add(1, Ordering::Relaxed);
                outcome.unwrap_or_else(|panic| Outcome::Failed(message(&*panic)))
            })
            .collect()
    }))
}

fn run(trial: &Trial, control: &Control) -> Outcome {
    let mut stepper = Stepper::new(trial, SolverKind::Reduced);
    let mut gauge = Gauge::new(trial);
    for done in 0..trial.steps() {
        if done % STEPS_BETWEEN_LOOKS == 0 && control.stop.load(Ordering::Relaxed) {
            return Outcome::Stopped;
        }
        stepper.advance();
        if !stepper.is_finite() {
            return Outcome::Failed(Diverged { time: stepper.time() }.to_string());
        }
        gauge.read(&stepper, trial.step());
    }
    Outcome::Done(gauge.metrics())
}

fn message(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "the solver panicked".to_owned())
}
