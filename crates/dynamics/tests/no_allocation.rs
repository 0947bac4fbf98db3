//! A step allocates nothing.
#![allow(unsafe_code)] // a counting allocator can be written in no other way

mod common;

use common::*;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use tumblers_dynamics::{SolverKind, Stepper, Trial};

thread_local! {
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

struct Counting;

unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.with(|count| count.set(count.get() + 1));
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
