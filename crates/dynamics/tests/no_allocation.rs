//! A step allocates nothing, and neither does a run that keeps its metrics only.
#![allow(unsafe_code)] // a counting allocator can be written in no other way

mod common;

use common::*;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use tumblers_dynamics::batch::{Control, sweep};
use tumblers_dynamics::{Outcome, SolverKind, Stepper, Trial};

thread_local! {
    static COUNT: Cell<u64> = const { Cell::new(0) };
    static BYTES: Cell<usize> = const { Cell::new(0) };
}

struct Counting;

unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.with(|count| count.set(count.get() + 1));
        BYTES.with(|bytes| bytes.set(bytes.get() + layout.size()));
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn a_run_allocates_nothing_after_its_start() {
    for parts in [
        cuboid_on_paper(0.01, 10.0),
        pdms(spiked(4.0), 10.0, 0.0),
        pdms(curved(), 0.0, 0.0),
        disturbed(pdms(spiked(4.0), 10.0, 0.0)),
    ] {
        let trial = Trial::new(parts).unwrap();
        let mut stepper = Stepper::new(&trial, SolverKind::Reduced);
        let before = COUNT.with(Cell::get);
        for _ in 0..trial.steps() {
            stepper.advance();
        }
        assert_eq!(COUNT.with(Cell::get) - before, 0);
    }
}

/// One thread is the thread that counts.
#[test]
fn a_run_that_keeps_its_metrics_takes_the_same_memory_for_a_hundred_times_the_steps() {
    let taken = |duration: f64| {
        let mut parts = cuboid_on_paper(0.01, 10.0);
        parts.duration = duration;
        let trials = [Trial::new(parts).unwrap()];
        let before = BYTES.with(Cell::get);
        let outcomes = sweep(&trials, 1, &Control::default()).unwrap();
        assert!(matches!(outcomes[0], Outcome::Done(_)));
        (trials[0].steps(), BYTES.with(Cell::get) - before)
    };
    // The general solver's kernels keep a buffer for each thread, which its first solver makes.
    taken(0.05);
    let (few, least) = taken(0.05);
    let (many, most) = taken(5.0);
    assert_eq!((many, most), (100 * few, least));
}
