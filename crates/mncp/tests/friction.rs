//! The greatest dissipation of dry friction, the kind of problem with equalities that this solver is for.
//!
//! ```text
//! v_t = b + p_t,   v_n = c + p_n                        b, c: velocities without contact
//! 0 = μ² p_n v_t + p_t σ
//! 0 <= σ   ⟂ μ² p_n² - |p_t|² >= 0
//! 0 <= p_n ⟂ d + v_n >= 0
//! ```
//!
//! is solved by `p_n = max(0, -c - d)` and `p_t = -b min(1, μ p_n / |b|)`. Where `p_n = 0` all of the second and third
//! rows' derivatives vanish along `σ`, which is free; on the verge of sliding the friction pair is biactive.

mod common;

use common::{distance, jacobian_error, mixed, tight};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use tumblers_mncp::{Direction, Problem, Solver};

/// Unknowns `[v_x, v_y, v_n, p_x, p_y, σ, p_n]`
fn block(b: [f64; 2], c: f64, d: f64, mu: f64) -> impl Problem {
    let m = mu * mu;
    mixed(
        5,
        move |z| {
            let [vx, vy, vn, px, py, sigma, pn] = std::array::from_fn(|i| z[i]);
            [
                vx - b[0] - px,
                vy - b[1] - py,
                vn - c - pn,
                m * pn * vx + px * sigma,
                m * pn * vy + py * sigma,
                m * pn * pn - px * px - py * py,
                d + vn,
            ]
        },
        move |z| {
            let [vx, vy, _, px, py, sigma, pn]: [f64; 7] = std::array::from_fn(|i| z[i]);
            [
                [1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0],
                [0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0],
                [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0],
                [m * pn, 0.0, 0.0, sigma, 0.0, px, m * vx],
                [0.0, m * pn, 0.0, 0.0, sigma, py, m * vy],
                [0.0, 0.0, 0.0, -2.0 * px, -2.0 * py, 0.0, 2.0 * m * pn],
                [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
            ]
        },
    )
}

/// `[p_x, p_y, p_n]`
fn impulse(b: [f64; 2], c: f64, d: f64, mu: f64) -> [f64; 3] {
    let pn = (-c - d).max(0.0);
    let factor = (mu * pn / b[0].hypot(b[1])).min(1.0);
    [-b[0] * factor, -b[1] * factor, pn]
}

/// A block that a load is about to push with just the force that friction can hold: `σ = 0` and `|p_t| = μ p_n`.
#[test]
fn on_the_verge_of_sliding() {
    let problem = block([0.3, 0.4], -1.0, 0.0, 0.5);
    let mut solver = Solver::new(5, 2, tight()).unwrap();
    for start in [[0.0; 7], [1.0; 7], [0.3, 0.4, -1.0, 0.0, 0.0, 0.5, 0.0]] {
        assert!(jacobian_error(&problem, &start) < 1e-8);
        let mut z = start;
        let solution = solver.solve(&problem, &mut z).unwrap();
        assert!(solution.status.is_solved(), "{solution:?}");
        assert!(distance(&[z[3], z[4], z[6]], &[-0.3, -0.4, 1.0]) < 1e-5, "{z:?}");
    }
}

/// A guess of sliding at the speed 1 for a block of which the impulses are a tenth sticks at a stationary point of the
/// merit function, and is solved by the smoothing restart.
#[test]
fn smoothing_leaves_a_stationary_point() {
    let problem = block([0.02, 0.0], -0.1, 0.0, 0.3);
    let start = [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.1];
    let mut solver = Solver::new(5, 2, tight()).unwrap();
    let mut z = start;
    let solution = solver.solve(&problem, &mut z).unwrap();
    let steps = solver.statistics().iterations();
    assert!(solution.status.is_solved(), "{solution:?}");
    assert!(steps.iter().any(|i| i.direction == Direction::LevenbergMarquardt));
    assert!(steps.iter().any(|i| i.smoothing > 0.0));
    assert!(distance(&[z[3], z[4], z[6]], &[-0.02, 0.0, 0.1]) < 1e-9, "{z:?}");

    let direct = tumblers_mncp::Settings { smoothing: false, ..tight() };
    let solution = Solver::new(5, 2, direct).unwrap().solve(&problem, &mut { start }).unwrap();
    assert!(!solution.status.is_solved(), "{solution:?}");
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 5000, rng_seed: RngSeed::Fixed(1), failure_persistence: None, ..ProptestConfig::default()
    })]

    #[test]
    fn impulses_are_those_of_greatest_dissipation(
        b in prop::array::uniform2(-2.0..2.0),
        c in -2.0..0.0,
        d in prop_oneof![Just(0.0), 0.0..3.0],
        mu in 0.01..1.0,
        start in prop::array::uniform5(-1.0..1.0),
        pairs in prop::array::uniform2(0.0..2.0),
    ) {
        let mut z = [start[0], start[1], start[2], start[3], start[4], pairs[0], pairs[1]];
        let mut solver = Solver::new(5, 2, tight()).unwrap();
        let solution = solver.solve(&block(b, c, d, mu), &mut z).unwrap();
        prop_assert!(solution.status.is_solved(), "{:?}", solution);
        let error = distance(&[z[3], z[4], z[6]], &impulse(b, c, d, mu));
        prop_assert!(error < 1e-5, "{} {:?} {:?}", error, z, impulse(b, c, d, mu));
    }
}
