//! Bad input is an error, not converging is a status.

mod common;

use std::cell::Cell;

use common::{Functions, complementarity, linear, mixed};
use faer::{Mat, MatMut};
use tumblers_mncp::{Direction, Error, Settings, Solver, Status};

fn identity(n: usize) -> impl tumblers_mncp::Problem {
    linear(Mat::identity(n, n), vec![-1.0; n])
}

fn solver(equalities: usize, pairs: usize) -> Solver {
    Solver::new(equalities, pairs, Settings::default()).unwrap()
}

#[test]
fn wrong_dimensions_are_errors() {
    let error = solver(0, 3).solve(&identity(3), &mut [0.0; 2]).unwrap_err();
    assert_eq!(error, Error::PointLength { expected: 3, found: 2 });
    let error = solver(1, 2).solve(&identity(3), &mut [0.0; 3]).unwrap_err();
    assert_eq!(error, Error::ProblemDimensions { expected: (1, 2), found: (0, 3) });
    assert!(error.to_string().contains("(0, 3)"));
}

#[test]
fn a_start_that_is_not_finite_is_an_error() {
    for value in [f64::INFINITY, f64::NEG_INFINITY] {
        let error = solver(0, 2).solve(&identity(2), &mut [0.0, value]).unwrap_err();
        assert_eq!(error, Error::NonFiniteStart { index: 1, value });
    }
    let error = solver(0, 2).solve(&identity(2), &mut [f64::NAN, 0.0]).unwrap_err();
    assert!(matches!(error, Error::NonFiniteStart { index: 0, value } if value.is_nan()));
}

#[test]
fn settings_out_of_range_are_errors() {
    let good = Settings::default;
    for bad in [
        Settings { tolerance: 0.0, ..good() },
        Settings { tolerance: f64::NAN, ..good() },
        Settings { tolerance: f64::INFINITY, ..good() },
        Settings { max_iterations: 0, ..good() },
        Settings { max_iterations: usize::MAX, ..good() },
        Settings { armijo: 0.5, ..good() },
        Settings { backtracking: 1.0, ..good() },
        Settings { memory: 0, ..good() },
        Settings { patience: 0, ..good() },
        Settings { min_step: 0.0, ..good() },
        Settings { min_gradient_step: 2.0, ..good() },
        Settings { descent: -1.0, ..good() },
        Settings { levenberg_marquardt: 0.0, ..good() },
        Settings { stationarity: 1.0, ..good() },
        Settings { smoothing_start: -1.0, ..good() },
        Settings { smoothing_reduction: 1.0, ..good() },
        Settings { smoothing_end: 0.0, ..good() },
    ] {
        assert!(matches!(Solver::new(0, 1, bad.clone()), Err(Error::Setting { .. })), "{bad:?}");
    }
}

/// `f = -1` and `f = -1 - v` cannot be made positive; `g = u² + 1` has no root.
#[test]
fn problems_without_a_solution_end_in_a_status() {
    let mut z = [1.0];
    let solution = solver(0, 1).solve(&complementarity(|_| [-1.0], |_| [[0.0]]), &mut z).unwrap();
    assert!(matches!(solution.status, Status::Stalled | Status::MaxIterations), "{solution:?}");
    assert!(solution.residual >= 1.0 && z[0].is_finite());

    let solution = solver(0, 1).solve(&complementarity(|z| [-1.0 - z[0]], |_| [[-1.0]]), &mut [0.5]).unwrap();
    assert!(matches!(solution.status, Status::Stalled | Status::MaxIterations), "{solution:?}");

    let mut z = [0.7];
    let solution = solver(1, 0).solve(&mixed(1, |z| [z[0] * z[0] + 1.0], |z| [[2.0 * z[0]]]), &mut z).unwrap();
    assert_eq!(solution.status, Status::Stalled);
    assert!((solution.residual - 1.0).abs() < 1e-6, "{solution:?}");
}

#[test]
fn running_out_of_iterations_returns_the_best_point() {
    let settings = Settings { max_iterations: 2, smoothing: false, ..Settings::default() };
    let mut solver = Solver::new(1, 0, settings).unwrap();
    let mut z = [10.0];
    let solution = solver.solve(&mixed(1, |z| [z[0].powi(3)], |z| [[3.0 * z[0] * z[0]]]), &mut z).unwrap();
    assert_eq!((solution.status, solution.iterations), (Status::MaxIterations, 2));
    assert_eq!(solution.residual, z[0].powi(3));
    assert!(z[0] < 10.0);
}

