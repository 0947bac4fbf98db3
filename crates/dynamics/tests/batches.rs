//! Batches: the same bits for any number of threads, and a stop that is heard.

mod common;

use common::*;
use std::sync::atomic::Ordering;
use tumblers_dynamics::batch::{Control, Outcome, sweep};
use tumblers_dynamics::{Metrics, Trial};

fn trials() -> Vec<Trial> {
    (0..12).map(|i| Trial::new(pdms(spiked(f64::from(i)), 10.0, 30.0 * f64::from(i))).unwrap()).collect()
}

fn bits(outcome: &Outcome) -> [u64; 5] {
    let Outcome::Done(Metrics { twist, drift, speed, max_residual, newton_iterations, .. }) = outcome else {
        panic!("{outcome:?}")
    };
    [twist.to_bits(), drift.to_bits(), speed.to_bits(), max_residual.to_bits(), *newton_iterations]
}

#[test]
fn the_bits_do_not_depend_on_the_threads() {
    let trials = trials();
    let run = |threads| -> Vec<_> { sweep(&trials, threads, &Control::default()).unwrap().iter().map(bits).collect() };
    let one = run(1);
    assert_eq!(one, run(2));
    assert_eq!(one, run(4));
}

#[test]
fn a_stopped_batch_says_so() {
    let control = Control::default();
    control.stop.store(true, Ordering::Relaxed);
    let outcomes = sweep(&trials(), 2, &control).unwrap();
    assert!(outcomes.iter().all(|outcome| *outcome == Outcome::Stopped));
    assert_eq!(control.finished.load(Ordering::Relaxed), outcomes.len());
}
