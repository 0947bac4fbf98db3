//! No heap allocation inside a solve.

#![allow(unsafe_code)]

mod common;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use common::{complementarity, linear};
use faer::Mat;
use tumblers_mncp::{Problem, Settings, Solver, Status};

struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

fn count() {
    ALLOCATIONS.with(|count| count.set(count.get() + 1));
}

// SAFETY: every call is handed on to the system's allocator; the counter is a `const` thread local without destructor,
// which allocates nothing.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        unsafe { System.realloc(pointer, layout, size) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// The status, the number of steps and the number of allocations of the first solve on this thread.
fn first_solve(problem: &impl Problem, settings: Settings) -> (Status, usize, usize) {
    let mut solver = Solver::new(problem.equalities(), problem.pairs(), settings).unwrap();
    let mut z = vec![0.5; problem.equalities() + problem.pairs()];
    let before = ALLOCATIONS.with(Cell::get);
    let solution = solver.solve(problem, &mut z).unwrap();
    (solution.status, solution.iterations, ALLOCATIONS.with(Cell::get) - before)
}

#[test]
fn the_counter_counts() {
    let before = ALLOCATIONS.with(Cell::get);
    std::hint::black_box(vec![0_u8; 100]);
    assert_eq!(ALLOCATIONS.with(Cell::get) - before, 1);
}

/// The sizes cover every kernel of faer that the factorisation chooses among.
#[test]
fn a_solve_allocates_nothing() {
    for n in [1, 4, 16, 17, 33, 64, 150] {
        std::thread::spawn(move || {
            let m = Mat::from_fn(n, n, |i, j| if i == j { 1.0 } else { 2.0 * f64::from(u8::from(j > i)) });
            let (status, iterations, allocations) = first_solve(&linear(m, vec![-1.0; n]), Settings::default());
            assert_eq!((status, allocations), (Status::Solved, 0), "{n}");
            assert!(iterations > 0);
        })
        .join()
        .unwrap();
    }
}

/// A problem without a solution runs through every kind of direction and through the smoothing restart.
#[test]
fn a_solve_that_fails_allocates_nothing() {
    let hopeless = complementarity(
        |z| [-1.0 - z[0] * z[0], z[1] * z[1] + 1.0 - z[0]],
        |z| [[-2.0 * z[0], 0.0], [-1.0, 2.0 * z[1]]],
    );
    let (status, iterations, allocations) = first_solve(&hopeless, Settings::default());
    assert_ne!(status, Status::Solved);
    assert!(iterations > 0);
    assert_eq!(allocations, 0);

    let n = 60;
    let flat = linear(Mat::full(n, n, -1.0), vec![-1.0; n]);
    let (status, _, allocations) = first_solve(&flat, Settings::default());
    assert_ne!(status, Status::Solved);
    assert_eq!(allocations, 0);
}