#[test]
fn functions_that_are_not_finite_end_in_a_status() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut z = [1.0, 2.0];
        let solution = solver(1, 1).solve(&mixed(1, |_| [0.5, value], |_| [[1.0; 2]; 2]), &mut z).unwrap();
        assert_eq!((solution.status, z), (Status::NotFinite, [1.0, 2.0]));
        assert!(solution.residual.is_nan());

        let solution = solver(1, 1).solve(&mixed(1, |_| [0.5, 1.0], |_| [[value; 2]; 2]), &mut z).unwrap();
        assert_eq!((solution.status, z), (Status::NotFinite, [1.0, 2.0]));
        assert_eq!(solution.residual, 1.0);
    }
}

/// From the third call on the callback returns NaN.
#[test]
fn a_callback_that_turns_nan_ends_in_a_status() {
    let calls = Cell::new(0);
    let problem = Functions {
        equalities: 1,
        pairs: 0,
        residual: |z: &[f64], out: &mut [f64]| {
            calls.set(calls.get() + 1);
            out[0] = if calls.get() > 2 { f64::NAN } else { z[0].exp() - 2.0 };
        },
        jacobian: |z: &[f64], mut out: MatMut<'_, f64>| out[(0, 0)] = z[0].exp(),
    };
    let mut z = [3.0];
    let solution = solver(1, 0).solve(&problem, &mut z).unwrap();
    assert_eq!(solution.status, Status::NotFinite);
    assert_eq!((solution.iterations, solution.residual), (1, z[0].exp() - 2.0));
}

#[test]
fn a_solver_can_be_moved_to_another_thread() {
    let mut solver = solver(0, 3);
    let solve = move || solver.solve(&identity(3), &mut [0.0; 3]).unwrap().status;
    assert_eq!(std::thread::spawn(solve).join().unwrap(), Status::Solved);
}

/// `0 = ln u` from 4: the first Newton step ends at `u < 0`.
#[test]
fn the_line_search_steps_around_what_is_not_finite() {
    let mut z = [4.0];
    let mut solver = solver(1, 0);
    let solution = solver.solve(&mixed(1, |z| [z[0].ln()], |z| [[1.0 / z[0]]]), &mut z).unwrap();
    assert_eq!(solution.status, Status::Solved);
    assert!((z[0] - 1.0).abs() < 1e-9);
    assert!(solver.statistics().iterations()[0].step < 1.0);
}

#[test]
fn statistics_hold_the_history() {
    let mut solver = solver(0, 3);
    let mut z = [5.0; 3];
    let solution = solver.solve(&identity(3), &mut z).unwrap();
    let statistics = solver.statistics();
    assert_eq!(statistics.iterations().len(), solution.iterations);
    assert_eq!(statistics.start_residual(), 4.0);
    assert_eq!(statistics.iterations().last().unwrap().residual, solution.residual);
    assert!(statistics.iterations().iter().all(|i| i.step == 1.0 && i.smoothing == 0.0));
    assert!(statistics.iterations().iter().all(|i| i.direction == Direction::Newton));
}

#[test]
fn a_warm_start_at_the_solution_takes_no_step() {
    let mut z = [1.0; 3];
    let solution = solver(0, 3).solve(&identity(3), &mut z).unwrap();
    assert_eq!((solution.status, solution.iterations, z), (Status::Solved, 0, [1.0; 3]));
}

#[test]
fn an_empty_problem_is_solved() {
    let solution = solver(0, 0).solve(&identity(0), &mut []).unwrap();
    assert_eq!((solution.status, solution.residual), (Status::Solved, 0.0));
}

/// A square system with the singular root 0: `g = u1² + u2²`, `u1 - u2`.
#[test]
fn a_singular_root_is_reached() {
    let problem = mixed(2, |z| [z[0] * z[0] + z[1] * z[1], z[0] - z[1]], |z| [[2.0 * z[0], 2.0 * z[1]], [1.0, -1.0]]);
    for start in [[0.0, 1.0], [3.0, -3.0], [1.0, 1.0]] {
        let mut z = start;
        let solution = solver(2, 0).solve(&problem, &mut z).unwrap();
        assert!(solution.status.is_solved(), "{solution:?} {start:?}");
    }
}
