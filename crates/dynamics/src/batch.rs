//! A batch of trials over threads.
//!
//! Trials share nothing that is written, so that the bits of a result do not depend on the number of threads. Each
//! thread takes the longest trial that is left (Graham 1969, SIAM J. Appl. Math. 17, 416): small batches are many in a
//! diagnosis, and a long trial that begins last leaves the other threads idle.

use crate::error::Diverged;
use crate::metrics::Gauge;
use crate::recording::Ended;
use crate::rollout::Rollout;
use crate::{Metrics, SolverKind, Stepper, Trial};
use rayon::ThreadPoolBuilder;
use std::cmp::Reverse;
use std::iter;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// How many steps are made between two looks at the flag that stops a batch.
const STEPS_BETWEEN_LOOKS: u64 = 64;

/// What became of one trial of a batch.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome<T> {
    /// It ran to its end.
    Done(T),
    /// It left the finite numbers, or met a defect of this library; with the message.
    Failed(String),
    /// The batch was stopped before its end.
    Stopped,
}

/// When a rollout ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Until {
    /// At the trial's end.
    End,
    /// Before the first step that turns the body by more than it shows, or at the end: what comes after is no motion.
    Unresolved,
}

/// How a batch is watched and stopped from another thread.
#[derive(Debug, Default)]
pub struct Control {
    /// Set from another thread to stop the batch.
    pub stop: AtomicBool,
    /// How many trials have ended.
    pub finished: AtomicUsize,
}

/// Runs `trials` on `threads` threads (0: one a core) and keeps their metrics.
pub fn sweep(
    trials: &[Trial],
    threads: usize,
    control: &Control,
) -> Result<Vec<Outcome<Metrics>>, rayon::ThreadPoolBuildError> {
    each(trials, threads, control, |trial, _| {
        let mut gauge = Gauge::new(trial);
        let read = |stepper: &Stepper| {
            gauge.read(stepper, trial.step());
            Ok(())
        };
        match run(trial, SolverKind::Reduced, control, read) {
            Ok(()) => Ok(gauge.metrics()),
            Err(Ended::Diverged(diverged)) => Err(Outcome::Failed(diverged.to_string())),
            Err(Ended::Stopped) => Err(Outcome::Stopped),
        }
    })
}

/// Runs `trials` on `threads` threads (0: one a core) and keeps every `every[i]`-th pose of the trial `i`, to the last that is
/// finite.
pub fn rollouts(
    trials: &[Trial],
    every: &[u64],
    until: Until,
    kind: SolverKind,
    threads: usize,
    control: &Control,
) -> Result<Vec<Outcome<Rollout>>, rayon::ThreadPoolBuildError> {
    each(trials, threads, control, |trial, i| {
        let every = every.get(i).copied().unwrap_or(1).max(1);
        let mut rollout = Rollout::with_rows(trial.steps() / every + 2);
        rollout.push(trial, &Stepper::new(trial, kind));
        let mut done = 0;
        let ended = run(trial, kind, control, |stepper| {
            done += 1;
            rollout.unconverged_steps += u64::from(!stepper.solution().converged);
            if until == Until::Unresolved && !stepper.is_resolved() {
                return Err(Ended::Diverged(Diverged { time: stepper.time() }));
            }
            if done % every == 0 || done == trial.steps() {
                rollout.push(trial, stepper);
            }
            Ok(())
        });
        match ended {
            // A robot that has gone out of all bounds, or spins faster than its steps show, has been seen until then.
            Err(Ended::Diverged(_)) | Ok(()) => Ok(rollout),
            Err(Ended::Stopped) => Err(Outcome::Stopped),
        }
    })
}

/// What `run_one` makes of each trial, in their order.
fn each<T: Send>(
    trials: &[Trial],
    threads: usize,
    control: &Control,
    run_one: impl Fn(&Trial, usize) -> Result<T, Outcome<T>> + Sync,
) -> Result<Vec<Outcome<T>>, rayon::ThreadPoolBuildError> {
    let guarded = |i: usize| {
        let outcome = catch_unwind(AssertUnwindSafe(|| run_one(&trials[i], i)));
        control.finished.fetch_add(1, Ordering::Relaxed);
        match outcome {
            Ok(Ok(done)) => Outcome::Done(done),
            Ok(Err(ended)) => ended,
            Err(panic) => Outcome::Failed(message(&*panic)),
        }
    };
    let order = longest_first(trials.iter().map(Trial::steps));
    let taken = AtomicUsize::new(0);
    let take_all = || -> Vec<(usize, Outcome<T>)> {
        let next = || order.get(taken.fetch_add(1, Ordering::Relaxed));
        iter::from_fn(next).map(|&i| (i, guarded(i))).collect()
    };
    let mut done = if threads == 1 {
        take_all()
    } else {
        ThreadPoolBuilder::new().num_threads(threads).build()?.broadcast(|_| take_all()).into_iter().flatten().collect()
    };
    done.sort_unstable_by_key(|&(i, _)| i);
    Ok(done.into_iter().map(|(_, outcome)| outcome).collect())
}

/// The places of some lengths, the longest first, equals as they come.
fn longest_first(lengths: impl Iterator<Item = u64>) -> Vec<usize> {
    let mut order: Vec<(usize, u64)> = lengths.enumerate().collect();
    order.sort_by_key(|&(_, length)| Reverse(length));
    order.into_iter().map(|(i, _)| i).collect()
}

/// Runs `trial` to its end or to that of `watch`, which sees every step.
fn run(
    trial: &Trial,
    kind: SolverKind,
    control: &Control,
    mut watch: impl FnMut(&Stepper) -> Result<(), Ended>,
) -> Result<(), Ended> {
    let mut stepper = Stepper::new(trial, kind);
    for done in 0..trial.steps() {
        if done % STEPS_BETWEEN_LOOKS == 0 && control.stop.load(Ordering::Relaxed) {
            return Err(Ended::Stopped);
        }
        stepper.advance();
        if !stepper.is_finite() {
            return Err(Ended::Diverged(Diverged { time: stepper.time() }));
        }
        watch(&stepper)?;
    }
    Ok(())
}

fn message(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "the solver panicked".to_owned())
}

#[cfg(test)]
mod tests {
    use super::longest_first;

    #[test]
    fn the_longest_is_taken_first() {
        assert_eq!(longest_first([200, 40, 400, 40].into_iter()), [2, 0, 1, 3]);
        assert_eq!(longest_first([].into_iter()), [0; 0]);
    }
}
